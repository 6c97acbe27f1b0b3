// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "scenes/model.h"

#include <tetskin/core/src/base/mesh/used_vertices.h>
#include <tetskin/io/files.h>

#include <algorithm>
#include <cstdio>

#include "scenes/bar.h"
#include "scenes/hand.h"
#include "scenes/input_error.h"
#include "scenes/serpent.h"
#include "scenes/slotted_beam.h"

namespace tetskin::scenes {
namespace {

/// If more than this share of a mesh's vertices are outside a cage, and one of them is farther outside than this share
/// of the mesh's diagonal, the cage belongs to another model. A cage inside its mesh has many vertices outside, but
/// near.
constexpr double kManyOutside = 0.5, kFarOutside = 0.1;

struct Maker {
  const char* name;
  TriangleMesh (*surface)(std::size_t triangles);
  TetMesh (*tets)(std::size_t tets) = nullptr;
  std::size_t minTets = 0;
};

TriangleMesh makeSerpentOf(std::size_t triangles) {
  return makeSerpent({triangles});
}

const Maker& makerOf(BuiltIn model) {
  static const Maker makers[] = {{"serpent", makeSerpentOf},
                                 {"bar", makeBar},
                                 {"slotted_beam", makeSlottedBeam, makeSlottedBeamTets, kMinSlottedBeamTets},
                                 {"hand", makeHand, makeHandTets, kMinHandTets}};
  return makers[static_cast<std::size_t>(model)];
}

/// Reports the parts of a file that were not read as they are.
void warn(const std::string& path, const std::string& what) {
  if (!what.empty()) std::fprintf(stderr, "%s: %s\n", path.c_str(), what.c_str());
}

}  // namespace

const std::vector<BuiltIn>& builtInModels() {
  static const std::vector<BuiltIn> all = {BuiltIn::Serpent, BuiltIn::Bar, BuiltIn::SlottedBeam, BuiltIn::Hand};
  return all;
}

std::string nameOf(BuiltIn model) {
  return makerOf(model).name;
}

std::optional<TetMesh> conformingTets(BuiltIn model, std::size_t tets) {
  const Maker& maker = makerOf(model);
  if (!maker.tets || tets < maker.minTets) return {};
  return maker.tets(tets);
}

std::size_t fewestConformingTets(BuiltIn model) {
  return makerOf(model).minTets;
}

Surface loadSurface(const ModelOptions& options) {
  if (options.mesh.empty()) return {nameOf(options.builtIn), makerOf(options.builtIn).surface(options.triangles)};
  MeshFileReport report;
  Result<TriangleMesh> mesh = loadMesh(options.mesh, &report);
  require(mesh.status());
  warn(options.mesh, report.describe());
  return {options.mesh, std::move(mesh).value()};
}

Cage loadCage(const std::string& path) {
  TetFileReport report;
  Result<Cage> loaded = tetskin::loadCage(path, &report);
  require(loaded.status());
  // Most files also hold surfaces, which are not reported.
  if (report.movedNodes > 0) warn(path, report.describe());
  Cage cage = std::move(loaded).value();
  if (const Status status = validate(cage.mesh); !status.ok()) {
    throw InputError(path + ": " + status.message);
  }
  return cage;
}

Cage loadCage(const std::string& path, const Surface& surface) {
  Cage cage = loadCage(path);
  const Status status = cage.checkMesh(surface.mesh);
  if (status.ok()) return cage;
  if (cage.hasDuplicates()) {
    throw InputError(path + " is not a cage of " + surface.name + ": " + status.message + " with tetskin_cage");
  }
  // Without duplicate elements, the tets of any mesh's vertices are found by position, like for another level of
  // detail.
  cage.vertexTets.clear();
  cage.meshHash.reset();
  return cage;
}

Cage cageFor(const Surface& surface, const CageOptions& options, CageReport* report) {
  Result<Cage> cage = createCage(surface.mesh, options, report);
  if (!cage.ok()) throw InputError(surface.name + ": " + cage.status().message);
  return std::move(cage).value();
}

void gatherLooseVertices(Surface& surface, Cage& cage, bool quiet) {
  const std::vector<char> used = usedVertices(surface.mesh);
  const auto loose = static_cast<std::size_t>(std::count(used.begin(), used.end(), 0));
  if (loose == 0) return;
  if (!quiet) {
    std::printf("%s: no triangle uses %zu of its %zu vertices; they shape no cage\n", surface.name.c_str(), loose,
                used.size());
  }
  const auto corner = static_cast<std::size_t>(surface.mesh.triangles[0][0]);
  cage.meshHash.reset();
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (used[v]) continue;
    surface.mesh.positions[v] = surface.mesh.positions[corner];
    if (!cage.vertexTets.empty()) cage.vertexTets[v] = cage.vertexTets[corner];
  }
}

