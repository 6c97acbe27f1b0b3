// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Which mesh in which cage a program works on: built in, loaded, or built for the mesh.
#pragma once

#include <tetskin/cage/cage_builder.h>
#include <tetskin/core/mesh_skin.h>
#include <tetskin/core/tet_mesh.h>
#include <tetskin/core/triangle_mesh.h>
#include <tetskin/elastic/calibration.h>
#include <tetskin/io/obj_sequence.h>

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace tetskin::scenes {

enum class BuiltIn { Serpent, Bar, SlottedBeam, Hand };
/// In the order of the list above.
const std::vector<BuiltIn>& builtInModels();
/// "serpent", "bar", "slotted_beam", "hand".
std::string nameOf(BuiltIn model);

/// Tets that fill a built-in model, about so many, made by formula and not as cages are: parts of the model near to
/// each other are never fused. Nothing for a model that has none, or none of so few tets.
std::optional<TetMesh> conformingTets(BuiltIn model, std::size_t tets);

/// Which mesh, and which cage.
struct ModelOptions {
  BuiltIn builtIn = BuiltIn::Serpent;
  std::string mesh;               ///< file; empty: the built-in model
  std::string cage;               ///< file; empty: built from the mesh
  std::size_t tets = 3000;        ///< of a built cage
  std::size_t triangles = 60000;  ///< of the built-in model
  bool whole = false;             ///< the cage is not split
  bool calibrate = false;         ///< see tetskin::calibrate
  std::size_t fineTets = 30000;   ///< of which a reduced body has its vibrations
  bool quiet = true;              ///< does not tell that a cage is built, which may take seconds
  /// Told what was loaded, before a cage is built for it.
  std::function<void(const TriangleMesh& mesh, const ObjLayout& layout)> loaded = {};
};

struct Surface {
  std::string name;
  TriangleMesh mesh;
};
struct Model : Surface {
  Cage cage;
  ObjLayout layout;  ///< in which frames are written
};

/// These load or make; they throw InputError, with the file and the fault.
Surface loadSurface(const ModelOptions& options);
/// A usable cage, its tets as the file has them; not one of another mesh, if the file tells.
Cage loadCage(const std::string& path);
Cage loadCage(const std::string& path, const Surface& surface);
Cage cageFor(const Surface& surface, const CageOptions& options, CageReport* report = nullptr);
CageOptions cageOptionsOf(const ModelOptions& options);
/// Says that a cage of so many tets is about to be built, unless that is to be quiet.
void announceCage(std::size_t tets, const ModelOptions& options);
/// Calibrates a cage from the place that it is named by.
CalibrationReport calibrated(Cage& cage, const std::string& name);
/// The cage's tets are positive.
Model loadModel(const ModelOptions& options);

/// Throws InputError unless the status is ok, or if mesh and cage cannot belong together: they are in different units
/// (see EmbedReport), or most of the mesh lies outside, and far.
void requireFit(const Status& status, const EmbedReport& report, const ModelOptions& options);

/// The layout in which a skin with these normals is written.
ObjLayout layoutWith(Normals normals, const ObjLayout& layout);

}  // namespace tetskin::scenes
