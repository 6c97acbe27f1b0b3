// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Bodies of cages with duplicate elements: nothing in them turns freely about a node or an edge.
#include <gtest/gtest.h>
#include <tetskin/cage/create_cage.h>
#include <tetskin/elastic/src/calibration/rest_body.h>

#include "support/component_models.h"
#include "support/odd_meshes.h"

namespace tetskin::test {
namespace {

using Eigen::VectorXd;

constexpr double kPoissonOfSplits = 0.3;
/// Squared frequency, relative to the same body with fused elements, below which there must be a hinge; a hinge has 0.
constexpr double kHinge = 1e-4;

/// Square of the lowest frequency after the rigid motions, six per component.
double softest(const Cage& cage) {
  const std::vector<double> ones(cage.mesh.tetCount(), 1.0), known = cage.stiffnessScale();
  VectorXd masses = elastic_detail::lumpedVolumes(cage.mesh, ones);
  for (std::size_t n = 0; n < cage.masses.size(); ++n) masses.segment<3>(3 * n).setConstant(cage.masses[n]);
  const elastic_detail::RestBody body(cage.mesh, kPoissonOfSplits, known.empty() ? ones : known, masses);
  const elastic_detail::DirectSolver solver(body);
  EXPECT_TRUE(solver.ok());
  const VectorXd mode = elastic_detail::softestModes(body, solver, 1).col(0);
  return mode.dot(body.stiffness.selfadjointView<Eigen::Lower>() * mode) / mode.dot(masses.cwiseProduct(mode));
}

Cage built(const TriangleMesh& mesh, bool split) {
  CageOptions options;
  options.targetTets = 600;
  options.duplicateElements = split;
  return createCage(mesh, options).value();
}

TEST(SplitStiffness, SplitCagesHaveNoHinges) {
  for (const ComponentModel& model :
       {twoPlates(0.15), jaw(0.12), claw(0.1), chain(2, 0.15), coil(2, 0.1), jaw(0.03), crossedBoxes()}) {
    const double whole = softest(built(model.mesh, false)), split = softest(built(model.mesh, true));
    EXPECT_GT(split, kHinge * whole) << model.name << " " << model.gap;
  }
}

/// Two beams end to end, or connected only by an edge or a node.
Cage joinedBeams(int sharedNodes) {
  Cage beams = latticeCage(4, 1, 1);
  const Cage second = beams;
  const auto count = static_cast<int>(second.mesh.nodeCount());
  std::vector<int> number(second.mesh.nodeCount(), -1);
  for (int n = 0, shared = 0; n < count; ++n) {
    const Eigen::Vector3d at = second.mesh.nodes[n] + Eigen::Vector3d(4.0, 0.0, 0.0);
    for (int m = 0; m < count && shared < sharedNodes; ++m) {
      if ((beams.mesh.nodes[m] - at).norm() < 1e-9) number[n] = m, ++shared;
      if (number[n] >= 0) break;
    }
    if (number[n] >= 0) continue;
    number[n] = static_cast<int>(beams.mesh.nodeCount());
    beams.mesh.nodes.push_back(at);
  }
  for (Tet tet : second.mesh.tets) {
    for (int& n : tet) n = number[n];
    beams.mesh.tets.push_back(tet);
  }
  return beams;
}

TEST(SplitStiffness, AHingeWouldBeSeen) {
  const double whole = softest(joinedBeams(4));
  EXPECT_GT(softest(joinedBeams(3)), 10.0 * kHinge * whole);
  for (const int sharedNodes : {1, 2}) EXPECT_LT(softest(joinedBeams(sharedNodes)), 1e-2 * kHinge * whole);
}

}  // namespace
}  // namespace tetskin::test
