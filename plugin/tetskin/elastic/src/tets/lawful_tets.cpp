// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// CorotatedTets: tets with another law than the corotated one, see kernels/hyperelasticity.h. The matrix has their
// corotated stiffness times how much stiffer than at rest they are.
#include <tetskin/core/src/base/instantiate.h>
#include <tetskin/elastic/src/tets/corotated_tets.h>

#include <algorithm>
#include <limits>

namespace tetskin::elastic_detail {

using kernels::kGroup;
using kernels::kLaw;

template <class S>
void CorotatedTets<S>::setLaws(const std::vector<ElasticLaw>& byTet) {
  const auto isOther = [](const ElasticLaw& law) { return law.kind != ElasticLaw::Kind::Corotated; };
  const bool any = std::any_of(byTet.begin(), byTet.end(), isOther);
  lawStiffening_ = countedLaws_ = 1.0;
  lawsOutdated_ = false;
  forBoth([&](auto& packed) {
    packed.laws.assign(any ? kLaw * packed.packs.size() : 0, S(0));
    packed.lawStiffer.resize(any ? kGroup * packed.packs.size() : 0, S(1));
  });
  if (!any) return;
  findLeastHeight();
  forTets([&](auto& packed, std::size_t tet, const auto& cageTets) {
    S* const to = &packed.laws[kLaw * (tet / kGroup) + tet % kGroup];
    double c2 = 0.0, c3 = 0.0, most = std::numeric_limits<double>::infinity();
    for (const auto own : cageTets) {
      const ElasticLaw& law = byTet[static_cast<std::size_t>(own)];
      if (isOther(law)) to[0] = S(1);
      c2 += law.c2;
      c3 += law.c3;
      most = std::min(most, largestDistortion(law));
    }
    to[kGroup] = static_cast<S>(c2 / static_cast<double>(cageTets.size()));
    to[3 * kGroup] = static_cast<S>(most);
    to[2 * kGroup] = static_cast<S>(c3 / static_cast<double>(cageTets.size()));
  });
}

/// A height is one over the gradient of its node's weight.
template <class S>
void CorotatedTets<S>::findLeastHeight() {
  double steepest = 0.0;
  const auto add = [&](const std::array<double, 9>& gradients, double times) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3d own = Eigen::Vector3d::Map(&gradients[3 * k]);
      steepest = std::max(steepest, times * own.norm());
      sum += own;
    }
    steepest = std::max(steepest, times * sum.norm());
  };
  for (const std::array<double, 9>& gradients : rest_.gradients) add(gradients, 1.0);
  for (const RestQuadraticTet& tet : rest_.quadratic) add(tet.gradients, 2.0);
  leastHeight_ = 1.0 / steepest;
}

/// After forces were found.
template <class S>
void CorotatedTets<S>::findLawStiffening() {
  if (linear_.laws.empty() && quadratic_.laws.empty()) return;
  double whole = 0.0, now = 0.0, counted = 0.0;
  lawsOutdated_ = false;
  forBoth([&](auto& packed) {
    for (std::size_t tet = 0; tet < packed.lawStiffer.size(); ++tet) {
      const auto shear = static_cast<double>(packed.packs[tet / kGroup].shear[tet % kGroup]);
      const double wanted = matrixFactor(packed, tet);
      const double inMatrix = packed.factors.empty() ? 1.0 : static_cast<double>(packed.factors[tet]);
      whole += shear;
      now += shear * static_cast<double>(packed.lawStiffer[tet]);
      counted += shear * inMatrix * static_cast<double>(packed.lawStiffer[tet]) / wanted;
      lawsOutdated_ |= isStale(wanted, inMatrix);
    }
  });
  lawStiffening_ = now / whole;
  lawsOutdated_ |= isStale(counted, now);
}

#define TETSKIN_INSTANTIATE(S)                                                   \
  template void CorotatedTets<S>::setLaws(const std::vector<ElasticLaw>& byTet); \
  template void CorotatedTets<S>::findLawStiffening();
TETSKIN_FOR_SCALARS(TETSKIN_INSTANTIATE)
#undef TETSKIN_INSTANTIATE

}  // namespace tetskin::elastic_detail
