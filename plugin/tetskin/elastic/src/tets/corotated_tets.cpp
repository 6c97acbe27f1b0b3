// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/arithmetic/turns.h>
#include <tetskin/core/src/base/instantiate.h>
#include <tetskin/core/src/base/lists.h>
#include <tetskin/elastic/src/tets/corotated_tets.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>

namespace tetskin::elastic_detail {
namespace {

using kernels::kGroup;

/// Passing work to another thread costs some microseconds, in which this many points of packs, or nodes, are processed.
constexpr std::size_t kPointsPerTask = 64, kSlotsPerTask = 256;

template <class Pack>
constexpr std::size_t kPacksPerTask = kPointsPerTask / Pack::kPoints;

std::size_t tasksFor(std::size_t items, std::size_t perTask) {
  return (items + perTask - 1) / perTask;
}

template <class S>
bool haveSameBits(const AlignedVector<S>& a, const AlignedVector<S>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(S)) == 0);
}

}  // namespace

template <class S>
CorotatedTets<S>::CorotatedTets(RestTets rest, const std::vector<std::uint32_t>& slotOf, std::size_t slots)
    : rest_(std::move(rest)), slots_(slots) {
  assert(!rest_.empty() && rest_.gradients.size() == rest_.count() && rest_.volumes.size() == rest_.count());
  makePacks(rest_.count(), 0, linear_);
  makePacks(rest_.quadratic.size(), rest_.quadraticCorner(0), quadratic_);
  corners_.assign(4 * rest_.cornerCount(), S(0));
  findings_.resize(linear_.tasks + quadratic_.tasks);
  fillPacks(slotOf);
  listCorners(slotOf);
}

template <class S>
template <class Pack>
void CorotatedTets<S>::makePacks(std::size_t tets, std::size_t firstCorner, Packed<Pack>& packed) {
  const std::size_t packs = RestTets::padded(tets) / kGroup;
  packed.packs.resize(packs);
  packed.rotations.assign(4 * kGroup * Pack::kPoints * packs, S(0));
  for (std::size_t k = 0; k < packed.rotations.size(); k += 4 * kGroup) {
    std::fill_n(&packed.rotations[k], kGroup, S(1));
  }
  packed.assembled = packed.rotations;
  packed.firstCorner = firstCorner;
  packed.tasks = tasksFor(packs, kPacksPerTask<Pack>);
}

/// The rest of the last pack repeats the last tet, without stiffness.
template <class S>
void CorotatedTets<S>::fillPacks(const std::vector<std::uint32_t>& slotOf) {
  const auto fill = [&](auto& pack, std::size_t lane, const auto& nodes, const std::array<double, 9>& gradients) {
    for (std::size_t i = 0; i < 9; ++i) pack.gradients[i][lane] = static_cast<S>(gradients[i]);
    for (std::size_t i = 0; i < nodes.size(); ++i) pack.nodes[i][lane] = slotOf[static_cast<std::size_t>(nodes[i])];
    pack.shear[lane] = pack.bulk[lane] = S(0);
  };
  for (std::size_t k = 0; k < kGroup * linear_.packs.size(); ++k) {
    const std::size_t tet = std::min(k, rest_.count() - 1);
    fill(linear_.packs[k / kGroup], k % kGroup, rest_.tets[tet], rest_.gradients[tet]);
  }
  for (std::size_t k = 0; k < kGroup * quadratic_.packs.size(); ++k) {
    const RestQuadraticTet& tet = rest_.quadratic[std::min(k, rest_.quadratic.size() - 1)];
    auto& pack = quadratic_.packs[k / kGroup];
    fill(pack, k % kGroup, tet.nodes, tet.gradients);
    for (std::size_t i = 0; i < tet.points.size(); ++i) pack.points[i][k % kGroup] = static_cast<S>(tet.points[i]);
  }
}

