// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/mesh/mesh_checks.h>
#include <tetskin/io/files.h>
#include <tetskin/io/src/tets/gmsh_file.h>
#include <tetskin/io/src/tets/medit_file.h>
#include <tetskin/io/src/tets/tetgen_file.h>
#include <tetskin/io/src/tets/vtk_file.h>
#include <tetskin/io/src/text/file_text.h>

namespace tetskin {

namespace {

Result<Cage> readByExtension(const std::string& path, io::VtkData data, TetFileReport& report) {
  const std::string extension = io::lowerExtension(path);
  if (extension == ".vtk") return io::readVtkFile(path, data, report);
  if (extension == ".node" || extension == ".ele") return io::readTetgenFiles(path, report);
  if (extension == ".msh") return io::readGmshFile(path, report);
  if (extension == ".mesh") return io::readMeditFile(path, report);
  const std::string what = extension == ".vtu" || extension == ".pvtu"
                               ? "is an XML file of VTK, which is not supported; save it as legacy VTK (.vtk)"
                               : "unsupported input format; convert it to legacy VTK (.vtk), TetGen (.node and "
                                 ".ele), Gmsh (.msh) or Medit (.mesh)";
  return io::fileError(StatusCode::UnsupportedFormat, path, 0, what);
}

Result<Cage> load(const std::string& path, io::VtkData data, TetFileReport* report) {
  TetFileReport skipped;
  Result<Cage> cage = readByExtension(path, data, skipped);
  if (report) *report = skipped;
  if (!cage.ok() || !cage.value().mesh.tets.empty()) return cage;
  return io::fileError(StatusCode::Empty, path, 0,
                       "has no tets" + (skipped.skippedCells > 0 ? ": " + skipped.describe() : std::string()) +
                           "; export a volume mesh of tets");
}

}  // namespace

std::string TetFileReport::describe() const {
  std::string words;
  if (skippedCells > 0) words = std::to_string(skippedCells) + " cells that are no tets were skipped";
  if (cornersOnly == 0) return words;
  return words + (words.empty() ? "" : ", ") + std::to_string(cornersOnly) +
         " tets of higher order were read by their corners, without " + std::to_string(droppedNodes) + " other nodes";
}

Result<TetMesh> loadTetMesh(const std::string& path, TetFileReport* report) {
  Result<Cage> cage = load(path, io::VtkData::Skipped, report);
  if (!cage.ok()) return cage.status();
  return std::move(cage.value().mesh);
}

Result<Cage> loadCage(const std::string& path, TetFileReport* report) {
  Result<Cage> cage = load(path, io::VtkData::OfCage, report);
  if (!cage.ok()) return cage;
  const Status status = validateAttributes(cage.value());
  if (status.ok()) return cage;
  return io::fileError(status.code, path, 0, status.message + "; correct the array, or remove it");
}

}  // namespace tetskin
