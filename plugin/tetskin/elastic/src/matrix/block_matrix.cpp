// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/instantiate.h>
#include <tetskin/elastic/src/matrix/block_matrix.h>

#include <algorithm>
#include <cassert>
#include <iterator>
#include <limits>
#include <numeric>
#include <type_traits>

namespace tetskin::elastic_detail {

using kernels::kGroup;
using kernels::kWideSymmetric;

namespace {

/// Smallest mass of a node relative to the trace of its diagonal block of alpha K: some last digits of it.
template <class S>
constexpr S kMinMass = 4 * std::numeric_limits<S>::epsilon();

/// The inverse of a symmetric positive matrix: xx xy xz yy yz zz.
template <class S>
void invertSymmetric(const S block[6], S out[6]) {
  const S unit = 1 / (block[0] + block[3] + block[5]);
  S d[6];
  for (int k = 0; k < 6; ++k) d[k] = block[k] * unit;
  const S c00 = d[3] * d[5] - d[4] * d[4], c01 = d[2] * d[4] - d[1] * d[5], c02 = d[1] * d[4] - d[2] * d[3];
  const S scale = unit / (d[0] * c00 + d[1] * c01 + d[2] * c02);
  const S inverse[6] = {c00, c01, c02, d[0] * d[5] - d[2] * d[2], d[1] * d[2] - d[0] * d[4], d[0] * d[3] - d[1] * d[1]};
  for (int k = 0; k < 6; ++k) out[k] = scale * inverse[k];
}

/// The symmetric block of a slot in wide blocks.
template <class S>
void readBlock(const AlignedVector<S>& blocks, std::size_t slot, S out[6]) {
  const S* from = &blocks[slot / kGroup * kWideSymmetric + slot % kGroup];
  for (std::size_t k = 0; k < 6; ++k) out[k] = from[k * kGroup];
}

template <class S>
void writeBlock(const S block[6], std::size_t slot, AlignedVector<S>& blocks) {
  S* to = &blocks[slot / kGroup * kWideSymmetric + slot % kGroup];
  for (std::size_t k = 0; k < 6; ++k) to[k * kGroup] = block[k];
}

}  // namespace

template <class S>
BlockMatrix<S>::BlockMatrix(std::size_t nodes, const RestTets& rest) : pattern_(blockPattern(nodes, rest)) {
  const std::size_t chunks = pattern_.chunkCount(), slots = pattern_.slotCount();
  masses_.assign(slots, S(0));
  couplingAt_.assign(pattern_.neighbours.size(), 0);
  blocks_.assign((pattern_.sums.size() - 1) * kernels::kWideBlock, S(0));
  for (AlignedVector<S>* v : {&diagonal_, &inverse_, &freeDiagonal_, &freeInverse_})
    v->assign(chunks * kWideSymmetric, S(0));
  for (AlignedVector<S>* v : {&residual_, &direction_, &rest_, &step_, &solution_}) v->assign(wideSize(), S(0));
  for (AlignedVector<S>* v : {&stepPoints_, &lowerPoints_}) v->assign(4 * slots, S(0));
  partial_.assign(pattern_.rangeCount(), S(0));
}

template <class S>
kernels::RowWork<S> BlockMatrix<S>::work(std::size_t firstChunk, std::size_t lastChunk) const {
  assert(firstChunk <= lastChunk && lastChunk <= pattern_.chunkCount());
  // This function is const, but kernels that write are only called from functions that are not.
  const auto writable = [](const AlignedVector<S>& v) { return const_cast<S*>(v.data()); };
  kernels::RowWork<S> work;
  work.firstChunk = firstChunk;
  work.lastChunk = lastChunk;
  work.starts = pattern_.starts.data();
  work.neighbours = pattern_.neighbours.data();
  work.blocks = writable(blocks_);
  work.diagonal = writable(diagonal_);
  work.inverse = writable(inverse_);
  work.masses = masses_.data();
  work.sums = pattern_.sums.data();
  work.terms = pattern_.terms.data();
  work.quadraticSums = pattern_.quadraticSums.data();
  work.quadraticTerms = pattern_.quadraticTerms.data();
  work.residual = writable(residual_);
  work.direction = writable(direction_);
  work.rest = writable(rest_);
  work.step = writable(step_);
  work.solution = writable(solution_);
  work.stepPoints = writable(stepPoints_);
  work.lowerPoints = writable(lowerPoints_);
  return work;
}

template <class S>
void BlockMatrix<S>::serializeWide(StateStream& stream, S* wide) const {
  if (stream.restoring()) std::fill(wide, wide + wideSize(), S(0));
  for (const std::uint32_t slot : pattern_.slotOf) {
    S* at = wide + wideOfSlot(slot);
    S values[3] = {at[0], at[kernels::kGroup], at[2 * kernels::kGroup]};
    stream.plain(values, 3);
    if (!stream.restoring()) continue;
    for (std::size_t k = 0; k < 3; ++k) at[k * kernels::kGroup] = values[k];
  }
}

template <class S>
double BlockMatrix<S>::totalMass() const {
  return std::accumulate(masses_.begin(), masses_.end(), 0.0);
}

/// Calls kernel(its work, the table) for all ranges. If the results are numbers, returns their sum, in an order that
/// does not depend on the number of threads.
template <class S>
template <class Kernel>
double BlockMatrix<S>::sweep(Order order, ParallelFor* threads, Kernel&& kernel) const {
  const auto& table = kernels::elasticInUse<S>(deterministic_);
  auto runTask = [&](std::size_t task) {
    const std::size_t first = pattern_.tasks[task], count = pattern_.tasks[task + 1] - first;
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t range = first + (order == Order::Backward ? count - 1 - k : k);
      kernels::RowWork<S> part = work(pattern_.rangeChunks[range], pattern_.rangeChunks[range + 1]);
      if constexpr (std::is_void_v<decltype(kernel(part, table))>) {
        kernel(part, table);
      } else {
        partial_[range] = kernel(part, table);
      }
    }
  };
  if (order == Order::Any) {
    runTasks(threads, pattern_.taskCount(), runTask);
  } else {
    const std::size_t phases = pattern_.phases.size() - 1;
    for (std::size_t k = 0; k < phases; ++k) {
      const std::size_t phase = order == Order::Backward ? phases - 1 - k : k, first = pattern_.phases[phase];
      runTasks(threads, pattern_.phases[phase + 1] - first, [&](std::size_t task) { runTask(first + task); });
    }
  }
  return std::accumulate(partial_.begin(), partial_.end(), 0.0);
}

