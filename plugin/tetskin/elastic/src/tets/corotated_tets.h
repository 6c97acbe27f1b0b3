// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Elastic forces of a body's tets, each with a rotation and a stiffness of its own: see tet_loops.h.
#pragma once

#include <tetskin/core/parallel_for.h>
#include <tetskin/core/src/shared/base/aligned.h>
#include <tetskin/core/tet_mesh.h>
#include <tetskin/elastic/src/shared/kernels/elastic_kernels.h>
#include <tetskin/elastic/src/tets/material.h>

#include <array>
#include <cstdint>
#include <vector>

namespace tetskin::elastic_detail {

/// Tets as they are at rest. None is flat.
struct RestTets {
  std::vector<Tet> tets;
  std::vector<std::array<double, 9>> gradients;  ///< rows: of the weights of nodes 1, 2 and 3, rest space
  std::vector<double> volumes;                   ///< above 0

  std::size_t count() const { return tets.size(); }
};

/// Of a cage without flat tets. Cost O(T).
TETSKIN_ELASTIC_API RestTets restTets(const TetMesh& cage);

template <class S>
class TETSKIN_ELASTIC_API CorotatedTets {
 public:
  /// slotOf  by node, where its point lies
  CorotatedTets(RestTets rest, const std::vector<std::uint32_t>& slotOf, std::size_t slots);

  std::size_t count() const { return rest_.count(); }
  const RestTets& rest() const { return rest_; }
  /// What fills the last pack, and one tet more, have corners that are 0.
  static std::size_t noTet(std::size_t tets) {
    return (tets + kernels::kGroup - 1) / kernels::kGroup * kernels::kGroup;
  }

  void setMaterial(std::size_t tet, const Lame& lame);

  /// Elastic forces at `points`, both 4 scalars a slot; the tets' rotations are turned along.
  void forces(const S* points, S* out, ParallelFor* threads);
  /// Elastic energy at `points`.
  double energy(const S* points, ParallelFor* threads);

  /// By how much tets have turned since `cornersForMatrix`, in radians: root mean square, and at most.
  double meanTurn() const;
  double mostTurn() const;
  /// The corners that BlockMatrix::assemble takes, of the rotations as they are now.
  const S* cornersForMatrix(S alpha, ParallelFor* threads);

 private:
  template <class Kernel>
  void byPacks(ParallelFor* threads, Kernel&& kernel);
  double cornerForces(const S* points, bool energy, ParallelFor* threads);

  RestTets rest_;
  AlignedVector<kernels::TetPack<S>> packs_;
  AlignedVector<S> rotations_, assembled_, corners_;
  std::vector<std::uint32_t> cornerStarts_, cornersAt_;  ///< by slot
  std::size_t slots_ = 0;
  S mostTurned_ = 0;                               ///< squared difference of quaternions
  double turned_ = 0.0;                            ///< sum of them, a quarter of the angles' squares
  std::vector<kernels::TetFindings<S>> findings_;  ///< by task
};

}  // namespace tetskin::elastic_detail
