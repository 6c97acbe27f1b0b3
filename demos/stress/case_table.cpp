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

constexpr double kStiffnesses[] = {1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9};
constexpr double kStiffestOfBullets = 1e7;  ///< at most steps they explode with less
constexpr double kStiffestOfOurs = 1e7;     ///< that is promised
constexpr double kTimeSteps[] = {1.0 / 1000, 1.0 / 480, 1.0 / 240, 1.0 / 120, 1.0 / 60, 1.0 / 30, 1.0 / 20, 1.0 / 15};
constexpr double kDamping = 0.02;  ///< seconds
constexpr double kStiffForExplicit = 1e6;
constexpr int kFewestSteps = 60;  ///< of a cell of the map

/// "1e+06", "0.49".
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

/// A force, and how its world integrates it.
struct Method {
  Force force = Force::NeoHookean;
  bool implicit = false;
};

/// Bullet's forces with both of its integrators, and the library's, whose solver has one.
std::vector<Method> methodsOf(std::initializer_list<Force> bullets) {
  std::vector<Method> methods;
  for (const Force force : bullets) {
    methods.push_back({force, false});
    methods.push_back({force, true});
  }
  methods.push_back({Force::Elastic, false});
  return methods;
}

/// Group, and name from words.
StressCase named(const std::string& group, std::initializer_list<std::string> words) {
  StressCase made;
  made.group = group;
  made.name = group;
  for (const std::string& word : words) made.name += "/" + word;
  return made;
}

/// The same, of a method, which is in the name.
StressCase named(const std::string& group, const Method& method, std::initializer_list<std::string> words) {
  StressCase made = named(group, words);
  const std::string force = toString(method.force);
  made.name.insert(group.size(), "/" + (isOurs(method.force) ? force : force + "/" + integrator(method.implicit)));
  made.force = method.force;
  made.implicit = method.implicit;
  return made;
}

bool isOneOf(const std::string& scene, std::initializer_list<const char*> scenes) {
  return std::count(scenes.begin(), scenes.end(), scene) > 0;
}

/// What the library's force and solver are expected to hold; the rest are rows that say what is missing:
/// - beyond 1e7 Pa;
/// - 100 turns a second, 0.4 turns a substep: nodes fly that far straight on, to more than twice the size;
/// - a body flat, ten times as long, or inside out, beyond 1e6 Pa in steps longer than 1/240 s: it may grow to several
/// times its size, and
///   stay bent. That is the damping, which is as stiff as the body: without any, such bodies come back.
Simulation promised(const StressCase& ours) {
  constexpr double kStiffestInverted = 1e6;
  constexpr double kLongestStep = 1.0 / 240;
  if (ours.stiffness > kStiffestOfOurs || ours.scene == "spin") return Simulation::Either;
  const bool restored = isOneOf(ours.scene, {"squash_flat", "stretch", "mirror"});
  const bool coarse = ours.stiffness > kStiffestInverted && ours.substep() > kLongestStep;
  return restored && coarse ? Simulation::Either : Simulation::Bounded;
}

