// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// CorotatedTets: rest shapes that change. The kernels let what yields flow, see kernels/rest_change.h.
#include <tetskin/core/src/base/instantiate.h>
#include <tetskin/elastic/src/tets/corotated_tets.h>

#include <Eigen/LU>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace tetskin::elastic_detail {
namespace {

using kernels::kChange;
using kernels::kGroup;
using Matrix = Eigen::Matrix3d;

/// 1 - exp(-x) for x of 0 or more, to nine digits, by arithmetic alone: its bits are the same everywhere.
double shareIn(double x) {
  if (!(x < 30.0)) return 1.0;
  double left = 0.0;  // exp(-x / 64) - 1, by Taylor's series
  for (int k = 8; k >= 1; --k) left = -x / 64.0 / k * (1.0 + left);
  double kept = 1.0 + left;
  for (int k = 0; k < 6; ++k) kept *= kept;
  return x < 1e-3 ? x * (1.0 - 0.5 * x) : 1.0 - kept;
}

/// cosh(x) - 1 for x up to 6, by Taylor's series, whose bits are the same everywhere.
double coshMinus1(double x) {
  double sum = 0.0;
  for (int k = 20; k >= 1; --k) sum = x * x / (2.0 * k * (2.0 * k - 1.0)) * (1.0 + sum);
  return sum;
}

/// The plastic strain of kernels/rest_change.h of what is drawn out by this logarithmic strain.
double squaredPlasticStrain(double logarithmic) {
  return (coshMinus1(2.0 * logarithmic) + 2.0 * coshMinus1(logarithmic)) / 3.0;
}

/// A matrix that is stored wide, by rows.
template <class S>
Matrix narrowMatrix(const S* from) {
  Matrix matrix;
  for (int k = 0; k < 9; ++k) matrix(k / 3, k % 3) = static_cast<double>(from[k * kGroup]);
  return matrix;
}

template <class S>
void putMatrix(const Matrix& matrix, S* to) {
  for (int k = 0; k < 9; ++k) to[k * kGroup] = static_cast<S>(matrix(k / 3, k % 3));
}

/// The mean of what is given to some tets of the cage.
template <class Tets>
Matrix meanOf(const std::vector<std::array<double, 9>>& byTet, const Tets& tets) {
  Matrix sum = Matrix::Zero();
  for (const auto tet : tets) {
    sum += Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(byTet[static_cast<std::size_t>(tet)].data());
  }
  return sum / static_cast<double>(tets.size());
}

template <class Tets>
double meanOf(const std::vector<double>& byTet, const Tets& tets) {
  double sum = 0.0;
  for (const auto tet : tets) sum += byTet[static_cast<std::size_t>(tet)];
  return sum / static_cast<double>(tets.size());
}

}  // namespace

/// From now on, the tets have changes; at first, none.
template <class S>
void CorotatedTets<S>::makeChanges() {
  if (changes()) return;
  forBoth([](auto& packed) {
    using Pack = typename std::decay_t<decltype(packed.packs)>::value_type;
    const std::size_t points = Pack::kPoints * packed.packs.size();
    packed.changes.assign(kChange * points, S(0));
    for (std::size_t at = 0; at < points; ++at) std::fill_n(&packed.changes[kChange * at + 9 * kGroup], kGroup, S(1));
    packed.assembledChanges = packed.changes;
    packed.flowed.assign(kGroup * points, S(0));
  });
}

template <class S>
void CorotatedTets<S>::setExtraDamping(const std::vector<double>& byTet) {
  forBoth([&](auto& packed) { packed.extraDamping.assign(byTet.empty() ? 0 : kGroup * packed.packs.size(), 0.0); });
  if (byTet.empty()) return;
  forTets(
      [&](auto& packed, std::size_t tet, const auto& cageTets) { packed.extraDamping[tet] = meanOf(byTet, cageTets); });
}

template <class S>
void CorotatedTets<S>::findFactors(double perSecond) {
  perSecond_ = perSecond / countedLaws_;
  isStiffer_ = lawsOutdated_ = false;
  forBoth([&](auto& packed) {
    const bool any = !packed.stiffer.empty() || !packed.lawStiffer.empty() || !packed.extraDamping.empty();
    packed.factors.resize(any ? kGroup * packed.packs.size() : 0);
    for (std::size_t tet = 0; tet < packed.factors.size(); ++tet)
      packed.factors[tet] = static_cast<S>(matrixFactor(packed, tet));
  });
}

