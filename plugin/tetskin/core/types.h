// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/export.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cassert>
#include <cstddef>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

/// All that is public. The folder of a header has the name of the library that it belongs to.
namespace tetskin {

/// Axis-aligned box, empty until extended. Units and space are those of the points it was made from.
using Box3 = Eigen::AlignedBox3d;

/// What went wrong with data. `Ok` is the only success.
enum class StatusCode {
  Ok,
  FileNotFound,       ///< the file cannot be opened for reading
  FileNotWritable,    ///< the file or folder cannot be created or written
  UnsupportedFormat,  ///< the format, or this flavour of it, is not read
  Malformed,          ///< the text or bytes do not follow the format
  Empty,              ///< no vertices, no triangles, no nodes or no tets
  IndexOutOfRange,    ///< an index names a point that does not exist
  NonFinite,          ///< a coordinate is infinite or not a number
  Degenerate,         ///< every tet is flat, or repeats a node
  SizeMismatch,       ///< two arrays that belong together differ in count
  InvalidOption,      ///< an option's value makes no sense
  OutsideCage,        ///< a vertex lies farther outside the cage than allowed
  CageMismatch,       ///< the data belongs to another cage
  TooLarge,           ///< more of something than indices of 32 bits can number
};

/// Name of a status code, for messages and logs. Never null.
TETSKIN_CORE_API const char* toString(StatusCode code);

/// Outcome of an operation on data that may be bad. The message says what is wrong, where, and what to do about it; it
/// is empty on success.
struct [[nodiscard]] Status {
  StatusCode code = StatusCode::Ok;  ///< for programs
  std::string message;               ///< for people

  bool ok() const { return code == StatusCode::Ok; }  ///< success
};

/// A value, or the status that says why there is none. Ask `ok()` first: the value of a failed result is T{} (an empty
/// mesh, a null pointer), which every later stage rejects, and its message is lost.
template <class T>
class [[nodiscard]] Result {
 public:
  /// Success.
  Result(T value) : value_(std::move(value)) {}  // NOLINT: implicit by design
  /// Failure: the status is not Ok.
  Result(Status status) : status_(std::move(status)) { assert(!status_.ok()); }  // NOLINT: implicit by design

  bool ok() const { return status_.ok(); }          ///< there is a value
  const Status& status() const { return status_; }  ///< Ok, or why there is none
  const T& value() const& { return value_; }        ///< T{} where there is none, as of the next two
  T& value() & { return value_; }                   ///< to be changed in place
  T&& value() && { return std::move(value_); }      ///< to be moved out of a result that goes

 private:
  T value_{};
  Status status_;
};

/// A view of `count` points of 3 scalars each, any number of bytes apart: a tight array, or one attribute of an
/// interleaved vertex buffer. Does not own its memory. `PointView<const float>` is read, `PointView<float>` written.
template <class Scalar>
class PointView {
 public:
  static_assert(std::is_floating_point_v<Scalar>, "points are of float or double");
  /// Strides are counted in these.
  using Byte = std::conditional_t<std::is_const_v<Scalar>, const unsigned char, unsigned char>;

  /// Of no points.
  PointView() = default;
  /// Views points that outlive it.
  /// data         first scalar of the first point; may be null when count is 0
  /// strideBytes  from one point to the next; at least 3 scalars, a multiple of the scalar's size
  PointView(Scalar* data, std::size_t count, std::size_t strideBytes = 3 * sizeof(Scalar))
      : data_(data), count_(count), stride_(strideBytes) {
    assert(data || count == 0);
    assert(strideBytes >= 3 * sizeof(Scalar) && strideBytes % sizeof(Scalar) == 0);
  }
  /// A writable view may be read.
  template <class Other, class = std::enable_if_t<std::is_same_v<const Other, Scalar>>>
  PointView(const PointView<Other>& other)  // NOLINT: implicit by design
      : PointView(other.data(), other.size(), other.strideBytes()) {}

  std::size_t size() const { return count_; }          ///< points
  bool empty() const { return count_ == 0; }           ///< of no points
  Scalar* data() const { return data_; }               ///< first scalar of the first point
  std::size_t strideBytes() const { return stride_; }  ///< from one point to the next
  /// The 3 scalars of point i.
  Scalar* operator[](std::size_t i) const {
    assert(i < count_);
    return reinterpret_cast<Scalar*>(reinterpret_cast<Byte*>(data_) + i * stride_);
  }

 private:
  Scalar* data_ = nullptr;
  std::size_t count_ = 0;
  std::size_t stride_ = 3 * sizeof(Scalar);
};

/// View of a vector of points, valid as long as the vector is neither resized nor destroyed.
template <class Scalar>
PointView<const Scalar> viewOf(const std::vector<Eigen::Matrix<Scalar, 3, 1>>& points) {
  return {points.empty() ? nullptr : points.front().data(), points.size()};
}
/// The same, to be written.
template <class Scalar>
PointView<Scalar> viewOf(std::vector<Eigen::Matrix<Scalar, 3, 1>>& points) {
  return {points.empty() ? nullptr : points.front().data(), points.size()};
}

/// Box of finite points; a point that is not finite makes the box not finite, see `isFinite`.
template <class Scalar>
Box3 boundingBox(PointView<const Scalar> points) {
  Box3 box;
  for (std::size_t i = 0; i < points.size(); ++i) box.extend(Eigen::Vector3d(points[i][0], points[i][1], points[i][2]));
  return box;
}
/// The same.
inline Box3 boundingBox(const std::vector<Eigen::Vector3d>& points) {
  return boundingBox(viewOf(points));
}

/// Largest coordinate of a node that a surface can follow, in any unit: beyond, squares and weighted sums leave float's
/// range. Meshes and cages that start there are refused, bodies that get there have exploded.
constexpr double kLargestCoordinate = 1e18;

/// Largest absolute coordinate of the points in a box, which must not be empty.
inline double largestCoordinate(const Box3& box) {
  return std::max(box.max().maxCoeff(), -box.min().minCoeff());
}

/// Index of the first point with a coordinate that is not finite or beyond kLargestCoordinate, or `points.size()`.
template <class Scalar>
std::size_t firstUnusable(PointView<const Scalar> points) {
  constexpr auto kLargest = static_cast<Scalar>(kLargestCoordinate);
  const auto usable = [](Scalar x) { return x >= -kLargest && x <= kLargest; };  // NaN is not
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!usable(points[i][0]) || !usable(points[i][1]) || !usable(points[i][2])) return i;
  }
  return points.size();
}

/// Index of the first point with a coordinate that is not finite, or `points.size()`.
template <class Scalar>
std::size_t firstNonFinite(PointView<const Scalar> points) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Scalar* p = points[i];
    // x * 0 is 0 for every finite x and NaN for the rest, so one comparison serves three coordinates.
    if (!(p[0] * 0 + p[1] * 0 + p[2] * 0 == 0)) return i;
  }
  return points.size();
}

}  // namespace tetskin
