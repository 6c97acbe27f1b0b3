// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to SystemSolve: the bodies of a system, with the ends of its rows on each of them. The ends on one body
// touch no other body, so that bodies are processed side by side.
#pragma once

#include <tetskin/core/src/base/run_by_size.h>
#include <tetskin/solver/src/rows/contact_rows.h>
#include <tetskin/solver/src/system/other_forces.h>

#include <algorithm>
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

/// What the solve of a system reads, and where it writes: the step's.
struct SystemInput {
  SolverBodies& bodies;
  const ContactRows& rows;
  RigidUnknowns& rigids;
  OtherForces& others;
};

/// A body of the system.
struct SystemBody {
  /// A body when a pass began, before rows were added to its residual.
  struct PassStart {
    std::vector<btScalar> solution, residual;  ///< in the wide layout
    double byMatrix = 0.0, byMasses = 0.0;     ///< squares of the solution, as `limitsOfPass` adds
  };

  SystemBody(std::size_t number, SolvedBody& of) : index(number), solved(of), ends(of.dynamics->matrix()) {}
  Dynamics& dynamics() const { return *solved.dynamics; }
  elastic_detail::BlockMatrix<btScalar>& matrix() const { return solved.dynamics->matrix(); }

  std::size_t index;  ///< in SolverBodies::bodies
  SolvedBody& solved;
  BodyEnds ends;
  // Of the current pass.
  std::vector<std::uint32_t> coupled;  ///< those of `ends` that it couples to anything else
  bool moves = true;                   ///< others keep their solutions
  PassStart start;
};

/// Work on bodies runs in parallel over bodies, and work on rows over rows; sums over bodies and rows are in their
/// order.
class SystemBodies {
 public:
  /// system  of the bodies of the input, whose places in it are set
  SystemBodies(const SystemInput& input, const SolvedSystem& system, ParallelFor* threads);

  std::vector<SystemBody>& list() { return bodies_; }
  const std::vector<SystemBody>& list() const { return bodies_; }
  const SystemInput& input() const { return in_; }
  const SolvedSystem& system() const { return system_; }
  ParallelFor* threads() const { return threads_; }

  std::size_t rowCount() const { return system_.rows.size(); }
  bool hasRows() const { return !system_.rows.empty(); }
  bool hasForces() const { return !system_.forces.empty(); }
  ContactRow& row(std::size_t r) const { return *system_.rows[r]; }
  /// The point of an end that is soft.
  const CarriedPoint& pointOf(std::size_t row, std::size_t index) const {
    return in_.rows.originOf(*system_.rows[row]).points[index];
  }
  /// True if a row connects two points of soft bodies.
  bool joinsSoft() const { return joinsSoft_; }

  /// Calls call(body, inner) for each body.
  template <class Call>
  void forEachBody(Call&& call) {
    runBySize(
        threads_, sizes_, [&](std::size_t k) { return elastic_detail::isDivisible(sizes_[k]); },
        [&](std::size_t k, ParallelFor* inner) { call(bodies_[k], inner); });
  }
  /// Calls call(r) for each row.
  template <class Call>
  void forEachRow(Call&& call) const {
    // Enough work that handing it out costs little.
    constexpr std::size_t kRowsPerTask = 128;
    const std::size_t count = rowCount();
    runTasks(threads_, (count + kRowsPerTask - 1) / kRowsPerTask, [&](std::size_t task) {
      for (std::size_t r = task * kRowsPerTask; r < std::min(count, (task + 1) * kRowsPerTask); ++r) call(r);
    });
  }

 private:
  void collectEnds();

  SystemInput in_;
  const SolvedSystem& system_;
  ParallelFor* threads_;
  bool joinsSoft_ = false;
  std::vector<SystemBody> bodies_;
  std::vector<std::size_t> sizes_;  ///< by body: slots
};

}  // namespace tetskin::bullet_detail
