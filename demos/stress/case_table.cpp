// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The table of cases: one function a group.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "stress/models.h"

namespace tetskin::stress {
namespace {

using Cases = std::vector<StressCase>;
using scenes::Force;

constexpr double kStiffnesses[] = {1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7};
constexpr double kTimeSteps[] = {1.0 / 1000, 1.0 / 480, 1.0 / 240, 1.0 / 120, 1.0 / 60, 1.0 / 30, 1.0 / 20, 1.0 / 15};
constexpr double kDamping = 0.02;  ///< seconds
constexpr double kStiffForExplicit = 1e6;
constexpr int kFewestSteps = 60;  ///< of a cell of the map

/// "1e+05" as "1e5", "0.49" as it is.
std::string text(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%g", value);
  return buffer;
}

std::string stepText(double seconds) {
  return "1/" + text(std::round(1.0 / seconds));
}

const char* integrator(bool implicit) {
  return implicit ? "implicit" : "explicit";
}

/// Group, and name from words.
StressCase named(const std::string& group, std::initializer_list<std::string> words) {
  StressCase made;
  made.group = group;
  made.name = group;
  for (const std::string& word : words) made.name += "/" + word;
  return made;
}

/// What is documented of bodies that land: explicit steps are stable up to a stiffness, which is also the default's
/// bound; nothing is promised of implicit ones, and of the other force models.
Simulation documented(const StressCase& landing) {
  const bool offered = landing.force == Force::LinearElasticity || landing.force == Force::NeoHookean;
  if (landing.implicit || !offered) return Simulation::Either;
  SoftBodyOptions stiffest;  // its default stiffness is what `timeStep` bounds it by
  stiffest.relativeStiffness = 1e30;
  stiffest.timeStep = landing.substep();
  const TetMesh cage = makeModel(Cage::Bar, Surface::Bar).cage;
  const bool stable = landing.stiffness <= scenes::defaultStiffness(cage, stiffest);
  return stable ? Simulation::Bounded : Simulation::Either;
}

/// A body lands with every stiffness at every step, and is watched for a second.
void addStabilityMap(Cases& cases) {
  for (const bool implicit : {false, true}) {
    for (const double step : kTimeSteps) {
      for (const double stiffness : kStiffnesses) {
        StressCase cell = named("map", {integrator(implicit), "E=" + text(stiffness), "dt=" + stepText(step)});
        cell.implicit = implicit;
        cell.stiffness = stiffness;
        cell.timeStep = step;
        cell.substeps = 1;
        cell.damping = std::max(kDamping, 0.5 * step);
        cell.frames = std::max(kFewestSteps, static_cast<int>(std::lround(1.0 / step)));
        cell.simulation = documented(cell);
        cell.quick = step == 1.0 / 60 || step == 1.0 / 15;
        cases.push_back(cell);
      }
    }
  }
}

void addForces(Cases& cases) {
  for (const Force force : {Force::LinearElasticity, Force::Corotated}) {
    for (const bool implicit : {false, true}) {
      for (const double stiffness : kStiffnesses) {
        StressCase made = named("force", {toString(force), integrator(implicit), "E=" + text(stiffness)});
        made.force = force;
        made.implicit = implicit;
        made.stiffness = stiffness;
        made.simulation = documented(made);
        made.quick = stiffness == 1e3;
        cases.push_back(made);
      }
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
  for (const Force force : {Force::LinearElasticity, Force::NeoHookean}) {
    for (const bool implicit : {false, true}) {
      for (const double poisson : {0.0, 0.1, 0.2, 0.3, 0.4, 0.45, 0.49, 0.499}) {
        StressCase made = named("poisson", {toString(force), integrator(implicit), "nu=" + text(poisson)});
        made.force = force;
        made.implicit = implicit;
        made.poisson = poisson;
        made.simulation = documented(made);
        made.quick = poisson == 0.499;
        cases.push_back(made);
      }
    }
  }
}

/// Of a body so stiff that explicit steps need half a substep's worth of damping, which Bullet treats implicitly: that
/// is enough in free motion, not always in a landing.
void addDampings(Cases& cases) {
  const double step = StressCase().substep();
  const std::pair<const char*, double> dampings[] = {
      {"0", 0.0}, {"dt/8", step / 8}, {"dt/4", step / 4}, {"dt/2", step / 2}, {"dt", step}, {"0.1", 0.1}, {"1", 1.0}};
  for (const Force force : {Force::LinearElasticity, Force::NeoHookean}) {
    for (const auto& [name, damping] : dampings) {
      for (const bool implicit : {false, true}) {
        for (const std::string scene : {"pluck", "land"}) {
          StressCase made = named("damping", {toString(force), integrator(implicit), scene, std::string("c=") + name});
          made.force = force;
          made.implicit = implicit;
          made.damping = damping;
          made.stiffness = kStiffForExplicit;
          made.scene = scene;
          made.frames = 60;
          made.simulation = Simulation::Either;
          if (!implicit && scene == "pluck") {
            if (damping < 0.5 * step) made.simulation = Simulation::Unbounded;
            if (damping >= 0.5 * step && damping <= step) made.simulation = Simulation::Bounded;
          }
          made.quick = !implicit && scene == "pluck";
          cases.push_back(made);
        }
      }
    }
  }
}

void addSubsteps(Cases& cases) {
  for (const Force force : {Force::MassSpring, Force::LinearElasticity, Force::NeoHookean}) {
    for (const int substeps : {1, 2, 4, 8, 16}) {
      StressCase made = named("substeps", {toString(force), std::to_string(substeps)});
      made.force = force;
      made.substeps = substeps;
      made.quick = substeps == 16;
      cases.push_back(made);
    }
  }
}

constexpr const char* kEvents[] = {"land",      "pluck",    "squash_flat",   "stretch",     "mirror",
                                   "permute",   "spin",     "teleport",      "impact",      "pull",
                                   "heavy_box", "node_nan", "node_infinite", "node_too_far"};

bool isOneOf(const std::string& scene, std::initializer_list<const char*> scenes) {
  return std::count(scenes.begin(), scenes.end(), scene) > 0;
}
/// What Bullet's bodies have been seen to survive, with the library's defaults, and with room to spare.
bool survives(const std::string& scene) {
  return isOneOf(scene, {"land", "pluck", "squash_flat", "teleport", "pull", "heavy_box"});
}
bool recovers(const std::string& scene) {
  return isOneOf(scene, {"pluck", "squash_flat", "teleport"});
}

/// Every event, with each interpolation and each kind of normals.
void addEvents(Cases& cases) {
  for (const char* event : kEvents) {
    for (const Interpolation interpolation : {Interpolation::Linear, Interpolation::Quadratic}) {
      for (const Normals normals : {Normals::None, Normals::Transformed, Normals::Recomputed}) {
        StressCase made = named("event", {event, toString(interpolation), toString(normals)});
        made.scene = event;
        made.interpolation = interpolation;
        made.normals = normals;
        made.simulation = survives(event) ? Simulation::Bounded : Simulation::Either;
        made.recovers = recovers(event);
        made.quick = (interpolation == Interpolation::Quadratic) == (normals == Normals::Transformed);
        cases.push_back(made);
      }
    }
  }
}

void addCages(Cases& cases) {
  for (int cage = 0; cage <= static_cast<int>(Cage::Large); ++cage) {
    for (const Interpolation interpolation : {Interpolation::Linear, Interpolation::Quadratic}) {
      StressCase made = named("cage", {toString(static_cast<Cage>(cage)), toString(interpolation)});
      made.cage = static_cast<Cage>(cage);
      made.interpolation = interpolation;
      made.normals = interpolation == Interpolation::Linear ? Normals::Recomputed : Normals::Transformed;
      const bool thin = made.cage == Cage::NeedleTets || made.cage == Cage::SliverTets;
      made.simulation = thin || made.cage == Cage::Far1e7 ? Simulation::Either : Simulation::Bounded;
      if (made.cage == Cage::AllFlat) made.refusal = StatusCode::Degenerate;
      if (made.cage == Cage::Large) {
        made.frames = 1;
        made.scene = "mirror";
      }
      made.quick = made.cage != Cage::Large;
      cases.push_back(made);
    }
  }
}

void addSurfaces(Cases& cases) {
  for (int surface = 0; surface <= static_cast<int>(Surface::NoVertices); ++surface) {
    for (const Interpolation interpolation : {Interpolation::Linear, Interpolation::Quadratic}) {
      StressCase made = named("mesh", {toString(static_cast<Surface>(surface)), toString(interpolation)});
      made.surface = static_cast<Surface>(surface);
      made.interpolation = interpolation;
      made.normals = interpolation == Interpolation::Linear ? Normals::Recomputed : Normals::Transformed;
      if (made.surface == Surface::NonFinite) made.refusal = StatusCode::NonFinite;
      if (made.surface == Surface::NoVertices) made.refusal = StatusCode::Empty;
      if (made.surface == Surface::ThreeMillion) {
        made.frames = 2;
        made.scene = "mirror";
      }
      made.quick = made.surface != Surface::ThreeMillion;
      cases.push_back(made);
    }
  }
}

}  // namespace

std::vector<StressCase> stressCases() {
  Cases cases;
  addStabilityMap(cases);
  addForces(cases);
  addPoissonRatios(cases);
  addDampings(cases);
  addSubsteps(cases);
  addEvents(cases);
  addCages(cases);
  addSurfaces(cases);
  return cases;
}

}  // namespace tetskin::stress
