// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The common features of the programs' command lines, tested for each program.
#include <LinearMath/btScalar.h>

#include <cctype>
#include <filesystem>
#include <map>
#include <sstream>
#include <utility>

#include "command.h"

namespace tetskin::test {
namespace {

using Arguments = std::vector<std::string>;

/// A program and its required arguments.
struct Program {
  std::string path;
  Arguments required = {};
};

const Program kDrop{TETSKIN_DROP}, kErrorVsTime{TETSKIN_ERROR_VS_TIME},
    kDeform{TETSKIN_DEFORM, {"--deformed", "d.vtk", "-o", "o.obj"}};

const char* const kAllPrograms[] = {TETSKIN_DROP, TETSKIN_PILE,   TETSKIN_DRAG,  TETSKIN_MEASURE,
                                    TETSKIN_CAGE, TETSKIN_DEFORM, TETSKIN_BENCH, TETSKIN_ERROR_VS_TIME};

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

class Options : public testing::Test {
 protected:
  /// Expects exit status 2, one short line that contains the word, and no files written.
  void expectRefusal(const Program& program, const Arguments& arguments, const std::string& word) const {
    Arguments all = program.required;
    all.insert(all.end(), arguments.begin(), arguments.end());
    SCOPED_TRACE(program.path + testing::PrintToString(all));
    const CommandResult result = folder.run(program.path, all);
    expectRefused(result, word);
    EXPECT_LT(result.err.size(), 160u) << result.err;
    EXPECT_FALSE(folder.exists("out"));
  }

