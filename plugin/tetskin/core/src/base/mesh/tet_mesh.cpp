// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/mesh.h>
#include <tetskin/core/src/base/mesh/mesh_checks.h>
#include <tetskin/core/src/base/mesh/tet_geometry.h>

#include <algorithm>
#include <numeric>

namespace tetskin {
namespace {

void add(TetMeshReport::Fault& fault, std::size_t where) {
  if (fault.count++ == 0) fault.first = where;
}

bool inRange(const Tet& tet, std::size_t nodeCount) {
  return std::all_of(tet.begin(), tet.end(), [&](int n) { return n >= 0 && static_cast<std::size_t>(n) < nodeCount; });
}

template <class Key>
Key sorted(Key key) {
  std::sort(key.begin(), key.end());
  return key;
}

bool repeatsNode(const Tet& t) {
  return t[0] == t[1] || t[0] == t[2] || t[0] == t[3] || t[1] == t[2] || t[1] == t[3] || t[2] == t[3];
}

/// Indices of keys, sorted by key and then by index.
template <class Key>
std::vector<std::size_t> orderOf(const std::vector<Key>& keys) {
  std::vector<std::size_t> order(keys.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return keys[a] != keys[b] ? keys[a] < keys[b] : a < b; });
  return order;
}

void countShapes(const TetMesh& mesh, TetMeshReport& report) {
  for (std::size_t t = 0; t < mesh.tetCount(); ++t) {
    const Tet& tet = mesh.tets[t];
    if (!inRange(tet, mesh.nodeCount())) {
      add(report.indexOutOfRange, t);
    } else if (repeatsNode(tet)) {
      add(report.repeatedNode, t);
    } else if (const TetCorners p = cornersOf(mesh, tet); isFlat(p)) {
      add(report.zeroVolume, t);
    } else if (signedVolume(p) < 0.0) {
      add(report.negativeVolume, t);
    }
  }
}

void countDuplicates(const TetMesh& mesh, TetMeshReport& report) {
  std::vector<Tet> keys(mesh.tetCount());
  std::transform(mesh.tets.begin(), mesh.tets.end(), keys.begin(), sorted<Tet>);
  const std::vector<std::size_t> order = orderOf(keys);
  std::vector<std::size_t> repeats;
  for (std::size_t k = 1; k < order.size(); ++k) {
    if (keys[order[k]] == keys[order[k - 1]]) repeats.push_back(order[k]);
  }
  if (repeats.empty()) return;
  report.duplicateTets = {repeats.size(), *std::min_element(repeats.begin(), repeats.end())};
}

void countUnreferencedNodes(const TetMesh& mesh, TetMeshReport& report) {
  std::vector<char> used(mesh.nodeCount(), 0);
  for (const Tet& tet : mesh.tets) {
    if (!inRange(tet, mesh.nodeCount())) continue;
    for (const int n : tet) used[n] = 1;
  }
  for (std::size_t n = 0; n < mesh.nodeCount(); ++n) {
    if (!used[n]) add(report.unreferencedNodes, n);
  }
}

}  // namespace

bool TetMeshReport::clean() const {
  return indexOutOfRange.count + nonFiniteNodes.count + repeatedNode.count + zeroVolume.count + negativeVolume.count +
             duplicateTets.count + unreferencedNodes.count ==
         0;
}

std::string TetMeshReport::describe() const {
  std::string text;
  const auto line = [&](const Fault& fault, const char* what, const char* element) {
    if (fault.count == 0) return;
    text += std::to_string(fault.count) + " " + what + " (the first is " + element + " " + std::to_string(fault.first) +
            ")\n";
  };
  line(indexOutOfRange, "tets with an index out of range", "tet");
  line(nonFiniteNodes, "nodes with coordinates that are not finite", "node");
  line(repeatedNode, "tets with a repeated node", "tet");
  line(zeroVolume, "tets without volume", "tet");
  line(negativeVolume, "tets with reversed orientation", "tet");
  line(duplicateTets, "duplicate tets", "tet");
  line(unreferencedNodes, "nodes that no tet uses", "node");
  return text;
}

TetMeshReport inspectForUse(const TetMesh& mesh) {
  TetMeshReport report;
  for (std::size_t n = 0; n < mesh.nodeCount(); ++n) {
    if (!mesh.nodes[n].allFinite()) add(report.nonFiniteNodes, n);
  }
  countShapes(mesh, report);
  return report;
}

TetMeshReport checkTetMesh(const TetMesh& mesh) {
  TetMeshReport report = inspectForUse(mesh);
  countDuplicates(mesh, report);
  countUnreferencedNodes(mesh, report);
  return report;
}

