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

/// An edge that is halved.
struct HalvedEdge {
  std::array<int, 2> ends;  ///< ascending
  int middle;               ///< -1: to be made
  std::size_t line;         ///< of a tet that has it
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

  Status cut(CurvedEdges curved);

 private:
  Status checkNodes(HighOrderTet& tet) const;
  bool sortMiddles(HighOrderTet& tet) const;
  Status collectEdges();
  Status uniteEdges();
  bool isHalved(const std::array<int, 2>& ends) const;
  bool meetsLinearTets() const;
  void addLinearTets();
  bool isLinear(std::size_t tet) const;
  void placeMiddles();
  void cutTets();
  void dropSpareNodes();
  Status malformed(std::size_t line, const std::string& what) const {
    return fileError(StatusCode::Malformed, file_.path, line, what);
  }

  FileCage& file_;
  TetMesh& mesh_;
  TetFileReport& report_;
  std::vector<HalvedEdge> edges_;
  bool cutsLinear_ = false;
};

Status Cutter::cut(CurvedEdges curved) {
  assert(!file_.highOrder.empty());
  Status status = collectEdges();
  if (!status.ok()) return status;
  cutsLinear_ = meetsLinearTets();
  if (cutsLinear_) addLinearTets();
  status = checkTetCounts(mesh_.nodeCount() + edges_.size(), kSubTets * mesh_.tetCount());
  if (!status.ok()) return fileError(status.code, file_.path, 0, status.message);
  const std::vector<Eigen::Vector3d> given = mesh_.nodes;
  placeMiddles();
  cutTets();
  if (curved == CurvedEdges::Kept) {
    std::copy(given.begin(), given.end(), mesh_.nodes.begin());
    report_.movedNodes = 0;
    report_.farthestMove = 0.0;
  }
  dropSpareNodes();
  return {};
}

/// Puts the nodes on the edges into order, by their positions.
bool Cutter::sortMiddles(HighOrderTet& tet) const {
  std::array<int, 6> sorted{-1, -1, -1, -1, -1, -1};
  for (const int node : tet.middles) {
    std::array<double, 6> distances{};
    for (std::size_t e = 0; e < 6; ++e) {
      const auto [a, b] = edgeOf(mesh_.tets[tet.tet], e);
      distances[e] = (mesh_.nodes[node] - 0.5 * (mesh_.nodes[a] + mesh_.nodes[b])).norm();
    }
    const auto nearest = std::min_element(distances.begin(), distances.end()) - distances.begin();
    sorted[static_cast<std::size_t>(nearest)] = node;
  }
  tet.middles = sorted;
  return std::count(sorted.begin(), sorted.end(), -1) == 0;
}

Status Cutter::checkNodes(HighOrderTet& tet) const {
  std::vector<int> nodes(mesh_.tets[tet.tet].begin(), mesh_.tets[tet.tet].end());
  const bool given = tet.middles[0] >= 0;
  if (given) nodes.insert(nodes.end(), tet.middles.begin(), tet.middles.end());
  std::sort(nodes.begin(), nodes.end());
  const std::string name = "tet " + std::to_string(tet.tet) + " of the file, counted from 0, ";
  if (std::adjacent_find(nodes.begin(), nodes.end()) != nodes.end()) {
    return malformed(tet.line, name + "is of second or higher order, and names a node twice; correct the tet");
  }
  if (!given || !file_.anyOrder || sortMiddles(tet)) return {};
  return malformed(tet.line, name +
                                 "has nodes on its edges that are far from the middles, or two on one edge; save the "
                                 "mesh with straight edges, or as VTK or Gmsh");
}

Status Cutter::collectEdges() {
  for (HighOrderTet& tet : file_.highOrder) {
    if (Status status = checkNodes(tet); !status.ok()) return status;
    for (std::size_t e = 0; e < 6; ++e) edges_.push_back({edgeOf(mesh_.tets[tet.tet], e), tet.middles[e], tet.line});
  }
  if (Status status = uniteEdges(); !status.ok()) return status;
  std::vector<int> middles;
  for (const HalvedEdge& edge : edges_) {
    if (edge.middle >= 0) middles.push_back(edge.middle);
  }
  std::sort(middles.begin(), middles.end());
  const auto twice = std::adjacent_find(middles.begin(), middles.end());
  if (twice == middles.end()) return {};
  const auto edge = std::find_if(edges_.begin(), edges_.end(), [&](const auto& e) { return e.middle == *twice; });
  return malformed(edge->line, "a node is in the middle of two edges; is the order of the nodes right? Save it again");
}