CageOptions cageOptionsOf(const ModelOptions& options) {
  CageOptions cage;
  cage.targetTets = options.tets;
  cage.duplicateElements = !options.whole;
  return cage;
}

void announceCage(std::size_t tets, const ModelOptions& options) {
  if (options.quiet) return;
  std::printf("building a cage of about %zu tets\n", tets);
  std::fflush(stdout);  // shown before the work, which takes seconds
}

CalibrationReport calibrated(Cage& cage, const std::string& name) {
  const Result<CalibrationReport> report = calibrate(cage);
  if (!report.ok()) throw InputError(name + ": " + report.status().message);
  return report.value();
}

Model loadModel(const ModelOptions& options) {
  Model model;
  static_cast<Surface&>(model) = loadSurface(options);
  if (options.mesh.empty()) {
    model.layout = ObjLayout::create(model.mesh);
  } else {
    Result<ObjLayout> layout = objLayoutFor(options.mesh, model.mesh);
    require(layout.status());
    model.layout = std::move(layout).value();
  }
  if (options.loaded) options.loaded(model.mesh, model.layout);
  if (options.cage.empty()) announceCage(options.tets, options);
  model.cage = options.cage.empty() ? cageFor(model, cageOptionsOf(options)) : loadCage(options.cage, model);
  gatherLooseVertices(model, model.cage, options.quiet);
  // The refined tets of a tet whose orientation is reversed come in a different order.
  if (repairTetMesh(model.cage.mesh).negativeVolume.count > 0) model.cage.fineVolumeFraction.clear();
  if (options.calibrate) (void)calibrated(model.cage, options.cage.empty() ? model.name : options.cage);
  return model;
}

void requireFit(const Status& status, const EmbedReport& report, const ModelOptions& options) {
  const std::string mesh = options.mesh.empty() ? nameOf(options.builtIn) : options.mesh;
  if (!status.ok()) throw InputError(mesh + ": " + status.message);
  const double size = report.meshBox.diagonal().norm();
  std::string fault;
  if (report.unitsDiffer()) {
    fault = report.unitsMessage() + " Scale one of them";
  } else if (static_cast<double>(report.outside) > kManyOutside * static_cast<double>(report.vertexCount) &&
             report.maxDistance > kFarOutside * size) {
    char text[256];
    std::snprintf(
        text, sizeof text,
        "%zu of %zu vertices lie outside it, the farthest is vertex %zu at a distance of %.3g, and the mesh's "
        "diagonal is %.3g; use a cage made for this mesh, for example by tetskin_cage",
        report.outside, report.vertexCount, report.maxDistanceVertex, report.maxDistance, size);
    fault = text;
  } else {
    return;
  }
  throw InputError(mesh + " does not fit its cage " + options.cage + ": " + fault);
}

ObjLayout layoutWith(Normals normals, const ObjLayout& layout) {
  return normals == Normals::None ? layout : layout.withNormals();
}

}  // namespace tetskin::scenes
