// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Elastic forces of a body's tets, each with its own rotation and stiffness: see tet_loops.h.
#pragma once

#include <tetskin/core/mesh.h>
#include <tetskin/core/parallel_for.h>
#include <tetskin/core/src/base/aligned.h>
#include <tetskin/elastic/src/base/elastic_kernels.h>
#include <tetskin/elastic/src/tets/material.h>

#include <array>
#include <cstdint>
#include <vector>

namespace tetskin::elastic_detail {

/// The tets at rest. None is flat.
struct RestTets {
  std::vector<Tet> tets;
  std::vector<std::array<double, 9>> gradients;  ///< by rows: of the weights of nodes 1, 2 and 3, rest space
  std::vector<double> volumes;                   ///< above 0

  std::size_t count() const { return tets.size(); }
};

/// The tets of a cage without flat ones. Cost O(T).
TETSKIN_ELASTIC_API RestTets restTets(const TetMesh& cage);

template <class S>
class TETSKIN_ELASTIC_API CorotatedTets {
 public:
  /// slotOf  by node: the index of its point
  CorotatedTets(RestTets rest, const std::vector<std::uint32_t>& slotOf, std::size_t slots);

  std::size_t count() const { return rest_.count(); }
  const RestTets& rest() const { return rest_; }
  /// Index of the tet whose corners are 0: it follows the padding of the last pack, whose corners are 0, too.
  static std::size_t noTet(std::size_t tets) {
    return (tets + kernels::kGroup - 1) / kernels::kGroup * kernels::kGroup;
  }

  void setMaterial(std::size_t tet, const Lame& lame);

  /// Elastic forces at `points`, both 4 scalars per slot; updates the tets' rotations.
  void forces(const S* points, S* out, ParallelFor* threads);
  /// The elastic energy at `points`.
  double energy(const S* points, ParallelFor* threads);

  /// The rotation of tets since `cornersForMatrix`, in radians: root mean square, and maximum.
  double meanTurn() const;
  double maxTurn() const;
  /// The corners for BlockMatrix::assemble, with the current rotations.
  /// flatAlpha  if larger than `alpha`: its value for tets that were flat or inverted in the last `forces`, whose
  ///            points must still be there
  const S* cornersForMatrix(S alpha, ParallelFor* threads, S flatAlpha = 0);

 private:
  template <class Kernel>
  void byPacks(ParallelFor* threads, Kernel&& kernel);
  /// sums  see TetWork
  double cornerForces(const S* points, S* sums, bool energy, ParallelFor* threads);

  RestTets rest_;
  AlignedVector<kernels::TetPack<S>> packs_;
  AlignedVector<S> rotations_, assembled_, corners_;
  std::vector<std::uint32_t> cornerStarts_, cornersAt_;  ///< by slot
  std::size_t slots_ = 0;
  const S* points_ = nullptr;  ///< of the last `forces`
  S maxTurned_ = 0;            ///< squared difference of quaternions
  double turned_ = 0.0;        ///< sum of the squared differences, each a quarter of the squared angle
  std::vector<kernels::TetFindings<S>> findings_;  ///< by task
};

}  // namespace tetskin::elastic_detail
