// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "report/solver.h"

#include "report/material.h"
#include "report/named_choices.h"

namespace tetskin::report {
namespace {

bool isImplicit(Solver solver) {
  return solver == Solver::BulletNeoHookeanImplicit || solver == Solver::BulletLinearImplicit;
}

/// Bullet's neo-Hookean force is that of B. Smith et al., "Stable Neo-Hookean Flesh Simulation", 2018, whose parameters
/// are not Lame's: with these in their place, bodies are too soft by a quarter in shear. Sets the material with which
/// small strains are those of the one that was asked for, as that paper gives it.
void matchSmallStrains(SoftBodyOptions& body) {
  const double young = *body.youngsModulus, poisson = body.poissonRatio;
  const double mu = young / (2.0 + 2.0 * poisson), lambda = 2.0 * mu * poisson / (1.0 - 2.0 * poisson);
  const double forceMu = 4.0 / 3.0 * mu, forceLambda = lambda + 5.0 / 6.0 * mu;
  body.poissonRatio = forceLambda / (2.0 * (forceLambda + forceMu));
  body.youngsModulus = 2.0 * forceMu * (1.0 + body.poissonRatio);
}

}  // namespace

const char* nameOf(Solver solver) {
  constexpr const char* kNames[] = {"tetskin",
                                    "xpbd",
                                    "xpbd_unfitted",
                                    "bullet_neo_hookean",
                                    "bullet_linear",
                                    "bullet_neo_hookean_implicit",
                                    "bullet_linear_implicit"};
  return kNames[static_cast<std::size_t>(solver)];
}

bool isXpbd(Solver solver) {
  return solver == Solver::Xpbd || solver == Solver::XpbdUnfitted;
}

bool isBullets(Solver solver) {
  return solver != Solver::Tetskin && !isXpbd(solver);
}

std::vector<Solver> solversOf(const std::vector<std::string>& names) {
  return choicesOf("--solvers", "solver", kSolvers, names);
}

scenes::SceneOptions withSolver(scenes::SceneOptions options, Solver solver, int substeps) {
  options.substeps = substeps;
  if (!isBullets(solver)) return options;
  const bool linear = solver == Solver::BulletLinear || solver == Solver::BulletLinearImplicit;
  options.force = linear ? scenes::Force::LinearElasticity : scenes::Force::NeoHookean;
  options.body.implicit = isImplicit(solver);
  if (!linear) matchSmallStrains(options.body);
  return options;
}

std::vector<double> dampings(const scenes::SceneOptions& material, Solver solver, int substeps) {
  std::vector<double> seconds = {material.body.stiffnessDamping};
  if (solver == Solver::Xpbd || isImplicit(solver)) seconds.push_back(0.0);
  const double least = stableDamping(material.frameSeconds / substeps);
  if (isBullets(solver) && !isImplicit(solver) && least < seconds.front()) seconds.push_back(least);
  return seconds;
}

}  // namespace tetskin::report
