// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// This work is based on:
//   Wenping Wang, Bert Jüttler, Dayue Zheng, Yang Liu, "Computation of Rotation Minimizing Frames", 2008
//   F. N. Fritsch, J. Butland, "A Method for Constructing Local Monotone Piecewise Cubic Interpolants", 1984
#include "scenes/serpent_spine.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdlib>

#include "scenes/angles.h"

namespace tetskin::scenes {
namespace {

using Eigen::Vector3d;

constexpr int kSpineSamples = 4096;              ///< more than the number of rows of the finest mesh
constexpr int kSamplesPerSpan = 512;             ///< of the B-spline, before its length is measured
constexpr int kSettleReach = 1100;               ///< samples on either side over which the back turns upwards
constexpr double kEnd = 0.93, kEndWeight = 6.0;  ///< share of the length beyond which orientation has more weight
constexpr int kDensitySamples = 4096;

/// Index i with keys[i] <= key <= keys[i + 1], for ascending keys.
template <class Range, class Less>
std::size_t spanOf(const Range& keys, double key, Less less) {
  const auto next = std::upper_bound(keys.begin() + 1, keys.end() - 1, key, less);
  return static_cast<std::size_t>(next - keys.begin()) - 1;
}

std::size_t spanOf(const std::vector<double>& keys, double key) {
  return spanOf(keys, key, std::less<double>());
}

/// Points on the B-spline. Each end control counts three times, so that the curve reaches it.
std::vector<Vector3d> sampleBSpline(std::vector<Vector3d> c) {
  c.insert(c.begin(), 2, c.front());
  c.insert(c.end(), 2, c.back());
  std::vector<Vector3d> points;
  for (std::size_t i = 0; i + 3 < c.size(); ++i) {
    for (int k = 0; k < kSamplesPerSpan; ++k) {
      const double x = static_cast<double>(k) / kSamplesPerSpan, y = 1.0 - x;
      points.push_back((y * y * y * c[i] + (3 * x * x * x - 6 * x * x + 4) * c[i + 1] +
                        (3 * y * y * y - 6 * y * y + 4) * c[i + 2] + x * x * x * c[i + 3]) /
                       6.0);
    }
  }
  points.push_back(c.back());
  return points;
}

/// The length of the polyline up to each of its points.
std::vector<double> lengthsAlong(const std::vector<Vector3d>& points) {
  std::vector<double> lengths(points.size(), 0.0);
  for (std::size_t i = 1; i < points.size(); ++i) lengths[i] = lengths[i - 1] + (points[i] - points[i - 1]).norm();
  return lengths;
}

std::vector<Vector3d> resample(const std::vector<Vector3d>& points, const std::vector<double>& lengths) {
  std::vector<Vector3d> even;
  for (int k = 0; k < kSpineSamples; ++k) {
    const double at = lengths.back() * k / (kSpineSamples - 1);
    const std::size_t i = spanOf(lengths, at);
    const double x = (at - lengths[i]) / (lengths[i + 1] - lengths[i]);
    even.push_back((1.0 - x) * points[i] + x * points[i + 1]);
  }
  return even;
}

Vector3d perpendicularTo(const Vector3d& tangent, const Vector3d& v) {
  return (v - v.dot(tangent) * tangent).normalized();
}

/// The double reflection of Wang et al., table I: `from.up` transported to the next point without spin.
Vector3d carryUp(const Frame& from, const Vector3d& origin, const Vector3d& tangent) {
  const Vector3d v1 = origin - from.origin;
  const double c1 = v1.squaredNorm();
  const Vector3d upL = from.up - (2.0 / c1) * v1.dot(from.up) * v1;
  const Vector3d tangentL = from.tangent - (2.0 / c1) * v1.dot(from.tangent) * v1;
  const Vector3d v2 = tangent - tangentL;
  return perpendicularTo(tangent, upL - (2.0 / v2.squaredNorm()) * v2.dot(upL) * v2);
}

/// The angle about each frame's tangent from its up to the world's up, without jumps.
std::vector<double> anglesToWorldUp(const std::vector<Frame>& frames) {
  std::vector<double> angles;
  for (const Frame& f : frames) {
    const Vector3d wanted = perpendicularTo(f.tangent, Vector3d::UnitY());
    const double angle = std::atan2(f.tangent.dot(f.up.cross(wanted)), f.up.dot(wanted));
    angles.push_back(angles.empty() ? angle : angles.back() + std::remainder(angle - angles.back(), 2.0 * kPi));
  }
  return angles;
}

/// The weighted mean of the values within `reach` of each one; near values count most.
std::vector<double> smoothed(const std::vector<double>& values, const std::vector<double>& weights, int reach) {
  std::vector<double> nearness;
  for (int k = 0; k <= reach; ++k) {
    const double x = static_cast<double>(k) / (reach + 1);
    nearness.push_back((1.0 - x * x) * (1.0 - x * x));
  }
  const int count = static_cast<int>(values.size());
  std::vector<double> means;
  for (int i = 0; i < count; ++i) {
    double sum = 0.0, total = 0.0;
    for (int k = std::max(i - reach, 0); k <= std::min(i + reach, count - 1); ++k) {
      const double weight = nearness[std::abs(k - i)] * weights[k];
      sum += weight * values[k];
      total += weight;
    }
    means.push_back(sum / total);
  }
  return means;
}

/// Turns the frames about their tangents until up points upwards. The turn is smooth, as a sudden one would twist the
/// body. Steep places, where "upwards" means little, therefore have little weight, and the end, which is most visible,
/// has much.
void settleUpwards(std::vector<Frame>& frames) {
  std::vector<double> weights;
  for (const Frame& f : frames) {
    const double along = static_cast<double>(weights.size()) / static_cast<double>(frames.size());
    weights.push_back(std::pow(1.0 - f.tangent.y() * f.tangent.y(), 4) * (along > kEnd ? kEndWeight : 1.0));
  }
  const std::vector<double> turns = smoothed(anglesToWorldUp(frames), weights, kSettleReach);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    frames[i].up = Eigen::AngleAxisd(turns[i], frames[i].tangent) * frames[i].up;
    frames[i].side = frames[i].up.cross(frames[i].tangent);
  }
}

}  // namespace

