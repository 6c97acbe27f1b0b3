// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/export.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

/// The public API. The folder of a header has the name of the library that it belongs to.
namespace tetskin {

/// Axis-aligned box, empty until extended. Units and space are those of the points it was made from.
using Box3 = Eigen::AlignedBox3d;

/// Outcome of an operation. `Ok` is the only success.
enum class [[nodiscard]] StatusCode{
    Ok,
    FileNotFound,       ///< the file cannot be opened for reading
    FileNotWritable,    ///< the file or folder cannot be created or written
    UnsupportedFormat,  ///< the format, or this variant of it, is not supported
    Malformed,          ///< the text or bytes do not follow the format
    Empty,              ///< no vertices, no triangles, no nodes or no tets
    IndexOutOfRange,    ///< an index names a point that does not exist
    NonFinite,          ///< a coordinate is infinite or not a number
    Degenerate,         ///< every tet is flat, or repeats a node
    SizeMismatch,       ///< two arrays that belong together differ in count
    InvalidOption,      ///< an option's value is out of range
    OutsideCage,        ///< a vertex lies farther outside the cage than allowed
    CageMismatch,       ///< the data belongs to another cage
    TooLarge,           ///< more items than 32-bit indices can number

    // Of an update, a point of a surface, a ray or a body: nothing is wrong with the data.
    Asleep,           ///< skipped: the body sleeps and has not been moved since the last update
    Hidden,           ///< skipped: the skin is not visible
    Unbound,          ///< the skin has not been bound successfully yet
    TopologyChanged,  ///< the body has gained or lost nodes or tets since; bind, or add it, again
    NoHit,            ///< the ray meets nothing, or nothing of the surface is in the radius
    BodyDeleted,      ///< the body no longer exists
    Released,         ///< `release` was called, or there never was a body
    OtherBody,        ///< the skin, or the tree, belongs to another body or binding
    NotInWorld,       ///< the body is in no world, or not in this one
    NotAdded,         ///< the body was never added
    Enclosed,         ///< the body lies wholly within another one, and is not pushed out of it

    // Of snapshots.
    NotSaved,          ///< the world has something that cannot be saved
    SnapshotMismatch,  ///< the snapshot is of a world with other bodies, objects or joints

    // Of what takes long.
    Cancelled,  ///< the application's `progress` has said so
};

/// Name of a status code, for messages and logs: a few words in lower case. Never null; a static string.
TETSKIN_CORE_API const char* toString(StatusCode code);
/// Name of a status code as it is spelt above, "FileNotFound", for other languages and for files. Never null; a static
/// string.
TETSKIN_CORE_API const char* nameOf(StatusCode code);

/// Outcome of an operation on data that may be bad. The message says what is wrong, where, and what to do about it; it
/// is empty on success.
struct [[nodiscard]] Status {
  StatusCode code = StatusCode::Ok;  ///< for programs
  std::string message;               ///< for people; empty on success

  bool ok() const { return code == StatusCode::Ok; }  ///< success
};

/// Stops the program, in every build, because a `Result` was used in a way that it does not allow: throws
/// `std::logic_error` with this message, or, where the library was compiled without exceptions, prints it and calls
/// `std::terminate`.
[[noreturn]] TETSKIN_CORE_API void failResult(const std::string& message);

/// A value, or the status that says why there is none. Ask `ok()` before taking the value: that of a failure stops the
/// program with the status' message (see `failResult`).
template <class T>
class [[nodiscard]] Result {
 public:
  /// Success.
  Result(T value) : value_(std::move(value)) {}  // NOLINT: implicit by design
  /// Failure. A status that is Ok has no value to go with it, and stops the program.
  Result(Status status) : status_(std::move(status)) {  // NOLINT: implicit by design
    if (status_.ok()) failResult("a tetskin::Result was made of a status that is Ok, and has no value");
  }

