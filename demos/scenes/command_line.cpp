// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "scenes/command_line.h"

#include <LinearMath/btScalar.h>
#include <tetskin/tetskin.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <new>
#include <sstream>
#include <utility>

#include "scenes/files.h"
#include "scenes/formats.h"
#include "scenes/frame_writer.h"
#include "scenes/input_error.h"
#include "scenes/serpent.h"
#include "scenes/shared_options.h"

namespace tetskin::scenes {
namespace {

constexpr int kMaxFrames = 1000000;
constexpr const char* kOwnOptions = "Options";
constexpr std::size_t kHelpWidth = 110;
constexpr auto kMaxTets = static_cast<int>(Limits::kMaxTargetTets);

CLI::Validator isFileName() {
  return {[](std::string& text) { return std::string(text.empty() ? "the file name is empty" : ""); }, ""};
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

/// Reads numbers as the option itself does: "010" and "0x10" mean the same to both.
CLI::Validator isWholeNumber(long long minimum, long long maximum) {
  const std::string range = std::to_string(minimum) + " to " + std::to_string(maximum);
  const auto check = [=](std::string& text) {
    long long number = 0;
    const bool good = CLI::detail::lexical_cast(text, number) && number >= minimum && number <= maximum;
    return good ? std::string() : "'" + text + "' is not a whole number from " + range;
  };
  return {check, ""};
}

/// "N", with its range unless that is all positive numbers of the type int.
std::string countLabel(long long minimum, long long maximum) {
  if (minimum == 1 && maximum == std::numeric_limits<int>::max()) return "N";
  return "N:" + std::to_string(minimum) + ".." + std::to_string(maximum);
}

/// The description of an option: the shared one with a note, or the program's own text.
std::string optionText(const std::string& names, const std::string& text) {
  const SharedOption* shared = sharedOption(names);
  if (!shared) return text;
  return text.empty() ? shared->description : shared->description + " (" + text + ")";
}

/// Breaks a text into lines with at most this many characters.
std::string wrapped(const std::string& text, std::size_t width) {
  std::istringstream words(text);
  std::string result, line;
  for (std::string word; words >> word;) {
    if (!line.empty() && line.size() + 1 + word.size() > width) {
      result += line + "\n";
      line.clear();
    }
    line += (line.empty() ? "" : " ") + word;
  }
  return result + line;
}

/// Options that several programs have stand under the same headings and in the same order everywhere, after the
/// program's own options.
class HelpFormat : public CLI::Formatter {
 public:
  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode /*mode*/) const override {
    std::vector<std::string> groups = {kOwnOptions};
    for (const SharedOption& option : sharedOptions()) {
      if (groups.back() != option.group) groups.push_back(option.group);
    }
    std::string text = make_description(app) + make_usage(app, std::move(name));
    for (const std::string& group : groups) {
      std::vector<const CLI::Option*> options = app->get_options(
          [&](const CLI::Option* option) { return option->nonpositional() && option->get_group() == group; });
      std::stable_sort(options.begin(), options.end(),
                       [](const CLI::Option* a, const CLI::Option* b) { return rank(*a) < rank(*b); });
      if (!options.empty()) text += make_group(group, false, options);
    }
    return text + "\n" + make_footer(app);
  }

  std::string make_description(const CLI::App* app) const override {
    return wrapped(app->get_description(), kHelpWidth) + "\n";
  }
  std::string make_option_desc(const CLI::Option* option) const override {
    return wrapped(option->get_description(), kHelpWidth - get_column_width());
  }

  /// A value's description, such as "FILE [default]; excludes --cage".
  std::string make_option_opts(const CLI::Option* option) const override {
    std::string text;
    if (option->get_type_size() != 0) text += " " + option->get_type_name();
    if (option->get_required()) text += " (required)";
    if (!option->get_default_str().empty()) text += " [" + option->get_default_str() + "]";
    std::vector<std::string> excluded;
    for (const CLI::Option* other : option->get_excludes()) excluded.push_back(other->get_name());
    std::sort(excluded.begin(), excluded.end());
    for (const std::string& name : excluded) text += (name == excluded.front() ? "; excludes " : ", ") + name;
    return text;
  }

 private:
  static std::ptrdiff_t rank(const CLI::Option& option) {
    const SharedOption* shared = sharedOption(option.get_name());
    return shared ? shared - sharedOptions().data() : -1;
  }
};

/// label  shown by --help for the value; preset  shown as the default
CLI::Option* labelled(CLI::Option* option, const std::string& label, const std::string& preset = "") {
  option->type_name(label);
  if (!preset.empty()) option->default_str(preset);
  return option;
}

std::string joined(const std::vector<std::string>& words, char separator) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : std::string(1, separator)) + word;
  return text;
}

