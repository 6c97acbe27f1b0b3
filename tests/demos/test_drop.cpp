// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <gtest/gtest.h>
#include <tetskin/core/mesh_skin.h>
#include <tetskin/io/files.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

#include "drop_run.h"

namespace tetskin {
namespace {

using test::boxObj;
using test::CommandResult;
using test::cubeVtk;

class Drop : public test::DropRun {};

/// How far a frame is from the best rigid image of the first, as RMS, relative to the first one's largest side.
double deformation(const std::vector<std::array<double, 3>>& rest, const std::vector<std::array<double, 3>>& now) {
  Eigen::Matrix3Xd a(3, rest.size()), b(3, now.size());
  for (std::size_t v = 0; v < rest.size(); ++v) {
    a.col(v) = Eigen::Vector3d(rest[v].data());
    b.col(v) = Eigen::Vector3d(now[v].data());
  }
  const Eigen::Matrix4d motion = Eigen::umeyama(a, b, false);
  const Eigen::Matrix3Xd moved = (motion.topLeftCorner<3, 3>() * a).colwise() + motion.topRightCorner<3, 1>();
  const double size = (a.rowwise().maxCoeff() - a.rowwise().minCoeff()).maxCoeff();
  return std::sqrt((moved - b).colwise().squaredNorm().mean()) / size;
}

/// A half sphere, and the vertices of the other half, as some modellers leave them when they cut.
std::string cutSphereObj() {
  constexpr int kRings = 10, kAround = 24;
  std::string text = "v 0 1 0\n";
  for (int r = 1; r < 2 * kRings; ++r) {
    const double theta = std::acos(-1.0) * r / (2 * kRings);
    for (int s = 0; s < kAround; ++s) {
      const double phi = 2.0 * std::acos(-1.0) * s / kAround;
      text += "v " + std::to_string(std::sin(theta) * std::cos(phi)) + " " + std::to_string(std::cos(theta)) + " " +
              std::to_string(std::sin(theta) * std::sin(phi)) + "\n";
    }
  }
  const auto at = [](int r, int s) { return std::to_string(2 + (r - 1) * kAround + s % kAround); };
  for (int s = 0; s < kAround; ++s) text += "f 1 " + at(1, s + 1) + " " + at(1, s) + "\n";
  for (int r = 1; r < kRings; ++r) {
    for (int s = 0; s < kAround; ++s) {
      text += "f " + at(r, s) + " " + at(r, s + 1) + " " + at(r + 1, s + 1) + " " + at(r + 1, s) + "\n";
    }
  }
  return text;
}

TEST_F(Drop, AHalfSphereWithTheVerticesOfTheOtherHalfStaysInOnePiece) {
  folder.write("half.obj", cutSphereObj());
  const CommandResult result = drop({"--mesh", "half.obj", "--tets", "500", "--every", "60"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("half.obj: no triangle uses 216 of its 457 vertices; they shape no cage\n"),
            std::string::npos)
      << result.out;
  const auto json = folder.json("out/drop/summary.json");
  EXPECT_EQ(json["outside"], 0);
  EXPECT_LT(json["extent_max"], 1.3);
  EXPECT_TRUE(json["at_rest"]) << json["rest_speed"];
}

TEST_F(Drop, SerpentFallsDeformsStaysAboveTheFloorAndRests) {
  const CommandResult result = drop({"--triangles", "8000", "--tets", "1000", "--every", "30"});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto json = folder.json("out/drop/summary.json");
  EXPECT_EQ(json["frames"], 240);
  EXPECT_EQ(json["inside"].get<int>() + json["outside"].get<int>(), json["vertices"].get<int>());
  EXPECT_EQ(json["unbound"], 0);
  EXPECT_TRUE(json["finite"]);
  EXPECT_LT(json["extent_max"], 2.0);
  EXPECT_LT(json["rest_speed"], 0.05);
  EXPECT_LT(json["rest_error_max"], 1e-6);
  EXPECT_GT(json["iterations_per_step"], 1.0);
  EXPECT_GT(json["passes_per_step"], 0.1) << "it lies on obstacles for most of the time";
  EXPECT_EQ(json["steps_unconverged"], 0);
  EXPECT_NE(result.out.find("steps that did not converge: 0"), std::string::npos) << result.out;

  const auto first = test::objPositions(folder.read("out/drop/frame_0000.obj"));
  const auto impact = test::objPositions(folder.read("out/drop/frame_0030.obj"));
  const auto last = test::objPositions(folder.read("out/drop/frame_0210.obj"));
  ASSERT_EQ(first.size(), json["vertices"].get<std::size_t>());
  double fall = 0.0, low = HUGE_VAL;
  for (std::size_t v = 0; v < first.size(); ++v) {
    fall += (first[v][1] - last[v][1]) / static_cast<double>(first.size());
    low = std::min(low, last[v][1]);
  }
  EXPECT_GT(fall, 0.3);
  EXPECT_GT(deformation(first, impact), 0.01);
  EXPECT_GE(low, json["floor_y"].get<double>() - json["margin"].get<double>() - 0.01 * 2.0);
  EXPECT_NE(result.out.find("embedding "), std::string::npos);
}

TEST_F(Drop, WritesCurrentUnitNormalsIfAskedFor) {
  folder.write("box.obj", boxObj());
  for (const std::string normals : {"transformed", "recomputed"}) {
    ASSERT_EQ(drop({"--mesh", "box.obj", "--tets", "60", "--frames", "30", "--every", "29", "--interpolation",
                    "quadratic", "--normals", normals, "--out", normals})
                  .status,
              0);
    const TriangleMesh first = loadMesh(folder.path(normals + "/frame_0000.obj")).value();
    const TriangleMesh last = loadMesh(folder.path(normals + "/frame_0029.obj")).value();
    ASSERT_EQ(first.normals.size(), 8u);
    ASSERT_EQ(last.normals.size(), 8u);
    EXPECT_EQ(last.texcoords.size(), first.texcoords.size());
    const std::vector<Eigen::Vector3d> expected = restNormals(first);
    for (int v = 0; v < 8; ++v) {
      EXPECT_LT((first.normals[v].cast<double>() - expected[v]).norm(), 1e-5);
      EXPECT_NEAR(last.normals[v].norm(), 1.0, 1e-5);
    }
  }
}

TEST_F(Drop, TouchesTheFloorAsDrawnOrByItsCage) {
  double above[2] = {};
  for (const bool surface : {true, false}) {
    const std::string out = surface ? "surface" : "cage";
    const CommandResult result = drop({"--tets", "300", "--triangles", "8000", "--frames", "180", "--every", "180",
                                       "--out", folder.path(out), "--contact", out});
    ASSERT_EQ(result.status, 0) << result.err;
    const auto json = folder.json(out + "/summary.json");
    EXPECT_EQ(json["contact"], out);
    above[surface] = json["lowest_y"].get<double>() - json["floor_y"].get<double>();
  }
  EXPECT_NEAR(above[1], 0.0, 0.01);  // the model's size is 2
  EXPECT_GT(above[0], 0.02);
}

TEST_F(Drop, AReducedBodyFallsStaysAboveTheFloorAndRests) {
  const CommandResult result = drop({"--body", "reduced", "--modes", "8", "--fine-tets", "8000", "--tets", "300",
                                     "--triangles", "6000", "--frames", "240", "--every", "100", "--out", "out"});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto summary = folder.json("out/summary.json");
  EXPECT_EQ(summary.at("body"), "reduced");
  EXPECT_EQ(summary.at("modes"), 8);
  EXPECT_EQ(summary.at("contact"), "cage");
  EXPECT_EQ(summary.at("finite"), true);
  EXPECT_EQ(summary.at("above_floor"), true);
  EXPECT_LT(summary.at("extent_max").get<double>(), 2.0);
  EXPECT_LT(summary.at("rest_speed").get<double>(), 0.2);
  EXPECT_NE(result.out.find("reduced, 8 modes"), std::string::npos) << result.out;
}

TEST_F(Drop, ABodyOfBulletsForcesIsTouchedByItsCage) {
  const CommandResult result = drop({"--elasticity", "bullet", "--tets", "100", "--triangles", "3000", "--frames", "60",
                                     "--every", "59", "--out", "out"});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto summary = folder.json("out/summary.json");
  EXPECT_EQ(summary.at("elasticity"), "bullet");
  EXPECT_EQ(summary.at("contact"), "cage");
  EXPECT_EQ(summary.at("self_contact"), "off");
  EXPECT_EQ(summary.at("finite"), true);
  EXPECT_EQ(summary.at("stages_ms_per_frame").at("system"), 0.0);
  EXPECT_GT(summary.at("stages_ms_per_frame").at("bullet"), 0.0);
  EXPECT_TRUE(summary.at("iterations_per_step").is_null()) << "nobody counts Bullet's";
  EXPECT_EQ(result.out.find("converge"), std::string::npos) << result.out;
}

TEST_F(Drop, HashTellsRunsApart) {
  const auto hashOf = [&](const char* tets, const char* every) {
    const CommandResult result = drop(
        {"--tets", tets, "--triangles", "4000", "--frames", "40", "--every", every, "--quiet", "--hash", "--no-view"});
    EXPECT_EQ(result.status, 0);
    EXPECT_EQ(result.out.rfind("nodes of 40 frames: ", 0), 0u) << result.out;
    return result.out;
  };
  const std::string hash = hashOf("100", "39");
  EXPECT_EQ(hash, hashOf("100", "20"));
  EXPECT_NE(hash, hashOf("120", "39"));
}

}  // namespace
}  // namespace tetskin
