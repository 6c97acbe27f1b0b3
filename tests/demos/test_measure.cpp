// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors

#include <set>

#include "command.h"

namespace tetskin::test {
namespace {

class Measure : public testing::Test {
 protected:
  CommandResult measure(const std::vector<std::string>& arguments) const {
    return folder.run(TETSKIN_MEASURE, arguments);
  }
  /// The results of a run in which everything is as promised.
  nlohmann::json resultsOf(std::vector<std::string> arguments) const {
    arguments.insert(arguments.end(), {"--json", "m.json"});
    const CommandResult result = measure(arguments);
    EXPECT_EQ(result.status, 0) << result.out << result.err;
    return folder.json("m.json");
  }
  static double valueOf(const nlohmann::json& scene, const char* figure) {
    return figuresOf(scene).at(figure)["value"].get<double>();
  }

  CommandFolder folder;
};

/// The program sums up momentum and energy itself, independently of the solver: without contact, only rounding may
/// change them.
TEST_F(Measure, NothingIsLostInFreeFlight) {
  const auto scenes = resultsOf({"--only", "free flight"});
  ASSERT_EQ(scenes.size(), 2u);
  for (const auto& scene : scenes) {
    EXPECT_LT(valueOf(scene, "linear momentum lost"), 1e-6) << scene;
    EXPECT_LT(valueOf(scene, "angular momentum lost"), 1e-5) << scene;
    EXPECT_NEAR(valueOf(scene, "energy over its start"), 1.0, 1e-5) << scene;
  }
}

TEST_F(Measure, SaysWhatIsPromisedAndWhetherItHolds) {
  const CommandResult result = measure({"--only", "thin plate", "--json", "m.json"});
  ASSERT_EQ(result.status, 0) << result.out << result.err;
  for (const auto& scene : folder.json("m.json")) {
    const auto gap = figuresOf(scene).at("least gap, S");
    EXPECT_TRUE(gap["passed"].get<bool>()) << scene;
    EXPECT_GE(gap["value"].get<double>(), gap["least"].get<double>()) << scene;
    EXPECT_EQ(gap.count("most"), 0u) << scene;
  }
  EXPECT_NE(result.out.find(" passed\n"), std::string::npos) << result.out;
}

/// Scenes where soft bodies collide with each other, hang from multibodies, or turn about what holds them.
TEST_F(Measure, WhatIsPromisedOfSoftBodiesAmongThemselvesHolds) {
  for (const std::string scenes : {"soft collide/off-centre at 10", "pad/weightless", "held bar", "links"}) {
    for (const auto& scene : resultsOf({"--only", scenes})) {
      int promised = 0;
      for (const auto& figure : scene["figures"]) promised += figure.contains("least") || figure.contains("most");
      EXPECT_GT(promised, 0) << scene;
      // A box glides along a pad that it touches only in some steps; without contact, the scene would prove nothing.
      if (scenes == "pad/weightless") {
        EXPECT_GT(valueOf(scene, "contact points"), 0.05) << scene;
      }
    }
  }
}

/// Sliding bodies meet edges sideways: those of tiles, and their own on a soft slab. With contact at nodes nothing is
/// promised, but they take the same side of an edge.
TEST_F(Measure, ThingsSlideAsFarAsCoulombSays) {
  const char* distance = "distance over v^2 / (2 mu g)";
  for (const char* scene :
       {"slide over tiles/along", "slide over two height fields/along", "slide on slab/box/pinned"}) {
    const auto results = resultsOf({"--only", scene});
    EXPECT_NEAR(valueOf(results[0], distance), 1.0, 0.03) << scene;
    EXPECT_LT(valueOf(results[0], "jump, S"), 0.002) << scene;
  }
  for (const char* scene : {"slide over tiles/along", "slide over mesh of 20000/along"}) {
    EXPECT_NEAR(valueOf(resultsOf({"--only", scene, "--contact", "cage"})[0], distance), 1.0, 0.1) << scene;
  }
}

/// For Bullet's solver nothing is promised: it loses 4 % of the momentum here.
TEST_F(Measure, PromisesNothingOfBulletsSolver) {
  const CommandResult result = measure({"--only", "hit/1kg/k50", "--elasticity", "bullet", "--json", "b.json"});
  ASSERT_EQ(result.status, 0) << result.out << result.err;
  EXPECT_NE(result.out.find("FAILED"), std::string::npos) << result.out;
  const auto bullet = folder.json("b.json");
  EXPECT_FALSE(figuresOf(bullet[0]).at("linear momentum lost")["passed"].get<bool>()) << bullet;
}

/// A shape of each kind: the distances that the program measures and the contacts are computed independently.
TEST_F(Measure, GapsAreSmallByTheSurfaceAndNotByTheNodes) {
  double maxByNodes = 0.0;
  for (const std::string obstacle : {"floor", "edge", "hull", "mesh", "ball"}) {
    const auto scenes = resultsOf({"--only", "gap/300/" + obstacle + "/round"});
    ASSERT_EQ(scenes.size(), 1u);
    const auto figures = figuresOf(scenes[0]);
    EXPECT_LT(std::abs(figures.at("gap at rest by surface")["value"].get<double>()), 0.003) << scenes;
    EXPECT_TRUE(figures.at("gap at rest by surface").contains("most")) << scenes;
    EXPECT_GT(figures.at("least gap in impact by surface")["value"].get<double>(), -0.02) << scenes;
    // A body that has fallen off has none.
    const auto byNodes = figures.find("gap at rest by nodes");
    if (byNodes != figures.end()) maxByNodes = std::max(maxByNodes, std::abs(byNodes->second["value"].get<double>()));
  }
  EXPECT_GT(maxByNodes, 0.01);
}

TEST_F(Measure, QuickStressCasesHold) {
  const auto cases = resultsOf({"--group", "stress", "--quick", "--elasticity", "both"});
  EXPECT_GT(cases.size(), 100u);
  std::set<std::string> names, groups;
  std::map<std::string, bool> bounded;
  double steps = 0, unconverged = 0;
  for (const auto& row : cases) {
    const auto name = row["scene"].get<std::string>();
    EXPECT_TRUE(names.insert(name).second) << name << " twice";
    EXPECT_TRUE(row["broken"].empty()) << row;
    EXPECT_EQ(row["hash"].get<std::string>().size(), 16u) << row;
    groups.insert(name.substr(0, name.find('/')));
    const auto figures = figuresOf(row);
    if (figures.count("bounded")) bounded[name] = figures.at("bounded")["value"] == 1.0;
    const auto off = figures.find("steps that did not converge");  // only of what the library's solver simulates
    if (off == figures.end()) continue;
    steps += row["steps"].get<double>();
    unconverged += off->second["value"].get<double>();
    // If rigid bodies slide on rigid ones under a soft one, or balls rain on it, the bounds of friction converge slowly
    // over the passes; how often this happens depends on the last bit, and on the processor.
    EXPECT_LE(off->second["value"].get<double>(), row["steps"].get<double>() / 2) << row;
  }
  EXPECT_EQ(groups, (std::set<std::string>{"map", "force", "poisson", "damping", "substeps", "event", "stiff", "cage",
                                           "mesh", "claim", "contact", "soft_contact", "split", "reduced"}));
  EXPECT_LE(unconverged, 0.005 * steps);
  int gained = 0, cells = 0;
  for (const auto& [name, ours] : bounded) {
    if (name.rfind("map/tetskin/", 0) != 0) continue;
    EXPECT_TRUE(ours) << name << ": all of the map is stable, from 1 to 1e9 Pa";
    ++cells;
    const std::string cell = name.substr(std::string("map/tetskin/").size());
    const auto explicitly = bounded.find("map/explicit/" + cell), implicitly = bounded.find("map/implicit/" + cell);
    if (explicitly == bounded.end() || implicitly == bounded.end()) continue;
    gained += ours && !explicitly->second && !implicitly->second;
  }
  EXPECT_EQ(cells, 80);
  EXPECT_GT(gained, 5) << "what Bullet's force cannot hold, and ours can";
#ifdef TETSKIN_PYTHON
  const CommandResult drawn = folder.run(TETSKIN_PYTHON, {TETSKIN_PLOTS "/stability_map.py", "m.json", "map.png"});
  EXPECT_EQ(drawn.status, 0) << drawn.err;
  EXPECT_TRUE(folder.exists("map.png"));
  EXPECT_TRUE(folder.exists("map_tetskin.png"));
#endif
}

/// A body of 1 kg under a box of 1,000 kg, one that was flat, and one that was inside out.
TEST_F(Measure, BulletCannotWhatOursCan) {
  std::map<std::string, bool> bounded;
  for (const auto& row : resultsOf({"--only", "/E=1e+07/dt=1/240", "--elasticity", "both", "--quiet"}))
    bounded[row["scene"]] = valueOf(row, "bounded") == 1.0;
  for (const std::string scene : {"heavy_box", "squash_flat", "mirror"}) {
    EXPECT_FALSE(bounded.at("stiff/neo_hookean/explicit/" + scene + "/E=1e+07/dt=1/240")) << scene;
    EXPECT_TRUE(bounded.at("stiff/tetskin/" + scene + "/E=1e+07/dt=1/240")) << scene;
  }
}

TEST_F(Measure, LongCasesComeToRest) {
  expectRefused(measure({"--only", "long/"}), "long/");
  const auto cases = resultsOf({"--long", "--only", "long/tetskin/mill", "--quiet"});
  ASSERT_EQ(cases.size(), 1u);
  EXPECT_LT(valueOf(cases[0], "speed at the end"), 0.02);
  EXPECT_GT(valueOf(cases[0], "lowest"), -0.02);
}

}  // namespace
}  // namespace tetskin::test