  bool ok() const { return value_.has_value(); }    ///< there is a value
  const Status& status() const { return status_; }  ///< Ok, or why there is no value
  /// The value, to be read. Stops the program if there is none.
  const T& value() const& {
    if (!value_) failResult(status_.message);
    return *value_;
  }
  /// The value, to be changed in place. Stops the program if there is none.
  T& value() & {
    if (!value_) failResult(status_.message);
    return *value_;
  }
  /// The value, to be moved out of a temporary result. Stops the program if there is none.
  T&& value() && {
    if (!value_) failResult(status_.message);
    return *std::move(value_);
  }

 private:
  std::optional<T> value_;
  Status status_;
};

/// Gives the library's own sources access to private members of a public class; specialised only there.
template <class T>
struct Access;

/// A view of `count` points of 3 scalars each, with any stride: a tight array, or one attribute of an interleaved
/// vertex buffer. Does not own its memory. `PointView<const float>` is read, `PointView<float>` written.
template <class Scalar>
class PointView {
 public:
  static_assert(std::is_floating_point_v<Scalar>, "points are of float or double");
  /// Unit of the strides.
  using Byte = std::conditional_t<std::is_const_v<Scalar>, const unsigned char, unsigned char>;

  /// An empty view.
  PointView() = default;
  /// Views points that outlive it.
  /// data         first scalar of the first point; may be null when count is 0
  /// strideBytes  from one point to the next; at least 3 scalars, a multiple of the scalar's size
  PointView(Scalar* data, std::size_t count, std::size_t strideBytes = 3 * sizeof(Scalar))
      : data_(data), count_(count), stride_(strideBytes) {
    assert(data || count == 0);
    assert(strideBytes >= 3 * sizeof(Scalar) && strideBytes % sizeof(Scalar) == 0);
  }
  /// Converts a writable view to a read-only one.
  template <class Other, class = std::enable_if_t<std::is_same_v<const Other, Scalar>>>
  PointView(const PointView<Other>& other)  // NOLINT: implicit by design
      : PointView(other.data(), other.size(), other.strideBytes()) {}

