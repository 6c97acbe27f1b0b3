// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <algorithm>
#include <cmath>

#include "stress/case_groups.h"
#include "stress/models.h"

namespace tetskin::stress {
namespace {

constexpr double kStiffnesses[] = {1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9};
constexpr double kTimeSteps[] = {1.0 / 1000, 1.0 / 480, 1.0 / 240, 1.0 / 120, 1.0 / 60, 1.0 / 30, 1.0 / 20, 1.0 / 15};
constexpr double kDamping = 0.02;  ///< seconds
constexpr double kStiffForExplicit = 1e6;
constexpr int kMinSteps = 60;  ///< for each cell of the map

/// The documented behaviour of bodies that land: explicit steps are stable up to a stiffness, which also bounds the
/// default; nothing is promised of implicit steps, and of Bullet's other force models.
Simulation documented(const StressCase& landing) {
  if (isOurs(landing.force)) return promised(landing);
  const bool offered = landing.force == Force::LinearElasticity || landing.force == Force::NeoHookean;
  if (landing.implicit || !offered) return Simulation::Either;
  SoftBodyOptions stiffest = scenes::oneKilogram();  // its default stiffness is what `timeStep` bounds it by
  stiffest.relativeStiffness = 1e30;
  stiffest.timeStep = landing.substep();
  const TetMesh cage = makeModel(Cage::Bar, Surface::Bar).cage.mesh;
  const bool stable = landing.stiffness <= scenes::defaultStiffness(cage, stiffest);
  return stable ? Simulation::Bounded : Simulation::Either;
}

/// A body lands with every stiffness and time step, and is observed for one second.
void addStabilityMap(Cases& cases) {
  for (const Method& method : methodsOf({Force::NeoHookean})) {
    for (const double step : kTimeSteps) {
      for (const double stiffness : kStiffnesses) {
        if (!isOurs(method.force) && stiffness > kStiffestOfBullets) continue;
        const std::string whose = isOurs(method.force) ? toString(method.force) : integrator(method.implicit);
        StressCase cell = named("map", {whose, "E=" + text(stiffness), "dt=" + stepText(step)});
        cell.force = method.force;
        cell.implicit = method.implicit;
        cell.stiffness = stiffness;
        cell.timeStep = step;
        cell.substeps = 1;
        cell.damping = std::max(kDamping, 0.5 * step);
        cell.frames = std::max(kMinSteps, static_cast<int>(std::lround(1.0 / step)));
        cell.simulation = documented(cell);
        cell.quick = isOurs(method.force) || step == 1.0 / 60 || step == 1.0 / 15;
        cases.push_back(cell);
      }
    }
  }
}

void addForces(Cases& cases) {
  for (const Method& method : methodsOf({Force::LinearElasticity, Force::BulletCorotated})) {
    for (const double stiffness : kStiffnesses) {
      if (!isOurs(method.force) && stiffness > kStiffestOfBullets) continue;
      StressCase made = named("force", method, {"E=" + text(stiffness)});
      made.stiffness = stiffness;
      made.simulation = documented(made);
      made.quick = isOurs(method.force) || stiffness == 1e3;
      cases.push_back(made);
    }
  }
  for (const double stiffness : {0.01, 0.1, 0.5, 1.0}) {
    StressCase made = named("force", {toString(Force::MassSpring), "link=" + text(stiffness)});
    made.force = Force::MassSpring;
    made.stiffness = stiffness;
    made.quick = true;
    cases.push_back(made);
  }
}

void addPoissonRatios(Cases& cases) {
  for (const Method& method : methodsOf({Force::LinearElasticity, Force::NeoHookean})) {
    for (const double poisson : {0.0, 0.1, 0.2, 0.3, 0.4, 0.45, 0.49, 0.499}) {
      StressCase made = named("poisson", method, {"nu=" + text(poisson)});
      made.poisson = poisson;
      made.simulation = documented(made);
      made.quick = isOurs(method.force) || poisson == 0.499;
      cases.push_back(made);
    }
  }
}

/// Bullet's explicit steps of a stiff body need half a substep's worth of damping, which is treated implicitly: that is
/// enough in free motion, but not always in a landing.
Simulation documentedOfDamping(const StressCase& made) {
  if (isOurs(made.force)) return promised(made);
  if (made.implicit || made.scene != "pluck") return Simulation::Either;
  if (made.damping < 0.5 * made.substep()) return Simulation::Unbounded;
  return made.damping <= made.substep() ? Simulation::Bounded : Simulation::Either;
}

void addDampings(Cases& cases) {
  const double step = StressCase().substep();
  const std::pair<const char*, double> dampings[] = {
      {"0", 0.0}, {"dt/8", step / 8}, {"dt/4", step / 4}, {"dt/2", step / 2}, {"dt", step}, {"0.1", 0.1}, {"1", 1.0}};
  for (const Method& method : methodsOf({Force::LinearElasticity, Force::NeoHookean})) {
    for (const auto& [name, damping] : dampings) {
      for (const std::string scene : {"pluck", "land"}) {
        StressCase made = named("damping", method, {scene, std::string("c=") + name});
        made.damping = damping;
        made.stiffness = kStiffForExplicit;
        made.scene = scene;
        made.frames = 60;
        made.simulation = documentedOfDamping(made);
        made.quick = isOurs(method.force) || (!made.implicit && scene == "pluck");
        cases.push_back(made);
      }
    }
  }
}

void addSubsteps(Cases& cases) {
  for (const Force force : {Force::MassSpring, Force::LinearElasticity, Force::NeoHookean, Force::Elastic}) {
    for (const int substeps : {1, 2, 4, 8, 16}) {
      StressCase made = named("substeps", {toString(force), std::to_string(substeps)});
      made.force = force;
      made.substeps = substeps;
      made.quick = isOurs(force) || substeps == 16;
      cases.push_back(made);
    }
  }
}

}  // namespace

void addMaterialCases(Cases& cases) {
  addStabilityMap(cases);
  addForces(cases);
  addPoissonRatios(cases);
  addDampings(cases);
  addSubsteps(cases);
}

}  // namespace tetskin::stress
