// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The solve in two levels: the matrix as a sum of strains, the groups of nodes, and the result of both together.
#include <gtest/gtest.h>
#include <tetskin/elastic/src/dynamics/two_level_gradient.h>

#include <vector>

#include "dense_reference.h"
#include "gradient_fixtures.h"

namespace tetskin::test {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;
using elastic_detail::GroupMotions;
using elastic_detail::MatrixSource;
using elastic_detail::TetStiffness;
using elastic_detail::TwoLevelGradient;

template <class S>
struct Solved {
  explicit Solved(const Cage& cage, double amount, double alpha)
      : body(cage, amount, alpha), rest(body.restTets()), slots(body.matrix.slotCount()) {}

  MatrixSource<S> source() {
    return {rest, body.tets.cornersAgain(static_cast<S>(body.alpha), nullptr), static_cast<double>(body.tets.ratio())};
  }
  std::vector<double> bySlot(const VectorXd& v) const {
    std::vector<double> out(3 * slots, 0.0);
    for (std::size_t n = 0; n < body.nodes.size(); ++n) {
      for (std::size_t k = 0; k < 3; ++k) {
        out[3 * body.matrix.slotOf(n) + k] = v[static_cast<Eigen::Index>(3 * n + k)];
      }
    }
    return out;
  }
  VectorXd byNode(const std::vector<double>& v) const {
    VectorXd out(static_cast<Eigen::Index>(3 * body.nodes.size()));
    for (std::size_t n = 0; n < body.nodes.size(); ++n) {
      for (std::size_t k = 0; k < 3; ++k) {
        out[static_cast<Eigen::Index>(3 * n + k)] = v[3 * body.matrix.slotOf(n) + k];
      }
    }
    return out;
  }
  VectorXd positions() const {
    VectorXd out(static_cast<Eigen::Index>(3 * body.nodes.size()));
    for (std::size_t n = 0; n < body.nodes.size(); ++n)
      out.segment<3>(static_cast<Eigen::Index>(3 * n)) = body.nodes[n];
    return out;
  }
  /// A motion as the body would have it if it were rigid.
  VectorXd rigid() const {
    VectorXd out = positions();
    for (Eigen::Index k = 0; k < out.size(); k += 3) {
      out.segment<3>(k) = Vector3d(0.3, -1.0, 0.5) + Vector3d(1.0, 0.2, -0.4).cross(Vector3d(out.segment<3>(k)));
    }
    return out;
  }
  VectorXd stiffnessTimes(const VectorXd& v) {
    TetStiffness stiffness(rest, body.matrix.pattern().slotOf);
    stiffness.take(source());
    std::vector<double> out(3 * slots, 0.0);
    stiffness.addProduct(bySlot(v), out);
    return byNode(out);
  }

