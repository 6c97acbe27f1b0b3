// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <gtest/gtest.h>

#include <map>

#include "command.h"
#include "scenes/crowd.h"
#include "scenes/model.h"
#include "scenes/placement.h"
#include "scenes/system.h"
#include "scenes/table.h"

namespace tetskin {
namespace {

using test::CommandFolder;
using test::CommandResult;

TEST(Crowd, SleepersStayAsleepAndInPlaceWhileTheOthersFall) {
  scenes::ModelOptions options;
  options.builtIn = scenes::BuiltIn::Bar;
  options.triangles = 2000;
  options.tets = 100;
  const scenes::Model model = scenes::loadModel(options);
  const scenes::Placement position = scenes::placementOf(boundingBox(model.cage.mesh.nodes));
  scenes::SceneOptions scene;
  scene.bodies = 21;
  const auto crowd = scenes::sceneNamed("crowd").make(position.toWorld(model.cage), scene);
  EXPECT_EQ(scenes::asleepCount(*crowd), 0u);
  scenes::setAsleep(*crowd, true);
  EXPECT_EQ(scenes::asleepCount(*crowd), 21 - scenes::awakeAmong(21));
  std::vector<btScalar> heights;
  for (std::size_t i = 0; i < crowd->bodyCount(); ++i) heights.push_back(crowd->body(i).m_nodes[0].m_x.y());
  EXPECT_EQ(crowd->world().step(0.0), 0);
  for (int frame = 1; frame <= 5; ++frame) EXPECT_EQ(crowd->step(frame), scene.substeps);
  for (std::size_t i = 0; i < crowd->bodyCount(); ++i) {
    const btScalar height = crowd->body(i).m_nodes[0].m_x.y();
    if (scenes::alwaysAwake(i)) {
      EXPECT_LT(height, heights[i] - btScalar(0.02)) << i;
    } else {
      EXPECT_EQ(height, heights[i]) << i;
    }
  }
  scenes::setAsleep(*crowd, false);
  EXPECT_EQ(scenes::asleepCount(*crowd), 0u);
}

class CrowdCommand : public testing::Test {
 protected:
  CommandResult crowd(const std::vector<std::string>& arguments) const { return folder.run(TETSKIN_CROWD, arguments); }

  CommandFolder folder;
};

TEST_F(CrowdCommand, TellsWhatEachLeftOutPartSaves) {
  const CommandResult result =
      crowd({"--bodies", "40", "--triangles", "4000", "--repetitions", "3", "--json", "c.json"});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto json = folder.json("c.json");
  EXPECT_EQ(json["bodies"], 40);
  EXPECT_EQ(json["asleep"], 36);
  EXPECT_EQ(json["frames"], 3);
  EXPECT_NEAR(json["tets"].get<double>(), 200, 20);
  EXPECT_GT(json["simulation_ms_per_frame"], 0.0);
  EXPECT_TRUE(json["asleep_overhead_percent"].is_number());
  std::map<std::string, nlohmann::json> rows;
  for (const auto& row : json["rows"]) {
    rows[row["variant"]] = row;
    EXPECT_NE(result.out.find(row["variant"].get<std::string>()), std::string::npos) << result.out;
    EXPECT_GE(row["us_per_frame"], 0.0);
    EXPECT_EQ(row["compared_with"].is_null(), row["saved_percent"].is_null());
    EXPECT_TRUE(row["compared_with"].is_null() || rows.count(row["compared_with"])) << row;
  }
  const auto count = [&](const char* row, const char* key) { return rows.at(row).at(key).get<int>(); };
  EXPECT_EQ(count("all awake, every substep", "updates"), 160);
  EXPECT_EQ(count("all awake, every substep", "bodies_updated"), 40);
  EXPECT_EQ(count("all awake, once per frame", "updates"), 40);
  EXPECT_EQ(count("sleeping bodies skipped", "bodies_updated"), 4);
  EXPECT_EQ(count("hidden skins skipped", "bodies_updated"), 4);
  EXPECT_EQ(count("no substep, no update", "bodies_updated"), 0);
  EXPECT_EQ(count("only awake bodies", "bodies"), 4);
  EXPECT_EQ(count("one shared binding", "bodies"), 40);
  for (const char* name : {"normals recomputed", "normals transformed", "normals none", "quadratic", "linear",
                           "bounds on", "bounds off", "mesh order", "sorted order", "previous positions on"}) {
    EXPECT_EQ(count(name, "bodies_updated"), 4) << name;
  }
  if (scenes::heapBytes() > 0) {
    EXPECT_LT(2 * count("one shared binding", "bytes"), count("one binding per body", "bytes"));
    EXPECT_LT(count("normals none", "bytes"), count("normals transformed", "bytes"));
    EXPECT_LT(count("linear", "bytes"), count("quadratic", "bytes"));
    EXPECT_LT(count("previous positions off", "bytes"), count("previous positions on", "bytes"));
  }
}

}  // namespace
}  // namespace tetskin