template <class S>
void BlockMatrix<S>::assemble(const S* corners, S ratio, ParallelFor* threads, S spread,
                              const kernels::FibreLayers<S>& fibres) {
  assert(corners || pattern_.neighbours.empty());
  sweep(Order::Any, threads, [&](Work& part, const Table& table) {
    part.corners = corners;
    part.fibres = fibres;
    part.ratio = ratio;
    part.spread = spread;
    part.minMass = kMinMass<S>;
    part.diagonal = freeDiagonal_.data();
    part.inverse = freeInverse_.data();
    table.assemble(part);
  });
  // These blocks do not contain what was added before.
  for (Coupling& coupling : couplings_) coupling.known = coupling.used = false;
  used_.clear();
  free();
}

template <class S>
void BlockMatrix<S>::free() {
  changed_ = false;
  diagonal_ = freeDiagonal_;
  inverse_ = freeInverse_;
  for (const std::uint32_t k : used_) {
    std::fill(std::begin(couplings_[k].addition), std::end(couplings_[k].addition), S(0));
    couplings_[k].used = false;
    write(couplings_[k]);
  }
  used_.clear();
}

/// Entries of neighbours after the slot come after those of neighbours before it.
template <class S>
std::optional<std::size_t> BlockMatrix<S>::blockOf(std::size_t slot, std::size_t neighbour) const {
  assert(slot < slotCount() && neighbour < slotCount());
  const std::size_t chunk = slot / kGroup, lane = slot % kGroup;
  const std::size_t half = neighbour > slot ? 1 : 0;
  for (const std::size_t k : {2 * chunk + half, 2 * chunk + 1 - half}) {
    for (std::size_t e = pattern_.starts[k]; e < pattern_.starts[k + 1]; ++e) {
      if (pattern_.neighbours[kGroup * e + lane] == neighbour) return kernels::kWideBlock * e + lane;
    }
  }
  return std::nullopt;
}

