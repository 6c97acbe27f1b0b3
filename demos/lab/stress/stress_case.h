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

/// The cage that the skin is bound to. The body is made of those of its tets that are not flat.
enum class Cage {
  Bar,           ///< the bar's own cage
  FlatTets,      ///< with tets of no volume in it
  NeedleTets,    ///< tets squeezed to 1e-4 in two directions
  SliverTets,    ///< tets squeezed to 1e-8 in one direction
  AllFlat,       ///< tets squeezed to 1e-12 in one direction
  Inverted,      ///< every other tet is inverted
  Duplicates,    ///< every tet occurs twice
  Unreferenced,  ///< with nodes that no tet names
  Far1e5,        ///< the body 1e5 lengths from the origin, with the skin's origin there
  Far1e7,        ///< the body 1e7 lengths from the origin
  Tiny,          ///< 1e-4 times the size
  Huge,          ///< 1e4 times the size
  OneTet,        ///< one tet around the whole bar
  Split,         ///< of a beam with a slot narrower than its tets: duplicate elements, volume fractions
  Large,         ///< 300,000 tets
};

/// The mesh that the skin carries.
enum class Surface {
  Bar,           ///< the bar
  FarOutside,    ///< with vertices up to 1,000 lengths outside the cage
  Coincident,    ///< every vertex occurs three times
  NonFinite,     ///< one vertex is NaN: must be refused
  ThreeMillion,  ///< three million vertices
  NoVertices,    ///< no vertices: must be refused
};

/// The expected behaviour of the body. Bullet's behaviour may differ between versions and machines where it is not
/// documented to be stable: there, only the skin is judged.
enum class Simulation { Bounded, Unbounded, Either };

/// One row of the table: what is simulated, the options of the skin, and the expected result of the body and of `bind`.
/// The expectations on the skin follow from these: see `SkinJudge`.
struct StressCase {
  std::string group;
  std::string name;

  scenes::Force force =
      scenes::Force::NeoHookean;  ///< mass-spring in the classic world, all others in the deformable one
  bool implicit = false;
  /// Young's modulus, Pa, for a body of 1 kg and 2 m; for mass-spring, the links' stiffness from 0 to 1. 0: the
  /// library's default.
  double stiffness = 0.0;
  double poisson = 0.3;
  double damping = 0.02;         ///< seconds
  double timeStep = 1.0 / 60.0;  ///< seconds per frame
  int substeps = 4;              ///< per frame
  int frames = 30;

  std::string scene = "land";  ///< name in the table of scenes: what happens to the body
  double harshness = 0.0;      ///< of the scene, in units of its own; 0: the scene's own
  Cage cage = Cage::Bar;
  Surface surface = Surface::Bar;
  bool touchesBySurface = false;  ///< rigid bodies touch its surface, instead of the cage's nodes
  Interpolation interpolation = Interpolation::Linear;
  Normals normals = Normals::None;

  Simulation simulation = Simulation::Bounded;
  bool recovers = false;                ///< the body is expected to recover its shape
  bool staysAbove = false;              ///< its surface is expected to be above the scene's floor at the end
  bool rests = false;                   ///< it is expected to be at rest at the end
  StatusCode refusal = StatusCode::Ok;  ///< expected status of createSoftBody and bind, or of bind alone
  bool quick = false;                   ///< also runs with --quick
  bool lasts = false;     ///< a minute or more of simulated time, or one of thousands of claims: only with --long
  bool changing = false;  ///< its bodies have grown, and yield: see `growAndYield`
  ElasticLaw law;
  std::optional<Claim> claim;  ///< is run and judged instead of everything above

  double substep() const { return timeStep / substeps; }
};

/// True if the force is the library's own.
bool isOurs(scenes::Force force);

/// Names used in reports.
const char* toString(scenes::Force force);
const char* toString(Cage cage);
const char* toString(Surface surface);
const char* toString(Interpolation interpolation);
const char* toString(Normals normals);

/// All cases, in groups: first the stability maps, whose cells are separate runs.
std::vector<StressCase> stressCases();

}  // namespace tetskin::stress
