// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/disjoint_sets.h>
#include <tetskin/elastic/src/matrix/rigid_motions.h>

#include <algorithm>
#include <cassert>

namespace tetskin::elastic_detail {
namespace {

Eigen::Index rowOf(std::size_t item) {
  return static_cast<Eigen::Index>(3 * item);
}

/// Adds arm x vector to the sums, three rows each.
template <class Vectors, class Sums>
void addCross(const Eigen::Vector3d& arm, const Vectors& vectors, Sums&& sums) {
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    sums.row(i) += arm[j] * vectors.row(k) - arm[k] * vectors.row(j);
  }
}

}  // namespace

RigidMotions::RigidMotions(const TetMesh& mesh, const Eigen::VectorXd& masses) {
  assert(mesh.nodeCount() > 0 && masses.size() == rowOf(mesh.nodeCount()));
  DisjointSets sets(mesh.nodeCount());
  for (const Tet& tet : mesh.tets) {
    for (int k = 1; k < 4; ++k) sets.unite(tet[0], tet[k]);
  }
  partOf_ = sets.numbers();
  components_.resize(static_cast<std::size_t>(*std::max_element(partOf_.begin(), partOf_.end())) + 1);
  for (std::size_t n = 0; n < mesh.nodeCount(); ++n) {
    masses_.push_back(masses[rowOf(n)]);
    components_[partOf_[n]].mass += masses_[n];
    components_[partOf_[n]].centroid += masses_[n] * mesh.nodes[n];
  }
  for (Component& component : components_) component.centroid /= component.mass;
  for (std::size_t n = 0; n < mesh.nodeCount(); ++n) {
    Component& component = components_[partOf_[n]];
    arms_.emplace_back(mesh.nodes[n] - component.centroid);
    component.inertia +=
        masses_[n] * (arms_[n].squaredNorm() * Eigen::Matrix3d::Identity() - arms_[n] * arms_[n].transpose());
  }
  for (Component& component : components_)
    component.inertiaFactors = SmallLdlt<3>(smallFrom<3, 3>(component.inertia.data()));
}

void RigidMotions::removeFrom(Fields& displacements) const {
  assert(displacements.rows() == rowOf(partOf_.size()));
  // First computes the momenta of the components, then the velocities of the rigid motions with these momenta.
  Fields linear = Fields::Zero(rowOf(components_.size()), displacements.cols()), angular = linear;
  Fields momentum(3, displacements.cols()), motion = momentum;
  for (std::size_t n = 0; n < partOf_.size(); ++n) {
    const Eigen::Index part = 3 * partOf_[n];
    momentum = masses_[n] * displacements.middleRows<3>(rowOf(n));
    linear.middleRows<3>(part) += momentum;
    addCross(arms_[n], momentum, angular.middleRows<3>(part));
  }
  for (std::size_t p = 0; p < components_.size(); ++p) {
    linear.middleRows<3>(rowOf(p)) /= components_[p].mass;
    for (Eigen::Index k = 0; k < displacements.cols(); ++k) {
      const Eigen::Vector3d momentumOf = angular.block<3, 1>(rowOf(p), k);
      const Small3 velocity = components_[p].inertiaFactors.solve(smallFrom<3>(momentumOf.data()));
      angular.block<3, 1>(rowOf(p), k) = Eigen::Vector3d::Map(velocity.values);
    }
  }
  for (std::size_t n = 0; n < partOf_.size(); ++n) {
    const Eigen::Index part = 3 * partOf_[n];
    motion = linear.middleRows<3>(part);
    addCross(-arms_[n], angular.middleRows<3>(part), motion);
    displacements.middleRows<3>(rowOf(n)) -= motion;
  }
}

void RigidMotions::balance(Fields& loads) const {
  assert(loads.rows() == rowOf(masses_.size()));
  for (std::size_t n = 0; n < masses_.size(); ++n) loads.middleRows<3>(rowOf(n)) /= masses_[n];
  removeFrom(loads);
  for (std::size_t n = 0; n < masses_.size(); ++n) loads.middleRows<3>(rowOf(n)) *= masses_[n];
}

}  // namespace tetskin::elastic_detail
