// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/embedding/mapped_vertices.h>
#include <tetskin/core/src/search/tolerances.h>
#include <tetskin/core/src/shared/mesh/tet_geometry.h>
#include <tetskin/core/src/shared/mesh/weld.h>

namespace tetskin {
namespace {

/// Barycentric distance from which a vertex is not the one that the map means: rounding to float is a hundred times
/// less in any cage whose tets are a thousandth of its distance from the origin.
constexpr double kNotMapped = 0.02;

Status notMapped(const TriangleMesh& mesh, std::size_t vertex, int tet) {
  char text[256];
  const Eigen::Vector3d& p = mesh.positions[vertex];
  std::snprintf(
      text, sizeof text,
      "vertex %zu at (%.6g, %.6g, %.6g) is not in tet %d, where the cage's map has it: the cage was built for "
      "another mesh, or one of the two was moved; build a cage for this mesh",
      vertex, p.x(), p.y(), p.z(), tet);
  return {StatusCode::CageMismatch, text};
}

}  // namespace

Result<std::vector<std::int32_t>> mappedTets(const Cage& cage, const TriangleMesh& mesh, EmbedReport& report) {
  if (Status status = cage.check(); !status.ok()) return status;
  if (cage.vertexTets.size() != mesh.vertexCount()) {
    return Status{StatusCode::CageMismatch,
                  "the cage's map is of " + std::to_string(cage.vertexTets.size()) + " vertices, and the mesh has " +
                      std::to_string(mesh.vertexCount()) +
                      "; build a cage for this mesh, or find its tets by CageLocator, or embed in the bare TetMesh"};
  }
  const double rounding = kInsideTolerance * largestCoordinate(report.cageBox);
  std::vector<std::int32_t> tetOf(cage.vertexTets.begin(), cage.vertexTets.end());
  for (std::size_t v = 0; v < tetOf.size(); ++v) {
    const int tet = tetOf[v];
    const TetCorners corners = cornersOf(cage, cage.tets[tet]);
    if (isFlat(corners)) {
      return Status{StatusCode::Degenerate, "the cage's map names tet " + std::to_string(tet) + " for vertex " +
                                                std::to_string(v) + ", which is flat; build the cage again"};
    }
    const Eigen::Vector4d weights = BarycentricMap(corners)(mesh.positions[v]);
    const double barycentric = barycentricDistance(weights);
    if (!(barycentric < kNotMapped)) return notMapped(mesh, v, tet);
    if (barycentric <= 0.0) continue;
    const double distance = distanceToTet(mesh.positions[v], corners, weights);
    if (distance <= rounding) continue;
    tetOf[v] = ~tet;
    if (distance <= report.worstDistance) continue;
    report.worstDistance = distance;
    report.worstVertex = v;
    report.worstPosition = mesh.positions[v];
  }
  const std::vector<std::uint32_t> first = weldCoincident(viewOf(mesh.positions));
  for (std::size_t v = 0; v < tetOf.size(); ++v) report.coincident += first[v] != v;
  for (const Tet& tet : cage.tets) report.flatTets += isFlat(cornersOf(cage, tet));
  report.mapped = tetOf.size();
  return tetOf;
}

}  // namespace tetskin
