// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/mesh/mesh_checks.h>
#include <tetskin/core/src/base/mesh/quadratic_assembly.h>
#include <tetskin/core/src/base/mesh/uniform_refinement.h>
#include <tetskin/io/src/tets/high_order_tets.h>
#include <tetskin/io/src/text/file_text.h>

#include <algorithm>
#include <cassert>

namespace tetskin::io {

namespace {

struct HalvedEdge {
  std::array<int, 2> ends;  ///< ascending
  int middle;
  std::size_t line;  ///< of a tet that has it
};

bool hasLowerEnds(const HalvedEdge& a, const HalvedEdge& b) {
  return a.ends < b.ends;
}

std::array<int, 2> edgeOf(const Tet& tet, std::size_t e) {
  const auto [a, b] = std::minmax(tet[kTetEdges[e][0]], tet[kTetEdges[e][1]]);
  return {a, b};
}

template <class Value>
void repeat(std::vector<Value>& values, const std::vector<std::size_t>& from) {
  if (values.empty()) return;
  std::vector<Value> repeated;
  repeated.reserve(from.size());
  for (const std::size_t t : from) repeated.push_back(values[t]);
  values = std::move(repeated);
}

class Cutter {
 public:
  Cutter(FileCage& file, TetFileReport& report) : file_(file), mesh_(file.cage.mesh), report_(report) {}

  Status cut(ReadAs as);

 private:
  Status checkNodes(const HighOrderTet& tet) const;
  Status collectEdges();
  Status uniteEdges();
  bool isHalved(const std::array<int, 2>& ends) const;
  Status checkLinearTets() const;
  void placeMiddles(const std::vector<Eigen::Vector3d>& given);
  void cutTets();
  Status malformed(std::size_t line, const std::string& what) const {
    return fileError(StatusCode::Malformed, file_.path, line, what);
  }

