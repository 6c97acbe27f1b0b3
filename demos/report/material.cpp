// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "report/material.h"

#include <numeric>

namespace tetskin::report {
namespace {

/// Of a whole body as large as the reference, kg. Nothing but contacts depends on it.
constexpr double kReferenceMass = 1.0;
constexpr double kMarginShare = 0.02;  ///< of the size
/// Young's modulus over density x gravity x size. The standing serpent nods by a tenth of its size.
constexpr double kStiffness = 150.0, kLandingStiffness = 50.0;
/// Damping in substeps. Half of one is the least that is stable at any stiffness.
constexpr double kDampingSubsteps = 0.6;
constexpr int kMostSubsteps = 64;

/// kg a volume of the mesh, or of the tets where it is not known.
double densityOf(const Cage& reference) {
  const std::vector<double>& masses = reference.masses;
  return kReferenceMass /
         (masses.empty() ? totalVolume(reference) : std::accumulate(masses.begin(), masses.end(), 0.0));
}

/// The stiffness that a landing of this cage can have with so many substeps, at most the one wished for.
double landingStiffness(const Cage& cage, double wish, double substep) {
  SoftBodyOptions options;
  options.density = densityOf(cage);
  options.relativeStiffness = wish / (options.density * scenes::kEarth * boundingBox(cage.nodes).sizes().maxCoeff());
  options.timeStep = substep;
  return scenes::defaultStiffness(cage, options);
}

}  // namespace

const char* nameOf(Elasticity elasticity) {
  constexpr const char* kNames[] = {"tetskin", "explicit", "implicit"};
  return kNames[static_cast<std::size_t>(elasticity)];
}

scenes::SceneOptions materialOf(const scenes::SceneEntry& scene, const Cage& reference, double relativeStiffness,
                                Elasticity elasticity) {
  scenes::SceneOptions options;
  SoftBodyOptions& body = options.body;
  body.mass = 0.0;
  body.density = densityOf(reference);
  body.margin = kMarginShare * scenes::kSize;
  body.implicit = elasticity == Elasticity::BulletImplicit;
  const double relative = relativeStiffness > 0.0 ? relativeStiffness : scene.lands ? kLandingStiffness : kStiffness;
  body.youngsModulus = relative * body.density * scenes::kEarth * scenes::kSize;
  if (!scene.lands) {
    options.force = scenes::Force::LinearElasticity;
    body.damping = kDampingSubsteps * options.substep();
    if (elasticity == Elasticity::Tetskin) options.force = scenes::Force::Elastic;
    return options;
  }
  options.force = scenes::Force::NeoHookean;
  constexpr double kReached = 0.999;
  double stiffness = landingStiffness(reference, body.youngsModulus, options.substep());
  while (stiffness < kReached * body.youngsModulus && options.substeps < kMostSubsteps) {
    options.substeps *= 2;
    stiffness = landingStiffness(reference, body.youngsModulus, options.substep());
  }
  body.youngsModulus = stiffness;
  if (elasticity == Elasticity::Tetskin) {
    options.force = scenes::Force::Elastic;
    options.substeps = scenes::SceneOptions().substeps;
  }
  return options;
}

}  // namespace tetskin::report