template <class S>
std::vector<double> CorotatedTets<S>::extraShares() {
  std::vector<double> shares;
  const auto add = [&](auto& packed, std::size_t tets) {
    for (std::size_t tet = 0; tet < tets; ++tet) shares.push_back(1.0 - 1.0 / dampedFactor(packed, tet));
  };
  add(linear_, rest_.count());
  add(quadratic_, rest_.quadratic.size());
  return shares;
}

template <class S>
bool CorotatedTets<S>::serializeFactors(StateStream& stream) {
  bool changed = false;
  stream(perSecond_);
  forBoth([&](auto& packed) {
    const AlignedVector<S> before = packed.factors;
    stream.array(packed.factors);
    if (!packed.factors.empty() && packed.factors.size() != kGroup * packed.packs.size()) {
      packed.factors.clear();
      stream.fail();
    }
    changed |= before != packed.factors;
  });
  return changed;
}

template <class S>
bool CorotatedTets<S>::setStiffnessScale(const std::vector<double>& byTet) {
  if (byTet.empty() && madeVolumes_.empty()) return false;
  if (madeVolumes_.empty()) {
    madeVolumes_ = rest_.volumes;
    for (const RestQuadraticTet& tet : rest_.quadratic) madeVolumes_.push_back(tet.volume);
  }
  bool changed = false;
  const auto set = [&](double& volume, double made, const auto& cageTets) {
    const double now = byTet.empty() ? made : made * meanOf(byTet, cageTets);
    changed |= now != volume;
    volume = now;
  };
  for (std::size_t t = 0; t < rest_.count(); ++t)
    set(rest_.volumes[t], madeVolumes_[t], std::array<std::uint32_t, 1>{rest_.cageTets[t]});
  for (std::size_t q = 0; q < rest_.quadratic.size(); ++q)
    set(rest_.quadratic[q].volume, madeVolumes_[rest_.count() + q], rest_.quadratic[q].cageTets);
  return changed;
}

template <class S>
void CorotatedTets<S>::setGiven(const GivenShapes& byTet) {
  const std::vector<std::array<double, 9>>& shapes = byTet.shapes;
  if (shapes.empty() && !isGiven_) return;
  makeChanges();
  forBoth([&](auto& packed) {
    packed.given.resize(9 * packed.flowed.size(), S(0));
    packed.stiffenings.resize(kGroup * packed.packs.size(), {1.0, 3.0});
  });
  const bool known = isGiven_ && !shapes.empty() && given_.shapes.size() == shapes.size();
  forTets([&](auto& packed, std::size_t tet, const auto& cageTets) {
    const bool stays = known && std::all_of(cageTets.begin(), cageTets.end(), [&](auto own) {
                         const auto k = static_cast<std::size_t>(own);
                         return given_.shapes[k] == shapes[k];
                       });
    if (!stays) setGiven(packed, tet, shapes.empty() ? Matrix(Matrix::Identity()) : meanOf(shapes, cageTets));
  });
  given_ = byTet;
  isGiven_ = !shapes.empty();
  setStiffer();
  findStiffening();
}

template <class S>
void CorotatedTets<S>::changeGiven(const std::vector<int>& cageTets, const std::vector<std::uint32_t>& numbers,
                                   const GivenShapes& given) {
  assert(isGiven_ && knowsGiven() && given.shapes.size() == cageTets.size());
  const bool wereStiffer = !given_.stiffer.empty();
  if (!wereStiffer) given_.stiffer.assign(given_.shapes.size(), 1.0);
  for (std::size_t k = 0; k < cageTets.size(); ++k) {
    const auto tet = static_cast<std::size_t>(cageTets[k]);
    given_.shapes[tet] = given.shapes[k];
    given_.stiffer[tet] = given.stiffer[k];
  }
  if (!wereStiffer) setStiffer();
  std::uint32_t last = 0xffffffff;
  for (const int cageTet : cageTets) {
    const std::uint32_t number = numbers[static_cast<std::size_t>(cageTet)];
    if (number == last) continue;  // another part of the same quadratic tet
    last = number;
    forTet(number, [&](auto& packed, std::size_t tet, const auto& own) {
      setGiven(packed, tet, meanOf(given_.shapes, own));
      setStiffer(packed, tet, own);
    });
  }
  findStiffening();
}

