// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "copy_checks.h"

#include <tetskin/core/src/base/disjoint_sets.h>
#include <tetskin/core/src/base/mesh/mesh_checks.h>
#include <tetskin/core/src/base/mesh/tet_geometry.h>
#include <tetskin/core/src/base/mesh/used_vertices.h>

#include <map>
#include <numeric>

namespace tetskin::test {
namespace {

using Face = std::array<int, 3>;

/// Calls visit() with the tets of each face.
template <class Visit>
void forFaces(const TetMesh& cage, Visit&& visit) {
  std::vector<std::pair<Face, int>> faces;
  for (std::size_t t = 0; t < cage.tetCount(); ++t) {
    for (int corner = 0; corner < 4; ++corner) {
      const Tet& tet = cage.tets[t];
      Face face = {tet[(corner + 1) % 4], tet[(corner + 2) % 4], tet[(corner + 3) % 4]};
      std::sort(face.begin(), face.end());
      faces.emplace_back(face, static_cast<int>(t));
    }
  }
  std::sort(faces.begin(), faces.end());
  std::vector<int> around;
  for (std::size_t k = 0; k < faces.size(); ++k) {
    around.push_back(faces[k].second);
    if (k + 1 < faces.size() && faces[k + 1].first == faces[k].first) continue;
    visit(around);
    around.clear();
  }
}

/// By tet: its component by shared nodes, as the lowest number of a node in it.
std::vector<int> componentsByNodes(const TetMesh& cage) {
  DisjointSets nodes(cage.nodeCount());
  for (const Tet& tet : cage.tets) {
    for (const int n : tet) nodes.unite(tet[0], n);
  }
  std::vector<int> components;
  for (const Tet& tet : cage.tets) components.push_back(nodes.find(tet[0]));
  return components;
}

template <class Number>
std::size_t countDistinct(std::vector<Number> numbers) {
  std::sort(numbers.begin(), numbers.end());
  return static_cast<std::size_t>(std::unique(numbers.begin(), numbers.end()) - numbers.begin());
}

/// Whether two numberings define the same sets and differ only in the numbers.
bool sameSets(const std::vector<int>& a, const std::vector<int>& b) {
  if (a.size() != b.size()) return false;
  std::vector<std::array<int, 2>> pairs;
  for (std::size_t k = 0; k < a.size(); ++k) pairs.push_back({a[k], b[k]});
  const std::size_t count = countDistinct(std::move(pairs));
  return count == countDistinct(a) && count == countDistinct(b);
}

std::string faultOfMap(const TriangleMesh& mesh, const Cage& cage) {
  if (cage.vertexTets.size() != mesh.vertexCount()) return "a map of another number of vertices";
  std::map<std::array<double, 3>, int> tetAt;
  const std::vector<char> used = usedVertices(mesh);
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
    const Eigen::Vector3d& p = mesh.positions[v];
    const int tet = cage.vertexTets[v];
    const BarycentricMap map(cornersOf(cage.mesh, cage.mesh.tets[static_cast<std::size_t>(tet)]));
    if (used[v] && !(barycentricDistance(map(p)) <= 0.0)) return "vertex " + std::to_string(v) + " is not in its tet";
    if (tetAt.try_emplace({p.x(), p.y(), p.z()}, tet).first->second != tet) return "one position in two tets";
  }
  return "";
}

std::string faultOfMasses(const Cage& cage, double volume) {
  constexpr double kMin = 0.09;
  if (cage.masses.size() != cage.mesh.nodeCount()) return "masses of another number of nodes";
  const double sum = std::accumulate(cage.masses.begin(), cage.masses.end(), 0.0);
  if (!(std::abs(sum - volume) <= 1e-9 * volume)) return "masses of " + std::to_string(sum / volume) + " volumes";
  const double minimum = *std::min_element(cage.masses.begin(), cage.masses.end());
  const double fraction = minimum * static_cast<double>(cage.mesh.nodeCount()) / sum;
  return fraction >= kMin ? "" : "a node of " + std::to_string(fraction) + " mean masses";
}

}  // namespace

std::size_t countComponentsByFaces(const TetMesh& cage) {
  DisjointSets tets(cage.tetCount());
  forFaces(cage, [&](const std::vector<int>& around) {
    for (const int t : around) tets.unite(around[0], t);
  });
  std::size_t components = 0;
  for (std::size_t t = 0; t < cage.tetCount(); ++t) components += tets.find(static_cast<int>(t)) == static_cast<int>(t);
  return components;
}

std::string faultOfCopies(const Cage& cage, const CageReport& report) {
  if (cage.sourceTet.size() != cage.mesh.tetCount()) return "no places in the lattice";
  if (cage.mesh.tetCount() - countDistinct(cage.sourceTet) != report.duplicateTets)
    return "the report has other copies";
  if (cage.hasDuplicates() != (report.duplicateTets > 0)) return "a cage that does not know whether it is split";
  std::size_t maximum = 0;
  forFaces(cage.mesh, [&](const std::vector<int>& around) {
    std::vector<int> indices;
    for (const int t : around) indices.push_back(cage.sourceTet[static_cast<std::size_t>(t)]);
    maximum = std::max(maximum, countDistinct(std::move(indices)));
  });
  if (maximum > 2) return "a face between more than two places of the lattice";
  const std::vector<int> components = componentsByNodes(cage.mesh);
  if (!sameSets(components, cage.component)) return "parts that are none";
  if (countDistinct(components) != report.components) return "the report has other parts";
  if (*std::max_element(cage.component.begin(), cage.component.end()) + 1 != static_cast<int>(report.components)) {
    return "numbers of parts with gaps";
  }
  if (countComponentsByFaces(cage.mesh) != report.components)
    return "tets that hang together by a node or an edge only";
  return "";
}

std::string faultOfKnowledge(const TriangleMesh& mesh, const Cage& cage, const CageReport& report) {
  if (const Status status = validateAttributes(cage); !status.ok()) return status.message;
  if (const Status status = cage.checkMesh(mesh); !status.ok()) return status.message;
  std::string fault = faultOfMap(mesh, cage);
  if (fault.empty()) fault = faultOfMasses(cage, cage.volumeFraction.empty() ? report.cageVolume : report.meshVolume);
  if (fault.empty() && cage.volumeFraction.empty() != cage.fineVolumeFraction.empty())
    fault = "one fill without the other";
  return fault;
}

double filledVolume(const Cage& cage) {
  double sum = 0.0;
  for (std::size_t t = 0; t < cage.mesh.tetCount(); ++t)
    sum += cage.volumeFraction[t] * signedVolume(cornersOf(cage.mesh, cage.mesh.tets[t]));
  return sum;
}

bool sameCage(const Cage& a, const Cage& b) {
  return a.mesh.nodes == b.mesh.nodes && a.mesh.tets == b.mesh.tets && a.vertexTets == b.vertexTets &&
         a.volumeFraction == b.volumeFraction && a.stiffnessFactor == b.stiffnessFactor &&
         a.paintedStiffness == b.paintedStiffness && a.paintedDensity == b.paintedDensity &&
         a.paintedDamping == b.paintedDamping && a.masses == b.masses && a.component == b.component &&
         a.sourceTet == b.sourceTet && a.fineVolumeFraction == b.fineVolumeFraction && a.meshHash == b.meshHash;
}

}  // namespace tetskin::test
