// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Files of tet meshes, damaged: whatever the bytes, there is a sound mesh or a message. The first byte chooses the
// format: v for VTK, m for Gmsh, t for TetGen, whose two files are parted by a form feed.
#include "fuzz_files.h"

#include <tetskin/io/tet_files.h>

#include <string>
#include <utility>

namespace {

using namespace tetskin;
using test::write;

Result<TetMesh> load(char format, const std::string& bytes) {
  if (format == 'v') return loadTetMesh(write("c.vtk", bytes));
  if (format == 'm') return loadTetMesh(write("c.msh", bytes));
  const std::size_t split = bytes.find('\f');
  write("c.node", bytes.substr(0, split));
  return loadTetMesh(write("c.ele", split == std::string::npos ? "" : bytes.substr(split + 1)));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const auto format = static_cast<char>(data[0]);
  if (format != 'v' && format != 'm' && format != 't') return 0;
  Result<TetMesh> mesh = load(format, std::string(reinterpret_cast<const char*>(data) + 1, size - 1));
  if (!mesh.ok()) {
    TETSKIN_FUZZ_EXPECT(!mesh.status().message.empty());
    return 0;
  }
  TETSKIN_FUZZ_EXPECT(!mesh.value().tets.empty());
  const TetMeshReport report = repairTetMesh(mesh.value());
  TETSKIN_FUZZ_EXPECT(report.indexOutOfRange.count == 0 && report.nonFiniteNodes.count == 0);
  TETSKIN_FUZZ_EXPECT(firstUnusable(viewOf(std::as_const(mesh.value().nodes))) == mesh.value().nodeCount());
  TETSKIN_FUZZ_EXPECT(checkTetMesh(mesh.value()).negativeVolume.count == 0);
  return 0;
}
