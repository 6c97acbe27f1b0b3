// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to DeformableSolver: the ends of a system's rows on one body. Nothing here touches another body, so that
// bodies are processed side by side.
#pragma once

#include <tetskin/solver/src/forces/forced_bodies.h>
#include <tetskin/solver/src/rows/contact_row.h>

#include <cstdint>
#include <optional>
#include <vector>

namespace tetskin::bullet_detail {

/// One end of a row on the body.
struct BodyEnd {
  std::uint32_t row = 0;              ///< in the system's rows
  std::uint32_t index = 0;            ///< 0 or 1: which of the row's ends
  std::uint32_t first = 0, last = 0;  ///< its nodes, in `BodyEnds`
  /// Whether the row couples its body to another one, or to the reduced unknowns, in the current pass.
  bool byOther = false, byReduced = false;
};

class BodyEnds {
 public:
  using Matrix = elastic_detail::BlockMatrix<btScalar>;
  using Rows = std::vector<ContactRow*>;

  /// matrix  the body's, which exists as long as this
  explicit BodyEnds(Matrix& matrix) : matrix_(&matrix) {}

  /// Call it for all first ends on the body, in the order of their rows, and then for all second ends.
  void add(std::size_t row, std::size_t index, const CarriedPoint& point);
  const std::vector<BodyEnd>& list() const { return ends_; }
  std::vector<BodyEnd>& list() { return ends_; }

  /// The velocity that the matrix's solution gives the end, and the one that its step gives it.
  btVector3 velocity(const BodyEnd& end) const;
  btVector3 stepVelocity(const BodyEnd& end) const;
  /// wide  vector of the body, in the wide layout
  void addImpulse(const BodyEnd& end, const btVector3& impulse, btScalar* wide) const;
  /// Adds the rows' tangents to the matrix, to each of its blocks once.
  /// rows  the system's
  void addTangents(const Rows& rows);

 private:
  using Coupling = std::optional<std::uint32_t>;
  using Blocks = btScalar[kMaxPointNodes][kMaxPointNodes][6];  // the lower triangle
  struct Node {
    std::uint32_t met = 0, slot = 0, wide = 0;  ///< the first one: in `met_`
    btScalar weight = 0;
  };
  /// A node on which ends act.
  struct MetNode {
    std::size_t node = 0;
    btScalar block[6] = {};  ///< what is added to its block on the diagonal
    bool used = false;
  };
  /// Ends at the same nodes.
  struct Group {
    std::uint32_t first = 0, last = 0;  ///< in `ends_`
    std::uint32_t couplings = 0;        ///< in `couplings_`: the first of those of its pairs of nodes
    bool coupled = false;               ///< these are known; they are looked up when they are needed
  };

  std::uint32_t metNode(std::size_t node);
  bool isOfLastGroup(std::size_t index, const CarriedPoint& point) const;
  void addGroup(std::uint32_t pairs);
  void findCouplings(Group& group);
  void addBlocks(Group& group, const Rows& rows);
  void addApart(const Group& group, const Rows& rows, std::uint32_t i, std::uint32_t j, Blocks& blocks) const;

  Matrix* matrix_;
  std::vector<MetNode> met_;
  std::vector<std::uint32_t> metAt_;  ///< by slot: its number in `met_` + 1; 0: none
  std::vector<Node> nodes_;
  std::vector<BodyEnd> ends_;
  std::vector<Group> groups_;
  std::vector<Coupling> couplings_;
};

}  // namespace tetskin::bullet_detail
