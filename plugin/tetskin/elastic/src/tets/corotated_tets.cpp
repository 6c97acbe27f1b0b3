// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/instantiate.h>
#include <tetskin/core/src/base/lists.h>
#include <tetskin/core/src/base/mesh/tet_geometry.h>
#include <tetskin/elastic/src/tets/corotated_tets.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tetskin::elastic_detail {
namespace {

using kernels::kGroup;

/// Handing work to another thread costs some microseconds, in which this many packs, or nodes, are processed.
constexpr std::size_t kPacksPerTask = 64, kSlotsPerTask = 256;

std::size_t tasksFor(std::size_t items, std::size_t perTask) {
  return std::max<std::size_t>(1, (items + perTask - 1) / perTask);
}

}  // namespace

RestTets restTets(const TetMesh& cage) {
  RestTets rest;
  rest.tets = cage.tets;
  for (const Tet& tet : cage.tets) {
    const TetCorners corners = cornersOf(cage, tet);
    const std::array<Eigen::Vector3d, 4> gradients = BarycentricMap(corners).gradients();
    std::array<double, 9>& g = rest.gradients.emplace_back();
    for (std::size_t k = 0; k < 9; ++k) g[k] = gradients[1 + k / 3][static_cast<Eigen::Index>(k % 3)];
    rest.volumes.push_back(std::abs(signedVolume(corners)));
  }
  return rest;
}

template <class S>
CorotatedTets<S>::CorotatedTets(RestTets rest, const std::vector<std::uint32_t>& slotOf, std::size_t slots)
    : rest_(std::move(rest)), slots_(slots) {
  assert(count() > 0 && rest_.gradients.size() == count() && rest_.volumes.size() == count());
  const std::size_t packs = noTet(count()) / kGroup;
  packs_.resize(packs);
  rotations_.assign(4 * kGroup * packs, S(0));
  corners_.assign(kernels::kCorners * (kGroup * packs + 1), S(0));
  for (std::size_t k = 0; k < kGroup * packs; ++k) {
    kernels::TetPack<S>& pack = packs_[k / kGroup];
    const std::size_t lane = k % kGroup, tet = std::min(k, count() - 1);
    for (std::size_t i = 0; i < 9; ++i) pack.gradients[i][lane] = static_cast<S>(rest_.gradients[tet][i]);
    for (std::size_t i = 0; i < 4; ++i) pack.nodes[i][lane] = slotOf[static_cast<std::size_t>(rest_.tets[tet][i])];
    pack.shear[lane] = pack.bulk[lane] = S(0);
    rotations_[4 * kGroup * (k / kGroup) + lane] = S(1);
  }
  assembled_ = rotations_;
  findings_.resize(tasksFor(packs, kPacksPerTask));

  Lists<> corners = packLists(slots, [&](auto&& visit) {
    for (std::uint32_t t = 0; t < count(); ++t) {
      for (std::uint32_t a = 0; a < 4; ++a) visit(slotOf[static_cast<std::size_t>(rest_.tets[t][a])], 4 * t + a);
    }
  });
  cornerStarts_ = std::move(corners.starts);
  cornersAt_ = std::move(corners.values);
  assert(cornersAt_.size() == 4 * count());
}

template <class S>
void CorotatedTets<S>::setMaterial(std::size_t tet, const Lame& lame) {
  assert(tet < count() && lame.mu > 0.0 && lame.lambda >= 0.0);
  kernels::TetPack<S>& pack = packs_[tet / kGroup];
  pack.shear[tet % kGroup] = static_cast<S>(2.0 * lame.mu * rest_.volumes[tet]);
  pack.bulk[tet % kGroup] = static_cast<S>(lame.lambda * rest_.volumes[tet]);
}

template <class S>
template <class Kernel>
void CorotatedTets<S>::byPacks(ParallelFor* threads, Kernel&& kernel) {
  runTasks(threads, findings_.size(), [&](std::size_t task) {
    kernels::TetWork<S> work;
    work.firstPack = task * kPacksPerTask;
    work.lastPack = std::min(packs_.size(), work.firstPack + kPacksPerTask);
    work.packs = packs_.data();
    work.rotations = rotations_.data();
    work.assembled = assembled_.data();
    work.corners = corners_.data();
    kernel(work, task);
  });
}

template <class S>
double CorotatedTets<S>::cornerForces(const S* points, S* sums, bool energy, ParallelFor* threads) {
  assert(points);
  if (!energy) points_ = points;  // a query of the energy changes nothing
  const auto& table = kernels::elasticInUse<S>();
  byPacks(threads, [&](kernels::TetWork<S>& work, std::size_t task) {
    work.points = points;
    work.sums = sums;
    findings_[task] = table.forces(work, energy);
  });
  maxTurned_ = S(0);
  turned_ = 0.0;
  double total = 0.0;
  for (const kernels::TetFindings<S>& part : findings_) {
    maxTurned_ = std::max(maxTurned_, part.maxTurned);
    turned_ += part.turned;
    total += part.energy;
  }
  return total;
}

template <class S>
void CorotatedTets<S>::forces(const S* points, S* out, ParallelFor* threads) {
  // One thread adds the forces where they belong. Several could do so at the same time: they write corners, which are
  // then added in the same order.
  if (!threads) {
    std::fill_n(out, 4 * slots_, S(0));
    cornerForces(points, out, false, nullptr);
    return;
  }
  const auto& table = kernels::elasticInUse<S>();
  cornerForces(points, nullptr, false, threads);
  runTasks(threads, tasksFor(slots_, kSlotsPerTask), [&](std::size_t task) {
    kernels::SumWork<S> work;
    work.firstSlot = task * kSlotsPerTask;
    work.lastSlot = std::min(slots_, work.firstSlot + kSlotsPerTask);
    work.starts = cornerStarts_.data();
    work.corners = cornersAt_.data();
    work.from = corners_.data();
    work.points = out;
    table.sum(work);
  });
}

template <class S>
double CorotatedTets<S>::energy(const S* points, ParallelFor* threads) {
  // A query changes nothing, so that the next step finds its rotations starting from the same ones.
  const AlignedVector<S> rotations = rotations_;
  const S maxTurned = maxTurned_;
  const double turned = turned_;
  const double energy = cornerForces(points, nullptr, true, threads);
  rotations_ = rotations;
  maxTurned_ = maxTurned;
  turned_ = turned;
  return energy;
}

template <class S>
double CorotatedTets<S>::meanTurn() const {
  return std::sqrt(4.0 * turned_ / static_cast<double>(noTet(count())));
}

template <class S>
double CorotatedTets<S>::maxTurn() const {
  return 4.0 * std::asin(std::min(1.0, 0.5 * std::sqrt(static_cast<double>(maxTurned_))));
}

template <class S>
const S* CorotatedTets<S>::cornersForMatrix(S alpha, ParallelFor* threads, S flatAlpha) {
  assert(points_ || !(flatAlpha > alpha));
  const auto& table = kernels::elasticInUse<S>();
  assembled_ = rotations_;
  byPacks(threads, [&](kernels::TetWork<S>& work, std::size_t) {
    work.alpha = alpha;
    work.flatAlpha = flatAlpha;
    work.points = points_;
    table.rotatedGradients(work);
  });
  return corners_.data();
}

#define TETSKIN_INSTANTIATE(Scalar) template class CorotatedTets<Scalar>;
TETSKIN_FOR_SCALARS(TETSKIN_INSTANTIATE)
#undef TETSKIN_INSTANTIATE

}  // namespace tetskin::elastic_detail