  FileCage& file_;
  TetMesh& mesh_;
  TetFileReport& report_;
  std::vector<HalvedEdge> edges_;
};

Status Cutter::cut(ReadAs as) {
  assert(!file_.highOrder.empty());
  Status status = collectEdges();
  if (!status.ok()) return status;
  if (status = checkLinearTets(); !status.ok()) return status;
  status = checkTetCounts(mesh_.nodeCount(), kSubTets * mesh_.tetCount());
  if (!status.ok()) return fileError(status.code, file_.path, 0, status.message);
  const std::vector<Eigen::Vector3d> given = mesh_.nodes;
  placeMiddles(given);
  cutTets();
  if (as == ReadAs::Tets) {
    mesh_.nodes = given;
    report_.movedNodes = 0;
    report_.farthestMove = 0.0;
  }
  return {};
}

Status Cutter::checkNodes(const HighOrderTet& tet) const {
  std::vector<int> nodes(mesh_.tets[tet.tet].begin(), mesh_.tets[tet.tet].end());
  nodes.insert(nodes.end(), tet.middles.begin(), tet.middles.end());
  std::sort(nodes.begin(), nodes.end());
  if (std::adjacent_find(nodes.begin(), nodes.end()) == nodes.end()) return {};
  return malformed(tet.line, "tet " + std::to_string(tet.tet) +
                                 " of the file, counted from 0, is of second order, and names a node twice; correct "
                                 "the tet");
}

Status Cutter::collectEdges() {
  for (const HighOrderTet& tet : file_.highOrder) {
    if (Status status = checkNodes(tet); !status.ok()) return status;
    for (std::size_t e = 0; e < 6; ++e) edges_.push_back({edgeOf(mesh_.tets[tet.tet], e), tet.middles[e], tet.line});
  }
  if (Status status = uniteEdges(); !status.ok()) return status;
  std::vector<int> middles;
  for (const HalvedEdge& edge : edges_) middles.push_back(edge.middle);
  std::sort(middles.begin(), middles.end());
  const auto twice = std::adjacent_find(middles.begin(), middles.end());
  if (twice == middles.end()) return {};
  const auto edge = std::find_if(edges_.begin(), edges_.end(), [&](const auto& e) { return e.middle == *twice; });
  return malformed(edge->line, "a node is in the middle of two edges; is the order of the nodes right? Save it again");
}

/// Keeps each edge once.
Status Cutter::uniteEdges() {
  std::stable_sort(edges_.begin(), edges_.end(), hasLowerEnds);
  std::vector<HalvedEdge> unique;
  for (const HalvedEdge& edge : edges_) {
    if (unique.empty() || unique.back().ends != edge.ends) {
      unique.push_back(edge);
    } else if (edge.middle != unique.back().middle) {
      return malformed(edge.line,
                       "two tets have different nodes in the middle of an edge that they share; merge these nodes");
    }
  }
  edges_ = std::move(unique);
  return {};
}

bool Cutter::isHalved(const std::array<int, 2>& ends) const {
  return std::binary_search(edges_.begin(), edges_.end(), HalvedEdge{ends, -1, 0}, hasLowerEnds);
}

Status Cutter::checkLinearTets() const {
  auto high = file_.highOrder.begin();
  for (std::size_t t = 0; t < mesh_.tetCount(); ++t) {
    if (high != file_.highOrder.end() && high->tet == t) {
      ++high;
      continue;
    }
    for (std::size_t e = 0; e < 6; ++e) {
      if (!isHalved(edgeOf(mesh_.tets[t], e))) continue;
      return fileError(
          StatusCode::UnsupportedFormat, file_.path, 0,
          "has tets of second order, and beside them tets of first order with the same edges, such as tet " +
              std::to_string(t) + ", counted from 0; save all of them at second order, or none");
    }
  }
  return {};
}

/// Moves the nodes to the middles of their edges.
void Cutter::placeMiddles(const std::vector<Eigen::Vector3d>& given) {
  for (const HalvedEdge& edge : edges_) {
    const Eigen::Vector3d &a = given[edge.ends[0]], &b = given[edge.ends[1]], middle = 0.5 * (a + b);
    const double distance = (given[edge.middle] - middle).norm();
    mesh_.nodes[edge.middle] = middle;
    if (distance <= kMidpointTolerance * (b - a).norm()) continue;
    ++report_.movedNodes;
    report_.farthestMove = std::max(report_.farthestMove, distance);
  }
}

void Cutter::cutTets() {
  const std::vector<Tet> whole = std::move(mesh_.tets);
  mesh_.tets.clear();
  Cage& cage = file_.cage;
  std::vector<int> numbers;
  std::vector<std::size_t> from;  // by new tet
  auto high = file_.highOrder.begin();
  for (std::size_t t = 0; t < whole.size(); ++t) {
    const std::size_t first = mesh_.tetCount();
    int number = -1;
    if (high != file_.highOrder.end() && high->tet == t) {
      const std::array<Tet, kSubTets> eight = refinedTet(whole[t], high->middles, mesh_.nodes);
      ++high;
      mesh_.tets.insert(mesh_.tets.end(), eight.begin(), eight.end());
      std::array<int, kSubTets> tets{};
      for (std::size_t k = 0; k < kSubTets; ++k) tets[k] = static_cast<int>(first + k);
      if (assembleQuadraticTet(mesh_, tets)) number = static_cast<int>(report_.quadraticTets++);
    } else {
      mesh_.tets.push_back(whole[t]);
    }
    numbers.resize(mesh_.tetCount(), number);
    from.resize(mesh_.tetCount(), t);
  }
  cage.quadraticTet = report_.quadraticTets > 0 ? std::move(numbers) : std::vector<int>();
  repeat(cage.volumeFraction, from);
  repeat(cage.stiffnessFactor, from);
  repeat(cage.paintedStiffness, from);
  repeat(cage.paintedDensity, from);
  repeat(cage.paintedDamping, from);
  repeat(cage.component, from);
  // Data about duplicates, and about parts of tets, does not apply to the parts.
  cage.vertexTets.clear();
  cage.sourceTet.clear();
  cage.fineVolumeFraction.clear();
}

}  // namespace

Status cutHighOrderTets(ReadAs as, FileCage& file, TetFileReport& report) {
  return file.highOrder.empty() ? Status() : Cutter(file, report).cut(as);
}

}  // namespace tetskin::io
