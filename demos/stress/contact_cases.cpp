// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "stress/case_groups.h"

namespace tetskin::stress {
namespace {

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

void addContactCases(Cases& cases) {
  addContacts(cases);
  addSoftContacts(cases);
}

}  // namespace tetskin::stress
