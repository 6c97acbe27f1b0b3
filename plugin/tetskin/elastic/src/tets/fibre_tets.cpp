// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/instantiate.h>
#include <tetskin/elastic/src/tets/fibre_tets.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tetskin::elastic_detail {
namespace {

/// A fibre that is shorter than this has no direction, and no force.
constexpr double kShortest = 1e-6;

template <class S>
Eigen::Vector3d turnedBy(const S* quaternion, const Eigen::Vector3d& v) {
  const Eigen::Vector3d axis(static_cast<double>(quaternion[1]), static_cast<double>(quaternion[2]),
                             static_cast<double>(quaternion[3]));
  const Eigen::Vector3d twice = 2.0 * axis.cross(v);
  return v + static_cast<double>(quaternion[0]) * twice + axis.cross(twice);
}

/// That of a tet, of its parts in the cage.
template <class Parts>
TetFibre meanFibre(const std::vector<TetFibre>& family, const Parts& parts) {
  TetFibre mean;
  const double share = 1.0 / static_cast<double>(parts.size());
  for (const auto part : parts) {
    const TetFibre& own = family[static_cast<std::size_t>(part)];
    if (!(own.stiffness > 0.0)) continue;
    const double weight = share * own.stiffness;
    mean.along += (mean.along.dot(own.along) < 0.0 ? -weight : weight) * own.along;
    mean.stiffness += weight;
    mean.tensionOnly |= own.tensionOnly;
  }
  if (mean.stiffness > 0.0) mean.along /= mean.stiffness;
  return mean;
}

}  // namespace

template <class S>
FibreTets<S>::FibreTets(const RestTets& rest, const std::vector<std::uint32_t>& slotOf,
                        const std::vector<std::vector<TetFibre>>& families, double shearModulus)
    : layerSize_(4 * rest.cornerCount()), shearModulus_(shearModulus) {
  std::vector<std::size_t> layers(rest.count() + rest.quadratic.size(), 0);  // by tet: the next free one
  for (const std::vector<TetFibre>& family : families) {
    for (std::size_t t = 0; t < rest.count(); ++t) {
      const TetFibre fibre = meanFibre(family, std::array<std::uint32_t, 1>{rest.cageTets[t]});
      if (fibre.stiffness > 0.0) addLinear(rest, slotOf, t, fibre, layers[t]++);
    }
    for (std::size_t q = 0; q < rest.quadratic.size(); ++q) {
      const TetFibre fibre = meanFibre(family, rest.quadratic[q].cageTets);
      if (fibre.stiffness > 0.0) addQuadratic(rest, slotOf, q, fibre, layers[rest.count() + q]++);
    }
  }
  layerCount_ = layers.empty() ? 0 : 2 * *std::max_element(layers.begin(), layers.end());
  corners_.assign(layerSize_ * layerCount_, S(0));
}

template <class S>
typename FibreTets<S>::Spring& FibreTets<S>::add(const TetFibre& fibre, double volume) {
  Spring& spring = springs_.emplace_back();
  spring.along = fibre.along;
  spring.stiffness = volume * fibre.stiffness;
  spring.modulus = fibre.stiffness;
  spring.tensionOnly = fibre.tensionOnly;
  spring.now.d = spring.assembled.d = fibre.along.normalized();
  stiffness_ += spring.stiffness;
  return spring;
}

template <class S>
void FibreTets<S>::addLinear(const RestTets& rest, const std::vector<std::uint32_t>& slotOf, std::size_t tet,
                             const TetFibre& fibre, std::size_t layer) {
  Spring& spring = add(fibre, rest.volumes[tet]);
  const std::array<double, 4> slopes = weightSlopes(rest.gradients[tet], fibre.along);
  for (std::size_t n = 0; n < 4; ++n) {
    spring.slots[n] = slotOf[static_cast<std::size_t>(rest.tets[tet][n])];
    spring.weights[n] = slopes[n];
  }
  spring.corner = 2 * layer * layerSize_ + 16 * tet;
}

/// The three components of a node at one point are in three corners.
template <class S>
void FibreTets<S>::addQuadratic(const RestTets& rest, const std::vector<std::uint32_t>& slotOf, std::size_t number,
                                const TetFibre& fibre, std::size_t layer) {
  const RestQuadraticTet& tet = rest.quadratic[number];
  const std::array<double, 4> slopes = weightSlopes(tet.gradients, fibre.along);
  for (std::size_t point = 0; point < kQuadraticPoints; ++point) {
    Spring& spring = add(fibre, tet.volume / static_cast<double>(kQuadraticPoints));
    spring.nodes = kQuadraticNodes;
    spring.toNode = 12;
    spring.toComponent = 4;
    spring.corner = 2 * layer * layerSize_ + 4 * rest.quadraticCorner(number) + point;
    spring.weights = quadraticSlopes(slopes, Eigen::Vector3d::Map(&tet.points[3 * point]));
    for (std::size_t n = 0; n < kQuadraticNodes; ++n) {
      spring.slots[n] = slotOf[static_cast<std::size_t>(tet.nodes[n])];
    }
  }
}