  std::size_t size() const { return count_; }          ///< number of points
  bool empty() const { return count_ == 0; }           ///< true without points
  Scalar* data() const { return data_; }               ///< first scalar of the first point
  std::size_t strideBytes() const { return stride_; }  ///< bytes from one point to the next
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

/// Read-only view of a vector of points, valid as long as the vector is neither resized nor destroyed.
template <class Scalar>
PointView<const Scalar> viewOf(const std::vector<Eigen::Matrix<Scalar, 3, 1>>& points) {
  return {points.empty() ? nullptr : points.front().data(), points.size()};
}
/// Writable view of a vector of points, valid as long as the vector is neither resized nor destroyed.
template <class Scalar>
PointView<Scalar> viewOf(std::vector<Eigen::Matrix<Scalar, 3, 1>>& points) {
  return {points.empty() ? nullptr : points.front().data(), points.size()};
}

/// Bounding box of points; empty without points. A point that is not finite makes the box not finite.
template <class Scalar>
Box3 boundingBox(PointView<const Scalar> points) {
  Box3 box;
  for (std::size_t i = 0; i < points.size(); ++i) box.extend(Eigen::Vector3d(points[i][0], points[i][1], points[i][2]));
  return box;
}
/// Bounding box of a vector of points; empty without points.
inline Box3 boundingBox(const std::vector<Eigen::Vector3d>& points) {
  return boundingBox(viewOf(points));
}

/// Limits of what the library supports. Constants only.
struct Limits {
  /// Largest absolute coordinate of a node that a surface can follow, in any unit: beyond it, squares and weighted sums
  /// leave the range of float. Meshes and cages that start there are refused; bodies that get there have become
  /// unstable.
  static constexpr double kMaxCoordinate = 1e18;
  /// Largest number of nodes, and of tets: the neighbours of all of them, up to 32 each, are counted in 32 bits.
  static constexpr std::size_t kMaxTets = 0xFFFFFFFFu / 32;
  /// Largest number of vertices: their indices are ints.
  static constexpr std::size_t kMaxVertices = 0x7FFFFFFF;
  /// Largest number of triangles: the paths around vertices along which normals are computed take up to nine numbers
  /// per triangle, which are counted in 32 bits.
  static constexpr std::size_t kMaxTriangles = 0xFFFFFFFFu / 9;
  /// Ratio of the diagonals of mesh and cage above which different units are presumed: inches against metres are 39,
  /// and a cage 30 times as large as its mesh would leave the mesh in a handful of tets anyway.
  static constexpr double kMaxUnitRatio = 30.0;
  /// Barycentric distance beyond which a mesh is refused: multiplied by nodes at kMaxCoordinate, larger weights would
  /// leave the range of float; at rest they would lose all digits long before.
  static constexpr double kMaxBarycentric = 1e15;
  /// Largest `CageOptions::targetTets` for `createCage`; such a cage takes some 6 GB and four minutes.
  static constexpr std::size_t kMaxTargetTets = 20'000'000;
  /// Largest number of tets to which `calibrate` refines a cage: it makes two refinements (64 tets from each), one (8
  /// tets from each) or none, as far as the result stays within this.
  static constexpr std::size_t kMaxRefinedTets = 300'000;
  /// Smallest fraction of its stiffness that a tet keeps, however small its volume fraction: less would make light tets
  /// so soft that the time step or the solver suffers.
  static constexpr double kMinVolumeFraction = 0.1;
  /// Largest angular frequency times time step of a mode of a `ReducedBody`. A mode is stable up to 2; up to this
  /// limit, its frequency is off by a fifth at most.
  static constexpr double kMaxOmegaDt = 1.6;
};

/// Largest absolute coordinate of the points in a box, which must not be empty; in the box's units.
inline double maxCoordinate(const Box3& box) {
  assert(!box.isEmpty());
  // In brackets, as Windows' header defines macros of these names.
  return (std::max)((box.max)().maxCoeff(), -(box.min)().minCoeff());
}

/// Index of the first point with a coordinate that is not finite or beyond Limits::kMaxCoordinate, or `points.size()`.
template <class Scalar>
std::size_t firstUnusable(PointView<const Scalar> points) {
  constexpr auto kMax = static_cast<Scalar>(Limits::kMaxCoordinate);
  const auto usable = [](Scalar x) { return x >= -kMax && x <= kMax; };  // NaN is not
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

/// Interface through which an application provides threads: the library has none of its own. Derive from it, or use the
/// adapters `BulletParallelFor` (tetskin/bullet/soft_body.h) and `ThreadPool` (tetskin/threads/thread_pool.h).
/// Results are bit-identical for any number of threads, as the work is divided in the same way.
class TETSKIN_CORE_API ParallelFor {
 public:
  /// A reference to a callable void(std::size_t), valid as long as the callable is. Never allocates.
  class Task {
   public:
    /// Wraps a callable; a Task itself is copied instead.
    template <class Callable, class = std::enable_if_t<!std::is_same_v<std::remove_cv_t<Callable>, Task>>>
    explicit Task(Callable& callable)
        : callable_(&callable), call_([](void* c, std::size_t k) { (*static_cast<Callable*>(c))(k); }) {}
    /// Calls the callable with k.
    void operator()(std::size_t k) const { call_(callable_, k); }

   private:
    void* callable_;
    void (*call_)(void*, std::size_t);
  };

  virtual ~ParallelFor() = default;

  /// Calls task(k) once for every k in [0, count), in any order and on any threads, and returns when all have returned.
  /// Tasks do not throw, and do not call `run` again.
  virtual void run(std::size_t count, Task task) = 0;
};

/// Calls callable(k) for every k in [0, count): on `threads`, or on the calling thread if that is null or count is 1.
template <class Callable>
void runTasks(ParallelFor* threads, std::size_t count, Callable&& callable) {
  if (threads && count > 1) {
    threads->run(count, ParallelFor::Task(callable));
  } else {
    for (std::size_t k = 0; k < count; ++k) callable(k);
  }
}

}  // namespace tetskin
