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

/// Checks of options' values; what they refuse, they say in one line.
CLI::Validator isFileName();     ///< not empty
CLI::Validator isCount();        ///< whole, at least 1
CLI::Validator isPositive();     ///< above 0, and finite
CLI::Validator isNotNegative();  ///< 0 or above, and finite

/// --mesh, or --triangles.
void addSurfaceOptions(CLI::App& app, ModelOptions& options);
/// Those and --tets.
void addMeshOptions(CLI::App& app, ModelOptions& options);
/// Those and --cage, instead of --tets.
void addModelOptions(CLI::App& app, ModelOptions& options);
/// --interpolation.
void addInterpolationOption(CLI::App& app, SkinOptions& options);
/// --normals, --outside, --max-distance.
void addSkinOptions(CLI::App& app, SkinOptions& options);
/// --json.
void addSummaryOption(CLI::App& app, std::string& path, const std::string& description);
/// --frames, --every, --out, --json, --quiet. The defaults of `options` are the demo's.
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
/// Throws InputError if this file cannot be written, so that it is known before the work. Does not change it.
void requireWritable(const std::string& path);
/// Where the summary goes; its folder is there, and it can be written. Throws InputError.
std::string summaryPath(const OutputOptions& options);

/// Throws InputError if mesh and cage cannot belong together: they are in different units (see EmbedReport), or most of
/// the mesh lies outside, and far.
void requireFit(const EmbedReport& report, const ModelOptions& options);

/// The layout in which a skin with these normals is written.
ObjLayout layoutWith(Normals normals, const ObjLayout& layout);

/// Parses the command line and runs the demo; turns errors into one line on standard error and an exit status.
int runDemo(CLI::App& app, int argc, char** argv, const std::function<int()>& run);

}  // namespace tetskin::scenes
