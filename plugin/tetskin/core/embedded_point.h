// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A point that moves with the four nodes of a tet: where it is, how fast, and what a push on it does to them.
#pragma once

#include <tetskin/core/tet_mesh.h>

#include <array>
#include <cstddef>
#include <type_traits>

namespace tetskin {

/// A point of a cage by the weights of its tet's nodes. A value of some 60 bytes (90 in double) that owns nothing; made
/// by `Embedding::at`.
///
/// What is known of the nodes is asked for by node index, so that they may be anywhere: a function of an int that
/// returns a vector (an `Eigen::Matrix<Scalar, 3, 1>` or a `btVector3`, by value or by reference), or a scalar. Nodes
/// and results are in world space, in the units of what is given. No function allocates, each asks for every node a
/// few times at most, and none can fail: what is not finite stays so.
template <class Scalar>
struct EmbeddedPoint {
  Tet nodes{};                      ///< of the tet
  std::array<Scalar, 4> weights{};  ///< sum 1, the fourth being 1 minus the others; outside the tet they extrapolate
  /// Where forces act: the weights of the tet's point that is closest at rest, none below 0, sum 1 but for rounding.
  /// Weights that extrapolate would throw single nodes about.
  std::array<Scalar, 4> clamped{};
  int tet = -1;         ///< index of the tet in the cage
  bool inside = false;  ///< the point lies in the tet; if not, `clamped` is of another point

  /// Where it is: what linear skinning draws. Summed up relative to the last node, so that rounded weights cost nothing
  /// far from the origin.
  template <class PositionOf>
  auto position(const PositionOf& positionOf) const {
    using Vector = std::decay_t<decltype(positionOf(0))>;
    const Vector last = positionOf(nodes[3]);
    Vector sum = weights[0] * (positionOf(nodes[0]) - last);
    for (std::size_t k = 1; k < 3; ++k) sum += weights[k] * (positionOf(nodes[k]) - last);
    return Vector(last + sum);
  }

  /// How fast that point moves.
  template <class VelocityOf>
  auto velocity(const VelocityOf& velocityOf) const {
    return weightedSum(weights, velocityOf);
  }

  /// How fast the point moves that forces act at: what an impulse does work on.
  template <class VelocityOf>
  auto clampedVelocity(const VelocityOf& velocityOf) const {
    return weightedSum(clamped, velocityOf);
  }

  /// By how much a unit impulse in any direction changes `clampedVelocity`, by the nodes' own masses alone; 0 where all
  /// are pinned.
  /// inverseMassOf  scalar of a node, 0 where it is pinned
  template <class InverseMassOf>
  Scalar inverseMass(const InverseMassOf& inverseMassOf) const {
    Scalar sum = 0;
    for (std::size_t k = 0; k < 4; ++k) sum += clamped[k] * clamped[k] * inverseMassOf(nodes[k]);
    return sum;
  }

  /// Shares an impulse out to the nodes by the clamped weights: their linear momentum grows by it, but for what pinned
  /// nodes take, and their angular momentum by its moment about where it acts.
  /// impulse        mass times velocity
  /// inverseMassOf  as above
  /// change         called as change(node, velocityChange) for each of the nodes
  template <class Vector, class InverseMassOf, class Change>
  void applyImpulse(const Vector& impulse, const InverseMassOf& inverseMassOf, Change&& change) const {
    for (std::size_t k = 0; k < 4; ++k) {
      change(nodes[k], Vector((clamped[k] * inverseMassOf(nodes[k])) * impulse));
    }
  }

 private:
  template <class VectorOf>
  auto weightedSum(const std::array<Scalar, 4>& factors, const VectorOf& vectorOf) const {
    using Vector = std::decay_t<decltype(vectorOf(0))>;
    Vector sum = factors[0] * vectorOf(nodes[0]);
    for (std::size_t k = 1; k < 4; ++k) sum += factors[k] * vectorOf(nodes[k]);
    return sum;
  }
};

}  // namespace tetskin
