// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "copy_checks.h"

#include <tetskin/core/src/shared/base/disjoint_sets.h>
#include <tetskin/core/src/shared/mesh/tet_geometry.h>

#include <algorithm>
#include <cmath>
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

/// By tet, its part by nodes, as the lowest number of a node in it.
std::vector<int> partsByNodes(const TetMesh& cage) {
  DisjointSets nodes(cage.nodeCount());
  for (const Tet& tet : cage.tets) {
    for (const int n : tet) nodes.unite(tet[0], n);
  }
  std::vector<int> parts;
  for (const Tet& tet : cage.tets) parts.push_back(nodes.find(tet[0]));
  return parts;
}

template <class Number>
std::size_t countDistinct(std::vector<Number> numbers) {
  std::sort(numbers.begin(), numbers.end());
  return static_cast<std::size_t>(std::unique(numbers.begin(), numbers.end()) - numbers.begin());
}

/// Two numberings that differ in nothing but the numbers.
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
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
    const Eigen::Vector3d& p = mesh.positions[v];
    const int tet = cage.vertexTets[v];
    const BarycentricMap map(cornersOf(cage, cage.tets[static_cast<std::size_t>(tet)]));
    if (!(barycentricDistance(map(p)) <= 0.0)) return "vertex " + std::to_string(v) + " is not in its tet";
    if (tetAt.try_emplace({p.x(), p.y(), p.z()}, tet).first->second != tet) return "one position in two tets";
  }
  return "";
}

std::string faultOfMasses(const Cage& cage, double volume) {
  constexpr double kLightest = 0.09;
  if (cage.masses.size() != cage.nodeCount()) return "masses of another number of nodes";
  const double sum = std::accumulate(cage.masses.begin(), cage.masses.end(), 0.0);
  if (!(std::abs(sum - volume) <= 1e-9 * volume)) return "masses of " + std::to_string(sum / volume) + " volumes";
  const double least = *std::min_element(cage.masses.begin(), cage.masses.end());
  const double share = least * static_cast<double>(cage.nodeCount()) / sum;
  return share >= kLightest ? "" : "a node of " + std::to_string(share) + " mean masses";
}

}  // namespace

std::size_t countPartsByFaces(const TetMesh& cage) {
  DisjointSets tets(cage.tetCount());
  forFaces(cage, [&](const std::vector<int>& around) {
    for (const int t : around) tets.unite(around[0], t);
  });
  std::size_t parts = 0;
  for (std::size_t t = 0; t < cage.tetCount(); ++t) parts += tets.find(static_cast<int>(t)) == static_cast<int>(t);
  return parts;
}

std::string faultOfCopies(const Cage& cage, const CageReport& report) {
  if (cage.latticeTets.size() != cage.tetCount()) return "no places in the lattice";
  if (cage.tetCount() - countDistinct(cage.latticeTets) != report.copies) return "the report has other copies";
  if (cage.split() != (report.copies > 0)) return "a cage that does not know whether it is split";
  std::size_t most = 0;
  forFaces(cage, [&](const std::vector<int>& around) {
    std::vector<int> places;
    for (const int t : around) places.push_back(cage.latticeTets[static_cast<std::size_t>(t)]);
    most = std::max(most, countDistinct(std::move(places)));
  });
  if (most > 2) return "a face between more than two places of the lattice";
  const std::vector<int> parts = partsByNodes(cage);
  if (!sameSets(parts, cage.parts)) return "parts that are none";
  if (countDistinct(parts) != report.parts) return "the report has other parts";
  if (*std::max_element(cage.parts.begin(), cage.parts.end()) + 1 != static_cast<int>(report.parts)) {
    return "numbers of parts with gaps";
  }
  if (countPartsByFaces(cage) != report.parts) return "tets that hang together by a node or an edge only";
  return "";
}

std::string faultOfKnowledge(const TriangleMesh& mesh, const Cage& cage, const CageReport& report) {
  if (const Status status = cage.check(); !status.ok()) return status.message;
  if (const Status status = cage.checkMesh(mesh); !status.ok()) return status.message;
  std::string fault = faultOfMap(mesh, cage);
  if (fault.empty()) fault = faultOfMasses(cage, cage.fill.empty() ? report.cageVolume : report.meshVolume);
  if (fault.empty() && cage.fill.empty() != cage.fineFill.empty()) fault = "one fill without the other";
  return fault;
}

double filledVolume(const Cage& cage) {
  double sum = 0.0;
  for (std::size_t t = 0; t < cage.tetCount(); ++t) sum += cage.fill[t] * signedVolume(cornersOf(cage, cage.tets[t]));
  return sum;
}

bool sameCage(const Cage& a, const Cage& b) {
  return a.nodes == b.nodes && a.tets == b.tets && a.vertexTets == b.vertexTets && a.fill == b.fill &&
         a.factor == b.factor && a.masses == b.masses && a.parts == b.parts && a.latticeTets == b.latticeTets &&
         a.fineFill == b.fineFill && a.meshHash == b.meshHash;
}

}  // namespace tetskin::test
