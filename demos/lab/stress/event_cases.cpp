// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "stress/case_groups.h"

namespace tetskin::stress {
namespace {

constexpr const char* kEvents[] = {"land",      "pluck",    "squash_flat",   "stretch",     "mirror",
                                   "permute",   "spin",     "teleport",      "impact",      "pull",
                                   "heavy_box", "node_nan", "node_infinite", "node_too_far"};

/// True for events that Bullet's bodies have been observed to survive, with the library's defaults and a safety margin.
bool survives(const std::string& scene) {
  return isOneOf(scene, {"land", "pluck", "squash_flat", "teleport", "pull", "heavy_box"});
}
bool recovers(const std::string& scene) {
  return isOneOf(scene, {"pluck", "squash_flat", "teleport"});
}

/// Adds every event, with each interpolation and each kind of normals.
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

/// The event itself makes positions invalid, whatever the force.
bool isDamaged(const std::string& scene) {
  return isOneOf(scene, {"node_nan", "node_infinite", "node_too_far"});
}

/// An event with the skin that offers most to judge.
StressCase eventOf(const std::string& group, const Method& method, const char* event,
                   std::initializer_list<std::string> words) {
  StressCase made = named(group, method, words);
  made.scene = event;
  made.interpolation = Interpolation::Quadratic;
  made.normals = Normals::Transformed;
  return made;
}

/// Bodies are expected to recover their shape where they are promised to stay bounded. One of the stiffest bodies,
/// after it was inverted, keeps a bend for longer than the run.
bool comesBack(const StressCase& ours) {
  if (ours.scene == "mirror" && ours.stiffness >= kStiffestOfOurs) return false;
  const bool returns = isOneOf(ours.scene, {"pluck", "squash_flat", "stretch", "mirror", "teleport"});
  return returns && ours.simulation == Simulation::Bounded;
}

/// Adds every event with the library's force, at the default stiffness.
void addOurEvents(Cases& cases) {
  for (const char* event : kEvents) {
    StressCase made = eventOf("event", {Force::Elastic, false}, event, {event});
    made.simulation = isDamaged(event) ? Simulation::Either : promised(made);
    made.recovers = comesBack(made);
    made.quick = true;
    cases.push_back(made);
  }
}

/// Adds every event for stiff bodies, with the library's and with Bullet's forces. With Bullet's, only explicit steps
/// are used: its implicit steps lose velocities that are set by hand, so that nothing would spin, fall fast or be
/// pulled.
void addStiffEvents(Cases& cases) {
  for (const Method& method : {Method{Force::NeoHookean, false}, Method{Force::Elastic, false}}) {
    for (const char* event : kEvents) {
      if (isDamaged(event)) continue;
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

/// Adds every event with a body that has duplicate tets, some of them nearly empty, soft and stiff.
void addSplitEvents(Cases& cases) {
  for (const char* event : kEvents) {
    if (isDamaged(event)) continue;
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

}  // namespace

void addEventCases(Cases& cases) {
  addEvents(cases);
  addOurEvents(cases);
  addStiffEvents(cases);
  addSplitEvents(cases);
}

}  // namespace tetskin::stress
