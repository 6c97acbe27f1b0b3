// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/mesh/mesh_checks.h>
#include <tetskin/core/src/base/mesh/tet_geometry.h>
#include <tetskin/core/src/base/mesh/used_vertices.h>
#include <tetskin/core/src/base/mesh/weld.h>
#include <tetskin/core/src/embedding/mapped_vertices.h>
#include <tetskin/core/src/search/tolerances.h>

#include <cassert>

namespace tetskin {
namespace {

/// Barycentric distance above which a vertex is not the one for which the map was made: rounding to float gives a
/// hundredth of this in any cage whose tets are at least a thousandth of its distance from the origin.
constexpr double kNotMapped = 0.02;

Status notMapped(const TriangleMesh& mesh, std::size_t vertex, int tet) {
  char text[256];
  const Eigen::Vector3d& p = mesh.positions[vertex];
  std::snprintf(
      text, sizeof text,
      "vertex %zu at (%.6g, %.6g, %.6g) is not in tet %d, to which the cage's map assigns it: the cage was built for "
      "another mesh, or one of the two was moved; build a cage for this mesh",
      vertex, p.x(), p.y(), p.z(), tet);
  return {StatusCode::CageMismatch, text};
}

}  // namespace

Result<std::vector<std::int32_t>> mappedTets(const Cage& cage, const TriangleMesh& mesh, EmbedReport& report) {
  if (Status status = validateAttributes(cage); !status.ok()) return status;
  if (cage.vertexTets.size() != mesh.vertexCount()) {
    return Status{StatusCode::CageMismatch,
                  "the cage's map has " + std::to_string(cage.vertexTets.size()) + " vertices, but the mesh has " +
                      std::to_string(mesh.vertexCount()) +
                      "; build a cage for this mesh, or find its tets with CageLocator, or embed in the bare TetMesh"};
  }
  const double rounding = kInsideTolerance * maxCoordinate(report.cageBox);
  assert(!report.cageBox.isEmpty());
  std::vector<std::int32_t> tetOf(cage.vertexTets.begin(), cage.vertexTets.end());
  const std::vector<char> used = usedVertices(mesh);
  for (std::size_t v = 0; v < tetOf.size(); ++v) {
    const int tet = tetOf[v];
    const TetCorners corners = cornersOf(cage.mesh, cage.mesh.tets[tet]);
    if (isFlat(corners)) {
      return Status{StatusCode::Degenerate, "the cage's map assigns tet " + std::to_string(tet) + " to vertex " +
                                                std::to_string(v) + ", which is flat; build the cage again"};
    }
    const Eigen::Vector4d weights = BarycentricMap(corners)(mesh.positions[v]);
    const double barycentric = barycentricDistance(weights);
    if (barycentric <= 0.0) continue;
    if (!used[v]) {  // not drawn: no tets were made for it
      tetOf[v] = ~tet;
      continue;
    }
    if (!(barycentric < kNotMapped)) return notMapped(mesh, v, tet);
    const double distance = distanceToTet(mesh.positions[v], corners, weights);
    if (distance <= rounding) continue;
    tetOf[v] = ~tet;
    if (distance <= report.maxDistance) continue;
    report.maxDistance = distance;
    report.maxDistanceVertex = v;
    report.maxDistancePosition = mesh.positions[v];
  }
  const std::vector<std::uint32_t> first = weldCoincident(viewOf(mesh.positions));
  for (std::size_t v = 0; v < tetOf.size(); ++v) report.coincident += first[v] != v;
  for (const Tet& tet : cage.mesh.tets) report.flatTets += isFlat(cornersOf(cage.mesh, tet));
  report.mapped = tetOf.size();
  return tetOf;
}

}  // namespace tetskin