Spine::Spine(const std::vector<Vector3d>& controls) {
  assert(controls.size() >= 2);
  const std::vector<Vector3d> curve = sampleBSpline(controls);
  const std::vector<double> lengths = lengthsAlong(curve);
  const std::vector<Vector3d> points = resample(curve, lengths);
  length_ = lengths.back();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::size_t before = i > 0 ? i - 1 : 0, after = std::min(i + 1, points.size() - 1);
    const Vector3d tangent = (points[after] - points[before]).normalized();
    const Vector3d up =
        samples_.empty() ? perpendicularTo(tangent, Vector3d::UnitY()) : carryUp(samples_.back(), points[i], tangent);
    samples_.push_back({points[i], tangent, up, Vector3d::Zero()});
  }
  settleUpwards(samples_);
}

Frame Spine::frame(double t) const {
  const double inside = std::clamp(t, 0.0, 1.0);
  const double at = inside * (kSpineSamples - 1);
  const std::size_t i = std::min(static_cast<std::size_t>(at), samples_.size() - 2);
  const double x = at - static_cast<double>(i);
  const Frame &a = samples_[i], &b = samples_[i + 1];
  Frame f;
  f.tangent = ((1.0 - x) * a.tangent + x * b.tangent).normalized();
  f.up = perpendicularTo(f.tangent, (1.0 - x) * a.up + x * b.up);
  f.side = f.up.cross(f.tangent);
  f.origin = (1.0 - x) * a.origin + x * b.origin + (t - inside) * length_ * f.tangent;
  return f;
}

void Spine::translate(const Vector3d& offset) {
  for (Frame& f : samples_) f.origin += offset;
}

Profile::Profile(std::initializer_list<Knot> knots) : knots_(knots), slopes_(knots.size(), 0.0) {
  assert(knots_.size() >= 2);
  const auto rise = [&](std::size_t i) {
    return (knots_[i + 1].value - knots_[i].value) / (knots_[i + 1].at - knots_[i].at);
  };
  for (std::size_t i = 1; i + 1 < knots_.size(); ++i) {
    const double a = rise(i - 1), b = rise(i);
    if (a * b > 0.0) slopes_[i] = 2.0 * a * b / (a + b);
  }
}

double Profile::operator()(double at) const {
  const double inside = std::clamp(at, knots_.front().at, knots_.back().at);
  const std::size_t i = spanOf(knots_, inside, [](double key, const Knot& knot) { return key < knot.at; });
  const double width = knots_[i + 1].at - knots_[i].at;
  const double x = (inside - knots_[i].at) / width, y = 1.0 - x;
  return y * y * (1.0 + 2.0 * x) * knots_[i].value + x * x * (1.0 + 2.0 * y) * knots_[i + 1].value +
         x * y * width * (y * slopes_[i] - x * slopes_[i + 1]);
}

std::vector<double> spread(std::size_t count, double first, double last, const std::function<double(double)>& density) {
  assert(count >= 2);
  const double step = (last - first) / kDensitySamples;
  std::vector<double> sums(kDensitySamples + 1, 0.0);
  for (int k = 0; k < kDensitySamples; ++k) sums[k + 1] = sums[k] + density(first + (k + 0.5) * step);
  std::vector<double> values;
  for (std::size_t k = 0; k < count; ++k) {
    const double sum = sums.back() * static_cast<double>(k) / static_cast<double>(count - 1);
    const std::size_t i = spanOf(sums, sum);
    values.push_back(first + step * (static_cast<double>(i) + (sum - sums[i]) / (sums[i + 1] - sums[i])));
  }
  values.back() = last;  // exact, without rounding errors, as the ends of the serpent are points
  return values;
}

}  // namespace tetskin::scenes
