// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The mesh and the cage that a program works on: built in, loaded, or built for the mesh.
#pragma once

#include <tetskin/cage/create_cage.h>
#include <tetskin/core/mesh.h>
#include <tetskin/core/mesh_skin.h>
#include <tetskin/elastic/calibration.h>
#include <tetskin/io/obj_sequence.h>

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace tetskin::scenes {

enum class BuiltIn { Serpent, Bar, SlottedBeam, Hand };
/// All built-in models, in the order of the enumeration.
const std::vector<BuiltIn>& builtInModels();
/// "serpent", "bar", "slotted_beam", "hand".
std::string nameOf(BuiltIn model);

/// About this many tets that fill a built-in model, made by formula and not by the cage builder: parts of the model
/// that are near each other are never fused. Nothing if the model has none, or none with so few tets.
std::optional<TetMesh> conformingTets(BuiltIn model, std::size_t tets);
/// The fewest of these that a built-in model has; 0 if it has none.
std::size_t fewestConformingTets(BuiltIn model);

/// Options that choose the mesh and the cage.
struct ModelOptions {
  BuiltIn builtIn = BuiltIn::Serpent;
  std::string mesh;               ///< file; empty: the built-in model
  std::string cage;               ///< file; empty: built from the mesh
  std::size_t tets = 3000;        ///< requested for a built cage
  std::size_t triangles = 60000;  ///< of the built-in model
  bool whole = false;             ///< the cage has no duplicate elements
  bool calibrate = false;         ///< see tetskin::calibrate
  std::size_t fineTets = 30000;   ///< tets from which the modes of a reduced body are computed
  bool quiet = true;              ///< does not print that a cage is built, which may take seconds
  /// Called with the loaded mesh, before a cage is built for it.
  std::function<void(const TriangleMesh& mesh, const ObjLayout& layout)> loaded = {};
};

struct Surface {
  std::string name;
  TriangleMesh mesh;
};
struct Model : Surface {
  Cage cage;
  ObjLayout layout;  ///< the layout in which frames are written
};

/// Functions that load or make something throw InputError with the file and its fault.
Surface loadSurface(const ModelOptions& options);
/// A valid cage, its tets in the order of the file; refused if the file says that it belongs to another mesh.
Cage loadCage(const std::string& path);
Cage loadCage(const std::string& path, const Surface& surface);
Cage cageFor(const Surface& surface, const CageOptions& options, CageReport* report = nullptr);
CageOptions cageOptionsOf(const ModelOptions& options);
/// Moves vertices that no triangle uses to the mesh's first corner, whose tet then carries them; prints how many,
/// unless quiet. They are nowhere drawn, but would count where a program places the body or measures it.
/// cage  its map, if it has one, is of this mesh
void gatherLooseVertices(Surface& surface, Cage& cage, bool quiet);
/// Prints that a cage of this many tets is about to be built, unless the options are quiet.
void announceCage(std::size_t tets, const ModelOptions& options);
/// Calibrates a cage; errors name it by `name`.
CalibrationReport calibrated(Cage& cage, const std::string& name);
/// Loads or makes a mesh and its cage, whose tets are positive.
Model loadModel(const ModelOptions& options);

/// Throws InputError unless the status is Ok, or if mesh and cage cannot belong together: they are in different units
/// (see EmbedReport), or most of the mesh lies far outside of the cage.
void requireFit(const Status& status, const EmbedReport& report, const ModelOptions& options);

/// The layout for a skin with these normals.
ObjLayout layoutWith(Normals normals, const ObjLayout& layout);

}  // namespace tetskin::scenes
