// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Bars with a stiffness painted on them, pulled at their ends, against springs in series.
#include <gtest/gtest.h>
#include <tetskin/cage/create_cage.h>
#include <tetskin/cage/painted_maps.h>
#include <tetskin/core/embedding.h>
#include <tetskin/elastic/calibration.h>
#include <tetskin/elastic/src/calibration/refined_bodies.h>

#include <cmath>
#include <utility>
#include <vector>

#include "support/painted_bar.h"

namespace tetskin::test {
namespace {

using elastic_detail::Fields;

/// How far a bar with a Young's modulus of 1 stretches under a stress of 1 at its ends.
struct Pulled {
  double first = 0.0, second = 0.0;  ///< strains of the halves, over their middle parts
  double stretch = 0.0;              ///< of the whole bar
};

/// The vertices of a bar at this x, and the share of the cross-section of each.
std::vector<std::pair<std::size_t, double>> section(const TriangleMesh& bar, double x) {
  std::vector<std::pair<std::size_t, double>> found;
  double sum = 0.0;
  const auto inner = [](double along) { return along > 1e-9 && along < 1.0 - 1e-9 ? 1.0 : 0.5; };
  for (std::size_t v = 0; v < bar.vertexCount(); ++v) {
    const Eigen::Vector3d& p = bar.positions[v];
    if (std::abs(p.x() - x) > 1e-9) continue;
    found.emplace_back(v, inner(p.y()) * inner(p.z()));
    sum += found.back().second;
  }
  for (auto& [vertex, share] : found) share /= sum;
  return found;
}

Pulled pulled(const Cage& cage, const TriangleMesh& bar) {
  const auto embedded = embed(cage, bar);
  EXPECT_TRUE(embedded.ok()) << embedded.status().message;
  Eigen::VectorXd masses(static_cast<Eigen::Index>(3 * cage.mesh.nodeCount()));
  for (std::size_t n = 0; n < cage.mesh.nodeCount(); ++n)
    masses.segment<3>(static_cast<Eigen::Index>(3 * n)).setConstant(cage.masses[n]);
  const elastic_detail::RestBody body(cage, 0.3, {}, masses);
  const elastic_detail::DirectSolver solver(body);
  EXPECT_TRUE(solver.ok());
  const auto nodesAt = [&](double x, auto&& visit) {
    for (const auto& [vertex, share] : section(bar, x)) {
      const auto point = embedded.value().at(vertex);
      for (std::size_t k = 0; k < 4; ++k) visit(3 * point.nodes[k], share * point.weights[k]);
    }
  };
  Fields loads = Fields::Zero(masses.size(), 1);
  nodesAt(0.0, [&](Eigen::Index row, double share) { loads(row, 0) -= share; });
  nodesAt(4.0, [&](Eigen::Index row, double share) { loads(row, 0) += share; });
  body.rigid.balance(loads);
  const Fields moved = solver.solve(loads);
  const auto movedAt = [&](double x) {
    double sum = 0.0;
    nodesAt(x, [&](Eigen::Index row, double share) { sum += share * moved(row, 0); });
    return sum;
  };
  return {movedAt(1.5) - movedAt(0.5), movedAt(3.5) - movedAt(2.5), movedAt(4.0) - movedAt(0.0)};
}

Cage caged(const TriangleMesh& bar, std::size_t tets, std::vector<double> stiffness) {
  CageOptions options;
  options.targetTets = tets;
  options.stiffness = std::move(stiffness);
  Result<Cage> cage = createCage(bar, options);
  EXPECT_TRUE(cage.ok()) << cage.status().message;
  return cage.ok() ? std::move(cage).value() : Cage();
}

TEST(PaintedBars, StrainsAreInverseToStiffnessesAndStretchesAddUp) {
  const TriangleMesh bar = barSurface(8);
  for (const std::size_t tets : {400u, 1000u, 3000u}) {
    const Pulled plain = pulled(caged(bar, tets, {}), bar), half = pulled(caged(bar, tets, halves(bar, 4, 2)), bar);
    EXPECT_NEAR(plain.second / plain.first, 1.0, 0.02);
    EXPECT_NEAR(half.first / half.second, 4.0, 0.2) << tets;
    EXPECT_NEAR(half.stretch / plain.stretch, 0.625, 0.03 * 0.625) << tets;
  }
}

TEST(PaintedBars, OfTheirOwnTetsAreExactInBothKinds) {
  const TriangleMesh bar = barSurface(8);
  Cage linear(makeBox({16, 4, 4}, {4, 1, 1}));
  ASSERT_TRUE(paintCage(linear, bar, {halves(bar, 4, 2), std::vector<double>(bar.vertexCount(), 2.0)}).ok());
  Cage coarse(makeBox({8, 2, 2}, {4, 1, 1}));
  ASSERT_TRUE(paintCage(coarse, bar, {halves(bar, 4, 2), std::vector<double>(bar.vertexCount(), 2.0)}).ok());
  const Result<Cage> quadratic = refineQuadratic(coarse);
  ASSERT_TRUE(quadratic.ok());
  for (const Cage& cage : {linear, quadratic.value()}) {
    const Pulled half = pulled(cage, bar);
    EXPECT_NEAR(half.first / half.second, 4.0, 0.2);
    EXPECT_NEAR(half.stretch, 2.5, 0.03 * 2.5);
  }
}

TEST(PaintedBars, AreCalibratedAsTheyArePainted) {
  const TriangleMesh bar = barSurface(8);
  Cage plain = caged(bar, 400, {}), even = caged(bar, 400, std::vector<double>(bar.vertexCount(), 3.0)),
       half = caged(bar, 400, halves(bar, 4, 2));
  for (Cage* cage : {&plain, &even, &half}) {
    const Result<CalibrationReport> report = calibrate(*cage);
    ASSERT_TRUE(report.ok()) << report.status().message;
  }
  for (std::size_t t = 0; t < plain.mesh.tetCount(); ++t) {
    EXPECT_NEAR(even.stiffnessFactor[t], plain.stiffnessFactor[t], 1e-3);
    EXPECT_DOUBLE_EQ(half.stiffnessScale()[t], half.paintedStiffness[t] * half.stiffnessFactor[t] *
                                                   std::max(half.volumeFraction[t], Limits::kMinVolumeFraction));
  }
  const std::vector<double> before = half.stiffnessFactor;
  ASSERT_TRUE(calibrate(half).ok());
  EXPECT_EQ(half.stiffnessFactor, before);
  const Pulled result = pulled(half, bar);
  EXPECT_NEAR(result.first / result.second, 4.0, 0.6);  // factors by region differ by up to 1.4
}

}  // namespace
}  // namespace tetskin::test
