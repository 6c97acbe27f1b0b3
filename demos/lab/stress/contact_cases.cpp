// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "stress/case_groups.h"

namespace tetskin::stress {
namespace {

struct Touch {
  const char* scene;
  double harshness;  ///< 0: the scene's own
  const char* word;  ///< suffix of the case's name
};

/// Harshness: speeds in body lengths per second, masses relative to the body's, shares of the body's height, turns per
/// second.
constexpr Touch kTouches[] = {{"land", 0, ""},
                              {"impact", 5, "/speed=5"},
                              {"impact", 15, "/speed=15"},
                              {"impact", 50, "/speed=50"},
                              {"impact", 0, ""},
                              {"pole", 0, ""},
                              {"pole", 15, "/speed=15"},
                              {"pole", 100, "/speed=100"},
                              {"blade", 0, ""},
                              {"blade", 15, "/speed=15"},
                              {"blade", 100, "/speed=100"},
                              {"light_box", 0, ""},
                              {"heavy_box", 1, "/mass=1"},
                              {"heavy_box", 10, "/mass=10"},
                              {"heavy_box", 100, "/mass=100"},
                              {"heavy_box", 0, ""},
                              {"press", 0, ""},
                              {"flatten", 0.5, "/left=0.5"},
                              {"flatten", 0.25, "/left=0.25"},
                              {"flatten", 0, ""},
                              {"flatten", 0.02, "/left=0.02"},
                              {"mill", 0, ""},
                              {"mill", 5, "/turns=5"},
                              {"bed", 0, ""},
                              {"bed", 15, "/speed=15"},
                              {"hail", 0, ""},
                              {"obstacles_go", 0, ""},
                              {"body_goes", 1, "/in_step"},
                              {"body_goes", 2, "/between_steps"}};

/// A box with a thousand times the body's mass flattens the body so much that it is pressed into the floor.
bool isPressedIntoTheFloor(const StressCase& made) {
  return made.scene == "heavy_box" && made.harshness == 0;
}

/// Bullet 3.24 itself may end with a segmentation fault: when the body has exploded, its distance field of the box is
/// queried at positions outside all of its cells.
bool endsBullet(const StressCase& made) {
  return made.force == Force::NeoHookean && made.implicit && made.scene == "heavy_box" && made.harshness > 0;
}

/// Obstacles that are hard to handle in contact, by the surface and by the cage. Nothing is promised of Bullet's
/// forces, where contact is by the cage only.
void addContacts(Cases& cases) {
  for (const Method& method : methodsOf({Force::NeoHookean})) {
    for (const Touch& touch : kTouches) {
      for (const bool surface : {true, false}) {
        if (surface && !isOurs(method.force)) continue;
        const std::string scene = touch.scene;
        StressCase made = named("contact", method, {scene + touch.word, surface ? "surface" : "cage"});
        made.scene = scene;
        made.harshness = touch.harshness;
        made.frames = 60;
        made.touchesBySurface = surface;
        made.simulation = isOurs(method.force) ? Simulation::Bounded : Simulation::Either;
        made.staysAbove = surface && !isPressedIntoTheFloor(made);
        made.quick = isOurs(method.force);
        if (!endsBullet(made)) cases.push_back(made);
      }
    }
  }
}

/// Bodies that collide with each other.
void addSoftContacts(Cases& cases) {
  for (const char* scene : {"soft_stack", "soft_removed", "soft_squeezed", "soft_pile"}) {
    StressCase made = named("soft_contact", {Force::Elastic, false}, {scene});
    made.scene = scene;
    made.frames = 120;
    made.quick = scene != std::string("soft_pile");
    cases.push_back(made);
  }
}

/// A minute for each case; moving obstacles stop after 50 seconds.
void addLongContacts(Cases& cases) {
  constexpr int kFrames = 3600;
  for (const char* scene : {"soft_pile", "squeeze", "mill"}) {
    StressCase made = named("long", {Force::Elastic, false}, {scene});
    made.scene = scene;
    made.frames = kFrames;
    made.touchesBySurface = true;
    made.staysAbove = true;
    made.rests = true;
    made.lasts = true;
    cases.push_back(made);
  }
}

}  // namespace

void addContactCases(Cases& cases) {
  addContacts(cases);
  addSoftContacts(cases);
  addLongContacts(cases);
}

}  // namespace tetskin::stress
