// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <gtest/gtest.h>

#include "command.h"

namespace tetskin {
namespace {

using test::CommandFolder;
using test::CommandResult;
using test::figuresOf;

/// The test sums up momentum and energy itself, independently of the solver: where nothing is in contact, only rounding
/// may change them.
TEST(Contact, LosesNothingInFreeFlight) {
  const CommandFolder folder;
  const CommandResult result = folder.run(TETSKIN_CONTACT, {"--only", "free flight", "--json", "c.json"});
  ASSERT_EQ(result.status, 0) << result.out << result.err;
  const auto scenes = folder.json("c.json");
  ASSERT_EQ(scenes.size(), 2u);
  for (const auto& scene : scenes) {
    const auto figures = figuresOf(scene);
    EXPECT_LT(figures.at("linear momentum lost")["value"].get<double>(), 1e-6) << scene;
    EXPECT_LT(figures.at("angular momentum lost")["value"].get<double>(), 1e-5) << scene;
    EXPECT_NEAR(figures.at("energy over its start")["value"].get<double>(), 1.0, 1e-5) << scene;
  }
}

TEST(Contact, SaysWhatIsPromisedAndWhetherItHolds) {
  const CommandFolder folder;
  const CommandResult result =
      folder.run(TETSKIN_CONTACT, {"--only", "thin plate", "--json", "c.json", "--markdown", "c.md"});
  ASSERT_EQ(result.status, 0) << result.out << result.err;
  for (const auto& scene : folder.json("c.json")) {
    const auto gap = figuresOf(scene).at("least gap, S");
    EXPECT_TRUE(gap["passed"].get<bool>()) << scene;
    EXPECT_GE(gap["value"].get<double>(), gap["least"].get<double>()) << scene;
    EXPECT_EQ(gap.count("most"), 0u) << scene;
  }
  EXPECT_NE(folder.read("c.md").find("| thin plate, k50, k500 | least gap, S | >= -0.009 |"), std::string::npos)
      << folder.read("c.md");
  EXPECT_NE(result.out.find(" passed\n"), std::string::npos) << result.out;
}

/// Scenes where soft bodies collide with each other, hang from multibodies, or turn about what holds them.
TEST(Contact, HoldsWhatIsPromisedOfSoftBodiesAmongThemselves) {
  const CommandFolder folder;
  for (const char* scenes : {"soft collide/off-centre at 10", "pad/weightless", "held bar", "links"}) {
    const CommandResult result = folder.run(TETSKIN_CONTACT, {"--only", scenes, "--json", "c.json"});
    ASSERT_EQ(result.status, 0) << result.out << result.err;
    for (const auto& scene : folder.json("c.json")) {
      int promised = 0;
      for (const auto& figure : scene["figures"]) {
        promised += figure.contains("least") || figure.contains("most");
        EXPECT_TRUE(figure["passed"].get<bool>()) << scene["scene"] << figure;
      }
      EXPECT_GT(promised, 0) << scene;
      // A box glides along a pad that it touches only in some steps; without contact, the scene would prove nothing.
      if (scenes != std::string("pad/weightless")) continue;
      EXPECT_GT(figuresOf(scene).at("contact points")["value"].get<double>(), 0.05) << scene;
    }
  }
}

/// What slides comes near to edges from aside: those of tiles, and its own on a soft slab.
TEST(Contact, LetsThingsSlideAsFarAsCoulombSays) {
  const CommandFolder folder;
  for (const char* scene :
       {"slide over tiles/along", "slide over two height fields/along", "slide on slab/box/pinned"}) {
    const CommandResult result = folder.run(TETSKIN_CONTACT, {"--only", scene, "--json", "c.json"});
    ASSERT_EQ(result.status, 0) << result.out << result.err;
    const auto figures = figuresOf(folder.json("c.json")[0]);
    EXPECT_NEAR(figures.at("distance over v^2 / (2 mu g)")["value"].get<double>(), 1.0, 0.03) << scene;
    EXPECT_LT(figures.at("jump, S")["value"].get<double>(), 0.002) << scene;
  }
}

/// With contact at nodes nothing is promised, but they take the same side of an edge.
TEST(Contact, LetsNodesSlideOverSeams) {
  const CommandFolder folder;
  for (const char* scene : {"slide over tiles/along", "slide over mesh of 20000/along"}) {
    const CommandResult result =
        folder.run(TETSKIN_CONTACT, {"--only", scene, "--contact", "cage", "--json", "c.json"});
    ASSERT_EQ(result.status, 0) << result.out << result.err;
    const auto figures = figuresOf(folder.json("c.json")[0]);
    EXPECT_NEAR(figures.at("distance over v^2 / (2 mu g)")["value"].get<double>(), 1.0, 0.1) << scene;
  }
}

/// For Bullet's solver nothing is promised: it loses 4 % of the momentum here.
TEST(Contact, PromisesNothingOfBulletsSolver) {
  const CommandFolder folder;
  const CommandResult result =
      folder.run(TETSKIN_CONTACT, {"--only", "hit/1kg/k50", "--elasticity", "bullet", "--json", "b.json"});
  ASSERT_EQ(result.status, 0) << result.out << result.err;
  EXPECT_NE(result.out.find("FAILED"), std::string::npos) << result.out;
  const auto bullet = folder.json("b.json");
  EXPECT_FALSE(figuresOf(bullet[0]).at("linear momentum lost")["passed"].get<bool>()) << bullet;

  const CommandResult beside = folder.run(
      TETSKIN_CONTACT, {"--only", "free flight/k500", "--bullet", "b.json", "--markdown", "c.md", "--quiet"});
  ASSERT_EQ(beside.status, 0) << beside.out << beside.err;
  const std::string table = folder.read("c.md");
  EXPECT_NE(table.find("| tetskin-surface | Bullet |"), std::string::npos) << table;
  EXPECT_NE(table.find("| hit, k50, k500 | linear momentum lost | <= 0.001 |  | **"), std::string::npos) << table;
}

TEST(Contact, RefusesWhatItDoesNotKnow) {
  const CommandFolder folder;
  test::expectRefused(folder.run(TETSKIN_CONTACT, {"--only", "flying"}), "flying");
  test::expectRefused(folder.run(TETSKIN_CONTACT, {"--elasticity", "bullet", "--contact", "surface"}),
                      "--contact surface");
  folder.write("other.json", "{\"a\": 1}");
  test::expectRefused(folder.run(TETSKIN_CONTACT, {"--before", "other.json", "--only", "thin"}), "other.json");
}

}  // namespace
}  // namespace tetskin