template <class S>
template <class Tets>
void CorotatedTets<S>::setGiven(Tets& packed, std::size_t tet, const Eigen::Matrix3d& exact) {
  using Pack = typename std::decay_t<decltype(packed.packs)>::value_type;
  // Rounded as it is stored: what has flowed is found again exactly.
  const Matrix given = exact.template cast<S>().template cast<double>();
  const Matrix inverse = given.inverse();
  const double volume = given.determinant();
  packed.stiffenings[tet] = {volume, inverse.squaredNorm()};
  for (std::size_t point = 0; point < Pack::kPoints; ++point) {
    const std::size_t at = Pack::kPoints * (tet / kGroup) + point, lane = tet % kGroup;
    S* const change = &packed.changes[kChange * at + lane];
    S* const own = &packed.given[9 * kGroup * at + lane];
    const Matrix before = isGiven_ ? narrowMatrix(own) : Matrix(Matrix::Identity());
    // What stays has the same bits.
    if (before == given) {
      if (!isGiven_) putMatrix(given, own);
      continue;
    }
    Matrix plastic = Matrix::Identity();  // P^-1
    if (everFlowed_) plastic = before * (plastic + narrowMatrix(change));
    putMatrix(given, own);
    putMatrix(inverse * plastic - Matrix::Identity(), change);
    change[9 * kGroup] = static_cast<S>(volume);
  }
}

template <class S>
void CorotatedTets<S>::setStiffer() {
  const bool none = given_.stiffer.empty();
  forBoth([&](auto& packed) { packed.stiffer.assign(none ? 0 : kGroup * packed.packs.size(), 1.0); });
  if (none) return;
  forTets([&](auto& packed, std::size_t tet, const auto& cageTets) { setStiffer(packed, tet, cageTets); });
}

template <class S>
template <class Packs, class Tets>
void CorotatedTets<S>::setStiffer(Packs& packed, std::size_t tet, const Tets& cageTets) {
  packed.stiffer[tet] = meanOf(given_.stiffer, cageTets);
  const double counted = packed.factors.empty() ? 1.0 : static_cast<double>(packed.factors[tet]);
  isStiffer_ |= isStale(matrixFactor(packed, tet), counted);
}

template <class S>
void CorotatedTets<S>::findStiffening() {
  stiffening_ = 1.0;
  if (!isGiven_) return;
  double whole = 0.0, now = 0.0;
  forBoth([&](auto& packed) {
    for (std::size_t tet = 0; tet < packed.stiffenings.size(); ++tet) {
      const auto volume = static_cast<double>(packed.packs[tet / kGroup].shear[tet % kGroup]);
      whole += volume;
      const auto& [grown, squared] = packed.stiffenings[tet];
      now += (packed.stiffer.empty() ? 1.0 : packed.stiffer[tet]) * volume * grown * squared / 3.0;
    }
  });
  stiffening_ = now / whole;
}

template <class S>
void CorotatedTets<S>::setPlasticity(const Plasticity* plasticity) {
  if (!plasticity) {
    forBoth([](auto& packed) { packed.yields.clear(); });
    return;
  }
  makeChanges();
  everFlowed_ = true;
  flowRate_ = plasticity->flowRate;
  // A tet that is drawn out farther, to 20 times its length, is badly conditioned: in float its forces explode.
  constexpr double kLargestStrain = 3.0;
  const double largest = std::sqrt(squaredPlasticStrain(std::min(plasticity->largestStrain, kLargestStrain)));
  largestStrain_ = std::max(static_cast<S>(largest), std::numeric_limits<S>::min());
  const double perStress = 1.0 / (std::sqrt(6.0) * mu_);
  forBoth([&](auto& packed) { packed.yields.assign(2 * kGroup * packed.packs.size(), S(0)); });
  yieldEnergy_ = 0.0;
  forTets([&](auto& packed, std::size_t tet, const auto& cageTets) {
    S* const yield = &packed.yields[2 * kGroup * (tet / kGroup) + tet % kGroup];
    const auto& byTet = plasticity->yieldStresses;
    const double stress = byTet.empty() ? plasticity->yieldStress : meanOf(byTet, cageTets);
    yield[0] = static_cast<S>(perStress * stress);
    yield[kGroup] = static_cast<S>(perStress * plasticity->hardening);
    using Pack = typename std::decay_t<decltype(packed.packs)>::value_type;
    const auto shear = static_cast<double>(packed.packs[tet / kGroup].shear[tet % kGroup]);
    const double volume = shear * static_cast<double>(Pack::kPoints) / (2.0 * mu_);
    yieldEnergy_ += 0.5 * volume * stress * stress / youngsModulus_;
  });
}

/// A body on its way back to its first shape would flow again: it waits until it has been there for a while.
template <class S>
void CorotatedTets<S>::flowFor(double seconds) {
  constexpr double kCalmSeconds = 0.5;
  if (returns_) {
    calmSeconds_ = yields_ ? 0.0 : calmSeconds_ + seconds;
    returns_ = calmSeconds_ < kCalmSeconds;
  }
  flowShare_ = returns_ ? S(0) : static_cast<S>(flowShare(seconds));
}

