// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "report/material.h"

#include <numeric>

namespace tetskin::report {
namespace {

/// Mass of a body as large as the reference, kg. Only contacts depend on it.
constexpr double kReferenceMass = 1.0;
constexpr double kMarginFraction = 0.02;  ///< over the body's size
/// Young's modulus over density x gravity x size. The standing serpent's head dips by a tenth of its size.
constexpr double kStiffness = 150.0, kLandingStiffness = 50.0;
/// Damping in substeps. Half a substep is the least that is stable at any stiffness.
constexpr double kDampingSubsteps = 0.6;
constexpr int kMaxSubsteps = 64;
/// The residual that the solver may leave in the reference's substeps, and the limit of its iterations. With the
/// defaults, the residual outweighs the gain of so many substeps if bodies touch.
constexpr double kConvergedTolerance = 1e-6;
constexpr int kConvergedIterations = 1000;

/// kg per volume of the mesh, or per volume of the tets if the mesh's is unknown.
double densityOf(const Cage& reference) {
  const std::vector<double>& masses = reference.masses;
  return kReferenceMass /
         (masses.empty() ? totalVolume(reference.mesh) : std::accumulate(masses.begin(), masses.end(), 0.0));
}

/// The stiffness, at most the requested one, with which this cage can land with substeps of this length.
double landingStiffness(const Cage& cage, double wish, double substep) {
  SoftBodyOptions options;
  options.density = densityOf(cage);
  options.relativeStiffness =
      wish / (options.density * scenes::kEarth * boundingBox(cage.mesh.nodes).sizes().maxCoeff());
  options.timeStep = substep;
  return scenes::defaultStiffness(cage, options);
}

}  // namespace

double stableDamping(double substep) {
  return kDampingSubsteps * substep;
}

scenes::SceneOptions materialOf(const scenes::SceneEntry& scene, const Cage& reference, double relativeStiffness,
                                bool bullets) {
  scenes::SceneOptions options;
  SoftBodyOptions& body = options.body;
  body.mass.reset();
  body.density = densityOf(reference);
  body.margin = kMarginFraction * scenes::kSize;
  const double relative = relativeStiffness > 0.0 ? relativeStiffness : scene.lands ? kLandingStiffness : kStiffness;
  const double wanted = relative * body.density * scenes::kEarth * scenes::kSize;
  body.youngsModulus = wanted;
  if (!scene.lands) {
    options.force = scenes::Force::LinearElasticity;
    body.stiffnessDamping = stableDamping(options.substep());
    if (!bullets) options.force = scenes::Force::Elastic;
    return options;
  }
  options.force = scenes::Force::NeoHookean;
  constexpr double kReached = 0.999;
  double stiffness = landingStiffness(reference, wanted, options.substep());
  while (stiffness < kReached * wanted && options.substeps < kMaxSubsteps) {
    options.substeps *= 2;
    stiffness = landingStiffness(reference, wanted, options.substep());
  }
  body.youngsModulus = stiffness;
  if (!bullets) {
    options.force = scenes::Force::Elastic;
    options.substeps = scenes::SceneOptions().substeps;
  }
  return options;
}

scenes::SceneOptions withSubsteps(scenes::SceneOptions options, int substeps) {
  if (substeps > 0) options.substeps = substeps;
  return options;
}

scenes::SceneOptions converged(scenes::SceneOptions options) {
  options.body.solverTolerance = kConvergedTolerance;
  options.body.maxIterations = kConvergedIterations;
  return options;
}

}  // namespace tetskin::report