/// Leaves each edge once.
Status Cutter::uniteEdges() {
  std::stable_sort(edges_.begin(), edges_.end(), hasLowerEnds);
  std::vector<HalvedEdge> unique;
  for (const HalvedEdge& edge : edges_) {
    if (unique.empty() || unique.back().ends != edge.ends) {
      unique.push_back(edge);
    } else if (unique.back().middle < 0) {
      unique.back().middle = edge.middle;
    } else if (edge.middle >= 0 && edge.middle != unique.back().middle) {
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

bool Cutter::isLinear(std::size_t tet) const {
  return !std::binary_search(file_.highOrder.begin(), file_.highOrder.end(), HighOrderTet{tet, {}, 0},
                             [](const HighOrderTet& a, const HighOrderTet& b) { return a.tet < b.tet; });
}

bool Cutter::meetsLinearTets() const {
  for (std::size_t t = 0; t < mesh_.tetCount(); ++t) {
    for (std::size_t e = 0; e < 6 && isLinear(t); ++e) {
      if (isHalved(edgeOf(mesh_.tets[t], e))) return true;
    }
  }
  return false;
}

void Cutter::addLinearTets() {
  report_.cutLinearTets = mesh_.tetCount() - file_.highOrder.size();
  for (std::size_t t = 0; t < mesh_.tetCount(); ++t) {
    for (std::size_t e = 0; e < 6 && isLinear(t); ++e) edges_.push_back({edgeOf(mesh_.tets[t], e), -1, 0});
  }
  const Status united = uniteEdges();
  assert(united.ok());  // nothing is named that could differ
  (void)united;
}

/// Makes the nodes that are missing, and moves the others to the middles of their edges.
void Cutter::placeMiddles() {
  const std::size_t before = mesh_.nodeCount();
  const std::vector<Eigen::Vector3d> given = mesh_.nodes;
  for (HalvedEdge& edge : edges_) {
    const Eigen::Vector3d &a = given[edge.ends[0]], &b = given[edge.ends[1]], middle = 0.5 * (a + b);
    if (edge.middle < 0) {
      edge.middle = static_cast<int>(mesh_.nodeCount());
      mesh_.nodes.push_back(middle);
      continue;
    }
    const double distance = (given[edge.middle] - middle).norm();
    mesh_.nodes[edge.middle] = middle;
    if (distance <= kMidpointTolerance * (b - a).norm()) continue;
    ++report_.movedNodes;
    report_.farthestMove = std::max(report_.farthestMove, distance);
  }
  if (mesh_.nodeCount() > before) file_.cage.masses.clear();  // those of the new nodes are unknown
}

void Cutter::cutTets() {
  const std::vector<Tet> whole = std::move(mesh_.tets);
  mesh_.tets.clear();
  Cage& cage = file_.cage;
  std::vector<int> numbers;
  std::vector<std::size_t> from;  // by new tet
  for (std::size_t t = 0, high = 0; t < whole.size(); ++t) {
    const bool quadratic = high < file_.highOrder.size() && file_.highOrder[high].tet == t;
    high += quadratic;
    const std::size_t first = mesh_.tetCount();
    if (quadratic || cutsLinear_) {
      std::array<int, 6> middles{};
      for (std::size_t e = 0; e < 6; ++e) {
        middles[e] =
            std::lower_bound(edges_.begin(), edges_.end(), HalvedEdge{edgeOf(whole[t], e), -1, 0}, hasLowerEnds)
                ->middle;
      }
      const std::array<Tet, kSubTets> eight = refinedTet(whole[t], middles, mesh_.nodes);
      mesh_.tets.insert(mesh_.tets.end(), eight.begin(), eight.end());
    } else {
      mesh_.tets.push_back(whole[t]);
    }
    int number = -1;
    if (quadratic) {
      std::array<int, kSubTets> tets{};
      for (std::size_t k = 0; k < kSubTets; ++k) tets[k] = static_cast<int>(first + k);
      if (assembleQuadraticTet(mesh_, tets)) number = static_cast<int>(report_.quadraticTets++);
    }
    numbers.resize(mesh_.tetCount(), number);
    from.resize(mesh_.tetCount(), t);
  }
  cage.quadraticTet = report_.quadraticTets > 0 ? std::move(numbers) : std::vector<int>();
  repeat(cage.volumeFraction, from);
  repeat(cage.stiffnessFactor, from);
  repeat(cage.component, from);
  // What is known of duplicates, and of parts of tets, is not known of the parts.
  cage.vertexTets.clear();
  cage.sourceTet.clear();
  cage.fineVolumeFraction.clear();
}

void Cutter::dropSpareNodes() {
  const std::size_t count = mesh_.nodeCount();
  std::vector<bool> dropped(count, false);
  for (const std::int64_t node : file_.spareNodes) {
    if (node >= 0 && static_cast<std::uint64_t>(node) < count) dropped[static_cast<std::size_t>(node)] = true;
  }
  for (const Tet& tet : mesh_.tets) {
    for (const int node : tet) dropped[static_cast<std::size_t>(node)] = false;
  }
  std::vector<double>& masses = file_.cage.masses;
  std::vector<int> numbers(count, -1);
  std::size_t kept = 0;
  for (std::size_t n = 0; n < count; ++n) {
    if (dropped[n]) continue;
    mesh_.nodes[kept] = mesh_.nodes[n];
    if (!masses.empty()) masses[kept] = masses[n];
    numbers[n] = static_cast<int>(kept++);
  }
  report_.droppedNodes = count - kept;
  mesh_.nodes.resize(kept);
  if (!masses.empty()) masses.resize(kept);
  for (Tet& tet : mesh_.tets) {
    for (int& node : tet) node = numbers[static_cast<std::size_t>(node)];
  }
}

}  // namespace

Status cutHighOrderTets(CurvedEdges curved, FileCage& file, TetFileReport& report) {
  return file.highOrder.empty() ? Status() : Cutter(file, report).cut(curved);
}

}  // namespace tetskin::io