/// In the order in which one thread adds the forces.
template <class S>
void CorotatedTets<S>::listCorners(const std::vector<std::uint32_t>& slotOf) {
  Lists<> corners = packLists(slots_, [&](auto&& visit) {
    const auto list = [&](const auto& nodes, std::size_t corner) {
      for (const int n : nodes) visit(slotOf[static_cast<std::size_t>(n)], static_cast<std::uint32_t>(corner++));
    };
    for (std::size_t t = 0; t < rest_.count(); ++t) list(rest_.tets[t], 4 * t);
    for (std::size_t t = 0; t < rest_.quadratic.size(); ++t) list(rest_.quadratic[t].nodes, rest_.quadraticCorner(t));
  });
  cornerStarts_ = std::move(corners.starts);
  cornersAt_ = std::move(corners.values);
  assert(cornersAt_.size() == 4 * rest_.count() + kQuadraticNodes * rest_.quadratic.size());
}

template <class S>
void CorotatedTets<S>::setMaterial(const Lame& lame) {
  assert(lame.mu > 0.0 && lame.lambda >= 0.0);
  ratio_ = static_cast<S>(lame.lambda / lame.mu);
  mu_ = lame.mu;
  youngsModulus_ = lame.mu * (3.0 * lame.lambda + 2.0 * lame.mu) / (lame.lambda + lame.mu);
  const auto set = [&](auto& pack, std::size_t lane, double volume) {
    pack.shear[lane] = static_cast<S>(2.0 * lame.mu * volume);
    pack.bulk[lane] = static_cast<S>(lame.lambda * volume);
  };
  for (std::size_t t = 0; t < rest_.count(); ++t) set(linear_.packs[t / kGroup], t % kGroup, rest_.volumes[t]);
  for (std::size_t t = 0; t < rest_.quadratic.size(); ++t) {
    set(quadratic_.packs[t / kGroup], t % kGroup, rest_.quadratic[t].volume / kQuadraticPoints);
  }
}

template <class S>
void CorotatedTets<S>::setFibres(const std::vector<std::vector<TetFibre>>& families,
                                 const std::vector<std::uint32_t>& slotOf) {
  fibres_.reset();
  const auto any = [](const std::vector<TetFibre>& family) {
    return std::any_of(family.begin(), family.end(), [](const TetFibre& fibre) { return fibre.stiffness > 0.0; });
  };
  if (std::any_of(families.begin(), families.end(), any)) fibres_.emplace(rest_, slotOf, families, mu_);
}

template <class S>
double CorotatedTets<S>::stiffening() const {
  const double ofTets = stiffening_ * lawStiffening_;
  if (!fibres_) return ofTets;
  double volume = 0.0;
  for (const double own : rest_.volumes) volume += own;
  for (const RestQuadraticTet& tet : rest_.quadratic) volume += tet.volume;
  return ofTets + fibres_->stiffness() / (volume * mu_ * (2.0 + static_cast<double>(ratio_)));
}

template <class S>
template <class Pack>
kernels::TetWork<S, Pack> CorotatedTets<S>::work(Packed<Pack>& packed, std::size_t task) {
  kernels::TetWork<S, Pack> work;
  work.firstPack = task * kPacksPerTask<Pack>;
  work.lastPack = std::min(packed.packs.size(), work.firstPack + kPacksPerTask<Pack>);
  work.packs = packed.packs.data();
  work.rotations = packed.rotations.data();
  work.assembled = packed.assembled.data();
  work.corners = corners_.data() + 4 * packed.firstCorner;
  work.alphas = packed.alphas.data();
  work.factors = packed.factors.empty() ? nullptr : packed.factors.data();
  work.laws = packed.laws.empty() ? nullptr : packed.laws.data();
  work.stiffer = packed.laws.empty() || isAsked_ ? nullptr : packed.lawStiffer.data();
  work.frames = frames_;
  work.partOf = partOf_;
  if (packed.changes.empty()) return work;
  work.changes = packed.changes.data();
  work.assembledChanges = packed.assembledChanges.data();
  work.given = isGiven_ ? packed.given.data() : nullptr;
  work.yields = packed.yields.empty() || isAsked_ ? nullptr : packed.yields.data();
  work.flowed = packed.flowed.data();
  work.flowShare = flowShare_;
  work.largestStrain = largestStrain_;
  return work;
}

template <class S>
template <class Kernel>
void CorotatedTets<S>::byPacks(ParallelFor* threads, Kernel&& kernel) {
  const auto& table = kernels::elasticInUse<S>(deterministic_);
  runTasks(threads, findings_.size(), [&](std::size_t task) {
    if (task < linear_.tasks) {
      kernel(work(linear_, task), table.linear, task);
    } else {
      kernel(work(quadratic_, task - linear_.tasks), table.quadratic, task);
    }
  });
}

