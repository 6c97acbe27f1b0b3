// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <gtest/gtest.h>
#include <tetskin/io/files.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <sstream>

#include "command.h"
#include "scenes/bar.h"
#include "scenes/twist.h"

namespace tetskin {
namespace {

using Eigen::Vector3d;
using test::CommandFolder;
using test::CommandResult;

constexpr double kPi = 3.14159265358979323846;

TEST(Bar, IsAClosedTubeOfTheTrianglesWishedFor) {
  for (const std::size_t wish : {2000, 8000, 60000}) {
    const TriangleMesh bar = scenes::makeBar(wish);
    ASSERT_TRUE(validate(bar).ok());
    EXPECT_NEAR(static_cast<double>(bar.triangleCount()), static_cast<double>(wish), 0.02 * static_cast<double>(wish));
    EXPECT_EQ(bar.normals.size(), bar.vertexCount());
    const Vector3d sides = boundingBox(bar.positions).sizes();
    EXPECT_NEAR(sides.x(), 4.0, 1e-9);
    EXPECT_LT(sides.y(), 1.1);
    double volume = 0.0;  // sum over the triangles' tets with the origin: positive if the triangles face outwards
    for (const auto& t : bar.triangles) {
      volume += bar.positions[t[0]].dot(bar.positions[t[1]].cross(bar.positions[t[2]])) / 6.0;
    }
    EXPECT_NEAR(volume, 3.008, 0.05);
  }
}

TEST(Twist, TurnsPointsEvenlyAndNoFurtherThanItsEnds) {
  scenes::Twist twist = scenes::twistOf(Box3(Vector3d(-1, 0, -1), Vector3d(1, 4, 1)), kPi);
  EXPECT_EQ(twist.axis, 1);
  EXPECT_LT((twist.point({1, 0, 0}) - Vector3d(1, 0, 0)).norm(), 1e-12);
  EXPECT_LT((twist.point({1, 2, 0}) - Vector3d(0, 2, -1)).norm(), 1e-12);
  EXPECT_LT((twist.point({1, 4, 0}) - Vector3d(-1, 4, 0)).norm(), 1e-12);
  EXPECT_LT((twist.point({1, 9, 0}) - Vector3d(-1, 9, 0)).norm(), 1e-12);
}

TEST(Twist, NormalsStandOnTheTwistedSurface) {
  const scenes::Twist twist = scenes::twistOf(Box3(Vector3d(-1, -2, -1), Vector3d(1, 2, 1)), 3.0);
  constexpr double kStep = 1e-6;
  for (const Vector3d& n : {Vector3d(1, 2, 3), Vector3d(0, 1, 0), Vector3d(-1, 0.2, 0.5)}) {
    const Vector3d p(0.7, 0.3, -0.4), normal = n.normalized();
    const Vector3d a = normal.unitOrthogonal(), b = normal.cross(a);
    const Vector3d u = twist.point(p + kStep * a) - twist.point(p - kStep * a);
    const Vector3d v = twist.point(p + kStep * b) - twist.point(p - kStep * b);
    EXPECT_LT((twist.normal(p, normal) - u.cross(v).normalized()).norm(), 1e-8);
  }
}

class TwistCommand : public testing::Test {
 protected:
  CommandResult twist(const std::vector<std::string>& arguments) const { return folder.run(TETSKIN_TWIST, arguments); }