CLI::Validator isOneOf(const std::vector<std::string>& words) {
  const auto check = [words](std::string& text) {
    if (std::count(words.begin(), words.end(), text) > 0) return std::string();
    return "'" + text + "' is not one of " + joined(words, '|');
  };
  return {check, ""};
}

/// Six digits, without trailing zeros.
std::string plainNumber(double number) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", number);
  return text;
}

std::string textOf(const HelpEnd& end) {
  std::string text = "Examples:\n";
  for (const Example& example : end.examples) text += "  " + example.line + "\n      " + example.does + "\n";
  text += "\nExit status:\n  0  done\n";
  if (!end.failure.empty()) text += "  1  " + end.failure + "\n";
  return text + "  2  invalid arguments, unreadable input, or files that do not match each other";
}

/// Returns "--output" for "-o,--output".
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
  std::vector<std::string> arguments = {};  ///< as given

  /// The arguments as given, but without these options and their values.
  std::vector<std::string> argumentsWithout(const std::vector<std::string>& names) const;

  /// Adds an option that CLI11 reads into `value`; under the shared heading if the option is shared.
  template <class Value>
  CLI::Option* add(const std::string& name, Value& value, const std::string& text) {
    return placed(app.add_option(name, value, optionText(name, text)), name);
  }
  static CLI::Option* placed(CLI::Option* option, const std::string& name) {
    const SharedOption* shared = sharedOption(name);
    return option->group(shared ? shared->group : kOwnOptions);
  }

  /// Adds an option whose value is one of several words, each of which stands for a value.
  template <class Choice>
  void addChoice(const std::string& name, Choice& choice, const std::vector<std::pair<std::string, Choice>>& words,
                 const std::string& text = "") {
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
    CLI::Option* option = app.add_option_function<std::string>(name, choose, optionText(name, text));
    labelled(placed(option, name), joined(known, '|'), preset)->check(isOneOf(known));
  }
};

std::vector<std::string> CommandLine::Parser::argumentsWithout(const std::vector<std::string>& names) const {
  std::vector<std::string> kept;
  for (std::size_t k = 0; k < arguments.size(); ++k) {
    const std::string& argument = arguments[k];
    const std::string name = argument.substr(0, argument.find('='));
    if (std::find(names.begin(), names.end(), name) == names.end()) {
      kept.push_back(argument);
    } else if (name.size() == argument.size() && app.get_option(name)->get_items_expected_max() > 0) {
      ++k;  // its value
    }
  }
  return kept;
}

CommandLine::CommandLine(const std::string& description, const HelpEnd& end)
    : parser_(new Parser{CLI::App(description)}) {
  CLI::App& app = parser_->app;
  app.formatter(std::make_shared<HelpFormat>());
  app.footer(textOf(end));
  app.set_help_flag("-h,--help", "Print this help and exit");
  app.set_version_flag("--version", "", "Print the versions of tetskin and Bullet and exit");
  app.option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
}

CommandLine::~CommandLine() = default;

void CommandLine::addFlag(const std::string& name, bool& value, const std::string& text) {
  Parser::placed(parser_->app.add_flag(name, value, optionText(name, text)), name);
}

void CommandLine::addText(const std::string& name, std::string& value, const std::string& text) {
  labelled(parser_->add(name, value, text), "TEXT", value);
}

void CommandLine::addName(const std::string& name, std::string& value, const std::string& text, Need need,
                          const char* label, const std::string& preset) {
  CLI::Option* option = parser_->add(name, value, text)->check(isFileName());
  labelled(option, label, value.empty() ? preset : value)->required(need == Need::Required);
}

