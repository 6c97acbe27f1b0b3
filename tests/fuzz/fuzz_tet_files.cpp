// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Damaged files of tet meshes: whatever the bytes, the result is a sound mesh or a message. The first byte chooses the
// format: v for VTK, t for TetGen, whose two files are separated by a form feed. VTK files are also read as cages.
#include "fuzz_files.h"

#include <tetskin/core/src/base/mesh/mesh_checks.h>
#include <tetskin/io/files.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace tetskin;
using test::write;

/// Writes the files of a format, and returns the path to be read.
std::string writeAll(char format, const std::string& bytes) {
  if (format == 'v') return write("c.vtk", bytes);
  const std::size_t split = bytes.find('\f');
  write("c.node", bytes.substr(0, split));
  return write("c.ele", split == std::string::npos ? "" : bytes.substr(split + 1));
}

/// True if nodes differ by no more than rounding, in which midpoints are moved.
bool near(const std::vector<Eigen::Vector3d>& a, const std::vector<Eigen::Vector3d>& b) {
  double size = 0.0;
  for (const Eigen::Vector3d& p : a) size = std::max(size, p.norm());
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [&](const Eigen::Vector3d& p, const Eigen::Vector3d& q) { return (p - q).norm() <= 1e-3 * size; });
}

/// Expects a cage that was read to be valid, to have the same tets as when read as a mesh, and to be savable.
void checkCage(const std::string& path, const TetMesh& mesh) {
  TetFileReport report;
  const Result<Cage> cage = loadCage(path, &report);
  if (!cage.ok()) {
    TETSKIN_FUZZ_EXPECT(!cage.status().message.empty());
    return;
  }
  TETSKIN_FUZZ_EXPECT(validateAttributes(cage.value()).ok());
  TETSKIN_FUZZ_EXPECT(cage.value().mesh.tets == mesh.tets && cage.value().mesh.nodeCount() == mesh.nodeCount());
  TETSKIN_FUZZ_EXPECT(report.movedNodes > 0 || near(cage.value().mesh.nodes, mesh.nodes));
  const std::string copy = (test::folder() / "copy.vtk").string();
  TETSKIN_FUZZ_EXPECT(saveCage(cage.value(), copy).ok());
  const Result<Cage> again = loadCage(copy);
  TETSKIN_FUZZ_EXPECT(again.ok() && again.value().vertexTets == cage.value().vertexTets);
  TETSKIN_FUZZ_EXPECT(again.value().volumeFraction == cage.value().volumeFraction &&
                      again.value().stiffnessFactor == cage.value().stiffnessFactor &&
                      again.value().paintedStiffness == cage.value().paintedStiffness);
  TETSKIN_FUZZ_EXPECT(again.value().masses == cage.value().masses && again.value().component == cage.value().component);
  TETSKIN_FUZZ_EXPECT(again.value().sourceTet == cage.value().sourceTet);
  TETSKIN_FUZZ_EXPECT(again.value().quadraticTet == cage.value().quadraticTet);
  TETSKIN_FUZZ_EXPECT(again.value().fineVolumeFraction == cage.value().fineVolumeFraction);
  TETSKIN_FUZZ_EXPECT(again.value().meshHash == cage.value().meshHash);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const auto format = static_cast<char>(data[0]);
  if (format != 'v' && format != 't') return 0;
  const std::string path = writeAll(format, std::string(reinterpret_cast<const char*>(data) + 1, size - 1));
  Result<TetMesh> mesh = loadTetMesh(path);
  if (!mesh.ok()) {
    TETSKIN_FUZZ_EXPECT(!mesh.status().message.empty());
    TETSKIN_FUZZ_EXPECT(!loadCage(path).ok());
    return 0;
  }
  checkCage(path, mesh.value());
  TETSKIN_FUZZ_EXPECT(!mesh.value().tets.empty());
  const TetMeshReport report = repairTetMesh(mesh.value());
  TETSKIN_FUZZ_EXPECT(report.indexOutOfRange.count == 0 && report.nonFiniteNodes.count == 0);
  TETSKIN_FUZZ_EXPECT(firstUnusable(viewOf(std::as_const(mesh.value().nodes))) == mesh.value().nodeCount());
  TETSKIN_FUZZ_EXPECT(checkTetMesh(mesh.value()).negativeVolume.count == 0);
  return 0;
}
