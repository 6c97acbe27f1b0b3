// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "stress/case_groups.h"

namespace tetskin::stress {
namespace {

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

/// Nothing is promised of 300,000 tets: that case tests the skin. A cage of slivers has a density, and therefore a
/// default stiffness, that is out of proportion.
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

void addModelCases(Cases& cases) {
  addCages(cases);
  addOurCages(cases);
  addSurfaces(cases);
}

}  // namespace tetskin::stress
