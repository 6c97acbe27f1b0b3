// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/mesh/mesh_checks.h>
#include <tetskin/io/files.h>
#include <tetskin/io/src/tets/high_order_tets.h>
#include <tetskin/io/src/tets/tet_readers.h>
#include <tetskin/io/src/text/file_text.h>

#include <cstdio>

namespace tetskin {

namespace {

Result<io::FileCage> readByExtension(const std::string& path, io::ReadAs as, TetFileReport& report) {
  const std::string extension = io::lowerExtension(path);
  if (extension == ".vtk") return io::readVtkFile(path, as, report);
  if (extension == ".node" || extension == ".ele") return io::readTetgenFiles(path);
  const std::string what =
      extension == ".vtu" || extension == ".pvtu"
          ? "is an XML file of VTK, which is not supported; save it as legacy VTK (.vtk)"
          : "unsupported input format; convert it to legacy VTK (.vtk), as by 'meshio convert in.msh "
            "out.vtk', or to TetGen (.node and .ele)";
  return io::fileError(StatusCode::UnsupportedFormat, path, 0, what);
}

Result<Cage> load(const std::string& path, io::ReadAs as, TetFileReport* report) {
  TetFileReport ignored;
  TetFileReport& found = report ? *report : ignored;
  found = {};
  Result<io::FileCage> file = readByExtension(path, as, found);
  if (!file.ok()) return file.status();
  if (file.value().cage.mesh.tets.empty()) {
    return io::fileError(StatusCode::Empty, path, 0,
                         "has no tets" + (found.skippedCells > 0 ? ": " + found.describe() : std::string()) +
                             "; export a volume mesh of tets");
  }
  if (Status status = io::cutHighOrderTets(as, file.value(), found); !status.ok()) return status;
  return std::move(file.value().cage);
}

}  // namespace

std::string TetFileReport::describe() const {
  std::string words;
  const auto add = [&](std::size_t count, const std::string& what) {
    if (count > 0) words += (words.empty() ? "" : ", ") + std::to_string(count) + what;
  };
  add(skippedCells, " cells that are not tets were skipped");
  add(quadraticTets, " tets of second order became quadratic tets, each of eight tets");
  char distance[32];
  std::snprintf(distance, sizeof distance, "%.3g", farthestMove);
  add(movedNodes, " nodes on curved edges were moved to their middles, by up to " + std::string(distance));
  return words;
}

Result<TetMesh> loadTetMesh(const std::string& path, TetFileReport* report) {
  Result<Cage> cage = load(path, io::ReadAs::Tets, report);
  if (!cage.ok()) return cage.status();
  return std::move(cage.value().mesh);
}

Result<Cage> loadCage(const std::string& path, TetFileReport* report) {
  Result<Cage> cage = load(path, io::ReadAs::Cage, report);
  if (!cage.ok()) return cage;
  const Status status = validateAttributes(cage.value());
  if (status.ok()) return cage;
  return io::fileError(status.code, path, 0, status.message + "; correct the array, or remove it");
}

}  // namespace tetskin
