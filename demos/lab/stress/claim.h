// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The README's claims about bodies in tetskin's solver, tested at the limits: stable from 1 to 1e9 Pa, light or heavy,
// spinning, in steps of any length. No energy beyond what is put in, momentum conserved in free flight, no growth.
#pragma once

#include <tetskin/elastic/elastic_law.h>

#include <string>
#include <vector>

#include "measure/run.h"

namespace tetskin::stress {

/// The event.
enum class ClaimEvent {
  Free,     ///< no contact: it drifts and spins without gravity
  Landing,  ///< it falls onto a floor, which touches its surface
  Dragged,  ///< a default spring at a point of its surface jumps by the body's size
};

/// One combination, all in SI units. The body is some 1 m long and has about 200 tets.
struct Claim {
  enum class Shape { Sphere, Bar, Serpent } shape = Shape::Sphere;
  double youngsModulus = 1e5;
  double density = 0.0;  ///< 0: the body has a mass of 1 kg
  double damping = 0.02;
  double spin = 0.0;  ///< radians per second, about an oblique axis
  double seconds = 1.0 / 240;
  double tolerance = 5e-3;
  ClaimEvent event = ClaimEvent::Free;
  bool compared = true;  ///< free bodies: with a reference in double precision, at a sixteenth of the step
  /// The body has grown, begins at rest in its new size, and yields. What it stores is not known then: energies are
  /// kinetic ones.
  bool changing = false;
  ElasticLaw law;
};

/// A name such as "free/sphere/E=1e+09/1kg/c=0.02/spin=10/dt=1_60/tol=0.005"
std::string nameOf(const Claim& claim);
/// All combinations of all values.
std::vector<Claim> allClaims();
/// This many of the combinations, chosen so that each pair of values occurs.
std::vector<Claim> chosenClaims(std::size_t count);

/// Runs the combination for one second. Energies are relative to the initial one and the work put in, those of landings
/// without elastic energy; momentum is that of free bodies.
void runClaim(const Claim& claim, measure::Run& run);

}  // namespace tetskin::stress