  CommandFolder folder;
};

/// The check depends only on the option's kind, not on the program.
TEST_F(Options, ValuesThatMakeNoSenseAreRefused) {
  for (const char* option : {"--mesh", "--cage", "--out", "--json"}) expectRefusal(kDrop, {option, ""}, option);
  expectRefusal(kDeform, {"--mesh", "m.obj", "--cage", "c.vtk", "--dump-embedding", ""}, "--dump-embedding");
  for (const char* value : {"0", "-1", "1.5", "nan", "many", "", "1000001", "99999999999999999999"}) {
    expectRefusal(kDrop, {"--frames", value}, std::string("'") + value + "' is not a whole number from 1 to 1000000");
  }
  expectRefusal(kDrop, {"--triangles", "few"}, "'few' is not a whole number from 2000 to 2000000");
  expectRefusal(kDrop, {"--tets", "20000001"}, "from 1 to 20000000");
  for (const char* value : {"nan", "-inf", "1e999", "-0.001", "far", ""}) {
    expectRefusal(kDrop, {"--max-distance", value}, "--max-distance");
    expectRefusal(kErrorVsTime, {"--stiffness", value}, "--stiffness");
  }
  expectRefusal(kErrorVsTime, {"--stiffness", "0"}, "--stiffness");
  expectRefusal(kDrop, {"--model", "dragon"}, "--model");
  expectRefusal(kDrop, {"--interpolation", "cubic"}, "quadratic");
  expectRefusal(kDrop, {"--mehs", "x.obj"}, "--mehs");
}

TEST_F(Options, ASummaryThatCannotBeWrittenIsRefusedBeforeTheWork) {
  const CommandResult result = folder.run(TETSKIN_DROP, {"--triangles", "2000", "--json", "no/where.json"});
  expectRefused(result, "no/where.json");
  EXPECT_EQ((result.out + result.err).find("simulating"), std::string::npos) << result.out << result.err;
  EXPECT_FALSE(folder.exists("out"));
}

TEST_F(Options, TheTrialWhetherASummaryCanBeWrittenChangesNoFile) {
  folder.write("s.json", "earlier");
  for (const char* name : {"s.json", "new.json"}) {
    expectRefused(folder.run(TETSKIN_DROP, {"--mesh", "nowhere.obj", "--json", name}), "nowhere.obj");
  }
  std::filesystem::create_symlink("target.json", folder.path("link.json"));
  expectRefused(folder.run(TETSKIN_DROP, {"--mesh", "nowhere.obj", "--json", "link.json"}), "nowhere.obj");
  EXPECT_EQ(folder.read("s.json"), "earlier");
  EXPECT_FALSE(folder.exists("new.json"));
  EXPECT_FALSE(folder.exists("target.json"));
  EXPECT_TRUE(std::filesystem::is_symlink(folder.path("link.json")));
}

TEST_F(Options, ACageOfAnotherModelIsRefusedWithTheNamesOfBoth) {
  folder.write("m.obj", "v 0 0 0\nv 2 0 0\nv 0 2 0\nv 0.1 0.1 0.1\nf 1 2 3\nf 1 2 4\n");
  folder.write("other.vtk",
               "# vtk DataFile Version 2.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 double\n0 0 0.05\n1 0 0.05\n"
               "0 1 0.05\n0 0 1\nCELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n10\n");
  for (const Program& program : {kDrop, Program{TETSKIN_DEFORM, {"--deformed", "other.vtk", "-o", "o.obj"}}}) {
    for (const char* word : {"m.obj", "other.vtk", "3 of 4 vertices"}) {
      Arguments all = program.required;
      all.insert(all.end(), {"--mesh", "m.obj", "--cage", "other.vtk"});
      expectRefused(folder.run(program.path, all), word);
    }
    EXPECT_FALSE(folder.exists("o.obj") || folder.exists("out"));
  }
}

/// An option as shown by --help.
struct ShownOption {
  std::string name, syntax, description;
};

/// The options in a program's --help: their names are indented by at least two blanks, and their descriptions start at
/// column 30, some of them on separate lines.
std::vector<ShownOption> shownOptions(const std::string& help) {
  constexpr std::size_t kColumn = 30;
  std::vector<ShownOption> options;
  std::istringstream lines(help.substr(0, help.find("\nExamples:")));
  for (std::string line; std::getline(lines, line);) {
    const auto add = [&](const std::string& text) {
      std::string& description = options.back().description;
      description += (description.empty() ? "" : " ") + text;
    };
    if (line.compare(0, 3, "  -") == 0) {
      const bool both = line.size() > kColumn && line[kColumn - 1] == ' ' && std::isupper(line[kColumn]);
      const std::string syntax = both ? line.substr(0, line.find_last_not_of(' ', kColumn - 1) + 1) : line;
      const std::size_t begin = syntax.find("--");
      options.push_back({syntax.substr(begin, syntax.find_first_of(" ;", begin) - begin), syntax, ""});
      if (both) add(line.substr(kColumn));
    } else if (!options.empty() && line.compare(0, kColumn, std::string(kColumn, ' ')) == 0) {
      add(line.substr(kColumn));
    }
  }
  return options;
}

/// The description without the note in parentheses on how this program uses the option.
std::string withoutNote(const std::string& description) {
  const std::size_t note = description.rfind(" (");
  return note != std::string::npos && description.back() == ')' ? description.substr(0, note) : description;
}

TEST_F(Options, OneOfSeveralProgramsHasTheSameDescriptionAndPlaceInAll) {
  std::map<std::string, std::string> descriptions;
  std::map<std::string, int> programs;
  // The program, by the names of two options in this order.
  std::map<std::pair<std::string, std::string>, std::string> order;
  for (const std::string path : kAllPrograms) {
    const std::vector<ShownOption> options = shownOptions(folder.run(path, {"--help"}).out);
    ASSERT_GT(options.size(), 4u) << path;
    for (std::size_t k = 0; k < options.size(); ++k) {
      const std::string text = withoutNote(options[k].description);
      EXPECT_FALSE(text.empty() || text.back() == '.') << path << " " << options[k].name << ": " << text;
      EXPECT_FALSE(contains(text, "default")) << path << " " << options[k].name << ": defaults are in brackets";
      EXPECT_EQ(descriptions.emplace(options[k].name, text).first->second, text) << path << " " << options[k].name;
      ++programs[options[k].name];
      for (std::size_t j = 0; j < k; ++j) {
        order[{options[j].name, options[k].name}] = path;
        const auto other = order.find({options[k].name, options[j].name});
        EXPECT_TRUE(other == order.end())
            << options[j].name << " before " << options[k].name << " in " << path << ", but not in " << other->second;
      }
    }
  }
  for (const char* shared : {"--mesh", "--tets", "--triangles", "--frames", "--out", "--every", "--json", "--quiet",
                             "--elasticity", "--contact", "--self-contact", "--hash", "--view", "--quick"}) {
    EXPECT_GT(programs[shared], 1) << shared;
  }
}

// The tests of the pages run the examples themselves.
TEST_F(Options, HelpOfEveryProgramEndsWithExamplesAndExitStatuses) {
  for (const std::string path : kAllPrograms) {
    const CommandResult result = folder.run(path, {"--help"});
    const std::string name = std::filesystem::path(path).filename().string();
    EXPECT_EQ(result.status, 0) << name;
    EXPECT_EQ(result.err, "") << name;
    const std::size_t end = result.out.find("\nExamples:\n  " + name);
    ASSERT_NE(end, std::string::npos) << result.out;
    EXPECT_LT(result.out.rfind("  --"), end) << "options behind the examples: " << result.out;
    for (const char* status : {"\nExit status:\n  0  done\n", "\n  2  invalid arguments"}) {
      EXPECT_TRUE(contains(result.out.substr(end), status)) << result.out;
    }
    const bool neverFails = path == TETSKIN_DEFORM || path == TETSKIN_BENCH;
    EXPECT_NE(contains(result.out.substr(end), "\n  1  "), neverFails) << result.out;
  }
}

TEST_F(Options, VersionOfEveryProgramIsTheProjectsAndTellsOfBullet) {
  const std::string number = std::to_string(BT_BULLET_VERSION);  // 324
  const std::string bullet = "Bullet " + number.substr(0, 1) + "." + number.substr(1) + ", " +
                             (sizeof(btScalar) == 8 ? "double" : "float") + "\n";
  for (const std::string path : kAllPrograms) {
    const CommandResult result = folder.run(path, {"--version"});
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(result.out, std::filesystem::path(path).filename().string() + " " TETSKIN_PROJECT_VERSION "\n" + bullet);
  }
}

TEST_F(Options, OfAnOptionGivenTwiceTheLastCounts) {
  const CommandResult result = folder.run(TETSKIN_CAGE, {"--triangles", "2000", "--tets", "1000", "--tets", "100", "-o",
                                                         "a.vtk", "-o", "b.vtk", "--json", "s.json"});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(folder.json("s.json").at("target_tets"), 100);
  EXPECT_TRUE(folder.exists("b.vtk") && !folder.exists("a.vtk"));
}

}  // namespace
}  // namespace tetskin::test