  CommandFolder folder;
};

/// Angle about the x axis, in degrees, by which the vertices [0, count) of a slice across it have turned from one
/// surface to another; bending or drifting of the slice does not change it.
double turnOf(const TriangleMesh& rest, const TriangleMesh& now, std::size_t count, double from, double to) {
  std::vector<std::complex<double>> before, after;
  for (std::size_t v = 0; v < count; ++v) {
    if (rest.positions[v].x() < from || rest.positions[v].x() > to) continue;
    before.emplace_back(rest.positions[v].y(), rest.positions[v].z());
    after.emplace_back(now.positions[v].y(), now.positions[v].z());
  }
  std::complex<double> centroid = 0.0, currentCentroid = 0.0, sum = 0.0;
  for (std::size_t k = 0; k < before.size(); ++k) {
    centroid += before[k] / static_cast<double>(before.size());
    currentCentroid += after[k] / static_cast<double>(before.size());
  }
  for (std::size_t k = 0; k < before.size(); ++k) sum += (after[k] - currentCentroid) * std::conj(before[k] - centroid);
  return std::arg(sum) * 180.0 / kPi;
}

TEST_F(TwistCommand, TurnsOneEndAFullTurnHoldsItAndLetsItGo) {
  const CommandResult result = twist({"--triangles", "4000", "--tets", "600", "--every", "10"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("writing 24 frames and animation.glb, about "), std::string::npos) << result.out;
  const auto json = folder.json("out/twist/summary.json");
  EXPECT_EQ(json["frames"], 240);
  EXPECT_EQ(json["frames_written"], 24);
  EXPECT_TRUE(json["finite"]);
  EXPECT_LT(json["extent_max"], 1.2);
  EXPECT_LT(json["nodes_off_twist_rms"], 0.05);
  EXPECT_GT(json["skin_linear_us_per_frame"], 0.0);
  EXPECT_GT(json["skin_quadratic_us_per_frame"], 0.0);
  const TriangleMesh rest = loadMesh(folder.path("out/twist/frame_0000.obj")).value();
  const auto turned = [&](int frame, double from, double to) {
    char name[32];
    std::snprintf(name, sizeof name, "out/twist/frame_%04d.obj", frame);
    return turnOf(rest, loadMesh(folder.path(name)).value(), rest.vertexCount() / 2, from, to);
  };
  for (const int frame : {60, 120, 140, 230}) EXPECT_NEAR(turned(frame, -2.0, -1.8), 0.0, 5.0) << frame;
  EXPECT_NEAR(std::abs(turned(60, 1.8, 2.0)), 180.0, 8.0);
  EXPECT_NEAR(turned(140, 1.8, 2.0), 0.0, 8.0);
  EXPECT_NEAR(std::abs(turned(140, -0.1, 0.1)), 180.0, 40.0);  // the bar has not passed through itself
  EXPECT_GT(std::abs(turned(230, 1.8, 2.0)), 20.0);            // the bar turns back
  EXPECT_LT(std::abs(turned(230, -0.1, 0.1)), 110.0);
}

TEST_F(TwistCommand, QuadraticIsCloserToTheExactTwist) {
  const CommandResult result = twist({"--triangles", "8000", "--tets", "1500", "--frames", "2"});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto json = folder.json("out/twist/summary.json");
  EXPECT_LT(6.0 * json["error_quadratic_rms"].get<double>(), json["error_linear_rms"].get<double>());
  EXPECT_LT(4.0 * json["error_quadratic_max"].get<double>(), json["error_linear_max"].get<double>());
  EXPECT_LT(6.0 * json["normal_error_quadratic_deg"].get<double>(), json["normal_error_linear_deg"].get<double>());
  for (const char* word : {"linear", "quadratic", "error, RMS", "error of normals"}) {
    EXPECT_NE(result.out.find(word), std::string::npos) << result.out;
  }
}

TEST_F(TwistCommand, WritesBothSurfacesSideBySideWithNormals) {
  ASSERT_EQ(twist({"--triangles", "4000", "--tets", "300", "--frames", "61", "--every", "60", "--out", "o"}).status, 0);
  const TriangleMesh bar = scenes::makeBar(4000);
  const TriangleMesh first = loadMesh(folder.path("o/frame_0000.obj")).value();
  const TriangleMesh last = loadMesh(folder.path("o/frame_0060.obj")).value();
  ASSERT_EQ(first.vertexCount(), 2 * bar.vertexCount());
  ASSERT_EQ(first.groups.size(), 2u);
  EXPECT_EQ(first.groups[0].name, "linear");
  EXPECT_EQ(first.groups[1].name, "quadratic");
  EXPECT_EQ(first.groups[1].triangleCount, bar.triangleCount());
  EXPECT_EQ(first.texcoords.size(), first.vertexCount());
  ASSERT_EQ(last.normals.size(), last.vertexCount());
  Box3 halves[2];
  double farthest = 0.0;
  for (std::size_t v = 0; v < bar.vertexCount(); ++v) {
    const std::size_t twin = v + bar.vertexCount();
    const Vector3d offset = first.positions[twin] - first.positions[v];
    EXPECT_LT((first.positions[v] - bar.positions[v]).norm(), 1e-5);
    EXPECT_LT((offset - (first.positions[bar.vertexCount()] - first.positions[0])).norm(), 1e-5);
    farthest = std::max(farthest, (last.positions[twin] - last.positions[v] - offset).norm());
    halves[0].extend(last.positions[v]);
    halves[1].extend(last.positions[twin]);
  }
  EXPECT_FALSE(halves[0].intersects(halves[1]));
  EXPECT_GT(farthest, 1e-3);
  EXPECT_LT(farthest, 0.3);
}

TEST_F(TwistCommand, TakesAMeshAnywhereAndOfAnySize) {
  std::string text;
  for (int ring = 0; ring < 9; ++ring) {
    for (const char* corner : {"1000 1000", "1300 1000", "1300 1300", "1000 1300"}) {
      text += "v " + std::string(corner) + " " + std::to_string(5000 + 150 * ring) + "\n";
    }
  }
  for (int ring = 0; ring < 8; ++ring) {
    for (int k = 0; k < 4; ++k) {
      const int a = 4 * ring + k + 1, b = 4 * ring + (k + 1) % 4 + 1;
      text += "f " + std::to_string(a) + " " + std::to_string(b) + " " + std::to_string(b + 4) + " " +
              std::to_string(a + 4) + "\n";
    }
  }
  folder.write("long.obj", text + "f 4 3 2 1\nf 33 34 35 36\n");
  ASSERT_EQ(twist({"--mesh", "long.obj", "--tets", "200", "--frames", "5", "--normals", "none", "--out", "o"}).status,
            0);
  const std::string frame = folder.read("o/frame_0000.obj");
  EXPECT_EQ(frame.find("vn "), std::string::npos);
  const auto written = test::objPositions(frame);
  ASSERT_EQ(written.size(), 72u);
  EXPECT_NEAR(written[35][2], 6200.0, 1e-2);
  EXPECT_NEAR(written[71][2], 6200.0, 1e-2);  // next to the bar, not in line with it
  EXPECT_EQ(folder.json("o/summary.json")["vertices"], 36);
}

/// An OBJ file with its vertices multiplied by a factor.
std::string scaled(const std::string& obj, double factor) {
  std::string text;
  std::istringstream lines(obj);
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("v ", 0) == 0) {
      std::istringstream numbers(line.substr(2));
      line = "v";
      for (double x; numbers >> x;) line += " " + std::to_string(x * factor);
    }
    text += line + "\n";
  }
  return text;
}

TEST(Twist, TheQuadraticSurfaceOfATinyModelIsThatOfALargeOne) {
  const CommandFolder folder;
  ASSERT_EQ(folder.run(TETSKIN_DROP, {"--model", "bar", "--triangles", "2000", "--frames", "1", "--out", "m"}).status,
            0);
  std::vector<double> apart;
  for (const double factor : {1.0, 0.01, 100.0}) {
    folder.write("bar.obj", scaled(folder.read("m/frame_0000.obj"), factor));
    const CommandResult result = folder.run(
        TETSKIN_TWIST, {"--mesh", "bar.obj", "--tets", "600", "--frames", "120", "--every", "120", "--out", "o"});
    ASSERT_EQ(result.status, 0) << result.err;
    apart.push_back(folder.json("o/summary.json")["difference_rms"]);
  }
  EXPECT_GT(apart[0], 1e-3);
  for (const double other : apart) EXPECT_NEAR(other, apart[0], 0.05 * apart[0]);
}

}  // namespace
}  // namespace tetskin