template <class S>
void BlockMatrix<S>::read(Coupling& coupling) const {
  coupling.known = true;
  for (std::size_t k = 0; k < 9; ++k) {
    coupling.own[k] = blocks_[coupling.block + k * kGroup];
    coupling.ownMirrored[k] = blocks_[coupling.mirrored + k * kGroup];
  }
}

/// Writes the blocks of a pair: their own values plus the addition.
template <class S>
void BlockMatrix<S>::write(const Coupling& coupling) {
  // By entry of a block: its index in xx xy xz yy yz zz.
  constexpr std::size_t kPlaces[9] = {0, 1, 2, 1, 3, 4, 2, 4, 5};
  for (std::size_t k = 0; k < 9; ++k) {
    blocks_[coupling.block + k * kGroup] = coupling.own[k] + coupling.addition[kPlaces[k]];
    blocks_[coupling.mirrored + k * kGroup] = coupling.ownMirrored[k] + coupling.addition[kPlaces[k]];
  }
}

template <class S>
std::optional<std::uint32_t> BlockMatrix<S>::couplingOf(std::size_t first, std::size_t second) {
  const std::size_t low = std::min(slotOf(first), slotOf(second)), high = std::max(slotOf(first), slotOf(second));
  if (low == high) return std::nullopt;
  const std::optional<std::size_t> block = blockOf(low, high);
  if (!block) return std::nullopt;
  std::uint32_t& number = couplingAt_[*block / kernels::kWideBlock * kGroup + *block % kGroup];
  if (number > 0) return number - 1;
  const std::optional<std::size_t> mirrored = blockOf(high, low);
  if (!mirrored) return std::nullopt;
  Coupling& coupling = couplings_.emplace_back();
  coupling.first = low;
  coupling.second = high;
  coupling.block = *block;
  coupling.mirrored = *mirrored;
  number = static_cast<std::uint32_t>(couplings_.size());
  return number - 1;
}

template <class S>
void BlockMatrix<S>::couple(std::uint32_t number, const S block[6]) {
  assert(number < couplings_.size());
  changed_ = true;
  Coupling& coupling = couplings_[number];
  if (!coupling.used) {
    if (massAt(coupling.first) == S(0) || massAt(coupling.second) == S(0)) return;
    if (!coupling.known) read(coupling);
    coupling.used = true;
    used_.push_back(number);
  }
  for (std::size_t k = 0; k < 6; ++k) coupling.addition[k] += block[k];
}

template <class S>
void BlockMatrix<S>::applyCouplings() {
  for (const std::uint32_t k : used_) write(couplings_[k]);
}

template <class S>
void BlockMatrix<S>::resist(std::size_t node, const S block[6]) {
  assert(node < nodeCount());
  if (mass(node) == S(0)) return;
  changed_ = true;
  S m[6], inverse[6];
  diagonal(node, m);
  for (std::size_t k = 0; k < 6; ++k) m[k] += block[k];
  writeBlock(m, slotOf(node), diagonal_);
  invertSymmetric(m, inverse);
  writeBlock(inverse, slotOf(node), inverse_);
}

