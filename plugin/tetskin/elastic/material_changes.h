// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// What changes the state in which a body is at rest: plastic flow, growth, muscles. For `DeformableBody`
// (tetskin/solver) and `ElasticBody`.
#pragma once

#include <tetskin/core/mesh.h>
#include <tetskin/core/types.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <limits>
#include <vector>

namespace tetskin {

/// Plastic flow: beyond its yield stress a material keeps a part of its deformation, as clay, lead or wet sand do. Von
/// Mises's criterion with isotropic hardening; flow keeps the volume. It takes energy and never gives any. What flows
/// does not depend on the step, except that the flow of a step begins in the next one.
struct Plasticity {
  /// Pressure units, above 0: the von Mises stress at which the material yields, which is the stress of a bar that is
  /// pulled. In a tet with a stiffness factor, its yield stress has that factor, too: all tets yield at the same
  /// strain, yieldStress over Young's modulus.
  double yieldStress = 0.0;
  /// tetCount, above 0: yield stresses by tet. Empty: all have `yieldStress`
  std::vector<double> yieldStresses;
  double hardening = 0.0;  ///< pressure units, 0 or more: by how much the yield stress grows per plastic strain
  /// Per second, above 0: the rate at which what is beyond the yield stress flows; infinite: at once
  double flowRate = std::numeric_limits<double>::infinity();
  /// Above 0: the largest plastic strain that a tet may keep; from there on it is elastic. As a logarithmic strain: 0.1
  /// is a stretch by 1.105. Above 3, a stretch by 20, it counts as 3
  double largestStrain = std::numeric_limits<double>::infinity();
};

/// The yield stress of a material whose strain deviator has this norm when it yields, which is how Rapier and others
/// set it: sqrt(6) mu times the norm. Units of Young's modulus.
/// norm  Frobenius norm of the deviator of the strain, above 0
inline double yieldStressOf(double norm, double youngsModulus, double poissonRatio) {
  return 2.449489742783178 * norm * youngsModulus / (2.0 * (1.0 + poissonRatio));
}

/// Tets that contract along their fibres.
///
/// A muscle of activation a pulls with a tension of a x `stress` on the area across its fibres when it is held at its
/// rest length. When it is free, it shortens to 1 / (1 + w) of it, where
///   w (1 + 2 nu w) = a stress / E,  nu: Poisson's ratio,  E: Young's modulus of the tet
/// and becomes wider by sqrt(1 + 2 nu w). Between the two, tension follows elasticity.
///
/// With `lengthFactors` it pulls at any length, beside its elasticity, with a tension of a x `stress` x factor on the
/// area at rest, with the factor at its present stretch s, that along its fibres: free, it shortens to the s where
///   E (1 - s) = a stress factor(s)
/// Where s is below 2 nu / (1 + 2 nu), it pulls less, and with little tension it pushes. Each step takes the stretch at
/// its beginning, by tet. Where a stress x factor falls with the stretch by more than E, a muscle is unstable at any
/// given force, as in an animal: some of it becomes longer, and the rest shorter.
struct Muscle {
  std::vector<int> tets;  ///< of the cage, at least one, each once
  /// Rest space, of any length above 0: one for each tet, or one for all. For growth, see Fibres
  std::vector<Eigen::Vector3d> fibres;
  double stress = 3e5;  ///< pressure units, above 0: the tension at activation 1; a human muscle has 3e5 Pa
  /// Points (stretch, factor) of a curve of tension over length: stretches above 0, ascending; factors 0 or more.
  /// Linear between them, constant beyond. Empty: no curve. That of a skeletal muscle is about (0.5, 0), (0.9, 1),
  /// (1.1, 1), (1.6, 0)
  std::vector<std::array<double, 2>> lengthFactors;
};

/// Fibres that make tets stiffer along them: tendon, the passive part of muscles, a hose's braid, wood. Beside the
/// elasticity of its tets, what is stretched by a strain e along its fibres has a tension of `stiffness` x e there, on
/// its area at rest. Neither activation nor plastic flow changes their rest length, but growth does. All have the
/// damping of the least damped tet of the body: where a factor of 0 leaves one tet undamped, no fibre is damped.
struct Fibres {
  std::vector<int> tets;  ///< of the cage, at least one, each once
  /// Rest space, of any length above 0: one for each tet, or one for all. In a tet whose growth is not the same along
  /// all axes, they are directions in its grown shape
  std::vector<Eigen::Vector3d> directions;
  double stiffness = 0.0;    ///< pressure units, above 0; a tet's stiffness factor multiplies it, too
  bool tensionOnly = false;  ///< as a rope, nothing resists where they become shorter
};

/// Fibres along a curve: for each tet the direction of the nearest piece of it. Of two points: the axis between them.
/// tets   of the cage; must exist
/// curve  points, rest space, at least two, not all in one place
/// Cost   O(tets x points). Error: InvalidOption
inline Result<std::vector<Eigen::Vector3d>> fibresAlong(const TetMesh& cage, const std::vector<int>& tets,
                                                        const std::vector<Eigen::Vector3d>& curve) {
  std::vector<std::size_t> pieces;  // those that have a direction
  for (std::size_t k = 0; k + 1 < curve.size(); ++k) {
    if ((curve[k + 1] - curve[k]).squaredNorm() > 0.0) pieces.push_back(k);
  }
  if (pieces.empty()) {
    return Status{StatusCode::InvalidOption, "the curve of fibres needs two points in different places"};
  }
  std::vector<Eigen::Vector3d> fibres;
  for (const int t : tets) {
    const Tet& tet = cage.tets[static_cast<std::size_t>(t)];
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    for (const int n : tet) centre += 0.25 * cage.nodes[static_cast<std::size_t>(n)];
    const auto distance = [&](std::size_t k) {
      const Eigen::Vector3d way = curve[k + 1] - curve[k], from = centre - curve[k];
      return (from - std::min(std::max(from.dot(way) / way.squaredNorm(), 0.0), 1.0) * way).squaredNorm();
    };
    const std::size_t nearest = *std::min_element(
        pieces.begin(), pieces.end(), [&](std::size_t a, std::size_t b) { return distance(a) < distance(b); });
    fibres.push_back((curve[nearest + 1] - curve[nearest]).normalized());
  }
  return fibres;
}

}  // namespace tetskin