template <class S>
void CorotatedTets<S>::forgetFlow() {
  if (!changes()) return;
  returns_ = yields_ = true;
  forBoth([&](auto& packed) {
    std::fill(packed.flowed.begin(), packed.flowed.end(), S(0));
    for (std::size_t at = 0; at < packed.flowed.size() / kGroup; ++at) {
      for (std::size_t lane = 0; lane < kGroup; ++lane) {
        Matrix inverse = Matrix::Identity();
        if (isGiven_) inverse = narrowMatrix(&packed.given[9 * kGroup * at + lane]).inverse();
        putMatrix(inverse - Matrix::Identity(), &packed.changes[kChange * at + lane]);
      }
    }
  });
}

template <class S>
double CorotatedTets<S>::flowShare(double seconds) const {
  return std::isfinite(flowRate_) ? shareIn(flowRate_ * seconds) : 1.0;
}

template <class S>
std::vector<double> CorotatedTets<S>::plasticStrains(std::size_t cageTets) {
  std::vector<double> strains(cageTets, 0.0);
  if (!changes()) return strains;
  forTets([&](auto& packed, std::size_t tet, const auto& own) {
    using Pack = typename std::decay_t<decltype(packed.packs)>::value_type;
    double sum = 0.0;
    for (std::size_t point = 0; point < Pack::kPoints; ++point) {
      sum += static_cast<double>(packed.flowed[kGroup * (Pack::kPoints * (tet / kGroup) + point) + tet % kGroup]);
    }
    // What repeats the last tet has not flowed.
    for (const auto t : own) strains[t] = std::max(strains[t], sum / static_cast<double>(Pack::kPoints));
  });
  return strains;
}

/// What is given, and the limits of flow, are set again by their owner.
template <class S>
bool CorotatedTets<S>::serializeChanges(StateStream& stream, bool ofMatrix) {
  bool has = changes();
  stream(has);
  if (!has) {
    const bool changed = changes();
    forBoth([](auto& packed) {
      packed.changes.clear();
      packed.assembledChanges.clear();
      packed.flowed.clear();
      packed.given.clear();
      packed.yields.clear();
      packed.stiffer.clear();
      packed.stiffenings.clear();
    });
    given_ = {};
    isStiffer_ = isGiven_ = everFlowed_ = returns_ = yields_ = false;
    stiffening_ = 1.0;
    return changed;
  }
  bool changed = false;
  makeChanges();
  if (stream.restoring()) given_ = {};
  stream(isGiven_);
  stream(everFlowed_);
  stream(returns_);
  stream(yields_);
  stream(calmSeconds_);
  forBoth([&](auto& packed) {
    stream.plain(packed.changes.data(), packed.changes.size());
    stream.plain(packed.flowed.data(), packed.flowed.size());
    if (isGiven_) {
      packed.given.resize(9 * packed.flowed.size());
      stream.plain(packed.given.data(), packed.given.size());
    }
    if (!ofMatrix) return;
    const AlignedVector<S> before = packed.assembledChanges;
    stream.plain(packed.assembledChanges.data(), packed.assembledChanges.size());
    changed |= before != packed.assembledChanges;
  });
  return changed;
}

#define TETSKIN_INSTANTIATE(S)                                                                                      \
  template void CorotatedTets<S>::setGiven(const GivenShapes& byTet);                                               \
  template void CorotatedTets<S>::changeGiven(const std::vector<int>& cageTets,                                     \
                                              const std::vector<std::uint32_t>& numbers, const GivenShapes& given); \
  template bool CorotatedTets<S>::setStiffnessScale(const std::vector<double>& byTet);                              \
  template void CorotatedTets<S>::setPlasticity(const Plasticity* plasticity);                                      \
  template void CorotatedTets<S>::forgetFlow();                                                                     \
  template void CorotatedTets<S>::setExtraDamping(const std::vector<double>& byTet);                                \
  template void CorotatedTets<S>::findFactors(double perSecond);                                                    \
  template std::vector<double> CorotatedTets<S>::extraShares();                                                     \
  template void CorotatedTets<S>::flowFor(double seconds);                                                          \
  template double CorotatedTets<S>::flowShare(double seconds) const;                                                \
  template std::vector<double> CorotatedTets<S>::plasticStrains(std::size_t cageTets);                              \
  template bool CorotatedTets<S>::serializeChanges(StateStream& stream, bool ofMatrix);                             \
  template bool CorotatedTets<S>::serializeFactors(StateStream& stream);
TETSKIN_FOR_SCALARS(TETSKIN_INSTANTIATE)
#undef TETSKIN_INSTANTIATE

}  // namespace tetskin::elastic_detail
