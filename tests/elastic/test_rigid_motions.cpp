// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <gtest/gtest.h>
#include <tetskin/elastic/src/matrix/block_rows.h>
#include <tetskin/elastic/src/matrix/rigid_motions.h>

#include "dense_reference.h"
#include "support/odd_meshes.h"

namespace tetskin::test {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;
using elastic_detail::Fields;
using elastic_detail::RigidMotions;

/// A box, and a different one apart from it.
struct TwoComponents {
  TwoComponents() : mesh(jittered(latticeCage(2, 1, 1), 0.1, 4)), split(mesh.nodeCount()) {
    const TetMesh second = bodyCentredCage(2, 2, 2);
    const auto offset = static_cast<int>(split);
    for (const Vector3d& p : second.nodes) mesh.nodes.push_back(p + Vector3d(10, 0, 0));
    for (const Tet& t : second.tets) mesh.tets.push_back({t[0] + offset, t[1] + offset, t[2] + offset, t[3] + offset});
    masses = elastic_detail::lumpedVolumes(mesh, std::vector<double>(mesh.tetCount(), 1.0));
    for (Eigen::Index k = 0; k < masses.size(); ++k) masses[k] *= 1.0 + static_cast<double>(k / 3 % 5);
  }
  Eigen::Index rows() const { return masses.size(); }
  bool isFirst(std::size_t node) const { return node < split; }

  TetMesh mesh;
  std::size_t split;  ///< first node of the second component
  VectorXd masses;
};

/// Six motions per component: translations, and rotations about the origin.
Fields rigidMotionsOf(const TwoComponents& body) {
  Fields motions = Fields::Zero(body.rows(), 12);
  for (std::size_t n = 0; n < body.mesh.nodeCount(); ++n) {
    for (int k = 0; k < 3; ++k) {
      const int column = k + (body.isFirst(n) ? 0 : 6);
      motions.block<3, 1>(3 * n, column) = Vector3d::Unit(k);
      motions.block<3, 1>(3 * n, column + 3) = Vector3d::Unit(k).cross(body.mesh.nodes[n]);
    }
  }
  return motions;
}

TEST(RigidMotions, AreSixAPartAndMeetNoResistance) {
  const TwoComponents body;
  EXPECT_EQ(RigidMotions(body.mesh, body.masses).count(), 12);
  const elastic_detail::BlockRows stiffness(body.mesh, 0.3, std::vector<double>(body.mesh.tetCount(), 1.0));
  const Fields motions = rigidMotionsOf(body);
  Fields forces = motions;
  stiffness.multiply(motions, forces);
  EXPECT_LT(forces.norm(), 1e-12 * motions.norm());
}

TEST(RigidMotions, AreTakenOutPartByPart) {
  const TwoComponents body;
  Fields motions = rigidMotionsOf(body);
  const double size = motions.norm();
  RigidMotions(body.mesh, body.masses).removeFrom(motions);
  EXPECT_LT(motions.norm(), 1e-12 * size);
}

TEST(RigidMotions, LeaveWhatIsOrthogonalToThemByMassAsItWas) {
  const TwoComponents body;
  const RigidMotions rigid(body.mesh, body.masses);
  const Fields before = Fields::Random(body.rows(), 4), motions = rigidMotionsOf(body);
  Fields deformation = before;
  rigid.removeFrom(deformation);
  EXPECT_GT((deformation - before).norm(), 0.1 * before.norm());
  EXPECT_LT((motions.transpose() * body.masses.asDiagonal() * deformation).norm(), 1e-10);
  Fields again = deformation;
  rigid.removeFrom(again);
  EXPECT_LT((again - deformation).norm(), 1e-12 * before.norm());
  // The removed part is a rigid motion.
  const Fields taken = before - deformation;
  const Eigen::MatrixXd found = solved(motions.transpose() * motions, motions.transpose() * taken);
  EXPECT_LT((motions * found - taken).norm(), 1e-12 * before.norm());
}

TEST(RigidMotions, OfBalancedLoadsAreNotAccelerated) {
  const TwoComponents body;
  const Fields before = Fields::Random(body.rows(), 3);
  Fields loads = before, accelerations = body.masses.cwiseInverse().asDiagonal() * before;
  const RigidMotions rigid(body.mesh, body.masses);
  rigid.balance(loads);
  // The loads have no resultant and no moment.
  EXPECT_LT((rigidMotionsOf(body).transpose() * loads).norm(), 1e-10);
  rigid.removeFrom(accelerations);
  EXPECT_LT((body.masses.asDiagonal() * accelerations - loads).norm(), 1e-12 * before.norm());
}

}  // namespace
}  // namespace tetskin::test
