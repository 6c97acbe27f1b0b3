// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/mesh_skin.h>
#include <tetskin/io/files.h>

#include "drop_run.h"

namespace tetskin::test {
namespace {

class Drop : public DropRun {};

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

TEST_F(Drop, VerticesThatNoTriangleUsesAreToldAndShapeNoCage) {
  folder.write("box.obj", boxObj() + "v 9 9 9\nv 8 9 9\n");
  const CommandResult result = drop({"--mesh", "box.obj", "--tets", "60", "--frames", "2", "--no-view"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("box.obj: no triangle uses 2 of its 10 vertices"), std::string::npos) << result.out;
  EXPECT_LT(folder.json("out/drop/summary.json")["extent_max"], 1.3);
}

TEST_F(Drop, SerpentFallsDeformsStaysAboveTheFloorAndRests) {
  const CommandResult result = drop({"--triangles", "8000", "--tets", "1000", "--every", "30"});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto json = folder.json("out/drop/summary.json");
  EXPECT_EQ(json["frames"], 240);
  EXPECT_EQ(json["contact"], "surface");
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
}  // namespace tetskin::test
