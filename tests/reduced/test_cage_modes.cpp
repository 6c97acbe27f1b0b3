// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "reduced_test.h"

#include <tetskin/core/cage.h>
#include <tetskin/core/embedding.h>
#include <tetskin/reduced/src/modes/cage_modes.h>

#include <algorithm>
#include <numeric>

namespace tetskin {
namespace {

using namespace test;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using reduced_detail::CageModes;
using reduced_detail::modesOfCage;

CageModes modes(const VibrationModes& modes, const TetMesh& cage, const std::vector<int>& nodeTets = {}) {
  Result<CageModes> result = modesOfCage(modes, modes.modeCount(), cage, nodeTets);
  EXPECT_TRUE(result.ok()) << result.status().message;
  return std::move(result).value();
}

TEST(CageModes, OfTheFineTetsThemselvesAreTheirOwn) {
  const CageModes same = modes(barModes(), fineBar());
  for (std::size_t r = 0; r < same.shapes.size(); ++r) {
    EXPECT_LT(same.projectionErrors[r], 1e-3);  // not 0, because the projection also weighs bending
    double difference = 0.0, norm = 0.0;
    for (std::size_t k = 0; k < same.shapes[r].size(); ++k) {
      difference += std::pow(same.shapes[r][k] - barModes().shapes[r][k], 2);
      norm += std::pow(barModes().shapes[r][k], 2);
    }
    EXPECT_LT(std::sqrt(difference / norm), 2e-3) << r;
  }
}

TEST(CageModes, OfQuadraticTetsAreTheirOwn) {
  const Cage cage = refineQuadratic(makeBox({8, 2, 2}, Vector3d(2, 0.5, 0.5))).value();
  VibrationOptions options;
  options.modeCount = 6;
  const CageModes same = modes(computeVibrationModes(cage, options).value(), cage.mesh);
  EXPECT_EQ(same.outside, 0u);
  for (const double error : same.projectionErrors) EXPECT_LT(error, 1e-3);
}

TEST(CageModes, OfACoarserCageCarryTheSoftestOnesWell) {
  const CageModes coarse = modes(barModes(), barCage().mesh);
  EXPECT_EQ(coarse.outside, 0u);
  EXPECT_LT(coarse.projectionErrors[0], 0.03);
  for (const double error : coarse.projectionErrors) EXPECT_LT(error, 0.5);
}

TEST(CageModes, AreWhatTheReportedErrorSays) {
  const Cage cage = barCage();
  const CageModes coarse = modes(barModes(), cage.mesh);
  const std::vector<VertexBinding> bindings = embed(cage.mesh, viewOf(barModes().nodes)).value().bindings();
  for (std::size_t r = 0; r < coarse.shapes.size(); ++r) {
    double difference = 0.0;
    for (std::size_t n = 0; n < bindings.size(); ++n) {
      for (std::size_t k = 0; k < 3; ++k) {
        double carried = 0.0;
        for (std::size_t c = 0; c < 4; ++c) {
          carried += bindings[n].weights[c] *
                     coarse.shapes[r][3 * static_cast<std::size_t>(cage.mesh.tets[bindings[n].tet][c]) + k];
        }
        difference += barModes().masses[n] * std::pow(carried - barModes().shapes[r][3 * n + k], 2);
      }
    }
    EXPECT_NEAR(coarse.projectionErrors[r], std::sqrt(difference), 1e-5);  // modes have length 1
  }
}

TEST(CageModes, OfAffineDisplacementsAreAffineWhereNoNodeTells) {
  VibrationModes affine = barModes();
  Matrix3d map;
  map << 0.2, -0.1, 0.3, 0.05, 0.4, 0.1, -0.2, 0.1, 0.3;
  const Vector3d shift(0.1, 0.2, -0.3);
  for (std::size_t n = 0; n < affine.nodeCount(); ++n) {
    const Vector3d moved = map * affine.nodes[n] + shift;
    for (std::size_t k = 0; k < 3; ++k) affine.shapes[0][3 * n + k] = moved[static_cast<Eigen::Index>(k)];
  }
  // This cage has two layers of cells beyond the bar on all sides.
  TetMesh wide = makeBox({12, 6, 6}, Vector3d(3, 1.5, 1.5));
  for (Vector3d& node : wide.nodes) node -= Vector3d(1.5, 0.75, 0.75);
  const CageModes carried = modes(affine, wide);
  EXPECT_LT(carried.projectionErrors[0], 1e-6);
  for (std::size_t n = 0; n < wide.nodeCount(); ++n) {
    const Vector3d expected = map * wide.nodes[n] + shift;
    EXPECT_LT((Eigen::Map<const Vector3d>(&carried.shapes[0][3 * n]) - expected).norm(), 1e-5) << n;
  }
}

TEST(CageModes, HaveTheMassOfTheFineTets) {
  const CageModes coarse = modes(barModes(), barCage().mesh);
  const double mass = std::accumulate(coarse.masses.begin(), coarse.masses.end(), 0.0);
  EXPECT_NEAR(mass, 0.5, 1e-9);
  EXPECT_NEAR(coarse.mass, 0.5, 1e-9);
  Vector3d centre = Vector3d::Zero();
  const Cage cage = barCage();
  for (std::size_t n = 0; n < cage.mesh.nodeCount(); ++n) {
    EXPECT_GT(coarse.masses[n], 0.0);
    centre += coarse.masses[n] * cage.mesh.nodes[n];
  }
  EXPECT_LT((centre / mass - coarse.centre).norm(), 1e-4);
  // A box with sides 2, 0.5 and 0.5; masses at nodes lie slightly farther out.
  EXPECT_NEAR(coarse.inertia(1, 1) / (0.5 * 4.25 / 12), 1.0, 0.02);
}

TEST(CageModes, PinTheNodesThatCarryMoreOfWhatIsPinnedThanOfWhatIsNot) {
  const VibrationModes& bar = barModes(true);
  const Cage cage = barCage();
  std::vector<double> surplus(cage.mesh.nodeCount(), 0.0);  // of pinned nodes
  std::vector<char> any(cage.mesh.nodeCount(), 0);
  const auto bindings = embed(cage.mesh, viewOf(bar.nodes)).value().bindings();
  for (std::size_t v = 0; v < bindings.size(); ++v) {
    const bool held = std::count(bar.pinned.begin(), bar.pinned.end(), static_cast<int>(v)) > 0;
    for (int k = 0; k < 4; ++k) {
      const auto node = static_cast<std::size_t>(cage.mesh.tets[static_cast<std::size_t>(bindings[v].tet)][k]);
      const double mass = static_cast<double>(bindings[v].weights[k]) * bar.masses[v];
      surplus[node] += held ? mass : -mass;
      any[node] |= held && mass > 1e-6 * bar.masses[v];
    }
  }
  const CageModes found = modes(bar, cage.mesh);
  int shared = 0;
  for (std::size_t n = 0; n < surplus.size(); ++n) {
    EXPECT_EQ(found.pinned[n] != 0, surplus[n] > 0.0) << n;
    shared += any[n] != 0 && surplus[n] < 0.0;
  }
  EXPECT_GT(shared, 0);
}

TEST(CageModes, AreCarriedByTheTetsThatAreNamed) {
  const Cage cage = barCage();
  std::vector<int> tets;
  for (const VertexBinding& binding : embed(cage.mesh, viewOf(barModes().nodes)).value().bindings()) {
    tets.push_back(binding.tet);
  }
  const CageModes named = modes(barModes(), cage.mesh, tets), found = modes(barModes(), cage.mesh);
  for (std::size_t r = 0; r < found.shapes.size(); ++r) {
    EXPECT_NEAR(named.projectionErrors[r], found.projectionErrors[r], 1e-5);
  }
  tets.pop_back();
  EXPECT_EQ(modesOfCage(barModes(), 1, cage.mesh, tets).status().code, StatusCode::SizeMismatch);
  tets.push_back(static_cast<int>(cage.mesh.tetCount()));
  EXPECT_EQ(modesOfCage(barModes(), 1, cage.mesh, tets).status().code, StatusCode::IndexOutOfRange);
}

}  // namespace
}  // namespace tetskin
