// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "cage_checks.h"

#include <tetskin/cage/src/fit/cage_quality.h>
#include <tetskin/core/embedding.h>
#include <tetskin/core/src/base/mesh/used_vertices.h>

#include <map>
#include <numeric>
#include <set>

#include "copy_checks.h"

namespace tetskin::test {
namespace {

using Edge = std::array<int, 2>;
using Face = std::array<int, 3>;

template <class Key>
Key sorted(Key key) {
  std::sort(key.begin(), key.end());
  return key;
}

Face faceOpposite(const Tet& tet, int corner) {
  return sorted(Face{tet[(corner + 1) % 4], tet[(corner + 2) % 4], tet[(corner + 3) % 4]});
}

bool hasCoincidentNodes(const TetMesh& cage) {
  std::set<std::array<double, 3>> seen;
  for (const Eigen::Vector3d& p : cage.nodes) {
    if (!seen.insert({p.x(), p.y(), p.z()}).second) return true;
  }
  return false;
}

bool hasCrowdedFace(const TetMesh& cage) {
  std::map<Face, int> count;
  for (const Tet& tet : cage.tets) {
    for (int corner = 0; corner < 4; ++corner) {
      if (++count[faceOpposite(tet, corner)] > 2) return true;
    }
  }
  return false;
}

/// Whether the items are connected, where items with a key in common are neighbours.
template <class Key>
bool connected(const std::vector<std::vector<Key>>& keysOfItem) {
  std::vector<int> parent(keysOfItem.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto find = [&](int i) {
    while (parent[i] != i) i = parent[i];
    return i;
  };
  std::map<Key, int> firstItem;
  for (std::size_t i = 0; i < keysOfItem.size(); ++i) {
    for (const Key& key : keysOfItem[i]) {
      const auto [where, isNew] = firstItem.insert({key, static_cast<int>(i)});
      if (!isNew) parent[find(static_cast<int>(i))] = find(where->second);
    }
  }
  for (std::size_t i = 1; i < parent.size(); ++i) {
    if (find(static_cast<int>(i)) != find(0)) return false;
  }
  return true;
}

/// Whether there is a node around which the tets are not connected face to face.
bool hasPinchedNode(const TetMesh& cage) {
  std::vector<std::vector<std::vector<Face>>> faces(cage.nodeCount());
  for (const Tet& tet : cage.tets) {
    for (int i = 0; i < 4; ++i) {
      std::vector<Face> own;
      for (int corner = 0; corner < 4; ++corner) {
        if (corner != i) own.push_back(faceOpposite(tet, corner));
      }
      faces[tet[i]].push_back(own);
    }
  }
  return !std::all_of(faces.begin(), faces.end(), [](const auto& f) { return connected(f); });
}

/// Whether every boundary edge is in two boundary faces, and the boundary faces of every node are connected by edges at
/// that node.
bool hasManifoldBoundary(const TetMesh& cage) {
  std::map<Edge, int> count;
  std::map<int, std::vector<std::vector<int>>> links;  // by node: the other two nodes of each face
  for (const Face& face : boundaryFaces(cage)) {
    for (int i = 0; i < 3; ++i) {
      const int a = face[i], b = face[(i + 1) % 3], c = face[(i + 2) % 3];
      ++count[sorted(Edge{a, b})];
      links[a].push_back({b, c});
    }
  }
  return std::all_of(count.begin(), count.end(), [](const auto& c) { return c.second == 2; }) &&
         std::all_of(links.begin(), links.end(), [](const auto& l) { return connected(l.second); });
}

}  // namespace

std::string faultOfTopology(const TetMesh& cage) {
  if (hasCrowdedFace(cage)) return "a face of more than two tets";
  if (hasCoincidentNodes(cage)) return "coincident nodes";
  if (hasPinchedNode(cage)) return "tets that hang together by a node or an edge only";
  if (!hasManifoldBoundary(cage)) return "a boundary that is no manifold";
  return "";
}

std::string faultOfCage(const TriangleMesh& mesh, const Cage& cage, const CageReport& report) {
  const TetMeshReport check = checkTetMesh(cage.mesh);
  if (!check.clean()) return check.describe();
  const DihedralRange range = dihedralRange(cage.mesh);
  if (range.minDeg < kMinDihedralDeg || range.maxDeg > kMaxDihedralDeg) {
    return "dihedral angles " + std::to_string(range.minDeg) + " to " + std::to_string(range.maxDeg);
  }
  EmbedReport embedded;
  const Result<Embedding> embedding = embed(cage, mesh, {}, &embedded);
  if (!embedding.ok()) return embedding.status().message;
  if (embedded.mapped != mesh.vertexCount() || embedded.maxDistance > 0.0) return embedded.describe();
  const std::vector<char> used = usedVertices(mesh);
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (used[v] && !embedding.value().at(v).inside) return "vertex " + std::to_string(v) + " is outside";
  }
  if (report.verticesOutside != 0) return "the report counts vertices outside";
  if (report.tets != cage.mesh.tetCount() || report.nodes != cage.mesh.nodeCount())
    return "the report has other counts";
  std::string fault = faultOfKnowledge(mesh, cage, report);
  return fault.empty() ? faultOfCopies(cage, report) : fault;
}

std::string buildFault(const TriangleMesh& mesh, std::size_t targetTets, bool fit, CageReport* report) {
  CageReport own;
  CageReport& used = report ? *report : own;
  CageOptions options;
  options.targetTets = targetTets;
  options.fit = fit;
  const Result<Cage> cage = createCage(mesh, options, &used);
  std::string fault = cage.ok() ? faultOfCage(mesh, cage.value(), used) : cage.status().message;
  if (fault.empty() && !used.targetMet()) fault = std::to_string(used.tets) + " tets";
  return fault.empty() ? "" : "at " + std::to_string(targetTets) + " tets: " + fault;
}

Built build(const TriangleMesh& mesh, std::size_t target, bool fit, bool split) {
  Built built;
  CageOptions options;
  options.targetTets = target;
  options.fit = fit;
  options.duplicateElements = split;
  Result<Cage> made = createCage(mesh, options, &built.report);
  built.status = made.status();
  if (made.ok()) built.cage = std::move(made).value();
  return built;
}

}  // namespace tetskin::test
