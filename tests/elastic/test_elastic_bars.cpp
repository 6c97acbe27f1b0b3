// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/elastic/elastic_body.h>

#include <limits>

#include "elastic_motion.h"
#include "support/odd_meshes.h"

namespace tetskin::test {
namespace {

constexpr double kPi = 3.14159265358979323846;

template <class S>
class ElasticBarsOf : public WithScalar<S> {};
TYPED_TEST_SUITE(ElasticBarsOf, Scalars);

/// The mean displacement of the nodes at the free end.
template <class S>
Vector3d tipOf(ElasticBody<S>& body, const TetMesh& cage, double length) {
  Vector3d sum = Vector3d::Zero();
  int count = 0;
  for (std::size_t n = 0; n < cage.nodeCount(); ++n) {
    if (std::abs(cage.nodes[n].x() - length) > 1e-9) continue;
    sum += pointsOf(body.positions())[n] - cage.nodes[n];
    ++count;
  }
  return sum / count;
}

/// Takes steps so long that only the final state of the motion is left.
template <class S>
void settle(ElasticBody<S>& body, const std::array<double, 3>& acceleration, int steps) {
  for (int k = 0; k < steps; ++k) body.step(0.1, acceleration);
}

TYPED_TEST(ElasticBarsOf, AHangingBarIsAsLongAsTheTextbookSays) {
  constexpr double kLength = 2.0, kGravity = 9.8;
  const TetMesh cage = latticeCage(16, 2, 2, kLength / 16);
  ElasticOptions options = soft();
  options.tolerance = 1e-4;
  options.stiffnessDamping = 0.1;
  options.poissonRatio = 0.0;  // the pinned end cannot get thinner
  ElasticBody<TypeParam> body = made<TypeParam>(cage, options);
  pinTheEnd(body, cage);
  settle(body, {kGravity, 0, 0}, 150);
  const double expected = options.density * kGravity * kLength * kLength / (2.0 * options.youngsModulus);
  ASSERT_GT(expected, 0.05);
  EXPECT_NEAR(tipOf(body, cage, kLength).x() / expected, 1.0, 0.002);
}

TYPED_TEST(ElasticBarsOf, APulledBarIsAsLongAsTheTextbookSays) {
  constexpr double kLength = 2.0;
  const TetMesh cage = latticeCage(16, 2, 2, kLength / 16);
  const double area = 0.0625, force = 20.0;
  // All mass is at the free end, so that gravity pulls only there.
  ElasticOptions options = soft();
  options.tolerance = 1e-5;
  options.poissonRatio = 0.3;
  options.nodeMasses.assign(cage.nodeCount(), 1e-9);
  double sum = 0.0;
  const std::vector<double> fractions = lumped(cage);
  for (int pass = 0; pass < 2; ++pass) {
    for (std::size_t n = 0; n < cage.nodeCount(); ++n) {
      if (cage.nodes[n].x() != kLength) continue;
      if (pass == 0) sum += fractions[n];
      if (pass == 1) options.nodeMasses[n] = fractions[n] / sum;
    }
  }
  ElasticBody<TypeParam> body = made<TypeParam>(cage, options);
  pinTheEnd(body, cage);
  settle(body, {force, 0, 0}, 60);
  const double expected = force * kLength / (options.youngsModulus * area);
  EXPECT_NEAR(tipOf(body, cage, kLength).x() / expected, 1.0, 0.002);
}

TEST(ElasticBars, ACantileverBendsAsTheTextbookSaysInTheLimitOfFineCages) {
  constexpr double kLength = 2.0, kHeight = 0.25;
  ElasticOptions options;
  options.youngsModulus = 1e6;
  options.poissonRatio = 0.0;
  options.density = 1.0;
  options.tolerance = 1e-6;
  options.maxIterations = 2000;
  const double weight = kHeight * kHeight, inertia = std::pow(kHeight, 4) / 12.0;
  const double gravity = 10.0;
  const double expected = weight * gravity * std::pow(kLength, 4) / (8.0 * options.youngsModulus * inertia);
  double before = 0.0;
  for (const int across : {1, 2, 4}) {
    const TetMesh cage = latticeCage(8 * across, across, across, kHeight / across);
    ElasticBody<double> body = made<double>(cage, options);
    pinTheEnd(body, cage);
    settle(body, {0, 0, -gravity}, 20);
    const double error = 1.0 + tipOf(body, cage, kLength).z() / expected;
    EXPECT_GT(error, 0.0) << "cages are too stiff";
    if (across > 1) {
      EXPECT_LT(error, before / 1.7);
    }
    before = error;
  }
}

/// By Timoshenko's theory, whose shear adds little: S. P. Timoshenko, J. N.
/// Goodier, "Theory of Elasticity", 1970.
TEST(ElasticBars, ACantileverOfFewQuadraticTetsBendsAsTheTextbookSays) {
  constexpr double kLength = 2.0, kHeight = 0.25, kGravity = 10.0, kShearFactor = 5.0 / 6.0;
  ElasticOptions options;
  options.youngsModulus = 1e6;
  options.poissonRatio = 0.0;
  options.tolerance = 1e-6;
  options.maxIterations = 2000;
  const double area = kHeight * kHeight, inertia = std::pow(kHeight, 4) / 12.0, load = area * kGravity;
  const double bending = load * std::pow(kLength, 4) / (8.0 * options.youngsModulus * inertia);
  const double shear = load * kLength * kLength / (2.0 * kShearFactor * 0.5 * options.youngsModulus * area);
  for (const int across : {1, 2}) {
    const Cage cage = refineQuadratic(latticeCage(8 * across, across, across, kHeight / across)).value();
    ElasticBody<double> body = made<double>(cage, options);
    pinTheEnd(body, cage.mesh);
    settle(body, {0, 0, -kGravity}, 20);
    EXPECT_NEAR(-tipOf(body, cage.mesh, kLength).z() / (bending + shear), 1.0, across == 1 ? 0.03 : 0.01) << across;
  }
}

/// A uniform pressure on the top of a block, in two ways. Spread over small triangles, as contact does, it sinks the
/// corners of quadratic tets deeper than their other nodes, by a third of the compression of a layer of such tets.
TEST(ElasticBars, PressureOnSmallTrianglesSinksCornersOfQuadraticTetsByAThirdOfALayerMore) {
  constexpr int kAcross = 4, kHigh = 2;
  constexpr double kPressure = 10.0;
  const TetMesh mesh = latticeCage(kAcross, kAcross, kHigh);
  const Cage cage = refineQuadratic(mesh).value();
  const auto isOnTop = [&](const auto& face) {
    return std::all_of(face.begin(), face.end(), [&](int n) { return cage.mesh.nodes[n].z() == kHigh; });
  };
  std::vector<double> bySmallTriangles(cage.mesh.nodeCount(), 0.0), byShapes = bySmallTriangles;
  for (const auto& face : boundaryFaces(cage.mesh)) {
    for (const int n : face) bySmallTriangles[n] += isOnTop(face) ? 1.0 / 24.0 : 0.0;
  }
  // The integrals of the shape functions: 0 at corners, and at the middle of each edge a third of the face, which by
  // small triangles is a quarter.
  for (std::size_t n = mesh.nodeCount(); n < byShapes.size(); ++n) byShapes[n] = 4.0 / 3.0 * bySmallTriangles[n];
  const auto deeper = [&](const Cage& of, const std::vector<double>& loads) {
    ElasticOptions options = soft();
    options.tolerance = 1e-6;
    options.maxIterations = 2000;
    for (const double load : loads) options.nodeMasses.push_back(std::max(load, 1e-7));
    ElasticBody<double> body = made<double>(of, options);
    for (std::size_t n = 0; n < loads.size(); ++n) body.setPinned(n, cage.mesh.nodes[n].z() == 0.0);
    settle(body, {0, 0, -kPressure}, 60);
    double depth[2] = {};
    int count[2] = {};
    for (std::size_t n = 0; n < loads.size(); ++n) {
      const Vector3d& p = cage.mesh.nodes[n];
      if (p.z() != kHigh || (p.head<2>() - Eigen::Vector2d::Constant(0.5 * kAcross)).cwiseAbs().maxCoeff() > 1.0)
        continue;
      const std::size_t isCorner = n < mesh.nodeCount();
      depth[isCorner] += kHigh - body.positions()[n][2];
      ++count[isCorner];
    }
    return (depth[1] / count[1] - depth[0] / count[0]) * options.youngsModulus / kPressure;
  };
  EXPECT_NEAR(deeper(cage, bySmallTriangles), 0.34, 0.03);
  EXPECT_NEAR(deeper(cage, byShapes), 0.0, 0.04);
  EXPECT_NEAR(deeper(Cage(cage.mesh), bySmallTriangles), 0.0, 0.04);
}

/// The residual of a solve is small compared with gravity in each step, and must not add up to a wrong or creeping sag.
TEST(ElasticBars, AHeldBarComesToRestWhereItBelongsAndNeedsNoIterationsThere) {
  const TetMesh cage = latticeCage(20, 3, 3, 0.1);
  const auto settled = [&](double tolerance) {
    ElasticOptions options = soft();
    options.youngsModulus = 1e4;
    options.density = 10.0;
    options.stiffnessDamping = 0.5;
    options.tolerance = tolerance;
    options.maxIterations = 1000;
    return made<float>(cage, options);
  };
  const std::array<double, 3> gravity = {0, 0, -0.8};
  double sag[2] = {};
  for (const bool exact : {false, true}) {
    ElasticBody<float> body = settled(exact ? 1e-6 : ElasticOptions().tolerance);
    pinTheEnd(body, cage);
    int most = 0, last = 0;
    for (int k = 0; k < 2400; ++k) {
      const int iterations = body.step(1.0 / 240.0, gravity);
      most = std::max(most, iterations);
      last += k >= 2160 ? iterations : 0;
    }
    sag[exact] = tipOf(body, cage, 2.0).z();
    if (exact) continue;
    EXPECT_GT(most, 15);
    EXPECT_LT(last, 240) << "one per step";
    double fastest = 0.0;
    for (const Vector3d& v : pointsOf(body.velocities())) fastest = std::max(fastest, v.norm());
    EXPECT_LT(fastest, 1e-3 * std::abs(sag[0])) << "per second";
  }
  EXPECT_LT(sag[1], -0.1);
  EXPECT_NEAR(sag[0] / sag[1], 1.0, 2e-3);
}

TEST(ElasticBars, ABarRingsWithItsTextbookFrequency) {
  constexpr double kLength = 2.0;
  const TetMesh cage = latticeCage(16, 1, 1, kLength / 16);
  ElasticOptions options = soft();
  options.poissonRatio = 0.0;
  options.tolerance = 1e-4;
  ElasticBody<double> body = made<double>(cage, options);
  pinTheEnd(body, cage);
  Points positions = cage.nodes;  // its softest longitudinal vibration, at maximum amplitude
  for (Vector3d& p : positions) p.x() += 0.01 * std::sin(0.5 * kPi * p.x() / kLength);
  fill(body.positions(), positions);
  const double period = 4.0 * kLength / std::sqrt(options.youngsModulus / options.density), dt = period / 400.0;
  // The time from the first passage through rest to the third is one period.
  std::vector<double> passages;
  double before = tipOf(body, cage, kLength).x();
  for (int k = 1; k <= 700; ++k) {
    body.step(dt);
    const double now = tipOf(body, cage, kLength).x();
    if (before * now < 0.0) passages.push_back((k - now / (now - before)) * dt);
    before = now;
  }
  ASSERT_GE(passages.size(), 3u);
  EXPECT_NEAR((passages[2] - passages[0]) / period, 1.0, 0.01);
}

}  // namespace
}  // namespace tetskin::test