Status checkTetCounts(std::size_t nodes, std::size_t tets) {
  if (nodes <= Limits::kMaxTets && tets <= Limits::kMaxTets) return {};
  const bool excess = nodes > Limits::kMaxTets;
  return {StatusCode::TooLarge, "the cage has " + std::to_string(excess ? nodes : tets) +
                                    (excess ? " nodes" : " tets") + ", more than the " +
                                    std::to_string(Limits::kMaxTets) + " that are supported; make a coarser one"};
}

Status validate(const TetMesh& mesh, const TetMeshReport& report) {
  const auto first = [](const TetMeshReport::Fault& fault) { return std::to_string(fault.first); };
  if (mesh.tets.empty()) return {StatusCode::Empty, "the cage has no tets"};
  if (Status status = checkTetCounts(mesh.nodeCount(), mesh.tetCount()); !status.ok()) return status;
  if (report.indexOutOfRange.count > 0) {
    return {StatusCode::IndexOutOfRange, "tet " + first(report.indexOutOfRange) +
                                             " of the cage refers to a node that does not exist; there are " +
                                             std::to_string(mesh.nodeCount()) + " nodes; correct the tet"};
  }
  if (report.nonFiniteNodes.count > 0) {
    return {StatusCode::NonFinite,
            "node " + first(report.nonFiniteNodes) + " of the cage has a coordinate that is not finite; correct it"};
  }
  if (report.zeroVolume.count + report.repeatedNode.count == mesh.tetCount()) {
    return {StatusCode::Degenerate, "all " + std::to_string(mesh.tetCount()) +
                                        " tets of the cage are flat; is it a surface? Fill its inside with tets"};
  }
  return {};
}

Status validate(const TetMesh& mesh) {
  return validate(mesh, inspectForUse(mesh));
}

TetMeshReport repairTetMesh(TetMesh& mesh) {
  TetMeshReport report = checkTetMesh(mesh);
  if (report.indexOutOfRange.count + report.nonFiniteNodes.count > 0 || report.negativeVolume.count == 0) return report;
  for (Tet& tet : mesh.tets) {
    const TetCorners p = cornersOf(mesh, tet);
    if (!isFlat(p) && signedVolume(p) < 0.0) std::swap(tet[2], tet[3]);
  }
  return report;
}

double totalVolume(const TetMesh& mesh) {
  double sum = 0.0;
  for (const Tet& tet : mesh.tets) sum += std::abs(signedVolume(cornersOf(mesh, tet)));
  return sum;
}

std::vector<std::array<int, 2>> uniqueEdges(const TetMesh& mesh) {
  // By their corners, in the order that the header promises.
  constexpr int kEdges[6][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
  std::vector<std::array<int, 2>> edges;
  edges.reserve(6 * mesh.tetCount());
  for (const Tet& tet : mesh.tets) {
    for (const auto& e : kEdges) edges.push_back({tet[e[0]], tet[e[1]]});
  }
  std::vector<std::array<int, 2>> keys(edges.size());
  std::transform(edges.begin(), edges.end(), keys.begin(), sorted<std::array<int, 2>>);
  const std::vector<std::size_t> order = orderOf(keys);

  std::vector<std::size_t> firsts;
  for (std::size_t k = 0; k < order.size(); ++k) {
    if (k == 0 || keys[order[k]] != keys[order[k - 1]]) firsts.push_back(order[k]);
  }
  std::sort(firsts.begin(), firsts.end());
  std::vector<std::array<int, 2>> unique(firsts.size());
  std::transform(firsts.begin(), firsts.end(), unique.begin(), [&](std::size_t i) { return edges[i]; });
  return unique;
}

std::vector<std::array<int, 3>> boundaryFaces(const TetMesh& mesh) {
  // By their corners, counter-clockwise from outside.
  constexpr int kFaces[4][3] = {{1, 0, 2}, {3, 0, 1}, {3, 1, 2}, {2, 0, 3}};
  std::vector<std::array<int, 3>> faces;
  faces.reserve(4 * mesh.tetCount());
  for (const Tet& tet : mesh.tets) {
    for (const auto& f : kFaces) faces.push_back({tet[f[0]], tet[f[1]], tet[f[2]]});
  }
  std::vector<std::array<int, 3>> keys(faces.size());
  std::transform(faces.begin(), faces.end(), keys.begin(), sorted<std::array<int, 3>>);
  const std::vector<std::size_t> order = orderOf(keys);

  std::vector<std::array<int, 3>> boundary;
  for (std::size_t k = 0; k < order.size();) {
    std::size_t next = k + 1;
    while (next < order.size() && keys[order[next]] == keys[order[k]]) ++next;
    if ((next - k) % 2 == 1) boundary.push_back(faces[order[next - 1]]);
    k = next;
  }
  return boundary;
}

}  // namespace tetskin