template <class S>
void BlockMatrix<S>::fix(std::size_t node) {
  const S none[6] = {};
  writeBlock(none, slotOf(node), inverse_);
}

template <class S>
void BlockMatrix<S>::freeInverse(std::size_t node, S out[6]) const {
  readBlock(freeInverse_, slotOf(node), out);
}

template <class S>
void BlockMatrix<S>::diagonal(std::size_t node, S out[6]) const {
  readBlock(diagonal_, slotOf(node), out);
}

/// The matrix d (d^T D d)^-1 d^T.
template <class S>
void BlockMatrix<S>::fixAllBut(std::size_t node, const S d[3]) {
  if (mass(node) == S(0)) return;
  S m[6];
  diagonal(node, m);
  const S bend = m[0] * d[0] * d[0] + m[3] * d[1] * d[1] + m[5] * d[2] * d[2] +
                 2 * (m[1] * d[0] * d[1] + m[2] * d[0] * d[2] + m[4] * d[1] * d[2]);
  const S scale = bend > S(0) ? 1 / bend : S(0);
  const S inverse[6] = {scale * d[0] * d[0], scale * d[0] * d[1], scale * d[0] * d[2],
                        scale * d[1] * d[1], scale * d[1] * d[2], scale * d[2] * d[2]};
  writeBlock(inverse, slotOf(node), inverse_);
}

/// With B the inverse of the block, B - B n (n^T B n)^-1 n^T B is its inverse in the plane.
template <class S>
void BlockMatrix<S>::fixAlong(std::size_t node, const S n[3]) {
  if (mass(node) == S(0)) return;
  S b[6], m[6];
  diagonal(node, m);
  invertSymmetric(m, b);
  const S bn[3] = {b[0] * n[0] + b[1] * n[1] + b[2] * n[2], b[1] * n[0] + b[3] * n[1] + b[4] * n[2],
                   b[2] * n[0] + b[4] * n[1] + b[5] * n[2]};
  const S along = bn[0] * n[0] + bn[1] * n[1] + bn[2] * n[2];
  const S scale = along > S(0) ? 1 / along : S(0);
  const S inverse[6] = {b[0] - scale * bn[0] * bn[0], b[1] - scale * bn[0] * bn[1], b[2] - scale * bn[0] * bn[2],
                        b[3] - scale * bn[1] * bn[1], b[4] - scale * bn[1] * bn[2], b[5] - scale * bn[2] * bn[2]};
  writeBlock(inverse, slotOf(node), inverse_);
}

template <class S>
void BlockMatrix<S>::setOuter(const std::vector<std::uint32_t>& slots, const std::vector<double>& u) {
  assert(u.size() == 3 * slots.size());
  if (slots != outerSlots_) {
    outerSlots_ = slots;
    extraIsZero_ = false;
  }
  outer_.assign(u.size(), S(0));
  std::transform(u.begin(), u.end(), outer_.begin(), [](double value) { return static_cast<S>(value); });
}

/// u . v, of points.
template <class S>
S BlockMatrix<S>::outerFactor(const S* points) const {
  double sum = 0.0;
  for (std::size_t k = 0; k < outerSlots_.size(); ++k) {
    const S *u = &outer_[3 * k], *v = points + 4 * outerSlots_[k];
    sum += static_cast<double>(u[0]) * static_cast<double>(v[0]) +
           static_cast<double>(u[1]) * static_cast<double>(v[1]) +
           static_cast<double>(u[2]) * static_cast<double>(v[2]);
  }
  return static_cast<S>(sum);
}

template <class S>
void BlockMatrix<S>::addOuter(S factor, S* wide) const {
  for (std::size_t k = 0; k < outerSlots_.size(); ++k) {
    S* to = wide + wideOfSlot(outerSlots_[k]);
    for (std::size_t i = 0; i < 3; ++i) to[i * kGroup] += factor * outer_[3 * k + i];
  }
}

