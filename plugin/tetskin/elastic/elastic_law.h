// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// How stress follows from large strains. For `DeformableBody` (tetskin/solver) and `ElasticBody`.
#pragma once

#include <tetskin/core/types.h>

#include <vector>

namespace tetskin {

/// A law of elasticity. Small strains have the same Young's modulus and Poisson's ratio with each of them.
///
/// Where the volume stays, the nominal stress (force over the area at rest) of a bar that is stretched to s is
///   corotated    E (s - 1)
///   neo-Hookean  E / 3 (s - 1 / s^2)
///   Yeoh         E / 3 (s - 1 / s^2) (1 + 2 c2 K + 3 c3 K^2),  K = s^2 + 2 / s - 3
/// So neo-Hookean becomes softer than a linear law when it is pulled, and far stiffer when it is pressed. Yeoh's
/// stiffens when it is pulled, as rubber and flesh do. The volume resists with Lamé's lambda + mu times (J - 1). K is
/// bounded by `largestDistortion`: from there on stress grows in proportion to what the neo-Hookean's does.
/// Sources: see src/kernels/hyperelasticity.h.
struct ElasticLaw {
  /// Their formulas: see above.
  enum class Kind { Corotated, NeoHookean, Yeoh };

  Kind kind = Kind::Corotated;  ///< the formula
  double c2 = 0.0;              ///< of Yeoh's: C20 / C10, no units
  /// Likewise C30 / C10. 1 + 2 c2 K + 3 c3 K^2 must be at least 0.05 for all K from 0 to 60.
  double c3 = 0.0;

  /// The linear law.
  static ElasticLaw corotated() { return {}; }
  /// Softer when it is pulled, stiffer when it is pressed.
  static ElasticLaw neoHookean() { return {Kind::NeoHookean, 0.0, 0.0}; }
  /// Stiffer in both. See `c2`.
  static ElasticLaw yeoh(double c2, double c3) { return {Kind::Yeoh, c2, c3}; }

  /// The same law.
  bool operator==(const ElasticLaw& other) const { return kind == other.kind && c2 == other.c2 && c3 == other.c3; }
  /// Another law.
  bool operator!=(const ElasticLaw& other) const { return !(*this == other); }
};

/// Ok, or InvalidOption, with what is wrong.
TETSKIN_ELASTIC_API Status checkElasticLaw(const ElasticLaw& law);

/// The K from which on a law goes on in proportion: 60, at nearly eight times the length, or where it is a hundred
/// times stiffer than a neo-Hookean one.
TETSKIN_ELASTIC_API double largestDistortion(const ElasticLaw& law);

/// How a sample is loaded: pulled or pressed along one axis, along two, or along one while another keeps its length
/// (planar tension, "pure shear").
enum class Loading { Uniaxial, Equibiaxial, Planar };

/// The nominal stress over Young's modulus of a material that keeps its volume (Poisson's ratio of a half).
/// stretch  length over length at rest, above 0
TETSKIN_ELASTIC_API double nominalStress(const ElasticLaw& law, Loading loading, double stretch);

/// A measured point of a curve of stress over stretch.
struct StressPoint {
  double stretch = 1.0;                 ///< length over length at rest, above 0 and not 1
  double stress = 0.0;                  ///< nominal, pressure units; negative where the sample is pressed
  Loading loading = Loading::Uniaxial;  ///< of the sample
};

/// What `fitElasticLaw` finds.
struct FittedLaw {
  ElasticLaw law;              ///< of the kind that was asked for
  double youngsModulus = 0.0;  ///< pressure units
  double error = 0.0;          ///< root mean square of the relative errors of the stresses
};

/// The Young's modulus and, of Yeoh's law, the coefficients with which a law meets measured curves best: least squares
/// of relative errors, among coefficients that `checkElasticLaw` accepts.
/// points  at least one; at least three for Yeoh's law
/// Errors  InvalidOption: too few points, or points that no elastic material has
TETSKIN_ELASTIC_API Result<FittedLaw> fitElasticLaw(ElasticLaw::Kind kind, const std::vector<StressPoint>& points);

}  // namespace tetskin
