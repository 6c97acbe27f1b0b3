// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The table of scenes, and small helpers that the demos share.
#include <btBulletDynamicsCommon.h>

#include <filesystem>
#include <limits>
#include <map>
#include <set>

#include "command.h"
#include "scenes/files.h"
#include "scenes/input_error.h"
#include "scenes/model.h"
#include "scenes/placement.h"
#include "scenes/statistics.h"
#include "scenes/table.h"
#include "scenes/wring.h"

namespace tetskin {
namespace {

using scenes::Findings;
using scenes::Scene;
using scenes::SceneEntry;
using scenes::SceneOptions;

/// The bar in a small cage of size kSize, at the origin.
const TetMesh& smallCage() {
  static const TetMesh cage =
      [] {
        scenes::ModelOptions options;
        options.builtIn = scenes::BuiltIn::Bar;
        options.triangles = 2000;
        options.tets = 100;
        const TetMesh made = scenes::loadModel(options).cage.mesh;
        return scenes::placementOf(boundingBox(made.nodes)).toWorld(made);
      }()
          .mesh;
  return cage;
}

std::vector<Eigen::Vector3d> nodesOf(const Scene& scene) {
  std::vector<Eigen::Vector3d> nodes;
  for (int n = 0; n < scene.body().m_nodes.size(); ++n) nodes.push_back(toEigen(scene.body().m_nodes[n].m_x));
  return nodes;
}

/// The scene after some frames.
std::unique_ptr<Scene> played(const char* name, int frames, const SceneOptions& options = {}) {
  auto scene = scenes::sceneNamed(name).make(smallCage(), options);
  for (int frame = 1; frame <= frames; ++frame) scene->step(frame);
  return scene;
}

TEST(SceneTable, AScenesBodyBeginsWhereItIsSaidToBe) {
  for (const char* name : {"obstacles", "drop", "sag", "wring"}) {
    SceneOptions options;
    options.offset = {3.0, 0.5, -2.0};
    const auto there = scenes::sceneNamed(name).make(smallCage(), options);
    const auto here = scenes::sceneNamed(name).make(smallCage(), {});
    const std::vector<Eigen::Vector3d> moved = nodesOf(*there), rest = nodesOf(*here);
    for (std::size_t n = 0; n < rest.size(); n += 10)
      EXPECT_LT((moved[n] - rest[n] - options.offset).norm(), 1e-5) << name;
    EXPECT_LT((there->offset - here->offset - options.offset).norm(), 1e-12) << name;
  }
}

TEST(SceneTable, EverySceneMakesStepsAndChecks) {
  // Scenes that tear their bodies apart where Bullet cannot handle them.
  const std::set<std::string> violent = {"stretch", "mirror", "permute", "spin", "impact"};
  const std::map<std::string, std::size_t> several = {
      {"soft_stack", 4}, {"soft_removed", 4}, {"soft_squeezed", 3}, {"soft_pile", 10}};
  std::set<std::string> names;
  for (const SceneEntry& entry : scenes::sceneTable()) {
    SCOPED_TRACE(entry.name);
    EXPECT_TRUE(names.insert(entry.name).second) << "twice";
    EXPECT_EQ(&scenes::sceneNamed(entry.name), &entry);
    EXPECT_FALSE(entry.about.empty());
    SceneOptions options;
    options.frames = 8;
    const auto scene = entry.make(smallCage(), options);
    ASSERT_EQ(scene->bodyCount(), several.count(entry.name) ? several.at(entry.name) : 1u);
    EXPECT_EQ(scene->options().frames, 8);
    EXPECT_EQ(entry.make(smallCage())->options().frames, entry.frames);
    EXPECT_EQ(entry.lands, scene->floorY > -std::numeric_limits<double>::infinity());
    const auto start = nodesOf(*scene);
    for (std::size_t n = 0; n < start.size(); ++n) {
      EXPECT_LT((start[n] - smallCage().nodes[n] - scene->offset).norm(), 1e-6);
    }
    for (int frame = 1; frame <= options.frames; ++frame) {
      EXPECT_EQ(scene->step(frame), options.substeps);
      const Findings found = scene->check();
      EXPECT_TRUE(found.finite || violent.count(entry.name)) << frame;
      EXPECT_TRUE(!found.exploded || violent.count(entry.name)) << frame;
      EXPECT_TRUE(found.aboveFloor || violent.count(entry.name)) << frame;
    }
    scene->restore();
    EXPECT_EQ(nodesOf(*scene), start);
  }
}

TEST(SceneTable, AnUnknownNameIsRefusedWithAllThatAreKnown) {
  try {
    (void)scenes::sceneNamed("fly");
    FAIL() << "there is no such scene";
  } catch (const scenes::InputError& error) {
    for (const SceneEntry& entry : scenes::sceneTable()) {
      EXPECT_NE(std::string(error.what()).find(entry.name), std::string::npos) << error.what();
    }
  }
}

TEST(SceneTable, ScenesDoWhatTheySay) {
  const std::vector<Eigen::Vector3d>& rest = smallCage().nodes;
  const Box3 box = boundingBox(rest);
  const auto lowest = [](const Scene& scene) { return boundingBox(nodesOf(scene)).min().y(); };

  const auto sagging = nodesOf(*played("sag", 10));
  for (std::size_t n = 0; n < rest.size(); ++n) {
    if (rest[n].y() > box.min().y() + 0.35 * box.sizes().y()) continue;
    EXPECT_LT((sagging[n] - rest[n]).norm(), 1e-6);
  }
  EXPECT_LT((nodesOf(*played("float", 10))[0] - rest[0]).norm(), 1e-4);
  const auto drop = played("drop", 60);
  EXPECT_LT(lowest(*drop), box.min().y() - 0.4);
  EXPECT_TRUE(drop->check().aboveFloor);
  EXPECT_EQ(drop->world().obstacles().groups.size(), 1u);

  const int frame = 60;
  const auto wrung = nodesOf(*played("wring", frame));
  const scenes::Twist twist = scenes::wringAt(box, frame);
  EXPECT_NEAR(twist.turn, 3.14159265, 1e-6);
  for (std::size_t n = 0; n < rest.size(); ++n) {
    if (rest[n].x() > twist.from && rest[n].x() < twist.to) continue;
    EXPECT_LT((wrung[n] - twist.point(rest[n])).norm(), 1e-4) << n;
  }
  const auto mapped = nodesOf(*played("exact", 1));
  EXPECT_GT((mapped.back() - rest.back()).norm(), 0.01);
}

TEST(SceneTable, ObstaclesDoWhatTheySay) {
  const auto boxOf = [](const Scene& scene) { return boundingBox(nodesOf(scene)); };
  const Box3 rest = boundingBox(smallCage().nodes);
  SceneOptions options;
  options.frames = 60;
  // The plates are closest halfway through the three quarters of the run in which they move.
  EXPECT_LT(boxOf(*played("flatten", 23, options)).sizes().y(), 0.32 * rest.sizes().y());
  EXPECT_LT(boxOf(*played("squeeze", 30, options)).sizes().y(), 0.7 * rest.sizes().y());
  const double untouched = boxOf(*played("land", 60, options)).center().x();
  EXPECT_GT(std::abs(boxOf(*played("mill", 60, options)).center().x() - untouched), 0.05);
  // The body rests until its support is removed: a third of a second later it is on the floor.
  const double lying = boxOf(*played("obstacles_go", 39, options)).min().y();
  EXPECT_LT(boxOf(*played("obstacles_go", 60, options)).min().y(), lying - 0.2);
  // A body that was removed from the world stays where it was.
  const auto gone = played("body_goes", 40, options);
  const auto left = nodesOf(*gone);
  for (int frame = 41; frame <= 60; ++frame) gone->step(frame);
  EXPECT_EQ(nodesOf(*gone), left);
  EXPECT_EQ(gone->world().bullet().getNumCollisionObjects(), 1);
}

TEST(SceneTable, BodiesOfAllSizesFallAlike) {
  const auto fallen = [](double size) {
    TetMesh cage = smallCage();
    for (Eigen::Vector3d& p : cage.nodes) p *= size / scenes::kSize;
    SceneOptions options;
    options.size = size;
    const auto scene = scenes::sceneNamed("crowd").make(cage, options);
    for (int frame = 1; frame <= 10; ++frame) scene->step(frame);
    return scene->body().m_nodes[0].m_x.y() / static_cast<btScalar>(size);
  };
  EXPECT_NEAR(fallen(200.0), fallen(2.0), 1e-4);
}

TEST(SceneTable, ASurfaceIsDueWhenNodesArePutElsewhere) {
  for (const auto& [name, expected] : {std::pair("land", 0), std::pair("mirror", 1), std::pair("teleport", 2),
                                       std::pair("node_nan", 2), std::pair("spin", 0)}) {
    SceneOptions options;
    options.frames = 12;
    const auto scene = scenes::sceneNamed(name).make(smallCage(), options);
    const bool damaged = name == std::string("node_nan");
    int due = 0;
    const auto moved = [&] {
      ++due;
      EXPECT_EQ(scene->check().finite, !damaged || due == 2);
    };
    for (int frame = 1; frame <= options.frames; ++frame) scene->step(frame, moved);
    EXPECT_EQ(due, expected) << name;
  }
}

TEST(SceneTable, ChecksTellWhatHasExplodedOrFallenThrough) {
  const auto scene = scenes::sceneNamed("land").make(smallCage());
  EXPECT_TRUE(scene->check().aboveFloor && scene->check().finite && !scene->check().exploded);
  const auto with = [&](const btVector3& position) {
    scene->restore();
    scenes::placeNode(scene->body().m_nodes[0], position);
    return scene->check();
  };
  const auto floor = static_cast<btScalar>(scene->floorY);
  EXPECT_FALSE(with({0, floor - btScalar(0.1), 0}).aboveFloor);
  EXPECT_TRUE(with({0, floor - btScalar(0.05), 0}).aboveFloor) << "within margin and tolerance";
  EXPECT_TRUE(with({50, 0, 0}).exploded);
  EXPECT_FALSE(with({30, 0, 0}).exploded);
  EXPECT_FALSE(with({0, std::numeric_limits<btScalar>::quiet_NaN(), 0}).finite);
}

TEST(Placement, LeadsToTheWorldAndBack) {
  const scenes::Placement position =
      scenes::placementOf(Box3(Eigen::Vector3d(10, 20, 30), Eigen::Vector3d(14, 21, 32)));
  EXPECT_EQ(position.toWorld({14, 20.5, 31}), Eigen::Vector3d(1, 0, 0));
  const Eigen::Vector3d p(1, 2, 3);
  EXPECT_LT((position.toModel(position.toWorld(p)) - p).norm(), 1e-12);
}

TEST(Statistics, MedianIsTheMiddleOne) {
  EXPECT_EQ(scenes::median({}), 0.0);
  EXPECT_EQ(scenes::median({3.0, 1.0, 2.0}), 2.0);
}

TEST(Files, AreWholeOrNotThere) {
  const test::CommandFolder folder;
  scenes::writeFile(folder.path("f"), "first, which is longer");
  std::filesystem::create_symlink("f", folder.path("link"));
  scenes::writeFile(folder.path("link"), "second");
  EXPECT_EQ(folder.read("f"), "second");
  EXPECT_TRUE(std::filesystem::is_symlink(folder.path("link")));
  EXPECT_FALSE(folder.exists("f.part"));
  for (const char* name : {"no/where", "."}) {
    try {
      scenes::writeFile(folder.path(name), "text");
      FAIL() << name;
    } catch (const scenes::InputError& error) {
      EXPECT_NE(std::string(error.what()).find(folder.path(name)), std::string::npos) << error.what();
    }
  }
  EXPECT_EQ(folder.read("f"), "second");
  std::string text;
  scenes::appendNumber(text, 0.1);
  scenes::appendNumber(text, 7);
  EXPECT_EQ(text, "0.17");
}

}  // namespace
}  // namespace tetskin