template <class S>
void BlockMatrix<S>::multiply(const S* points, S* wide, ParallelFor* threads) const {
  assert(points && wide);
  sweep(Order::Any, threads, [&](Work& part, const Table& table) {
    part.stepPoints = const_cast<S*>(points);
    part.rest = wide;
    part.minMass = kMinMass<S>;
    changed_ ? table.multiply(part) : table.multiplyByDifferences(part);
  });
  if (!outerSlots_.empty()) addOuter(outerFactor(points), wide);
}

template <class S>
double BlockMatrix<S>::precondition(const S* impulses, S* velocities, ParallelFor* threads) {
  assert(impulses && velocities && impulses != residual_.data());
  const double squared = lowerInto(impulses, residual_.data(), threads);
  backward(S(0), threads);
  std::copy(step_.begin(), step_.end(), velocities);
  return squared;
}

template <class S>
double BlockMatrix<S>::lowerInto(const S* impulses, S* wide, ParallelFor* threads) {
  return sweep(Order::Forward, threads, [&](Work& part, const Table& table) {
    part.residual = const_cast<S*>(impulses);  // this kernel only reads it
    part.rest = wide;
    return table.lower(part);
  });
}

template <class S>
double BlockMatrix<S>::lower(ParallelFor* threads) {
  return lowerInto(residual_.data(), residual_.data(), threads);
}

template <class S>
double BlockMatrix<S>::squaredNorm(const S* impulses, ParallelFor* threads) {
  return lowerInto(impulses, rest_.data(), threads);
}

template <class S>
void BlockMatrix<S>::multiplyDifference(const S* first, const S* second, S* difference, S* image,
                                        ParallelFor* threads) {
  assert(first && difference && image);
  sweep(Order::Any, threads, [&](Work& part, const Table& table) {
    part.first = first;
    part.second = second;
    part.step = difference;
    table.difference(part);
  });
  multiply(stepPoints_.data(), image, threads);
}

template <class S>
double BlockMatrix<S>::inner(const S* first, const S* second, ParallelFor* threads) const {
  assert(first && second);
  return sweep(Order::Any, threads, [&](Work& part, const Table& table) {
    part.first = first;
    part.second = second;
    return table.inner(part);
  });
}

template <class S>
void BlockMatrix<S>::backward(S factor, ParallelFor* threads) {
  sweep(Order::Backward, threads, [&](Work& part, const Table& table) {
    part.factor = factor;
    table.backward(part);
  });
}

template <class S>
double BlockMatrix<S>::forward(const S* extra, ParallelFor* threads) {
  if (!outerSlots_.empty()) {
    outerExtra_.resize(wideSize());
    if (extra) {
      std::copy_n(extra, wideSize(), outerExtra_.data());
    } else if (!extraIsZero_) {
      std::fill(outerExtra_.begin(), outerExtra_.end(), S(0));
    } else {
      for (const std::uint32_t slot : outerSlots_) {
        for (std::size_t i = 0; i < 3; ++i) outerExtra_[wideOfSlot(slot) + i * kGroup] = S(0);
      }
    }
    extraIsZero_ = !extra;
    addOuter(outerFactor(stepPoints_.data()), outerExtra_.data());
    extra = outerExtra_.data();
  }
  return sweep(Order::Forward, threads, [&](Work& part, const Table& table) {
    part.extra = extra;
    return table.forward(part);
  });
}

template <class S>
double BlockMatrix<S>::advance(S factor, ParallelFor* threads) {
  return sweep(Order::Any, threads, [&](Work& part, const Table& table) {
    part.factor = factor;
    return table.advance(part);
  });
}

template <class S>
void BlockMatrix<S>::clear() {
  for (AlignedVector<S>* v : {&direction_, &stepPoints_, &lowerPoints_}) v->assign(v->size(), S(0));
}

TETSKIN_INSTANTIATE_CLASS(BlockMatrix)

}  // namespace tetskin::elastic_detail
