// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The command-line options that the demos share, spelled alike everywhere, and what they lead to.
#pragma once

#include <tetskin/cage/cage_builder.h>
#include <tetskin/core/mesh_skin.h>
#include <tetskin/core/tet_mesh.h>
#include <tetskin/core/triangle_mesh.h>
#include <tetskin/io/obj_layout.h>

#include <CLI/CLI.hpp>
#include <cstddef>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "scenes/input_error.h"

namespace tetskin::scenes {

/// Exit statuses of every demo.
constexpr int kDone = 0, kRunFailed = 1, kBadInput = 2;

enum class BuiltIn { Serpent, Bar };

/// Which mesh, and which cage.
struct ModelOptions {
  BuiltIn builtIn = BuiltIn::Serpent;
  std::string mesh;               ///< file; empty: the built-in model
  std::string cage;               ///< file; empty: built from the mesh
  std::size_t tets = 3000;        ///< of a built cage
  std::size_t triangles = 60000;  ///< of the built-in model
};

/// Where the results go.
struct OutputOptions {
  std::string out;   ///< folder of the OBJ sequence
  std::string json;  ///< file of the summary; empty: summary.json in the folder
  int frames = 0;
  int every = 1;  ///< write every so many frames
  bool quiet = false;
};

/// --mesh, --triangles, --tets.
void addMeshOptions(CLI::App& app, ModelOptions& options);
/// Those and --cage.
void addModelOptions(CLI::App& app, ModelOptions& options);
/// --interpolation.
void addInterpolationOption(CLI::App& app, SkinOptions& options);
/// --normals, --outside, --max-distance.
void addSkinOptions(CLI::App& app, SkinOptions& options);
/// The defaults of `options` are the demo's.
void addOutputOptions(CLI::App& app, OutputOptions& options);

struct Surface {
  std::string name;
  TriangleMesh mesh;
};
struct Model : Surface {
  TetMesh cage;
  ObjLayout layout;  ///< in which frames are written
};

/// These load, make or write; they throw InputError, with the file and the fault.
Surface loadSurface(const ModelOptions& options);
/// A usable cage, its tets as the file has them.
TetMesh loadCage(const std::string& path);
TetMesh cageFor(const Surface& surface, const CageOptions& options, CageReport* report = nullptr);
/// The cage's tets are positive.
Model loadModel(const ModelOptions& options);
/// The head of a summary: what the model is, and how the mesh fits the cage.
nlohmann::ordered_json summaryOf(const Model& model);
nlohmann::ordered_json summaryOf(const Model& model, const EmbedReport& fit);
void writeJson(const nlohmann::ordered_json& json, const std::string& path);

/// Throws InputError if mesh and cage cannot belong together: see EmbedReport.
void requireFit(const EmbedReport& report, const ModelOptions& options);

/// The layout in which a skin with these normals is written.
ObjLayout layoutWith(Normals normals, const ObjLayout& layout);

/// Parses the command line and runs the demo; turns errors into one line on standard error and an exit status.
int runDemo(CLI::App& app, int argc, char** argv, const std::function<int()>& run);

}  // namespace tetskin::scenes
