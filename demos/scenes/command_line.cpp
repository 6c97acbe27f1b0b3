// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "scenes/command_line.h"

#include <LinearMath/btScalar.h>
#include <tetskin/tetskin.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <new>

#include "scenes/files.h"
#include "scenes/frame_writer.h"
#include "scenes/input_error.h"
#include "scenes/serpent.h"

namespace tetskin::scenes {
namespace {

constexpr int kMostFrames = 1000000;
constexpr auto kMostTets = static_cast<int>(kLargestTargetTets);

CLI::Validator isFileName() {
  return {[](std::string& text) { return std::string(text.empty() ? "the name of a file is empty" : ""); }, ""};
}

CLI::Validator isFinite(const char* demand, bool (*holds)(double)) {
  const auto check = [=](std::string& text) {
    char* end = nullptr;
    const double number = std::strtod(text.c_str(), &end);
    const bool good = !text.empty() && *end == '\0' && std::isfinite(number) && holds(number);
    return good ? std::string() : "'" + text + "' is not " + demand;
  };
  return {check, ""};
}

/// As the option itself reads it: "010" or "0x10" are the same number to both.
CLI::Validator isWholeNumber(long long least, long long most) {
  const std::string range = std::to_string(least) + " to " + std::to_string(most);
  const auto check = [=](std::string& text) {
    long long number = 0;
    const bool good = CLI::detail::lexical_cast(text, number) && number >= least && number <= most;
    return good ? std::string() : "'" + text + "' is not a whole number from " + range;
  };
  return {check, "INT in [" + std::to_string(least) + " - " + std::to_string(most) + "]"};
}

/// An option that takes one of some words, each for a value.
template <class Choice>
void addChoice(CLI::App& app, const std::string& name, Choice& choice,
               const std::vector<std::pair<std::string, Choice>>& words, const std::string& description) {
  std::vector<std::string> known;
  std::string preset;
  for (const auto& [word, value] : words) {
    known.push_back(word);
    if (value == choice) preset = word;
  }
  const auto choose = [&choice, words](const std::string& wanted) {
    for (const auto& [word, value] : words) {
      if (word == wanted) choice = value;
    }
  };
  app.add_option_function<std::string>(name, choose, description)->check(CLI::IsMember(known))->default_str(preset);
}

std::string textOf(const HelpEnd& end) {
  std::string text = "Examples:\n";
  for (const Example& example : end.examples) text += "  " + example.line + "\n      " + example.does + "\n";
  text += "\nExit status:\n  0  done\n";
  if (!end.failure.empty()) text += "  1  " + end.failure + "\n";
  return text + "  2  wrong arguments, unreadable input, or files that do not fit each other";
}

/// "--output" of "-o,--output".
std::string lastOf(const std::string& names) {
  return names.substr(names.rfind(',') + 1);
}

void requireStandardOutput() {
  if (std::fflush(stdout) != 0 || std::ferror(stdout)) throw InputError("standard output cannot be written");
}

std::string versionOf(const std::string& program) {
  char bullet[16];
  std::snprintf(bullet, sizeof bullet, "%d.%02d", BT_BULLET_VERSION / 100, BT_BULLET_VERSION % 100);
  return program + " " TETSKIN_VERSION "\nBullet " + bullet + ", " + (sizeof(btScalar) == 8 ? "double" : "float") +
         "\n";
}

}  // namespace

struct CommandLine::Parser {
  CLI::App app;
  std::vector<std::function<void(NamedFiles&)>> files = {};
};

CommandLine::CommandLine(const std::string& description, const HelpEnd& end)
    : parser_(new Parser{CLI::App(description)}) {
  parser_->app.footer(textOf(end));
  parser_->app.set_version_flag("--version", "", "Print the version, and Bullet's, and exit");
  parser_->app.option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
}

CommandLine::~CommandLine() = default;

void CommandLine::addFlag(const std::string& name, bool& value, const std::string& description) {
  parser_->app.add_flag(name, value, description);
}

void CommandLine::addText(const std::string& name, std::string& value, const std::string& description) {
  parser_->app.add_option(name, value, description);
}

void CommandLine::addName(const std::string& name, std::string& value, const std::string& description, Need need) {
  CLI::Option* option = parser_->app.add_option(name, value, description)->check(isFileName());
  option->required(need == Need::Required);
  if (!value.empty()) option->capture_default_str();
}

void CommandLine::addFiles(const std::function<void(NamedFiles& files)>& tell) {
  parser_->files.push_back(tell);
}

void CommandLine::addInput(const std::string& name, std::string& value, const std::string& description, Need need) {
  addName(name, value, description, need);
  addFiles([name, &value](NamedFiles& files) { files.reads(lastOf(name), value); });
}

void CommandLine::addOutput(const std::string& name, std::string& value, const std::string& description, Need need,
                            const std::vector<std::string>& extensions) {
  addName(name, value, description, need);
  addFiles([name, &value, extensions](NamedFiles& files) {
    if (!value.empty()) requireExtension(value, extensions);
    files.writes(lastOf(name), value);
  });
}

void CommandLine::addFolder(const std::string& name, std::string& value, const std::string& description,
                            const NamedFiles::IsWritten& isWritten) {
  addName(name, value, description, Need::Optional);
  addFiles([name, &value, isWritten](NamedFiles& files) { files.writesFolder(name, value, isWritten); });
}

void CommandLine::addCount(const std::string& name, int& value, const std::string& description, int most) {
  CLI::Option* option = parser_->app.add_option(name, value, description)->check(isWholeNumber(1, most));
  if (value > 0) option->capture_default_str();
}

void CommandLine::addCount(const std::string& name, std::size_t& value, const std::string& description, int most) {
  parser_->app.add_option(name, value, description)->check(isWholeNumber(1, most))->capture_default_str();
}

void CommandLine::addPositive(const std::string& name, double& value, const std::string& description) {
  parser_->app.add_option(name, value, description)->check(isFinite("a finite, positive number", [](double number) {
    return number > 0.0;
  }));
}

void CommandLine::addWord(const std::string& name, std::string& value, const std::vector<std::string>& known,
                          const std::string& description) {
  parser_->app.add_option(name, value, description)->check(CLI::IsMember(known));
}

void CommandLine::addWords(const std::string& name, std::vector<std::string>& values, const std::string& description) {
  parser_->app.add_option(name, values, description)->delimiter(',');
}

void CommandLine::addCounts(const std::string& name, std::vector<std::size_t>& values, const std::string& description) {
  parser_->app.add_option(name, values, description)
      ->delimiter(',')
      ->check(isWholeNumber(1, kMostTets))
      ->capture_default_str();
}

void CommandLine::addSurfaceOptions(ModelOptions& options) {
  addInput("--mesh", options.mesh, "Render mesh, any format assimp reads (default: the built-in --model)");
  std::vector<std::pair<std::string, BuiltIn>> words;
  for (const BuiltIn model : builtInModels()) words.emplace_back(nameOf(model), model);
  addChoice(parser_->app, "--model", options.builtIn, words, "A built-in model");
  parser_->app.get_option("--model")->excludes("--mesh");
  parser_->app.add_option("--triangles", options.triangles, "Triangles of the built-in model")
      ->check(isWholeNumber(kMinSerpentTriangles, kMaxSerpentTriangles))
      ->capture_default_str()
      ->excludes("--mesh");
}

void CommandLine::addMeshOptions(ModelOptions& options) {
  addSurfaceOptions(options);
  addCount("--tets", options.tets, "Tets of a built cage", kMostTets);
  addFlag("--whole", options.whole, "Do not split the cage where parts of the mesh lie nearer than a tet: they fuse");
  addFlag("--calibrate", options.calibrate, "Give the cage the softness of the mesh: coarse tets are too stiff");
}

void CommandLine::addModelOptions(ModelOptions& options) {
  addMeshOptions(options);
  addInput("--cage", options.cage, "Tet mesh: .vtk, .ele/.node or .msh (default: built from the mesh)");
  parser_->app.get_option("--cage")->excludes("--tets");
}

void CommandLine::addForceOption(Force& force) {
  addChoice(parser_->app, "--force", force, {{"bullet", Force::NeoHookean}, {"tetskin", Force::Elastic}},
            "Whose elastic forces and solver: the library's, or Bullet's neo-Hookean ones (--contact cage)");
}

void CommandLine::addContactOption(Contact& contact) {
  addChoice(parser_->app, "--contact", contact, {{"surface", Contact::Surface}, {"cage", Contact::Cage}},
            "What meets the obstacles: the surface as drawn, or the cage's nodes, as Bullet has it");
}

void CommandLine::addSelfContactOption(SelfContactWish& wish) {
  addChoice(parser_->app, "--self-contact", wish, {{"on", SelfContactWish::On}, {"off", SelfContactWish::Off}},
            "Whether a body meets itself at its surface (default: with --contact surface, unless the mesh is open)");
}

void CommandLine::addInterpolationOption(SkinOptions& options) {
  addChoice(parser_->app, "--interpolation", options.interpolation,
            {{"linear", Interpolation::Linear}, {"quadratic", Interpolation::Quadratic}},
            "How the surface follows the cage");
}

void CommandLine::addSkinOptions(SkinOptions& options) {
  addChoice(parser_->app, "--normals", options.normals,
            {{"none", Normals::None}, {"transformed", Normals::Transformed}, {"recomputed", Normals::Recomputed}},
            "Current normals of the surface");
  addChoice(parser_->app, "--outside", options.outside,
            {{"nearest", OutsideRule::Nearest}, {"barycentric", OutsideRule::Barycentric}},
            "Which tet carries a vertex outside the cage");
  parser_->app
      .add_option("--max-distance", options.maxDistance,
                  "Refuse a mesh with a vertex farther than this from the cage, in the mesh's unit")
      ->check(isFinite("a finite, non-negative number", [](double number) { return number >= 0.0; }));
}

void CommandLine::addSummaryOption(std::string& path, const std::string& description) {
  addOutput("--json", path, description);
}

void CommandLine::addQuietOption(bool& quiet) {
  addFlag("--quiet", quiet, "Print nothing but errors");
}

void CommandLine::addOutputOptions(OutputOptions& options) {
  addCount("--frames", options.frames, "Frames of 1/60 s", kMostFrames);
  addCount("--every", options.every, "Write every so many frames", kMostFrames);
  addFolder("--out", options.out, "Folder of the OBJ sequence", isOfFrames);
  addOutput("--view", options.view,
            std::string("Write a page that plays the run in a browser") +
                (options.viewByDefault ? " (default: view.html in the folder)" : ""));
  if (options.viewByDefault) addFlag("--no-view", options.noView, "Write no such page");
  addFlag("--hash", options.hash, "Print a hash of the nodes in all frames, which equal runs share");
  addSummaryOption(options.json, "File of the summary (default: summary.json in the folder)");
  addQuietOption(options.quiet);
  addFiles([&options](NamedFiles& files) {
    if (options.json.empty()) files.writes("--out", summaryPath(options));
    const bool hasView = options.viewByDefault && !options.noView && options.view.empty();
    if (hasView) files.writes("--out", (std::filesystem::path(options.out) / "view.html").string());
  });
}

bool CommandLine::given(const std::string& name) const {
  return parser_->app.count(name) > 0;
}

int CommandLine::run(int argc, char** argv, const std::function<int()>& demo) {
  const std::string name = std::filesystem::path(argv[0]).filename().string();
  try {
    try {
      parser_->app.parse(argc, argv);
      NamedFiles files;
      for (const auto& tell : parser_->files) tell(files);
      files.check();
      const int status = demo();
      requireStandardOutput();
      return status;
    } catch (const CLI::CallForHelp&) {
      std::fputs(parser_->app.help().c_str(), stdout);
    } catch (const CLI::CallForVersion&) {
      std::fputs(versionOf(name).c_str(), stdout);
    }
    requireStandardOutput();
    return kDone;
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "%s: out of memory; ask for fewer tets or triangles\n", name.c_str());
  } catch (const std::exception& error) {  // CLI::Error and InputError among them
    std::fprintf(stderr, "%s: %s\n", name.c_str(), error.what());
  }
  return kBadInput;
}

std::string summaryPath(const OutputOptions& options) {
  return options.json.empty() ? (std::filesystem::path(options.out) / "summary.json").string() : options.json;
}

}  // namespace tetskin::scenes