template <class S>
double CorotatedTets<S>::cornerForces(const S* points, S* sums, bool energy, ParallelFor* threads) {
  assert(points);
  points_ = points;
  byPacks(threads, [&](auto work, const auto& loops, std::size_t task) {
    work.points = points;
    work.sums = sums;
    findings_[task] = loops.forces(work, energy);
  });
  flattest_ = S(1);
  maxTurned_ = S(0);
  turned_ = 0.0;
  bool yields = false;
  double total = 0.0;
  for (const kernels::TetFindings<S>& part : findings_) {
    flattest_ = std::min(flattest_, part.flattest);
    maxTurned_ = std::max(maxTurned_, part.maxTurned);
    turned_ += part.turned;
    yields |= part.yields;
    total += part.energy;
  }
  if (isAsked_) return total;
  yields_ = yields;
  findLawStiffening();
  return total;
}

template <class S>
void CorotatedTets<S>::forces(const S* points, S* out, ParallelFor* threads) {
  // A single thread adds forces directly to the nodes. Several could collide: they write corners, which are then added
  // in the same order.
  if (!threads) {
    std::fill_n(out, 4 * slots_, S(0));
    cornerForces(points, out, false, nullptr);
    if (fibres_) fibres_->addForces(points, frames_, partOf_, !isAsked_, out);
    return;
  }
  const auto& table = kernels::elasticInUse<S>(deterministic_);
  cornerForces(points, nullptr, false, threads);
  runTasks(threads, std::max<std::size_t>(1, tasksFor(slots_, kSlotsPerTask)), [&](std::size_t task) {
    kernels::SumWork<S> work;
    work.firstSlot = task * kSlotsPerTask;
    work.lastSlot = std::min(slots_, work.firstSlot + kSlotsPerTask);
    work.starts = cornerStarts_.data();
    work.corners = cornersAt_.data();
    work.from = corners_.data();
    work.points = out;
    table.sum(work);
  });
  if (fibres_) fibres_->addForces(points, frames_, partOf_, !isAsked_, out);
}

/// Restores everything, so that the next step finds its rotations from the same start, and assembles its matrix, or
/// not, as it would have.
template <class S>
template <class Query>
void CorotatedTets<S>::ask(Query&& query) {
  const AlignedVector<S> linear = linear_.rotations, quadratic = quadratic_.rotations;
  const S flattest = flattest_, maxTurned = maxTurned_;
  const double turned = turned_;
  const S* const points = points_;
  struct Asking {
    explicit Asking(bool& is) : is_(is) { is_ = true; }
    ~Asking() { is_ = false; }
    bool& is_;
  };
  {
    const Asking asking(isAsked_);
    query();
  }
  linear_.rotations = linear;
  quadratic_.rotations = quadratic;
  flattest_ = flattest;
  maxTurned_ = maxTurned;
  turned_ = turned;
  points_ = points;
}

template <class S>
double CorotatedTets<S>::energy(const S* points, ParallelFor* threads) {
  double energy = 0.0;
  ask([&] { energy = cornerForces(points, nullptr, true, threads); });
  return fibres_ ? energy + fibres_->energy(points, frames_, partOf_) : energy;
}

template <class S>
void CorotatedTets<S>::probeForces(const S* points, S* out, ParallelFor* threads) {
  ask([&] { forces(points, out, threads); });
}

template <class S>
double CorotatedTets<S>::meanTurn() const {
  const std::size_t scalars = linear_.rotations.size() + quadratic_.rotations.size();  // four per rotation
  const double own = std::sqrt(16.0 * turned_ / static_cast<double>(scalars));
  return fibres_ ? std::max(own, std::sqrt(fibres_->outdated().mean)) : own;
}

template <class S>
double CorotatedTets<S>::maxTurn() const {
  const double own = 4.0 * arcSine(std::min(1.0, 0.5 * std::sqrt(static_cast<double>(maxTurned_))));
  return fibres_ ? std::max(own, std::sqrt(fibres_->outdated().largest)) : own;
}

