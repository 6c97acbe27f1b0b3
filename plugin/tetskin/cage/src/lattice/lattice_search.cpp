// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// This work is based on:
//   Martin Roberts, "The Unreasonable Effectiveness of Quasirandom Sequences", 2018 (the sequence of origins)
#include <tetskin/cage/src/lattice/cage_joints.h>
#include <tetskin/cage/src/lattice/inside_fill.h>
#include <tetskin/cage/src/lattice/lattice_search.h>
#include <tetskin/cage/src/lattice/surface_cover.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace tetskin::cage_detail {
namespace {

/// A count this close to the target ends the search at once: a closer one is not worth more lattices.
constexpr double kGoodCount = 0.03;
/// Number of spacings to try at one origin before a count within kCountTolerance is accepted, and before the next
/// origin is tried.
constexpr std::size_t kSpacingsPerOrigin = 7;
/// Number of origins to try. A box of a dozen tets needs most of them, everything else one or two.
constexpr std::size_t kOrigins = 12;
/// Counting stops at this many times the target, plus a constant for small targets: this bounds the memory, and makes a
/// bad first guess cheap.
constexpr std::size_t kCountLimit = 3;
constexpr std::size_t kCountLimitMore = 200;
/// Mean width of a tet in lattice coordinates: the volume of tets that a plane touches, per area.
constexpr double kMeanWidth = 1.65;
/// Power with which the count depends on the spacing: between 2 for sheets and 3 for bulk. Only for the first steps.
constexpr double kCountPower = 2.5;
/// Steps without a bracket go slightly too far, so that the next count is likely to be on the other side.
constexpr double kOvershoot = 1.02;
/// Factor of the spacing after a count that was stopped.
constexpr double kStoppedFactor = 1.5;
/// Share of the bracket that a step leaves at each end, so that it shrinks from both sides.
constexpr double kBracketMargin = 0.1;
/// Smallest spacing, in rounding errors of the coordinates; below, tets would be visibly distorted.
constexpr double kRoundingRoom = 1e5;

/// Origin number i, in cubes: additive recurrence with the powers of the plastic number of three dimensions. All are
/// irrational, so no face of a mesh with round coordinates lies in a lattice plane.
Eigen::Vector3d originOf(std::size_t i) {
  constexpr double kPlastic = 1.2207440846057596;
  Eigen::Vector3d origin;
  double step = 1.0;
  for (int axis = 0; axis < 3; ++axis) {
    step /= kPlastic;
    const double x = 0.5 + static_cast<double>(i + 1) * step;
    origin[axis] = x - std::floor(x);
  }
  return origin;
}

/// Estimated number of tets at a spacing: those in the volume, plus half of those that touch the surface; for sheets,
/// whose area counts once, all of the latter.
double estimatedCount(const Surface& surface, double half) {
  const double volume = surface.volume + 0.5 * kMeanWidth * half * surface.area;
  return volume / (kLatticeTetVolume * half * half * half);
}

double firstSpacing(const Surface& surface, double target) {
  assert(target > 0.0);
  const double size = surface.box.sizes().maxCoeff();
  // For a wire, each tet covers a length comparable to its own size.
  if (!(surface.area > 0.0)) return 3.0 * size / target;
  double low = 1e-9 * size, high = 10.0 * size;
  for (int i = 0; i < 60; ++i) {
    const double middle = std::sqrt(low * high);
    (estimatedCount(surface, middle) > target ? low : high) = middle;
  }
  return high;
}

class Search {
 public:
  Search(const Surface& surface, const WindingTree& winding, std::size_t target)
      : surface_(surface),
        winding_(winding),
        target_(static_cast<double>(target)),
        limit_(kCountLimit * target + kCountLimitMore) {}

  LatticeCage run(std::size_t firstOrigin) {
    double half = firstSpacing(surface_, target_);
    for (std::size_t i = 0; i < kOrigins && error(best_) > kCountTolerance; ++i) {
      half = bracket(originOf(firstOrigin + i), half);
    }
    best_.lattices = lattices_;
    return std::move(best_);
  }

 private:
  struct Sample {
    double logHalf = 0.0, logCount = 0.0;
    bool known = false;
  };

  /// Deviation from the target as a fraction of it; infinite for an empty cage.
  double error(const LatticeCage& cage) const {
    const auto count = static_cast<double>(cage.set.tetCount());
    return count > 0.0 ? std::abs(count - target_) / target_ : std::numeric_limits<double>::infinity();
  }

  /// Searches the spacing at one origin; returns the initial one for the next origin.
  double bracket(const Eigen::Vector3d& origin, double half) {
    Sample low, high;  // of the spacing: low has too many tets, high too few
    for (std::size_t i = 0; i < kSpacingsPerOrigin; ++i) {
      half = std::max(half, smallestSpacing(surface_));
      const double count = keepTets(origin, half);
      if (std::abs(count - target_) <= kGoodCount * target_) break;
      const bool stopped = count > static_cast<double>(limit_);
      (count > target_ ? low : high) = {std::log(half), std::log(count), true};
      half = nextSpacing(low, high, half, count, stopped);
    }
    return half;
  }

  double nextSpacing(const Sample& low, const Sample& high, double half, double count, bool stopped) const {
    assert(half > 0.0 && count > 0.0);
    if (!low.known || !high.known) {
      const double factor = std::pow(count / target_, 1.0 / kCountPower);
      return half * (stopped ? kStoppedFactor : factor * (count > target_ ? kOvershoot : 1.0 / kOvershoot));
    }
    const double slope = (high.logCount - low.logCount) / (high.logHalf - low.logHalf);
    const double guess = slope < 0.0 ? low.logHalf + (std::log(target_) - low.logCount) / slope : low.logHalf;
    const double margin = kBracketMargin * (high.logHalf - low.logHalf);
    const double minimum = std::min(low.logHalf, high.logHalf) + std::abs(margin);
    const double maximum = std::max(low.logHalf, high.logHalf) - std::abs(margin);
    return std::exp(std::clamp(guess, minimum, maximum));
  }

  /// Builds the cage of one lattice and keeps it if it is the best so far. Returns its count.
  double keepTets(const Eigen::Vector3d& origin, double half) {
    assert(half >= smallestSpacing(surface_));
    ++lattices_;
    LatticeCage cage;
    cage.frame.half = half;
    cage.frame.origin = surface_.box.center() + 2.0 * half * origin;
    const bool complete = coverSurface(surface_, cage.frame, limit_, cage.set) &&
                          fillInside(surface_, winding_, cage.frame, limit_, cage.set);
    if (!complete) return static_cast<double>(limit_ + 1);
    cage.joiningTets = joinPinches(cage.set);
    const auto count = static_cast<double>(cage.set.tetCount());
    if (error(cage) < error(best_)) best_ = std::move(cage);
    return count;
  }

  const Surface& surface_;
  const WindingTree& winding_;
  double target_;
  std::size_t limit_;
  LatticeCage best_;
  std::size_t lattices_ = 0;
};

}  // namespace

double smallestSpacing(const Surface& surface) {
  const double farthest = std::max(surface.box.min().cwiseAbs().maxCoeff(), surface.box.max().cwiseAbs().maxCoeff());
  return std::max(kRoundingRoom * std::numeric_limits<double>::epsilon() * farthest,
                  surface.box.sizes().maxCoeff() / kMaxCube);
}

LatticeCage searchLattice(const Surface& surface, const WindingTree& winding, std::size_t target,
                          std::size_t firstOrigin) {
  return Search(surface, winding, target).run(firstOrigin);
}

}  // namespace tetskin::cage_detail
