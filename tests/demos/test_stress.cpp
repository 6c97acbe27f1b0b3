// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "command.h"

namespace tetskin {
namespace {

using test::CommandFolder;
using test::CommandResult;
using test::expectRefused;

class StressCommand : public testing::Test {
 protected:
  CommandResult stress(const std::vector<std::string>& arguments) const {
    return folder.run(TETSKIN_STRESS, arguments);
  }

  CommandFolder folder;
};

TEST_F(StressCommand, QuickCasesHold) {
  const CommandResult result = stress({"--quick", "--json", "s.json", "--markdown", "s.md"});
  ASSERT_EQ(result.status, 0) << result.out << result.err;
  const auto cases = folder.json("s.json");
  ASSERT_TRUE(cases.is_array());
  EXPECT_GT(cases.size(), 100u);
  std::set<std::string> names;
  std::set<bool> bounded;
  const std::string markdown = folder.read("s.md");
  for (const auto& row : cases) {
    const std::string name = row["name"];
    EXPECT_TRUE(names.insert(name).second) << name << " twice";
    EXPECT_TRUE(row["held"].get<bool>()) << row;
    EXPECT_TRUE(row["skin_finite"].get<bool>()) << row;
    EXPECT_TRUE(row["simulation_finite"].is_boolean());
    EXPECT_TRUE(row["status"].is_string());
    EXPECT_GE(row["amplification"], 0.0);
    EXPECT_GE(row["rest_error"], 0.0);
    bounded.insert(row["simulation_bounded"].get<bool>());
    EXPECT_NE(result.out.find(name), std::string::npos) << name;
    EXPECT_NE(markdown.find("| " + name + " |"), std::string::npos) << name;
  }
  EXPECT_EQ(bounded.size(), 2u) << "it tells what explodes from what does not";
#ifdef TETSKIN_PYTHON
  const CommandResult drawn = folder.run(TETSKIN_PYTHON, {TETSKIN_PLOTS "/stability_map.py", "s.json", "map.png"});
  EXPECT_EQ(drawn.status, 0) << drawn.err;
  EXPECT_TRUE(folder.exists("map.png"));
#endif
}

TEST_F(StressCommand, RunsTheCasesNamed) {
  const CommandResult result = stress({"--only", "node_nan/quadratic", "--json", "s.json", "--quiet"});
  EXPECT_EQ(result.status, 0);
  EXPECT_TRUE(result.out.empty()) << result.out;
  const auto cases = folder.json("s.json");
  ASSERT_EQ(cases.size(), 3u);
  for (const auto& row : cases) {
    EXPECT_FALSE(row["simulation_finite"].get<bool>());
    EXPECT_EQ(row["status"], "not finite");
    EXPECT_LT(row["rest_error"], 1e-6);
  }
}

TEST_F(StressCommand, RefusesBadInput) {
  expectRefused(stress({"--only", "no such case"}), "no such case");
  expectRefused(stress({"--often"}), "--often");
  expectRefused(stress({"--only", "mesh/non_finite/linear", "--json", "no/where.json"}), "no/where.json");
  expectRefused(stress({"--only", "mesh/non_finite/linear", "--markdown", "no/where.md"}), "no/where.md");
}

}  // namespace
}  // namespace tetskin