/// What is documented of bodies that land: explicit steps are stable up to a stiffness, which is also the default's
/// bound; nothing is promised of implicit ones, and of the other force models of Bullet's.
Simulation documented(const StressCase& landing) {
  if (isOurs(landing.force)) return promised(landing);
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
        cell.frames = std::max(kFewestSteps, static_cast<int>(std::lround(1.0 / step)));
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

/// Bullet's explicit steps of a stiff body need half a substep's worth of damping, which it treats implicitly: that is
/// enough in free motion, not always in a landing.
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

constexpr const char* kEvents[] = {"land",      "pluck",    "squash_flat",   "stretch",     "mirror",
                                   "permute",   "spin",     "teleport",      "impact",      "pull",
                                   "heavy_box", "node_nan", "node_infinite", "node_too_far"};

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

/// Not finite by the event itself, whatever the force.
bool isSpoilt(const std::string& scene) {
  return isOneOf(scene, {"node_nan", "node_infinite", "node_too_far"});
}

/// With the skin that has most to be judged.
StressCase eventOf(const std::string& group, const Method& method, const char* event,
                   std::initializer_list<std::string> words) {
  StressCase made = named(group, method, words);
  made.scene = event;
  made.interpolation = Interpolation::Quadratic;
  made.normals = Normals::Transformed;
  return made;
}

/// Bodies are expected back in shape where they are promised to stay bounded. One of the stiffest ones that has been
/// inside out keeps a bend for longer than is watched.
bool comesBack(const StressCase& ours) {
  if (ours.scene == "mirror" && ours.stiffness >= kStiffestOfOurs) return false;
  const bool returns = isOneOf(ours.scene, {"pluck", "squash_flat", "stretch", "mirror", "teleport"});
  return returns && ours.simulation == Simulation::Bounded;
}

/// Every event with the library's force, at the default stiffness.
void addOurEvents(Cases& cases) {
  for (const char* event : kEvents) {
    StressCase made = eventOf("event", {Force::Elastic, false}, event, {event});
    made.simulation = isSpoilt(event) ? Simulation::Either : promised(made);
    made.recovers = comesBack(made);
    made.quick = true;
    cases.push_back(made);
  }
}

/// The same of stiff bodies, the library's and Bullet's. Only explicit ones of Bullet's: its implicit steps forget
/// velocities that are set by hand, so that nothing would spin, fall fast or be pulled.
void addStiffEvents(Cases& cases) {
  for (const Method& method : {Method{Force::NeoHookean, false}, Method{Force::Elastic, false}}) {
    for (const char* event : kEvents) {
      if (isSpoilt(event)) continue;
      for (const int substeps : {1, 2, 4}) {
        for (const double stiffness : {1e5, 1e6, 1e7, 1e8, 1e9}) {
          if (!isOurs(method.force) && stiffness > kStiffestOfBullets) continue;
          const double step = StressCase().timeStep / substeps;
          StressCase made = eventOf("stiff", method, event, {event, "E=" + text(stiffness), "dt=" + stepText(step)});
          made.stiffness = stiffness;
          made.substeps = substeps;
          made.simulation = isOurs(method.force) ? promised(made) : Simulation::Either;
          made.recovers = isOurs(method.force) && comesBack(made);
          made.quick = isOurs(method.force);
          cases.push_back(made);
        }
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

/// Of 300,000 tets none: that is about the skin. One of slivers has a density, and so a default stiffness, that is out
/// of proportion.
void addOurCages(Cases& cases) {
  for (int cage = 0; cage < static_cast<int>(Cage::Large); ++cage) {
    StressCase made = named("cage", {Force::Elastic, false}, {toString(static_cast<Cage>(cage))});
    made.cage = static_cast<Cage>(cage);
    const bool thin = made.cage == Cage::NeedleTets || made.cage == Cage::SliverTets;
    made.simulation = thin || made.cage == Cage::Far1e7 ? Simulation::Either : Simulation::Bounded;
    if (made.cage == Cage::AllFlat) made.refusal = StatusCode::Degenerate;
    made.quick = true;
    cases.push_back(made);
  }
}

/// Every event with a body of copies of tets, some of them nearly empty, soft and stiff.
void addSplitEvents(Cases& cases) {
  for (const char* event : kEvents) {
    if (isSpoilt(event)) continue;
    for (const double stiffness : {0.0, 1e6, 1e8}) {
      StressCase made = eventOf("split", {Force::Elastic, false}, event, {event, "E=" + text(stiffness)});
      made.cage = Cage::Split;
      made.stiffness = stiffness;
      made.simulation = promised(made);
      made.recovers = comesBack(made);
      made.quick = true;
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

/// Obstacles that are hard to meet, by the surface and by the cage. Nothing is promised of Bullet's forces here.
void addContacts(Cases& cases) {
  for (const Method& method : methodsOf({Force::NeoHookean})) {
    for (const char* scene : {"land", "impact", "pole", "press", "light_box", "heavy_box"}) {
      for (const bool surface : {true, false}) {
        StressCase made = named("contact", method, {scene, surface ? "surface" : "cage"});
        made.scene = scene;
        made.frames = 60;
        made.touchesBySurface = surface;
        made.simulation = isOurs(method.force) ? Simulation::Bounded : Simulation::Either;
        made.quick = isOurs(method.force);
        cases.push_back(made);
      }
    }
  }
}

/// Bodies that meet each other, with each solver.
void addSoftContacts(Cases& cases) {
  const Method methods[] = {{Force::Elastic, false}, {Force::ElasticForceOnly, false}, {Force::ElasticForceOnly, true}};
  for (const Method& method : methods) {
    for (const char* scene : {"soft_stack", "soft_removed", "soft_squeezed"}) {
      StressCase made = named("soft_contact", method, {scene});
      if (method.force == Force::ElasticForceOnly) made.name += method.implicit ? "/implicit" : "/explicit";
      made.scene = scene;
      made.frames = 120;
      made.quick = !method.implicit;
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
  addOurEvents(cases);
  addStiffEvents(cases);
  addCages(cases);
  addOurCages(cases);
  addSplitEvents(cases);
  addSurfaces(cases);
  addContacts(cases);
  addSoftContacts(cases);
  return cases;
}

}  // namespace tetskin::stress
