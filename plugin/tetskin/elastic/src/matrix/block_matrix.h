// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The matrix A = M + alpha K of one body: 3x3 blocks, a row a node, symmetric and positive. Rows are sorted by colour,
// so that a Gauss-Seidel sweep has eight of them at once, and on any number of threads: see elastic_kernels.h.
#pragma once

#include <tetskin/core/parallel_for.h>
#include <tetskin/core/src/shared/base/aligned.h>
#include <tetskin/core/tet_mesh.h>
#include <tetskin/elastic/src/shared/kernels/elastic_kernels.h>

#include <cstdint>
#include <vector>

namespace tetskin::elastic_detail {

/// Where nodes have their rows, and which rows have blocks in common. Slots are numbered by row; some are of no node.
struct BlockPattern {
  std::vector<std::uint32_t> slotOf;      ///< by node
  std::vector<std::uint32_t> starts;      ///< by chunk, 2, and one more
  std::vector<std::uint32_t> neighbours;  ///< by entry, 8
  std::vector<std::uint32_t> sums;        ///< by entry, and one more
  std::vector<std::uint32_t> terms;       ///< 16 a term
  std::vector<std::uint32_t> taskChunks;  ///< by task, and one more: its first chunk; no task has rows of two colours
  std::vector<std::uint32_t> colours;     ///< by colour, and one more: its first task

  std::size_t chunkCount() const { return starts.size() / 2; }
  std::size_t slotCount() const { return chunkCount() * kernels::kGroup; }
  std::size_t taskCount() const { return taskChunks.size() - 1; }
};

/// Corners of tet t are 4 t to 4 t + 3; those of tet `noTet` are 0. Cost O(T).
BlockPattern blockPattern(std::size_t nodes, const std::vector<Tet>& tets, std::size_t noTet);

template <class S>
class TETSKIN_ELASTIC_API BlockMatrix {
 public:
  BlockMatrix(std::size_t nodes, const std::vector<Tet>& tets, std::size_t noTet);

  const BlockPattern& pattern() const { return pattern_; }
  std::size_t nodeCount() const { return pattern_.slotOf.size(); }
  std::size_t slotCount() const { return pattern_.slotCount(); }
  std::size_t slotOf(std::size_t node) const { return pattern_.slotOf[node]; }
  /// Of a node's first scalar in a wide vector; the next two follow kGroup apart.
  std::size_t wideOf(std::size_t node) const { return wideOfSlot(slotOf(node)); }
  static std::size_t wideOfSlot(std::size_t slot) {
    return slot / kernels::kGroup * kernels::kWideVector + slot % kernels::kGroup;
  }
  std::size_t wideSize() const { return pattern_.chunkCount() * kernels::kWideVector; }

  /// By slot; 0: held. They count from the next assembly on.
  S mass(std::size_t node) const { return masses_[slotOf(node)]; }
  S massAt(std::size_t slot) const { return masses_[slot]; }
  void setMass(std::size_t node, S mass) { masses_[slotOf(node)] = mass; }
  double totalMass() const;

  /// corners  4 points a tet, see ElasticTable::rotatedGradients; null: without tets, A = M
  void assemble(const S* corners, ParallelFor* threads);

  /// What a node may not move along: nothing, one direction, all but one, or any.
  void fix(std::size_t node);
  void fixAlong(std::size_t node, const S normal[3]);
  void fixAllBut(std::size_t node, const S direction[3]);
  /// Adds to a node's diagonal block what resists its motion, xx xy xz yy yz zz: no negative eigenvalue. Before the
  /// node is fixed.
  void resist(std::size_t node, const S block[6]);
  /// Adds a symmetric block, xx xy xz yy yz zz, to the blocks of two nodes, in both of their rows. False, and nothing
  /// done, where the two are the same or have no tet in common: the matrix has no such block. Nothing is added where
  /// one is held. Cost O(neighbours of a node)
  bool couple(std::size_t first, std::size_t second, const S block[6]);
  /// All but the held ones are free again, meet no resistance, and are coupled by elasticity alone.
  void free();

  /// The inverse of the node's diagonal block, as if it were free: xx xy xz yy yz zz. 0 where it is held.
  void freeInverse(std::size_t node, S out[6]) const;
  /// The node's diagonal block.
  void diagonal(std::size_t node, S out[6]) const;

  /// A times points, 4 scalars a slot.
  void multiply(const S* points, S* wide, ParallelFor* threads) const;
  /// One node's row of A times the solution.
  void rowTimesSolution(std::size_t node, S out[3]) const;

  // One step of the conjugate gradient each; see ElasticTable. `residual` and `solution` are the caller's to fill.
  double lower(ParallelFor* threads);
  void backward(S factor, ParallelFor* threads);
  double forward(const S* extra, ParallelFor* threads);
  double advance(S factor, ParallelFor* threads);

  /// Forgets what sweeps have left, if that may not be finite: products with it would not be, though its factors are 0.
  void clear();

  S* residual() { return residual_.data(); }
  S* solution() { return solution_.data(); }
  const S* solution() const { return solution_.data(); }
  const S* stepPoints() const { return stepPoints_.data(); }
  const S* step() const { return step_.data(); }

 private:
  kernels::RowWork<S> work(std::size_t firstChunk, std::size_t lastChunk) const;
  template <class Kernel>
  void everywhere(ParallelFor* threads, Kernel&& kernel) const;
  template <class Kernel>
  void byColours(bool forwards, ParallelFor* threads, Kernel&& kernel) const;
  double summed() const;
  void setInverse(std::size_t slot, const S inverse[6]);
  /// The first scalar of the block of two slots, one of each nine a lane of a group; null: there is none.
  S* blockOf(std::size_t slot, std::size_t neighbour);
  void addTo(S* block, const S addition[6]);

  /// What a block was before something was added.
  struct SavedBlock {
    S* block = nullptr;
    S values[9] = {};
  };

  BlockPattern pattern_;
  AlignedVector<S> masses_, blocks_, diagonal_, inverse_, freeDiagonal_, freeInverse_;
  AlignedVector<S> residual_, direction_, rest_, step_, solution_;  // wide
  AlignedVector<S> stepPoints_, lowerPoints_;
  mutable std::vector<S> partial_;  // by task
  std::vector<SavedBlock> saved_;
};

}  // namespace tetskin::elastic_detail