void CommandLine::addFiles(const std::function<void(NamedFiles& files)>& tell) {
  parser_->files.push_back(tell);
}

void CommandLine::addInput(const std::string& name, std::string& value, const std::string& text, Need need,
                           const std::string& preset) {
  addName(name, value, text, need, "FILE", preset);
  addFiles([name, &value](NamedFiles& files) { files.reads(lastOf(name), value); });
}

void CommandLine::addInputs(const std::string& name, std::vector<std::string>& values, const std::string& text,
                            Need need) {
  CLI::Option* option = parser_->add(name, values, text)->check(isFileName())->expected(1, kMaxFrames);
  labelled(option->multi_option_policy(CLI::MultiOptionPolicy::TakeAll), "FILE ...")->required(need == Need::Required);
  addFiles([name, &values](NamedFiles& files) {
    for (const std::string& value : values) files.reads(lastOf(name), value);
  });
}

void CommandLine::addOutput(const std::string& name, std::string& value, const std::string& text, Need need,
                            const std::vector<std::string>& extensions, const std::string& preset) {
  addName(name, value, text, need, "FILE", preset);
  addFiles([name, &value, extensions](NamedFiles& files) {
    if (!value.empty()) requireExtension(value, extensions);
    files.writes(lastOf(name), value);
  });
}

void CommandLine::addFolder(const std::string& name, std::string& value, const std::string& text,
                            const NamedFiles::IsWritten& isWritten) {
  addName(name, value, text, Need::Optional, "FOLDER", "");
  addFiles([name, &value, isWritten](NamedFiles& files) { files.writesFolder(name, value, isWritten); });
}

void CommandLine::addCount(const std::string& name, int& value, const std::string& text, int maximum,
                           const std::string& preset) {
  CLI::Option* option = parser_->add(name, value, text)->check(isWholeNumber(1, maximum));
  labelled(option, countLabel(1, maximum), value > 0 ? std::to_string(value) : preset);
}

void CommandLine::addCount(const std::string& name, std::size_t& value, const std::string& text, int maximum) {
  CLI::Option* option = parser_->add(name, value, text)->check(isWholeNumber(1, maximum));
  labelled(option, countLabel(1, maximum), std::to_string(value));
}

void CommandLine::addPositive(const std::string& name, double& value, const std::string& text,
                              const std::string& preset) {
  CLI::Option* option = parser_->add(name, value, text);
  option->check(isFinite("a finite, positive number", [](double number) { return number > 0.0; }));
  labelled(option, "X", value > 0.0 ? plainNumber(value) : preset);
}

void CommandLine::addWord(const std::string& name, std::string& value, const std::vector<std::string>& known,
                          const std::string& text) {
  labelled(parser_->add(name, value, text), joined(known, '|'), value)->check(isOneOf(known));
}

void CommandLine::addWords(const std::string& name, std::vector<std::string>& values, const std::string& text,
                           const std::string& preset) {
  labelled(parser_->add(name, values, text)->delimiter(','), "LIST", values.empty() ? preset : joined(values, ','));
}

void CommandLine::addCounts(const std::string& name, std::vector<std::size_t>& values, const std::string& text) {
  std::vector<std::string> preset;
  for (const std::size_t value : values) preset.push_back(std::to_string(value));
  CLI::Option* option = parser_->add(name, values, text)->delimiter(',')->check(isWholeNumber(1, kMaxTets));
  labelled(option, "LIST", joined(preset, ','));
}

void CommandLine::addSurfaceOptions(ModelOptions& options) {
  addInput("--mesh", options.mesh);
  std::vector<std::pair<std::string, BuiltIn>> words;
  for (const BuiltIn model : builtInModels()) words.emplace_back(nameOf(model), model);
  parser_->addChoice("--model", options.builtIn, words);
  parser_->app.get_option("--model")->excludes("--mesh");
  CLI::Option* triangles = parser_->add("--triangles", options.triangles, "");
  triangles->check(isWholeNumber(kMinSerpentTriangles, kMaxSerpentTriangles))->excludes("--mesh");
  labelled(triangles, countLabel(kMinSerpentTriangles, kMaxSerpentTriangles), std::to_string(options.triangles));
}

