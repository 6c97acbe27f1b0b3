// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/mesh_skin.h>

#include <optional>
#include <string>
#include <vector>

#include "scenes/world.h"
#include "stress/claim.h"

namespace tetskin::stress {

/// The cage that the skin is bound to. The body is made of its tets that are not flat.
enum class Cage {
  Bar,           ///< the bar's own
  FlatTets,      ///< with tets of no volume in it
  NeedleTets,    ///< squeezed to 1e-4 in two directions
  SliverTets,    ///< squeezed to 1e-8 in one
  AllFlat,       ///< squeezed to 1e-12 in one
  Inverted,      ///< every other tet inside out
  Duplicates,    ///< every tet twice
  Unreferenced,  ///< with nodes that no tet names
  Far1e5,        ///< the body 1e5 lengths from the origin, the skin's origin there
  Far1e7,        ///< 1e7 lengths
  Tiny,          ///< 1e-4 of the size
  Huge,          ///< 1e4 times the size
  OneTet,        ///< around all of the bar
  Split,         ///< of a beam with a slot, which is narrower than its tets: split, filled
  Large,         ///< 300,000 tets
};

/// The mesh that the skin carries.
enum class Surface {
  Bar,           ///< the bar
  FarOutside,    ///< with vertices up to 1,000 lengths outside the cage
  Coincident,    ///< every vertex three times
  NonFinite,     ///< one vertex is not a number: must be refused
  ThreeMillion,  ///< three million vertices
  NoVertices,    ///< must be refused
};

/// What the body is expected to do. Bullet's behaviour where it is not documented to be stable may differ between
/// versions and machines: there the expectation is all about the skin.
enum class Simulation { Bounded, Unbounded, Either };

/// One row of the table: what is simulated, what the skin is asked for, and what the body and `bind` shall do. What the
/// skin shall do follows: see `SkinJudge`.
struct StressCase {
  std::string group;
  std::string name;

  scenes::Force force =
      scenes::Force::NeoHookean;  ///< mass-spring in the classic world, the others in the deformable one
  bool implicit = false;
  /// Young's modulus, Pa, for a body of 1 kg and 2 m; mass-spring: link stiffness from 0 to 1. 0: the library's
  /// default.
  double stiffness = 0.0;
  double poisson = 0.3;
  double damping = 0.02;         ///< seconds
  double timeStep = 1.0 / 60.0;  ///< seconds a frame
  int substeps = 4;              ///< of a frame
  int frames = 30;

  std::string scene = "land";  ///< of the table of scenes: what happens to the body
  double harshness = 0.0;      ///< of the scene, in units of its own; 0: its own
  Cage cage = Cage::Bar;
  Surface surface = Surface::Bar;
  bool touchesBySurface = false;  ///< rigid bodies, instead of by the cage's nodes
  Interpolation interpolation = Interpolation::Linear;
  Normals normals = Normals::None;

  Simulation simulation = Simulation::Bounded;
  bool recovers = false;                ///< the body shall come back to its shape
  bool staysAbove = false;              ///< its surface shall be above the scene's floor at the end
  bool rests = false;                   ///< it shall be at rest at the end
  StatusCode refusal = StatusCode::Ok;  ///< of makeSoftBody and bind, or of bind alone
  bool quick = false;                   ///< also runs with --quick
  bool lasts = false;                   ///< a minute and more of simulated time, or one of thousands: only with --long
  std::optional<Claim> claim;           ///< what is run and judged instead of all the above

  double substep() const { return timeStep / substeps; }
};

/// Whether the force is the library's own.
bool isOurs(scenes::Force force);

/// Whether a case of Bullet's neo-Hookean force is the same as one of the library's in all that a body feels but its
/// force and integrator. The skins may differ, and so may default stiffnesses.
bool areTwins(const StressCase& ours, const StressCase& bullets);

/// Names for reports.
const char* toString(scenes::Force force);
const char* toString(Simulation simulation);
const char* toString(Cage cage);
const char* toString(Surface surface);
const char* toString(Interpolation interpolation);
const char* toString(Normals normals);

/// All cases, in groups: first the stability maps, whose cells are runs of their own.
std::vector<StressCase> stressCases();

}  // namespace tetskin::stress