  AssembledBody<S> body;
  RestTets rest;
  std::size_t slots;
};

/// 1 x 1 x 1/50, of quadratic tets.
Cage slender() {
  Cage cage;
  cage.mesh = latticeCage(25, 1, 1, 1.0 / 25.0);
  for (Vector3d& node : cage.mesh.nodes) {
    node.y() *= 0.5;
    node.z() *= 0.5;
  }
  return refineQuadratic(cage.mesh).value();
}

TEST(TetStiffness, IsTheMatrixWithoutTheMasses) {
  for (const Cage& cage : {oddCage(), oddMixedCage()}) {
    Solved<double> one(cage, 0.1, 0.3);
    const VectorXd v = Random(5).vector(3 * one.body.nodes.size());
    VectorXd expected = one.body.times(v);
    for (std::size_t i = 0; i < 3 * one.body.nodes.size(); ++i) {
      expected[static_cast<Eigen::Index>(i)] -= one.body.masses[i / 3] * v[static_cast<Eigen::Index>(i)];
    }
    EXPECT_LT(apart(one.stiffnessTimes(v), expected), 1e-12);
  }
}

/// To the second power of the rounding of floats, and the matrix of floats to the first.
TEST(TetStiffness, LeavesRigidMotionsOfABodyAtRestAloneInFloat) {
  Solved<float> one(slender(), 0.0, 1.0);
  const VectorXd rigid = one.rigid(), random = Random(6).vector(static_cast<std::size_t>(rigid.size()));
  const double scale = random.dot(one.stiffnessTimes(random)) / random.squaredNorm() * rigid.squaredNorm();
  EXPECT_LT(std::abs(rigid.dot(one.stiffnessTimes(rigid))), 1e-13 * scale);
}

TEST(GroupMotions, AnswerTheLoadsOfTheirOwnMotionsExactly) {
  Solved<double> one(oddMixedCage(), 0.1, 0.3);
  one.body.hold(0);
  const std::vector<std::uint32_t>& slotOf = one.body.matrix.pattern().slotOf;
  GroupMotions groups(one.rest, slotOf, one.slots);
  TetStiffness stiffness(one.rest, slotOf);
  stiffness.take(one.source());
  std::vector<double> masses(one.slots, 0.0);
  for (std::size_t n = 0; n < slotOf.size(); ++n) masses[slotOf[n]] = one.body.masses[n];
  ASSERT_TRUE(groups.assemble(stiffness, masses, one.bySlot(one.positions())));
  // The answer to any load is a motion of groups; the load of such a motion is answered by the motion itself.
  std::vector<double> motion(3 * one.slots, 0.0), again = motion;
  groups.addResponse(one.bySlot(Random(7).vector(3 * slotOf.size())), motion);
  std::vector<double> load(motion.size());
  for (std::size_t k = 0; k < load.size(); ++k) load[k] = masses[k / 3] * motion[k];
  stiffness.addProduct(motion, load);
  groups.addResponse(load, again);
  EXPECT_GT(one.byNode(motion).norm(), 0.0);
  EXPECT_EQ(one.byNode(motion).head<3>().norm(), 0.0);  // it is held
  EXPECT_LT(apart(one.byNode(again), one.byNode(motion)), 1e-9);
}

template <class S>
void expectSolved(const Cage& cage, double alpha, double error, int iterations) {
  Solved<S> one(cage, 0.0, alpha);
  for (std::size_t n = 0; n < one.body.nodes.size(); ++n) {
    if (cage.mesh.nodes[n].x() < 1e-9) one.body.hold(n);
  }
  one.body.assemble();
  VectorXd load = VectorXd::Zero(static_cast<Eigen::Index>(3 * one.body.nodes.size()));
  for (std::size_t n = 0; n < one.body.nodes.size(); ++n) {
    load[static_cast<Eigen::Index>(3 * n + 1)] = static_cast<double>(static_cast<S>(one.body.masses[n]));
  }
  MatrixXd dense = one.body.dense();
  for (std::size_t i = 0; i < 3 * one.body.nodes.size(); ++i) {
    if (one.body.masses[i / 3] > 0.0) continue;
    const auto at = static_cast<Eigen::Index>(i);
    dense.row(at).setZero();
    dense.col(at).setZero();
    dense(at, at) = 1.0;
  }
  AlignedVector<S> right(one.body.matrix.wideSize(), S(0));
  one.body.toWide(load, right.data());
  one.body.toWide(VectorXd::Zero(load.size()), one.body.matrix.solution());
  const double target = 1e-10 * one.body.matrix.squaredNorm(right.data(), nullptr);
  TwoLevelGradient<S> solver(one.rest, one.body.matrix);
  const int used =
      solver.solve(one.body.matrix, one.source(), right.data(), one.bySlot(one.positions()), target, 500, nullptr);
  EXPECT_LT(used, iterations);
  EXPECT_LT(apart(solutionOf(one.body), solved(dense, load)), error);
  const VectorXd left = one.body.fromWide(one.body.matrix.residual());
  for (std::size_t i = 0; i < 3 * one.body.nodes.size(); ++i) {
    if (one.body.masses[i / 3] > 0.0) continue;
    EXPECT_EQ(left[static_cast<Eigen::Index>(i)], 0.0) << "it is held";
  }
}

/// As stiff as a beam of steel that sags by a thousandth of its length: the conjugate gradient alone needs thousands of
/// iterations, and in float does not come near.
TEST(TwoLevelGradient, SolvesForASlenderBeamInFloatAsADenseSolverDoes) {
  expectSolved<double>(slender(), 1e9, 1e-4, 130);
  expectSolved<float>(slender(), 1e9, 1e-3, 130);
}

TEST(TwoLevelGradient, SolvesForOtherBodiesAsADenseSolverDoes) {
  expectSolved<double>(oddMixedCage(), 0.3, 1e-4, 60);
  expectSolved<double>(oddMixedCage(), 1e6, 1e-4, 60);
  expectSolved<float>(oddCage(), 0.3, 1e-3, 60);
}

/// More separate parts than groups: some parts are left to the sweeps.
TEST(TwoLevelGradient, SolvesForMorePartsThanThereAreGroups) {
  Cage cage;
  for (int part = 0; part < 40; ++part) {
    const TetMesh cube = latticeCage(1, 1, 1);
    const auto first = static_cast<int>(cage.mesh.nodes.size());
    for (const Vector3d& node : cube.nodes) cage.mesh.nodes.emplace_back(node + Vector3d(1.0 + 2.0 * part, 0, 0));
    for (const Tet& t : cube.tets) cage.mesh.tets.push_back({t[0] + first, t[1] + first, t[2] + first, t[3] + first});
  }
  expectSolved<double>(cage, 0.3, 1e-4, 200);
}

}  // namespace
}  // namespace tetskin::test
