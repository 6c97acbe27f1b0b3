// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/shared/mesh/mesh_checks.h>
#include <tetskin/io/files.h>
#include <tetskin/io/src/tets/gmsh_file.h>
#include <tetskin/io/src/tets/tetgen_file.h>
#include <tetskin/io/src/tets/vtk_file.h>
#include <tetskin/io/src/text/file_text.h>

namespace tetskin {

namespace {

/// A cage with tets only, as other formats contain no more.
Result<Cage> bare(Result<TetMesh> mesh) {
  if (!mesh.ok()) return mesh.status();
  return Cage(std::move(mesh).value());
}

Result<Cage> readByExtension(const std::string& path, io::VtkData data, TetFileReport& report) {
  const std::string extension = io::lowerExtension(path);
  if (extension == ".vtk") return io::readVtkFile(path, data, report);
  if (extension == ".node" || extension == ".ele") return bare(io::readTetgenFiles(path, report));
  if (extension == ".msh") return bare(io::readGmshFile(path, report));
  const std::string what = extension == ".vtu" || extension == ".pvtu"
                               ? "is an XML file of VTK, which is not supported; save it as legacy VTK (.vtk)"
                               : "unsupported input format; convert it to legacy VTK (.vtk), TetGen (.node and "
                                 ".ele) or Gmsh (.msh)";
  return io::fileError(StatusCode::UnsupportedFormat, path, 0, what);
}

Result<Cage> load(const std::string& path, io::VtkData data, TetFileReport* report) {
  TetFileReport skipped;
  Result<Cage> cage = readByExtension(path, data, skipped);
  if (report) *report = skipped;
  if (!cage.ok() || !cage.value().mesh.tets.empty()) return cage;
  return io::fileError(StatusCode::Empty, path, 0,
                       "has no linear tets" + (skipped.skippedCells > 0 ? ": " + skipped.describe() : std::string()) +
                           "; export a volume mesh of tets with 4 nodes each");
}

}  // namespace

std::string TetFileReport::describe() const {
  if (skippedCells == 0) return {};
  return std::to_string(skippedCells) + " cells that are not linear tets were skipped" +
         (skippedHighOrder > 0 ? ", " + std::to_string(skippedHighOrder) + " of them higher-order tets" : "");
}

Result<TetMesh> loadTetMesh(const std::string& path, TetFileReport* report) {
  Result<Cage> cage = load(path, io::VtkData::Skipped, report);
  if (!cage.ok()) return cage.status();
  return std::move(cage.value().mesh);
}

Result<Cage> loadCage(const std::string& path, TetFileReport* report) {
  Result<Cage> cage = load(path, io::VtkData::OfCage, report);
  if (!cage.ok()) return cage;
  const Status status = checkKnowledge(cage.value());
  if (status.ok()) return cage;
  return io::fileError(status.code, path, 0, status.message + "; correct the array, or remove it");
}

}  // namespace tetskin
