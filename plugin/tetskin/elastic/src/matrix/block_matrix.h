// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The matrix A = M + alpha K of one body: 3x3 blocks, one row per node, symmetric and positive. A gas in it adds u u^T,
// whose blocks would couple all nodes of its surface: products have it, sweeps do not. A large body is divided
// into parts, with separators between them, so that a Gauss-Seidel sweep processes first all parts and then all
// separators, on any number of threads. The rows of each are sorted by colour, so that eight of them are processed at
// once: see elastic_kernels.h.
#pragma once

#include <tetskin/core/src/base/aligned.h>
#include <tetskin/core/src/base/state/state_stream.h>
#include <tetskin/core/types.h>
#include <tetskin/elastic/src/base/elastic_kernels.h>
#include <tetskin/elastic/src/tets/rest_tets.h>

#include <cassert>
#include <cstdint>
#include <optional>
#include <vector>

namespace tetskin::elastic_detail {

/// True if it pays to divide a matrix of this many slots among threads: see kChunksPerRange in block_pattern.cpp.
constexpr bool isDivisible(std::size_t slots) {
  return slots >= 4096;
}

/// Which slot each node has, and which rows share blocks. Slots are numbered by row; some belong to no node.
struct BlockPattern {
  std::vector<std::uint32_t> slotOf;                         ///< by node
  std::vector<std::uint32_t> starts;                         ///< by chunk, 2 entries each, and the end
  std::vector<std::uint32_t> neighbours;                     ///< by entry, 8 each
  std::vector<std::uint32_t> sums;                           ///< by entry, and the end
  std::vector<std::uint32_t> terms;                          ///< 16 per term
  std::vector<std::uint32_t> quadraticSums, quadraticTerms;  ///< the same of quadratic tets
  std::vector<std::uint32_t>
      rangeChunks;                    ///< by range, and the end: its first chunk; rows of a range are not neighbours
  std::vector<std::uint32_t> tasks;   ///< by task, and the end: its first range; they are swept in this order
  std::vector<std::uint32_t> phases;  ///< by phase, and the end: its first task; rows of two tasks are not neighbours

  std::size_t chunkCount() const { return starts.size() / 2; }
  std::size_t slotCount() const { return chunkCount() * kernels::kGroup; }
  std::size_t rangeCount() const { return rangeChunks.size() - 1; }
  std::size_t taskCount() const { return tasks.size() - 1; }
};

/// rest  whose corners are the terms
/// Cost  O(T)
BlockPattern blockPattern(std::size_t nodes, const RestTets& rest);

template <class S>
class TETSKIN_ELASTIC_API BlockMatrix {
 public:
  BlockMatrix(std::size_t nodes, const RestTets& rest);

  const BlockPattern& pattern() const { return pattern_; }
  std::size_t nodeCount() const { return pattern_.slotOf.size(); }
  std::size_t slotCount() const { return pattern_.slotCount(); }
  std::size_t slotOf(std::size_t node) const {
    assert(node < nodeCount());
    return pattern_.slotOf[node];
  }
  /// Index of a node's first scalar in a wide vector; the next two follow at a distance of kGroup.
  std::size_t wideOf(std::size_t node) const { return wideOfSlot(slotOf(node)); }
  static std::size_t wideOfSlot(std::size_t slot) {
    return slot / kernels::kGroup * kernels::kWideVector + slot % kernels::kGroup;
  }
  std::size_t wideSize() const { return pattern_.chunkCount() * kernels::kWideVector; }
  /// A vector in the wide layout, by node. Lanes without a node are undefined, and 0 after reading.
  void serializeWide(StateStream& stream, S* wide) const;

  /// Masses by slot; 0: pinned. They take effect at the next assembly.
  S mass(std::size_t node) const { return masses_[slotOf(node)]; }
  S massAt(std::size_t slot) const {
    assert(slot < masses_.size());
    return masses_[slot];
  }
  void setMass(std::size_t node, S mass) { masses_[slotOf(node)] = mass; }
  double totalMass() const;

  /// See `elasticInUse`.
  void setDeterministic(bool on) { deterministic_ = on; }

  /// corners  see CorotatedTets::cornersForMatrix; null: no tets, so A = M
  /// ratio    lambda / mu
  /// spread   1 + sigma / mu, in a body that a tension sigma stretches in all directions: it resists rotations
  /// fibres   those of the tets
  void assemble(const S* corners, S ratio, ParallelFor* threads, S spread = S(1),
                const kernels::FibreLayers<S>& fibres = {});

  /// Fixes a node in all directions, in one direction, or in all but one.
  void fix(std::size_t node);
  void fixAlong(std::size_t node, const S normal[3]);
  void fixAllBut(std::size_t node, const S direction[3]);
  /// Adds a block, xx xy xz yy yz zz, without negative eigenvalues, to a node's diagonal block: resists the node's
  /// motion. Call it before the node is fixed.
  void resist(std::size_t node, const S block[6]);
  /// The number of a pair of nodes to be coupled, valid as long as the matrix; empty if both are the same node or share
  /// no tet: the matrix has no such block. Cost O(neighbours of a node)
  std::optional<std::uint32_t> couplingOf(std::size_t first, std::size_t second);
  /// Adds a symmetric block, xx xy xz yy yz zz, to the sum that `applyCouplings` adds to the blocks of a pair, in both
  /// of their rows; does nothing if one of the two is pinned.
  void couple(std::uint32_t coupling, const S block[6]);
  void applyCouplings();
  /// Reverts all changes by `fix`, `resist` and `couple`; pinned nodes stay pinned.
  void free();

