// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to SystemSolve: the bodies of a system, with the ends of its rows on each of them.
#pragma once

#include <tetskin/core/src/base/run_by_size.h>
#include <tetskin/solver/src/rows/contact_rows.h>
#include <tetskin/solver/src/system/body_ends.h>
#include <tetskin/solver/src/system/other_forces.h>

#include <algorithm>
#include <vector>

namespace tetskin::bullet_detail {

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