/// With displacements, a strain below the last digit of 1 is not lost.
template <class S>
typename FibreTets<S>::Stretch FibreTets<S>::stretchOf(const Spring& spring, const S* points, const S* frames,
                                                       const std::uint32_t* partOf) const {
  Eigen::Vector3d moved = Eigen::Vector3d::Zero();
  for (std::size_t n = 0; n < spring.nodes; ++n) {
    const S* x = &points[4 * std::size_t{spring.slots[n]}];
    for (int k = 0; k < 3; ++k) moved[k] += spring.weights[n] * static_cast<double>(x[k]);
  }
  Stretch stretch;
  double squared = moved.squaredNorm() - 1.0;  // of |F a|, less 1
  stretch.carried = moved;
  if (frames) {
    const std::size_t part = partOf ? partOf[spring.slots[0]] : 0;
    const Eigen::Vector3d turned = turnedBy(frames + 4 * part, spring.along);
    stretch.carried += turned;
    squared = moved.squaredNorm() + 2.0 * turned.dot(moved) + (spring.along.squaredNorm() - 1.0);
  }
  stretch.length = std::sqrt(stretch.carried.squaredNorm());
  stretch.strain = squared / (stretch.length + 1.0);
  return stretch;
}

template <class S>
void FibreTets<S>::addForces(const S* points, const S* frames, const std::uint32_t* partOf, bool keeps, S* out) {
  for (Spring& spring : springs_) {
    const Stretch stretch = stretchOf(spring, points, frames, partOf);
    const bool taut = stretch.strain > 0.0, pulls = taut || !spring.tensionOnly;
    if (!(stretch.length > kShortest)) {
      if (keeps) spring.now = spring.assembled;  // a snapshot has no other direction
      continue;
    }
    const Eigen::Vector3d d = stretch.carried / stretch.length;
    if (keeps) spring.now = {d, taut ? stretch.strain / stretch.length : 0.0};
    if (!pulls) continue;
    const double force = -spring.stiffness * stretch.strain;
    for (std::size_t n = 0; n < spring.nodes; ++n) {
      S* to = &out[4 * std::size_t{spring.slots[n]}];
      for (int k = 0; k < 3; ++k) to[k] += static_cast<S>(force * spring.weights[n] * d[k]);
    }
  }
  if (keeps) findOutdated();
}

template <class S>
double FibreTets<S>::energy(const S* points, const S* frames, const std::uint32_t* partOf) const {
  double sum = 0.0;
  for (const Spring& spring : springs_) {
    const Stretch stretch = stretchOf(spring, points, frames, partOf);
    if (stretch.strain > 0.0 || !spring.tensionOnly) sum += 0.5 * spring.stiffness * stretch.strain * stretch.strain;
  }
  return sum;
}

template <class S>
void FibreTets<S>::findOutdated() {
  constexpr double kMore = 0.25;  // of what resists sidewards
  outdated_ = {};
  for (const Spring& spring : springs_) {
    const double squared = (spring.now.d - spring.assembled.d).squaredNorm();
    outdated_.mean += squared;
    outdated_.largest = std::max(outdated_.largest, squared);
    const double counted = shearModulus_ + spring.modulus * spring.assembled.t;
    outdated_.stiffer |= spring.modulus * (spring.now.t - spring.assembled.t) > kMore * counted;
  }
  outdated_.mean /= static_cast<double>(springs_.size());
}

template <class S>
void FibreTets<S>::assemble(double alpha) {
  for (Spring& spring : springs_) spring.assembled = spring.now;
  outdated_ = {};
  assembleAgain(alpha);
}

template <class S>
void FibreTets<S>::assembleAgain(double alpha) {
  for (const Spring& spring : springs_) {
    const double along = std::sqrt(alpha * spring.stiffness * (1.0 - spring.assembled.t)),
                 around = std::sqrt(alpha * spring.stiffness * spring.assembled.t);
    for (std::size_t n = 0; n < spring.nodes; ++n) {
      S* const to = &corners_[spring.corner + spring.toNode * n];
      for (std::size_t k = 0; k < 3; ++k) {
        to[spring.toComponent * k] =
            static_cast<S>(along * spring.weights[n] * spring.assembled.d[static_cast<Eigen::Index>(k)]);
      }
      to[layerSize_] = static_cast<S>(around * spring.weights[n]);
    }
  }
}

template <class S>
bool FibreTets<S>::serialize(StateStream& stream) {
  bool changed = false;
  for (Spring& spring : springs_) {
    const Direction before = spring.assembled;
    stream.plain(spring.assembled.d.data(), 3);
    stream(spring.assembled.t);
    if (!(spring.assembled.t >= 0.0 && spring.assembled.t < 1.0)) stream.fail();
    changed |= before.d != spring.assembled.d || before.t != spring.assembled.t;
  }
  return changed;
}

TETSKIN_INSTANTIATE_CLASS(FibreTets)

}  // namespace tetskin::elastic_detail
