// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <initializer_list>
#include <vector>

namespace tetskin::scenes {

/// A right-handed orthonormal frame at a point of the spine.
struct Frame {
  Eigen::Vector3d origin;
  Eigen::Vector3d tangent;  ///< towards the head
  Eigen::Vector3d up;       ///< towards the back
  Eigen::Vector3d side;     ///< up x tangent: the left for an observer who looks along the tangent
};

/// A smooth curve with frames that do not spin about it, parametrised by arc length: t = 0 at the tail, 1 at the snout.
class Spine {
 public:
  /// The uniform cubic B-spline of the control points, from the first to the last. Up is as close to the world's y as
  /// the tangent permits; where the spine is steep, the frame is transported without spin.
  explicit Spine(const std::vector<Eigen::Vector3d>& controls);

  double length() const { return length_; }
  /// Beyond 0 and 1 the spine continues straight.
  Frame frame(double t) const;
  void translate(const Eigen::Vector3d& offset);

 private:
  double length_ = 0.0;
  std::vector<Frame> samples_;  ///< at equal steps of t
};

/// A smooth curve through knots that never overshoots them; constant beyond the first and the last.
class Profile {
 public:
  struct Knot {
    double at = 0.0;
    double value = 0.0;
  };
  /// Knots in ascending order, at least two.
  Profile(std::initializer_list<Knot> knots);
  double operator()(double at) const;

 private:
  std::vector<Knot> knots_;
  std::vector<double> slopes_;
};

/// `count` >= 2 values from `first` to `last`; where `density` (> 0) is higher, they are closer to each other.
std::vector<double> spread(std::size_t count, double first, double last, const std::function<double(double)>& density);

/// 0 up to `from`, 1 beyond `to`, with zero slope at both ends.
inline double smoothStep(double from, double to, double at) {
  const double x = at <= from ? 0.0 : at >= to ? 1.0 : (at - from) / (to - from);
  return x * x * (3.0 - 2.0 * x);
}

}  // namespace tetskin::scenes
