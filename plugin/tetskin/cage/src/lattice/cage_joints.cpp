// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The triangles of a node's star opposite to the node tile a sphere. If the kept ones and the missing ones are each
// connected by edges, they meet in one simple closed curve (by the Jordan curve theorem), which makes the boundary a
// manifold. That includes the edges at the node, which are the corners of the tiling.
#include <tetskin/cage/src/lattice/cage_joints.h>

#include <algorithm>
#include <cassert>

namespace tetskin::cage_detail {
namespace {

/// The bits of all tets around a node.
constexpr std::uint32_t kWholeStar = (1u << kStarSize) - 1;

using Links = std::array<std::uint32_t, kStarSize>;

int bitCount(std::uint32_t bits) {
  int count = 0;
  for (; bits != 0; bits &= bits - 1) ++count;
  return count;
}

/// Union of the neighbours of the given tets within the star.
std::uint32_t neighboursOf(std::uint32_t tets, const Links& links) {
  std::uint32_t result = 0;
  for (int t = 0; t < kStarSize; ++t) {
    if (tets >> t & 1) result |= links[t];
  }
  return result;
}

/// The connected component of `within` that contains its lowest tet.
std::uint32_t firstComponent(std::uint32_t within, const Links& links) {
  assert(within != 0);
  std::uint32_t component = 0;
  std::uint32_t grown = within & (~within + 1);
  while (grown != component) {
    component = grown;
    grown = (component | neighboursOf(component, links)) & within;
  }
  return component;
}

/// The smallest number of missing tets that connect one component of the kept tets with another.
std::uint32_t shortestBridge(std::uint32_t kept, std::uint32_t component, const Links& links) {
  assert(component != 0 && (kept & component) == component && kept != component);
  std::array<std::uint32_t, kStarSize> rings{};  // rings[k]: tets at distance k from the component
  std::uint32_t reached = component;
  int k = 0;
  for (rings[0] = component; (rings[k] & kept & ~component) == 0; ++k) {
    rings[k + 1] = neighboursOf(rings[k], links) & ~reached;
    reached |= rings[k + 1];
  }
  std::uint32_t bridge = 0;
  std::uint32_t step = rings[k] & kept & ~component;
  for (--k; k > 0; --k) {
    step = neighboursOf(step & (~step + 1), links) & rings[k];
    step &= ~step + 1;
    bridge |= step;
  }
  return bridge;
}

/// Tets of the star to add so that it becomes one component with one complement; 0 if it already is.
std::uint32_t missingTets(std::uint32_t kept, const Links& links) {
  assert((kept & ~kWholeStar) == 0);
  if (kept == 0 || kept == kWholeStar) return 0;
  const std::uint32_t component = firstComponent(kept, links);
  if (component != kept) return shortestBridge(kept, component, links);
  std::uint32_t largest = 0;
  const std::uint32_t missing = kWholeStar & ~kept;
  for (std::uint32_t rest = missing; rest != 0;) {
    const std::uint32_t hole = firstComponent(rest, links);
    if (bitCount(hole) > bitCount(largest)) largest = hole;
    rest &= ~hole;
  }
  return missing & ~largest;
}

class Joiner {
 public:
  explicit Joiner(LatticeSet& set) : set_(set) {}

  std::size_t run() {
    const std::size_t before = set_.tetCount();
    for (const std::int32_t i : columnOrder(set_)) {
      for (int local = 0; local < kTetsPerCube; ++local) {
        if (set_.mask(i) >> local & 1) enqueueNodes({set_.cube(i), local});
      }
    }
    while (!queue_.empty()) {
      const LatticeNode node = queue_.back();
      queue_.pop_back();
      queued_.remove(node);
      repair(node);
    }
    return set_.tetCount() - before;
  }

 private:
  /// The set of nodes in the queue.
  class NodeSet {
   public:
    bool add(const LatticeNode& node) {
      char& bits = bitsOf(node);
      const auto bit = static_cast<char>(1 << node.kind);
      if (bits & bit) return false;
      bits = static_cast<char>(bits | bit);
      return true;
    }
    void remove(const LatticeNode& node) {
      char& bits = bitsOf(node);
      bits = static_cast<char>(bits & ~(1 << node.kind));
    }

   private:
    char& bitsOf(const LatticeNode& node) {
      const auto i = static_cast<std::size_t>(cubes_.insert(node.cube));
      if (i == bits_.size()) bits_.push_back(0);
      return bits_[i];
    }
    LatticeSet cubes_;
    std::vector<char> bits_;
  };

  void enqueueNodes(const LatticeTet& tet) {
    for (const LatticeNode& node : nodesOf(tet)) {
      if (queued_.add(node)) queue_.push_back(node);
    }
  }

  void repair(const LatticeNode& node) {
    const LatticeTables& tables = latticeTables();
    std::uint32_t kept = 0;
    for (int t = 0; t < kStarSize; ++t) {
      kept |= (set_.contains(node.cube + tables.star[node.kind][t]) ? 1u : 0u) << t;
    }
    const std::uint32_t missing = missingTets(kept, tables.starLinks[node.kind]);
    for (int t = 0; t < kStarSize; ++t) {
      if ((missing >> t & 1) == 0) continue;
      const LatticeTet tet = node.cube + tables.star[node.kind][t];
      set_.add(tet);
      enqueueNodes(tet);
    }
  }

  LatticeSet& set_;
  NodeSet queued_;
  std::vector<LatticeNode> queue_;
};

}  // namespace

std::size_t joinPinches(LatticeSet& set) {
  return Joiner(set).run();
}

}  // namespace tetskin::cage_detail
