// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Maps painted on vertices, and what tets, nodes and masses get of them.
#include "cage_models.h"
#include "copy_checks.h"
#include "support/painted_bar.h"

#include <tetskin/cage/create_cage.h>
#include <tetskin/cage/painted_maps.h>
#include <tetskin/core/src/base/mesh/tet_geometry.h>

#include <limits>
#include <numeric>
#include <random>

namespace tetskin::test {
namespace {

Cage paintedCage(const TriangleMesh& mesh, std::vector<double> stiffness, std::vector<double> density,
                 std::size_t tets = 2000) {
  CageOptions options;
  options.targetTets = tets;
  options.stiffness = std::move(stiffness);
  options.density = std::move(density);
  Result<Cage> cage = createCage(mesh, options);
  EXPECT_TRUE(cage.ok()) << cage.status().message;
  return cage.ok() ? std::move(cage).value() : Cage();
}

/// Values of a function of the position, by vertex.
template <class Function>
std::vector<double> painted(const TriangleMesh& mesh, Function&& function) {
  std::vector<double> values;
  for (const Eigen::Vector3d& p : mesh.positions) values.push_back(function(p));
  return values;
}

double massOf(const Cage& cage) {
  return std::accumulate(cage.masses.begin(), cage.masses.end(), 0.0);
}

Eigen::Vector3d centreOfMass(const Cage& cage) {
  Eigen::Vector3d sum(0, 0, 0);
  for (std::size_t n = 0; n < cage.masses.size(); ++n) sum += cage.masses[n] * cage.mesh.nodes[n];
  return sum / massOf(cage);
}

Eigen::Vector3d centroidOf(const Cage& cage, std::size_t t) {
  const TetCorners p = cornersOf(cage.mesh, cage.mesh.tets[t]);
  return 0.25 * (p[0] + p[1] + p[2] + p[3]);
}

std::vector<double> spreadTets(const Cage& cage, const TriangleMesh& mesh, const std::vector<double>& values,
                               MapMean mean = MapMean::Arithmetic) {
  const Result<SpreadMap> map = spreadMap(cage, mesh, values, mean);
  EXPECT_TRUE(map.ok()) << map.status().message;
  return map.ok() ? map.value().tets : std::vector<double>();
}

double largestDifference(const std::vector<double>& a, const std::vector<double>& b) {
  EXPECT_EQ(a.size(), b.size());
  double largest = 0.0;
  for (std::size_t k = 0; k < std::min(a.size(), b.size()); ++k) largest = std::max(largest, std::abs(a[k] - b[k]));
  return largest;
}

TEST(PaintedMaps, OfOneChangeNoBit) {
  const TriangleMesh mesh = figurineMesh(30);
  const std::vector<double> ones(mesh.vertexCount(), 1.0);
  const Cage plain = paintedCage(mesh, {}, {});
  EXPECT_TRUE(sameCage(paintedCage(mesh, ones, ones), plain));
  EXPECT_TRUE(plain.paintedStiffness.empty() && plain.paintedDensity.empty());
}

TEST(PaintedMaps, OfOneValueGiveItExactly) {
  const TriangleMesh mesh = figurineMesh(30);
  const std::vector<double> values(mesh.vertexCount(), 0.3);
  const Cage plain = paintedCage(mesh, {}, {}), cage = paintedCage(mesh, values, values);
  EXPECT_EQ(cage.paintedStiffness, std::vector<double>(cage.mesh.tetCount(), 0.3));
  EXPECT_EQ(cage.paintedDensity, cage.paintedStiffness);
  EXPECT_NEAR(massOf(cage), 0.3 * massOf(plain), 1e-12 * massOf(plain));
  for (std::size_t t = 0; t < cage.mesh.tetCount(); ++t)
    EXPECT_EQ(cage.stiffnessScale()[t], 0.3 * plain.stiffnessScale()[t]);
}

TEST(PaintedMaps, BothHalvesOfABarHaveTheirDensity) {
  const TriangleMesh bar = barSurface(8);
  for (const std::size_t tets : {300u, 2000u}) {
    const Cage plain = paintedCage(bar, {}, {}, tets), cage = paintedCage(bar, {}, halves(bar, 4, 2.5), tets);
    EXPECT_NEAR(massOf(cage), 10.0, 0.1) << tets;
    const Eigen::Vector3d exact(2.6, 0.5, 0.5), before(2.0, 0.5, 0.5);
    EXPECT_LT((centreOfMass(plain) - before).norm(), 0.04);
    EXPECT_LT((centreOfMass(cage) - exact).norm(), 0.04) << centreOfMass(cage).transpose();
  }
}

TEST(PaintedMaps, TheInsideHasTheValueOfTheNearestSurface) {
  const TriangleMesh ball = unitSphere(60);
  // Constant along each radius: by integration, the mass is the volume, and the centre of mass at 1/8.
  const auto slope = [](const Eigen::Vector3d& p) { return 1.0 + 0.5 * p.z() / p.norm(); };
  const Cage cage = paintedCage(ball, {}, painted(ball, slope), 3000);
  const Cage plain = paintedCage(ball, {}, {}, 3000);
  EXPECT_NEAR(massOf(cage), massOf(plain), 0.01 * massOf(plain));
  EXPECT_NEAR(centreOfMass(cage).z(), 0.125, 0.01);
  for (std::size_t t = 0; t < cage.mesh.tetCount(); ++t) {
    if (cage.volumeFraction[t] == 1.0 && centroidOf(cage, t).norm() > 0.4) {
      EXPECT_NEAR(cage.paintedDensity[t], slope(centroidOf(cage, t)), 0.05);
    }
  }
}

TEST(PaintedMaps, ABallPaintedOnOneSideIsStiffOnThatSide) {
  const TriangleMesh ball = unitSphere(40);
  const Cage cage = paintedCage(ball, painted(ball, [](const auto& p) { return p.z() > 0.0 ? 4.0 : 1.0; }), {});
  std::size_t between = 0;
  for (std::size_t t = 0; t < cage.mesh.tetCount(); ++t) {
    const double height = centroidOf(cage, t).z();
    if (std::abs(height) > 0.2) {
      EXPECT_NEAR(cage.paintedStiffness[t], height > 0.0 ? 4.0 : 1.0, 1e-9) << height;
    }
    between += cage.paintedStiffness[t] > 1.001 && cage.paintedStiffness[t] < 3.999;
  }
  EXPECT_GT(between, 0u);
  EXPECT_LT(between, cage.mesh.tetCount() / 3);
}

TEST(PaintedMaps, StiffnessIsAveragedByItsLogarithm) {
  const TriangleMesh bar = barSurface(4);
  const Cage cage = paintedCage(bar, {}, {}, 300);
  const std::vector<double> geometric = spreadTets(cage, bar, halves(bar, 100, 10), MapMean::Geometric);
  const std::vector<double> logarithms = spreadTets(cage, bar, halves(bar, 2, 1.5));
  for (std::size_t t = 0; t < geometric.size(); ++t)
    EXPECT_NEAR(std::log10(geometric[t]), 2.0 * (logarithms[t] - 1.0), 1e-12);
}

TEST(PaintedMaps, CopiesAtSeamsAreAveraged) {
  const TriangleMesh whole = unitSphere(20), torn = unwelded(whole);
  std::mt19937 random(5);
  std::vector<double> values(torn.vertexCount()), means(whole.vertexCount(), 0.0), counts(whole.vertexCount(), 0.0);
  for (std::size_t v = 0; v < values.size(); ++v) values[v] = std::uniform_real_distribution<double>(1.0, 3.0)(random);
  const auto whole3 = [&](std::size_t v) {
    return static_cast<std::size_t>(std::find(whole.positions.begin(), whole.positions.end(), torn.positions[v]) -
                                    whole.positions.begin());
  };
  for (std::size_t v = 0; v < values.size(); ++v) {
    means[whole3(v)] += values[v];
    ++counts[whole3(v)];
  }
  for (std::size_t v = 0; v < means.size(); ++v) means[v] = counts[v] > 0.0 ? means[v] / counts[v] : 1.0;
  std::vector<double> even;
  for (std::size_t v = 0; v < values.size(); ++v) even.push_back(means[whole3(v)]);
  const Cage cage = paintedCage(torn, {}, {}, 500);
  EXPECT_LT(largestDifference(spreadTets(cage, torn, values), spreadTets(cage, torn, even)), 1e-12);
}

TEST(PaintedMaps, PartsThatShareTetsKeepTheirOwn) {
  TriangleMesh mesh =
      joined(transformed(boxMesh({2, 2, 0.9}), 1.0, {0, 0, 0.6}), transformed(boxMesh({2, 2, 0.9}), 1.0, {0, 0, -0.6}));
  const Cage cage = paintedCage(mesh, painted(mesh, [](const auto& p) { return p.z() > 0.0 ? 4.0 : 1.0; }), {}, 300);
  ASSERT_TRUE(cage.hasDuplicates());
  std::vector<double> ofComponent(2, 0.0);
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v)
    ofComponent[static_cast<std::size_t>(cage.component[static_cast<std::size_t>(cage.vertexTets[v])])] =
        mesh.positions[v].z() > 0.0 ? 4.0 : 1.0;
  for (std::size_t t = 0; t < cage.mesh.tetCount(); ++t) {
    if (cage.volumeFraction[t] > 0.02) {
      EXPECT_NEAR(cage.paintedStiffness[t], ofComponent[static_cast<std::size_t>(cage.component[t])], 1e-9);
    }
  }
}

TEST(PaintedMaps, ALevelOfDetailGivesAboutTheSame) {
  const auto slope = [](const Eigen::Vector3d& p) { return 2.0 + p.x(); };
  const TriangleMesh fine = unitSphere(60), coarse = unitSphere(20);
  const Cage cage = paintedCage(fine, {}, {}, 1000);
  EXPECT_LT(
      largestDifference(spreadTets(cage, fine, painted(fine, slope)), spreadTets(cage, coarse, painted(coarse, slope))),
      0.1);
}

TEST(PaintedMaps, AMaskGivesTheNodesToPin) {
  const TriangleMesh bar = barSurface(8);
  const Cage cage = paintedCage(bar, {}, {}, 2000);
  const Result<SpreadMap> mask = spreadMap(cage, bar, painted(bar, [](const auto& p) { return p.x() <= 1.0 ? 1 : 0; }));
  ASSERT_TRUE(mask.ok());
  ASSERT_EQ(mask.value().nodes.size(), cage.mesh.nodeCount());
  for (std::size_t n = 0; n < cage.mesh.nodeCount(); ++n) {
    if (std::abs(cage.mesh.nodes[n].x() - 1.0) > 0.3) {
      EXPECT_EQ(mask.value().nodes[n] >= 0.5, cage.mesh.nodes[n].x() < 1.0);
    }
  }
}

TEST(PaintedMaps, BecomeThoseOfQuadraticTets) {
  const TriangleMesh bar = barSurface(4);
  Cage filled(makeBox({8, 2, 2}, {4, 1, 1}));
  ASSERT_TRUE(paintCage(filled, bar, {halves(bar, 4, 2), halves(bar, 4, 2.5)}).ok());
  EXPECT_NEAR(massOf(filled), 10.0, 0.1);
  const Result<Cage> quadratic = refineQuadratic(filled);
  ASSERT_TRUE(quadratic.ok()) << quadratic.status().message;
  EXPECT_NEAR(massOf(quadratic.value()), massOf(filled), 1e-9);
  EXPECT_NEAR(centreOfMass(quadratic.value()).x(), 2.6, 0.03);
  for (std::size_t t = 0; t < quadratic.value().mesh.tetCount(); ++t)
    EXPECT_EQ(quadratic.value().paintedStiffness[t], filled.paintedStiffness[t / kSubTets]);
}

TEST(PaintedMaps, GiveEveryNodeOfACageWithoutMassesOne) {
  const TriangleMesh bar = barSurface(4);
  Cage cage(makeBox({8, 2, 2}, {4, 1, 1}));
  cage.mesh.nodes.emplace_back(9, 9, 9);  // that no tet uses
  const PaintedMaps maps{{}, halves(bar, 4, 2.5)};
  for (const double filled : {1.0, 0.0}) {
    cage.volumeFraction.assign(cage.mesh.tetCount(), 0.0);  // those around the last nodes stay empty
    for (std::size_t t = 0; t < cage.mesh.tetCount() / 2; ++t) cage.volumeFraction[t] = filled;
    Cage painted = cage;
    ASSERT_TRUE(paintCage(painted, bar, maps).ok());
    EXPECT_TRUE(validate(painted).ok()) << validate(painted).message;
    double integral = 0.0;
    for (std::size_t t = 0; t < cage.mesh.tetCount(); ++t) {
      const double share = filled > 0.0 ? cage.volumeFraction[t] : 1.0;  // all empty counts as full
      integral += share * painted.paintedDensity[t] * std::abs(signedVolume(cornersOf(cage.mesh, cage.mesh.tets[t])));
    }
    EXPECT_NEAR(massOf(painted), integral, 1e-12);
  }
}

TEST(PaintedMaps, DoNotDependOnVerticesThatNoTriangleUses) {
  const TriangleMesh bar = barSurface(4);
  const Cage plain = paintedCage(bar, {}, {}, 300);
  TriangleMesh more = bar;
  more.positions.emplace_back(2.0, 0.5, 0.5);
  const auto with = [](std::vector<double> values, double last) {
    values.push_back(last);
    return values;
  };
  const std::vector<double> ones(bar.vertexCount(), 1.0), painted = halves(bar, 4, 2.5);
  Cage cage = plain, same = plain;
  ASSERT_TRUE(paintCage(cage, more, {with(ones, -3.0), with(ones, 7.0)}).ok());
  EXPECT_TRUE(sameCage(cage, plain));
  ASSERT_TRUE(paintCage(cage, more, {with(painted, -3.0), with(painted, 1e9)}).ok());
  ASSERT_TRUE(paintCage(same, bar, {painted, painted}).ok());
  EXPECT_TRUE(sameCage(cage, same));
}

TEST(PaintedMaps, ReplaceThoseBefore) {
  const TriangleMesh bar = barSurface(8);
  const Cage plain = paintedCage(bar, {}, {});
  Cage cage = plain;
  const PaintedMaps maps{halves(bar, 4, 2), halves(bar, 4, 2.5)};
  ASSERT_TRUE(paintCage(cage, bar, {halves(bar, 9, 3), halves(bar, 0.1, 0.5)}).ok());
  ASSERT_TRUE(paintCage(cage, bar, maps).ok());
  const Cage once = paintedCage(bar, maps.stiffness, maps.density);
  EXPECT_EQ(cage.paintedStiffness, once.paintedStiffness);
  EXPECT_LT(largestDifference(cage.masses, once.masses), 1e-12);
  ASSERT_TRUE(paintCage(cage, bar, {{}, {}}).ok());
  EXPECT_TRUE(cage.paintedStiffness == once.paintedStiffness && !cage.paintedDensity.empty());
  const std::vector<double> ones(bar.vertexCount(), 1.0);
  ASSERT_TRUE(paintCage(cage, bar, {ones, ones}).ok());
  EXPECT_TRUE(cage.paintedStiffness.empty() && cage.paintedDensity.empty());
  EXPECT_LT(largestDifference(cage.masses, plain.masses), 1e-12);
}

TEST(PaintedMaps, DampingMayBeNothingAndLeavesTheRest) {
  const TriangleMesh bar = barSurface(8);
  CageOptions options;
  options.targetTets = 300;
  const Cage plain = createCage(bar, options).value();
  options.damping = halves(bar, 0.0, 0.5);
  Cage cage = createCage(bar, options).value();
  ASSERT_EQ(cage.paintedDamping.size(), cage.mesh.tetCount());
  const auto [least, greatest] = std::minmax_element(cage.paintedDamping.begin(), cage.paintedDamping.end());
  EXPECT_EQ(*least, 0.0);
  EXPECT_NEAR(*greatest, 1.0, 1e-12);
  EXPECT_EQ(cage.masses, plain.masses);
  EXPECT_EQ(cage.stiffnessScale(), plain.stiffnessScale());
  PaintedMaps maps;
  maps.damping.assign(bar.vertexCount(), 1.0);
  ASSERT_TRUE(paintCage(cage, bar, maps).ok());
  EXPECT_TRUE(sameCage(cage, plain));
  maps.damping[7] = -1.0;
  const Status status = paintCage(cage, bar, maps);
  EXPECT_EQ(status.code, StatusCode::InvalidOption);
  EXPECT_NE(status.message.find("the damping map is -1.000000 at vertex 7, but must be 0 or more"), std::string::npos)
      << status.message;
}

TEST(PaintedMaps, ASheetHasThemToo) {
  const TriangleMesh sheet = sheetMesh(10);
  const Cage cage = paintedCage(sheet, {}, painted(sheet, [](const auto& p) { return 2.0 + p.x(); }), 300);
  EXPECT_EQ(cage.paintedDensity.size(), cage.mesh.tetCount());
}

TEST(PaintedMaps, BadOnesAreRefusedAndNothingChanges) {
  const TriangleMesh ball = unitSphere(10);
  const Cage plain = paintedCage(ball, {}, {}, 100);
  const auto refuse = [&](PaintedMaps maps, StatusCode code, const char* words) {
    Cage cage = plain;
    const Status status = paintCage(cage, ball, maps);
    EXPECT_EQ(status.code, code);
    EXPECT_NE(status.message.find(words), std::string::npos) << status.message;
    EXPECT_TRUE(sameCage(cage, plain));
    CageOptions options;
    options.stiffness = maps.stiffness;
    options.density = maps.density;
    EXPECT_EQ(createCage(ball, options).status().message, status.message);
  };
  std::vector<double> values(ball.vertexCount(), 2.0);
  values[7] = 0.0;
  refuse({values, {}}, StatusCode::InvalidOption, "the stiffness map is 0.000000 at vertex 7");
  refuse({{}, values}, StatusCode::InvalidOption, "the density map");
  values[7] = std::numeric_limits<double>::quiet_NaN();
  refuse({values, {}}, StatusCode::NonFinite, "at vertex 7");
  refuse({{}, std::vector<double>(ball.vertexCount(), 5e-324)}, StatusCode::InvalidOption, "a mass that double");
  refuse({{1.0, 2.0}, {}}, StatusCode::SizeMismatch, "the stiffness map has 2 values, but the mesh has");
  EXPECT_EQ(spreadMap(plain, ball, values).status().code, StatusCode::NonFinite);
  values[7] = -1.0;
  EXPECT_TRUE(spreadMap(plain, ball, values).ok());
  EXPECT_EQ(spreadMap(plain, ball, values, MapMean::Geometric).status().code, StatusCode::InvalidOption);
  TriangleMesh points = ball;
  points.triangles.clear();
  EXPECT_EQ(spreadMap(plain, points, values).status().code, StatusCode::Empty);
}

}  // namespace
}  // namespace tetskin::test