template <class S>
const S* CorotatedTets<S>::cornersForMatrix(S alpha, ParallelFor* threads, S flatAlpha) {
  flatAlpha_ = flatAlpha > alpha ? flatAlpha : S(0);
  assert(points_ || flatAlpha_ == S(0));
  forBoth([&](auto& packed) {
    packed.assembled = packed.rotations;
    packed.assembledChanges = packed.changes;
    if (flatAlpha_ > S(0)) packed.alphas.resize(packed.rotations.size() / 4);
  });
  if (fibres_) fibres_->assemble(static_cast<double>(alpha));
  return corners(alpha, flatAlpha_ > S(0) ? flatAlpha_ : alpha, points_, threads);
}

template <class S>
const S* CorotatedTets<S>::cornersWithoutFlat(S alpha, ParallelFor* threads) {
  assert(points_ && alpha > S(0));
  forBoth([&](auto& packed) {
    packed.assembled = packed.rotations;
    packed.assembledChanges = packed.changes;
    packed.alphas.resize(packed.rotations.size() / 4);
  });
  if (fibres_) fibres_->assemble(static_cast<double>(alpha));
  return corners(alpha, S(0), points_, threads);
}

template <class S>
const S* CorotatedTets<S>::cornersAgain(S alpha, ParallelFor* threads) {
  if (fibres_) fibres_->assembleAgain(static_cast<double>(alpha));
  return corners(alpha, flatAlpha_ > S(0) ? flatAlpha_ : alpha, nullptr, threads);
}

/// points  null: the same tets are flat as before
template <class S>
const S* CorotatedTets<S>::corners(S alpha, S flatAlpha, const S* points, ParallelFor* threads) {
  byPacks(threads, [&](auto work, const auto& loops, std::size_t) {
    work.rotations = const_cast<S*>(work.assembled);  // this kernel only reads them
    work.alpha = alpha;
    work.flatAlpha = flatAlpha;
    work.points = points;
    loops.rotatedGradients(work);
  });
  return corners_.data();
}

template <class S>
bool CorotatedTets<S>::serialize(StateStream& stream, S alpha, bool ofMatrix) {
  forBoth([&](auto& packed) { stream.plain(packed.rotations.data(), packed.rotations.size()); });
  if (hasLaws()) {
    stream(lawStiffening_);
    stream(countedLaws_);
  }
  bool changed = serializeChanges(stream, ofMatrix);
  if (!ofMatrix) return false;
  const S flatAlpha = flatAlpha_;
  stream(flatAlpha_);
  changed |= flatAlpha != flatAlpha_;
  changed |= serializeFactors(stream);
  if (fibres_) changed |= fibres_->serialize(stream);
  forBoth([&](auto& packed) { changed |= serializeAssembled(stream, packed); });
  if (flatAlpha_ > S(0)) forBoth([&](auto& packed) { changed |= serializeAlphas(stream, alpha, packed); });
  return changed;
}

/// After an assembly, the rotations are those of the matrix.
template <class S>
template <class Pack>
bool CorotatedTets<S>::serializeAssembled(StateStream& stream, Packed<Pack>& packed) {
  bool same = haveSameBits(packed.rotations, packed.assembled);
  stream(same);
  if (stream.saving()) {
    if (!same) stream.plain(packed.assembled.data(), packed.assembled.size());
    return false;
  }
  AlignedVector<S> now = packed.rotations;
  if (!same) stream.plain(now.data(), now.size());
  const bool changed = !haveSameBits(now, packed.assembled);
  packed.assembled.swap(now);
  return changed;
}

/// Few tets are flat, if any.
template <class S>
template <class Pack>
bool CorotatedTets<S>::serializeAlphas(StateStream& stream, S alpha, Packed<Pack>& packed) {
  std::vector<std::uint32_t> flat;
  for (std::size_t k = 0; stream.saving() && k < packed.alphas.size(); ++k) {
    if (packed.alphas[k] == flatAlpha_) flat.push_back(static_cast<std::uint32_t>(k));
  }
  stream.array(flat);
  if (stream.saving()) return false;
  AlignedVector<S> now(packed.rotations.size() / 4, alpha);
  for (const std::uint32_t k : flat) {
    if (k < now.size()) now[k] = flatAlpha_;
  }
  const bool changed = now != packed.alphas;
  packed.alphas.swap(now);
  return changed;
}

TETSKIN_INSTANTIATE_CLASS(CorotatedTets)

}  // namespace tetskin::elastic_detail
