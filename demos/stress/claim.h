// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// What the first page claims of bodies in tetskin's solver, at its ends: stable from 1 to 1e9 Pa, light or heavy,
// spinning, in steps of any length. No energy but what is put in, momentum kept in free flight, no swelling.
#pragma once

#include <string>
#include <vector>

namespace tetskin::stress {

struct Verdict;

/// What happens to the body.
enum class ClaimEvent {
  Free,     ///< nothing: it drifts and spins without gravity
  Landing,  ///< it falls onto a floor, which it meets by its surface
  Dragged,  ///< a default spring at a point of its surface jumps by one size
};

/// One combination; all in SI units. The body is some 1 m long in about 200 tets.
struct Claim {
  enum class Shape { Sphere, Bar, Serpent } shape = Shape::Sphere;
  double youngsModulus = 1e5;
  double density = 0.0;  ///< 0: 1 kg in all
  double damping = 0.02;
  double spin = 0.0;  ///< radians a second, about an oblique axis
  double seconds = 1.0 / 240;
  double tolerance = 5e-3;
  ClaimEvent event = ClaimEvent::Free;
  bool compared = true;  ///< of free bodies: with a reference in double, at a sixteenth of the step
};

/// "free/sphere/E=1e+09/1kg/c=0.02/spin=10/dt=1_60/tol=0.005"
std::string nameOf(const Claim& claim);
/// The product of all values.
std::vector<Claim> allClaims();
/// Of these so few that each pair of values occurs, and so many.
std::vector<Claim> chosenClaims(std::size_t count);

/// Runs it, for a second.
void runClaim(const Claim& claim, Verdict& verdict);

}  // namespace tetskin::stress
