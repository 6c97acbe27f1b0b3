// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "command.h"

namespace tetskin {
namespace {

using test::CommandFolder;
using test::CommandResult;

/// Tests shapes of each kind: the distances that the program measures and the contacts are computed independently.
TEST(Gaps, AreSmallByTheSurfaceAndNotByTheNodes) {
  const CommandFolder folder;
  const CommandResult result = folder.run(
      TETSKIN_GAPS, {"--shapes", "round", "--tets", "300", "--triangles", "8000", "--obstacles",
                     "floor,edge,hull,mesh,ball", "--seconds", "2", "--json", "g.json", "--markdown", "g.md"});
  ASSERT_EQ(result.status, 0) << result.out << result.err;
  const auto scenes = folder.json("g.json");
  ASSERT_EQ(scenes.size(), 5u);
  double maxByNodes = 0.0;
  for (const auto& scene : scenes) {
    const auto figures = test::figuresOf(scene);
    const auto& gap = figures.at("gap at rest by surface");
    EXPECT_TRUE(gap["passed"].get<bool>()) << scene;
    EXPECT_LT(std::abs(gap["value"].get<double>()), 0.003) << scene;
    EXPECT_GT(figures.at("least gap in impact by surface")["value"].get<double>(), -0.02) << scene;
    // A body that has fallen off has none.
    const auto byNodes = figures.find("gap at rest by nodes");
    if (byNodes != figures.end()) maxByNodes = std::max(maxByNodes, std::abs(byNodes->second["value"].get<double>()));
  }
  EXPECT_GT(maxByNodes, 0.01);
  EXPECT_NE(folder.read("g.md").find("| gap/floor/round/300 |"), std::string::npos) << folder.read("g.md");
}

TEST(Gaps, RefuseWhatTheyDoNotKnow) {
  const CommandFolder folder;
  test::expectRefused(folder.run(TETSKIN_GAPS, {"--shapes", "cloud"}), "cloud");
  test::expectRefused(folder.run(TETSKIN_GAPS, {"--obstacles", "air"}), "air");
}

}  // namespace
}  // namespace tetskin