void CommandLine::addMeshOptions(ModelOptions& options) {
  addSurfaceOptions(options);
  addCount("--tets", options.tets, "", kMaxTets);
  addFlag("--no-duplicate-elements", options.whole);
  addFlag("--calibrate", options.calibrate);
}

void CommandLine::addModelOptions(ModelOptions& options) {
  addMeshOptions(options);
  addInput("--cage", options.cage, "", Need::Optional, "built from the mesh");
  parser_->app.get_option("--cage")->excludes("--tets");
}

void CommandLine::addElasticityOption(Force& force, const std::string& text) {
  parser_->addChoice("--elasticity", force, {{"tetskin", Force::Elastic}, {"bullet", Force::NeoHookean}}, text);
}

void CommandLine::addContactOption(Contact& contact) {
  parser_->addChoice("--contact", contact, {{"surface", Contact::Surface}, {"cage", Contact::Cage}});
}

void CommandLine::addSelfContactOption(SelfContactWish& wish) {
  parser_->addChoice(
      "--self-contact", wish,
      {{"auto", SelfContactWish::WherePossible}, {"on", SelfContactWish::On}, {"off", SelfContactWish::Off}});
}

void CommandLine::addInterpolationOption(SkinOptions& options) {
  parser_->addChoice("--interpolation", options.interpolation,
                     {{"linear", Interpolation::Linear}, {"quadratic", Interpolation::Quadratic}});
}

void CommandLine::addSkinOptions(SkinOptions& options) {
  parser_->addChoice(
      "--normals", options.normals,
      {{"none", Normals::None}, {"transformed", Normals::Transformed}, {"recomputed", Normals::Recomputed}});
  parser_->addChoice("--outside", options.outside,
                     {{"nearest", OutsideRule::Nearest}, {"barycentric", OutsideRule::Barycentric}});
  CLI::Option* distance = parser_->add("--max-distance", options.maxDistance, "");
  distance->check(isFinite("a finite, non-negative number", [](double number) { return number >= 0.0; }));
  labelled(distance, "X", "no limit");
}

void CommandLine::addSummaryOption(std::string& path, const std::string& preset) {
  addOutput("--json", path, "", Need::Optional, {}, preset);
}

void CommandLine::addQuietOption(bool& quiet) {
  addFlag("--quiet", quiet);
}

void CommandLine::addOutputOptions(OutputOptions& options) {
  const auto inFolder = [&](const char* name) { return (std::filesystem::path(options.out) / name).string(); };
  addCount("--frames", options.frames, "", kMaxFrames);
  addFolder("--out", options.out, "", isOfFrames);
  const std::vector<std::string> formats = {"obj", "glb", "pc2"};
  labelled(parser_->add("--format", options.formats, "")->delimiter(',')->check(isOneOf(formats)), "LIST", "obj,glb");
  addCount("--every", options.every, "", kMaxFrames);
  addOutput("--view", options.view, "", Need::Optional, {}, options.viewByDefault ? inFolder("view.html") : "");
  if (options.viewByDefault) addFlag("--no-view", options.noView);
  addSummaryOption(options.json, inFolder("summary.json"));
  addFlag("--hash", options.hash);
  addFlag("--check-determinism", options.checkDeterminism);
  addOutput("--record", options.record);
  addInput("--replay", options.replay);
  addQuietOption(options.quiet);
  addFiles([this, &options](NamedFiles& files) {
    options.program = parser_->app.get_name();
    options.arguments = parser_->argumentsWithout({"--record", "--replay", "--check-determinism"});
    requireFormats(options);
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
  parser_->app.name(name);
  try {
    try {
      parser_->arguments.assign(argv + 1, argv + argc);
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
  } catch (const std::exception& error) {  // includes CLI::Error and InputError
    std::fprintf(stderr, "%s: %s\n", name.c_str(), error.what());
  }
  return kBadInput;
}

std::string summaryPath(const OutputOptions& options) {
  return options.json.empty() ? (std::filesystem::path(options.out) / "summary.json").string() : options.json;
}

}  // namespace tetskin::scenes
