// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/mesh/mesh_checks.h>
#include <tetskin/io/files.h>
#include <tetskin/io/src/tets/vtk_cage_data.h>
#include <tetskin/io/src/text/atomic_file.h>
#include <tetskin/io/src/text/file_text.h>
#include <tetskin/io/src/text/number_text.h>

#include <algorithm>
#include <cassert>
#include <filesystem>

namespace tetskin {

namespace {

void appendPoint(std::string& text, const Eigen::Vector3d& p) {
  for (int i = 0; i < 3; ++i) {
    io::appendNumber(text, p[i]);
    text += i < 2 ? ' ' : '\n';
  }
}

void appendCorners(std::string& text, const Tet& tet) {
  assert(*std::min_element(tet.begin(), tet.end()) >= 0);
  for (int i = 0; i < 4; ++i) {
    io::appendNumber(text, static_cast<std::size_t>(tet[i]));
    text += i < 3 ? ' ' : '\n';
  }
}

std::string vtkText(const TetMesh& mesh) {
  const std::string tetCount = std::to_string(mesh.tetCount());
  std::string text = "# vtk DataFile Version 2.0\ntetrahedral mesh\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS " +
                     std::to_string(mesh.nodeCount()) + " double\n";
  for (const Eigen::Vector3d& node : mesh.nodes) appendPoint(text, node);
  text += "CELLS " + tetCount + " " + std::to_string(5 * mesh.tetCount()) + "\n";
  for (const Tet& tet : mesh.tets) {
    text += "4 ";
    appendCorners(text, tet);
  }
  text += "CELL_TYPES " + tetCount + "\n";
  for (std::size_t t = 0; t < mesh.tetCount(); ++t) text += "10\n";
  return text;
}

std::string nodeText(const TetMesh& mesh) {
  std::string text = std::to_string(mesh.nodeCount()) + " 3 0 0\n";
  for (std::size_t n = 0; n < mesh.nodeCount(); ++n) {
    io::appendNumber(text, n);
    text += ' ';
    appendPoint(text, mesh.nodes[n]);
  }
  return text;
}

std::string eleText(const TetMesh& mesh) {
  std::string text = std::to_string(mesh.tetCount()) + " 4 0\n";
  for (std::size_t t = 0; t < mesh.tetCount(); ++t) {
    io::appendNumber(text, t);
    text += ' ';
    appendCorners(text, mesh.tets[t]);
  }
  return text;
}

Status checkExtension(const std::string& path) {
  const std::string extension = io::lowerExtension(path);
  for (const char* known : {".vtk", ".node", ".ele"}) {
    if (extension == known) return {};
  }
  return io::fileError(StatusCode::UnsupportedFormat, path, 0, "unsupported output format; use .vtk, .node or .ele");
}

/// Ok if a reader would accept the mesh.
Status checkWritable(const TetMesh& mesh, const std::string& path) {
  if (mesh.tets.empty()) {
    return io::fileError(StatusCode::Empty, path, 0,
                         "cannot be written from a mesh without tets; build the mesh first");
  }
  const std::size_t bad = firstNonFinite(viewOf(mesh.nodes));
  if (bad < mesh.nodeCount()) {
    return io::fileError(StatusCode::NonFinite, path, 0,
                         "cannot be written, as node " + std::to_string(bad) +
                             " has a coordinate that is not finite; check the source of the mesh");
  }
  for (std::size_t t = 0; t < mesh.tetCount(); ++t) {
    for (const int node : mesh.tets[t]) {
      if (node >= 0 && static_cast<std::size_t>(node) < mesh.nodeCount()) continue;
      return io::fileError(StatusCode::IndexOutOfRange, path, 0,
                           "cannot be written, as tet " + std::to_string(t) + " refers to node " +
                               std::to_string(node) + " of " + std::to_string(mesh.nodeCount()) +
                               "; check the source of the mesh");
    }
  }
  return {};
}

std::string withExtension(const std::string& path, const char* extension) {
  return std::filesystem::path(path).replace_extension(extension).string();
}

}  // namespace

Status saveTetMesh(const TetMesh& mesh, const std::string& path) {
  const std::string extension = io::lowerExtension(path);
  Status status = checkExtension(path);
  if (status.ok()) status = checkWritable(mesh, path);
  if (!status.ok()) return status;
  if (extension == ".vtk") return io::writeFile(path, vtkText(mesh));
  status = io::writeFile(extension == ".node" ? path : withExtension(path, ".node"), nodeText(mesh));
  if (!status.ok()) return status;
  return io::writeFile(extension == ".ele" ? path : withExtension(path, ".ele"), eleText(mesh));
}

Status saveCage(const Cage& cage, const std::string& path) {
  Status status = checkExtension(path);
  if (status.ok()) status = checkWritable(cage.mesh, path);
  if (!status.ok()) return status;
  if (status = validateAttributes(cage); !status.ok()) {
    return io::fileError(status.code, path, 0,
                         "cannot be written, as " + status.message + "; check the source of the cage");
  }
  if (io::lowerExtension(path) == ".vtk") {
    std::string text = vtkText(cage.mesh);
    io::appendCageData(text, cage);
    return io::writeFile(path, text);
  }
  if (cage.vertexTets.empty() || !cage.hasDuplicates()) return saveTetMesh(cage.mesh, path);
  return io::fileError(StatusCode::UnsupportedFormat, path, 0,
                       "this format cannot store which duplicate of a tet carries which vertex, and this cage has "
                       "duplicate elements; use .vtk");
}

}  // namespace tetskin
