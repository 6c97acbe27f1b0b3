// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "stress/case_groups.h"

namespace tetskin::stress {
namespace {

StressCase reduced(std::initializer_list<std::string> words) {
  StressCase made = named("reduced", words);
  made.force = Force::Reduced;
  made.frames = 60;
  return made;
}

}  // namespace

/// Reduced bodies, in Bullet's reduced solver. Modes that are too fast for the step are left out; if only a few remain,
/// there is no promise about a body that hits something.
void addReducedCases(Cases& cases) {
  for (const double stiffness : {1e2, 1e3, 1e4, 1e5}) {
    for (const int substeps : {1, 4, 16}) {
      if (stiffness > 1e4 && substeps == 1) continue;  // no mode is slow enough
      StressCase made = reduced({"land", text(stiffness), std::to_string(substeps)});
      made.scene = "land";
      made.stiffness = stiffness;
      made.substeps = substeps;
      made.simulation = Simulation::Either;
      made.quick = substeps == 4;
      cases.push_back(made);
    }
  }
  for (const double damping : {0.0, 0.02, 1.0}) {
    StressCase made = reduced({"sag", "damping", text(damping)});
    made.scene = "sag";
    made.damping = damping;
    made.quick = true;
    cases.push_back(made);
  }
  for (const char* scene : {"drop", "pole", "press", "light_box", "heavy_box"}) {
    StressCase made = reduced({scene});
    made.scene = scene;
    made.simulation = Simulation::Either;
    made.quick = true;
    cases.push_back(made);
  }
  for (const Cage cage : {Cage::Inverted, Cage::Far1e5, Cage::Tiny, Cage::Huge}) {
    StressCase made = reduced({"cage", toString(cage)});
    made.scene = "sag";
    made.cage = cage;
    made.simulation = Simulation::Either;
    made.quick = cage != Cage::Far1e5;
    cases.push_back(made);
  }
}

}  // namespace tetskin::stress
