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
TEST(Gaps, AreSmallByTheSurfaceAndNotByTheCage) {
  const CommandFolder folder;
  const CommandResult result = folder.run(
      TETSKIN_GAPS, {"--shapes", "round", "--tets", "300", "--triangles", "8000", "--obstacles",
                     "floor,edge,hull,mesh,ball", "--seconds", "2", "--json", "g.json", "--markdown", "g.md"});
  ASSERT_EQ(result.status, 0) << result.out << result.err;
  const auto rows = folder.json("g.json");
  ASSERT_EQ(rows.size(), 5u);
  double maxByCage = 0.0;
  for (const auto& row : rows) {
    EXPECT_TRUE(row["passed"].get<bool>()) << row;
    ASSERT_TRUE(row["surface"]["touches"].get<bool>()) << row;
    EXPECT_LT(std::abs(row["surface"]["gap"].get<double>()), 0.003) << row;
    if (row["cage"]["touches"].get<bool>()) {
      maxByCage = std::max(maxByCage, std::abs(row["cage"]["gap"].get<double>()));
    }
    EXPECT_GT(row["deepest_surface"].get<double>(), -0.02) << row;
  }
  EXPECT_GT(maxByCage, 0.01);
  const std::string markdown = folder.read("g.md");
  EXPECT_NE(markdown.find("| floor |"), std::string::npos) << markdown;
}

TEST(Gaps, RefuseWhatTheyDoNotKnow) {
  const CommandFolder folder;
  test::expectRefused(folder.run(TETSKIN_GAPS, {"--shapes", "cloud"}), "cloud");
  test::expectRefused(folder.run(TETSKIN_GAPS, {"--obstacles", "air"}), "air");
}

}  // namespace
}  // namespace tetskin