  /// Adds u u^T to A, until the next call.
  /// slots  those at which u is not 0;  u  three numbers for each
  void setOuter(const std::vector<std::uint32_t>& slots, const std::vector<double>& u);
  /// What `setOuter` has added.
  const std::vector<std::uint32_t>& outerSlots() const { return outerSlots_; }
  const std::vector<S>& outer() const { return outer_; }

  /// The inverse of the node's diagonal block, as if it were not fixed: xx xy xz yy yz zz. 0 if it is pinned.
  void freeInverse(std::size_t node, S out[6]) const;
  void diagonal(std::size_t node, S out[6]) const;

  /// Multiplies A with points, 4 scalars per slot. If A is as it was assembled, a translation meets only its masses, to
  /// the last digit.
  void multiply(const S* points, S* wide, ParallelFor* threads) const;

  /// Computes velocities = P^-1 impulses, both in the wide layout, with the preconditioner of sweeps; returns the
  /// squared norm of the impulses. Overwrites `residual`.
  double precondition(const S* impulses, S* velocities, ParallelFor* threads);
  /// The squared norm of impulses in the wide layout, in the same norm that `lower` returns for the residual.
  double squaredNorm(const S* impulses, ParallelFor* threads);
  /// Computes difference = first - second, in the wide layout, 0 at pinned nodes, and A times it.
  /// second  null: 0
  void multiplyDifference(const S* first, const S* second, S* difference, S* image, ParallelFor* threads);
  /// The inner product of two vectors in the wide layout.
  double inner(const S* first, const S* second, ParallelFor* threads) const;

  // Each does one step of the conjugate gradient; see ElasticTable. The caller fills `residual` and `solution`.
  double lower(ParallelFor* threads);
  void backward(S factor, ParallelFor* threads);
  double forward(const S* extra, ParallelFor* threads);
  double advance(S factor, ParallelFor* threads);

  /// Resets the vectors of sweeps if they may not be finite: products with them would not be finite either, even with
  /// factors of 0.
  void clear();

  S* residual() { return residual_.data(); }
  S* solution() { return solution_.data(); }
  const S* solution() const { return solution_.data(); }
  const S* stepPoints() const { return stepPoints_.data(); }
  const S* step() const { return step_.data(); }

 private:
  using Work = kernels::RowWork<S>;
  using Table = kernels::ElasticTable<S>;
  /// Forward: each row after its neighbours that precede it; backward: after those that follow it.
  enum class Order { Any, Forward, Backward };

  Work work(std::size_t firstChunk, std::size_t lastChunk) const;
  S outerFactor(const S* points) const;
  void addOuter(S factor, S* wide) const;
  template <class Kernel>
  double sweep(Order order, ParallelFor* threads, Kernel&& kernel) const;
  double lowerInto(const S* impulses, S* wide, ParallelFor* threads);

  bool deterministic_ = false;
  bool changed_ = false;  ///< by `resist` or `couple`
  /// Index of the first scalar of the block of two slots, which is one of nine per lane of a group.
  std::optional<std::size_t> blockOf(std::size_t slot, std::size_t neighbour) const;

  /// The addition to the two blocks of a pair of nodes, and their values without it.
  struct Coupling {
    std::size_t first = 0, second = 0;    ///< slots
    std::size_t block = 0, mirrored = 0;  ///< of the first scalars
    S addition[6] = {}, own[9] = {}, ownMirrored[9] = {};
    bool known = false;  ///< its own values are known since the last assembly
    bool used = false;   ///< since the last `free`
  };
  void read(Coupling& coupling) const;
  void write(const Coupling& coupling);

  BlockPattern pattern_;
  AlignedVector<S> masses_, blocks_, diagonal_, inverse_, freeDiagonal_, freeInverse_;
  AlignedVector<S> residual_, direction_, rest_, step_, solution_;  // in the wide layout
  AlignedVector<S> stepPoints_, lowerPoints_;
  std::vector<std::uint32_t> outerSlots_;
  std::vector<S> outer_;            ///< by entry of `outerSlots_`
  AlignedVector<S> outerExtra_;     ///< in the wide layout
  bool extraIsZero_ = false;        ///< `outerExtra_` is, except at `outerSlots_`
  mutable std::vector<S> partial_;  // by range
  std::vector<Coupling> couplings_;
  std::vector<std::uint32_t> used_;        ///< numbers of couplings, since the last `free`
  std::vector<std::uint32_t> couplingAt_;  ///< by entry and lane: number of the coupling + 1; 0: none
};

/// Calls visit(slot, first scalar in wide vectors) for all slots.
template <class Visit>
void bySlots(std::size_t slots, Visit&& visit) {
  constexpr std::size_t lanes = kernels::kGroup;
  for (std::size_t chunk = 0; chunk < slots / lanes; ++chunk) {
    for (std::size_t lane = 0; lane < lanes; ++lane) visit(lanes * chunk + lane, kernels::kWideVector * chunk + lane);
  }
}

}  // namespace tetskin::elastic_detail
