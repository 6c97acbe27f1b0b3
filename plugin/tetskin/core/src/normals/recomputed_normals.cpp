// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/instantiate.h>
#include <tetskin/core/src/base/lists.h>
#include <tetskin/core/src/base/mesh/weld.h>
#include <tetskin/core/src/normals/recomputed_normals.h>
#include <tetskin/core/src/skinning/skin_tasks.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>
#include <numeric>

namespace tetskin {
namespace {

using skin_tasks::firstItem;
using skin_tasks::taskCount;

/// Enough work to make the cost of scheduling it small.
constexpr std::size_t kGroupsPerTask = 8192;
/// Groups that are sorted at a time: sorting all at once would read their vertices in random order.
constexpr std::size_t kWindow = 256;
/// In radians.
constexpr double kDegree = 3.14159265358979323846 / 180.0;
/// A vertex without a group so far.
constexpr std::uint32_t kNoGroup = 0xFFFFFFFFu;

/// Rounding of the cosine of an angle between two directions given as floats.
constexpr double kRounding = 1e-12;

/// The direction of the rest normal, whatever its length; zero if there is none, or it has no direction.
Eigen::Vector3d restDirection(const TriangleMesh& mesh, std::uint32_t v) {
  if (mesh.normals.size() != mesh.vertexCount()) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d normal = mesh.normals[v].cast<double>();
  const double length = normal.norm();
  return length > 0.0 && std::isfinite(length) ? Eigen::Vector3d(normal / length) : Eigen::Vector3d::Zero();
}

/// Vertices that share a normal, as lists: those at one position whose rest normals are within an angle of each other.
std::vector<std::uint32_t> smoothGroups(const TriangleMesh& mesh, const std::vector<std::uint32_t>& first,
                                        double hardEdgeDegrees, std::size_t& groupCount) {
  assert(first.size() == mesh.vertexCount() && hardEdgeDegrees >= 0.0);
  const double limit = std::cos(std::min(hardEdgeDegrees, 180.0) * kDegree) - kRounding;
  // The groups at one position are chained by their first vertices.
  std::vector<std::uint32_t> groupOf(mesh.vertexCount(), kNoGroup), firstGroup(groupOf), next(groupOf);
  groupCount = 0;
  const auto join = [&](std::uint32_t v, auto&& isWith) {
    std::uint32_t* other = &firstGroup[first[v]];
    while (*other != kNoGroup && !isWith(*other)) other = &next[*other];
    if (*other == kNoGroup) {
      *other = v;
      groupOf[v] = static_cast<std::uint32_t>(groupCount++);
    } else {
      groupOf[v] = groupOf[*other];
    }
  };
  for (std::uint32_t v = 0; v < mesh.vertexCount(); ++v) {
    const Eigen::Vector3d direction = restDirection(mesh, v);
    if (direction.isZero(0.0)) continue;
    join(v, [&](std::uint32_t other) { return direction.dot(restDirection(mesh, other)) >= limit; });
  }
  for (std::uint32_t v = 0; v < mesh.vertexCount(); ++v) {
    if (groupOf[v] == kNoGroup)
      join(v, [](std::uint32_t) { return true; });  // after those with a normal, which determine the groups
  }
  return groupOf;
}

/// The far side of a triangle, as seen from one of its corners: two vertices, and the numbers of their positions.
struct FarSide {
  std::uint32_t from, to;
  std::uint32_t fromPosition, toPosition;
};

/// Appends the sides as one path, in which each side is followed by one that begins where it ends; `centre` is inserted
/// where there is none. The path begins with the first side, and prefers earlier ones, so it does not depend on the
/// numbering of the vertices.
void appendPath(const std::vector<FarSide>& sides, std::uint32_t centre, std::vector<std::uint32_t>& path) {
  std::vector<std::size_t> byStart(sides.size());
  std::iota(byStart.begin(), byStart.end(), std::size_t{0});
  std::stable_sort(byStart.begin(), byStart.end(),
                   [&](auto a, auto b) { return sides[a].fromPosition < sides[b].fromPosition; });
  // Sides that begin at one position are used in order; this counts the used ones, at the first one's index.
  std::vector<std::size_t> taken(sides.size(), 0);
  std::vector<bool> used(sides.size(), false);
  const auto take = [&](std::uint32_t position) -> const FarSide* {
    const auto first = std::partition_point(byStart.begin(), byStart.end(),
                                            [&](std::size_t s) { return sides[s].fromPosition < position; });
    if (first == byStart.end()) return nullptr;
    const auto index = static_cast<std::size_t>(first - byStart.begin());
    const std::size_t next = index + taken[index];
    if (next == sides.size() || sides[byStart[next]].fromPosition != position) return nullptr;
    ++taken[index];
    used[byStart[next]] = true;
    return &sides[byStart[next]];
  };
  for (std::size_t start = 0; start < sides.size(); ++start) {
    if (used[start]) continue;
    if (start > 0) path.push_back(centre);
    path.push_back(sides[start].from);
    for (const FarSide* side = take(sides[start].fromPosition); side; side = take(side->toPosition)) {
      path.push_back(side->to);
    }
  }
}

/// Numbers groups in the order of their indices in the output, so that neighbours in memory are mostly neighbours on
/// the surface. Within a window they are sorted by their number of triangles, because the branch at the end of a loop
/// is mispredicted whenever the loop's length changes.
void renumber(const std::vector<std::uint32_t>& vertexAt, const TriangleMesh& mesh, std::size_t groups,
              std::vector<std::uint32_t>& groupOf) {
  assert(vertexAt.size() == mesh.vertexCount() && groupOf.size() == mesh.vertexCount());
  std::vector<std::uint32_t> triangles(groups, 0), order, numberOf(groups, kNoGroup);
  for (const auto& t : mesh.triangles) {
    for (const int v : t) ++triangles[groupOf[static_cast<std::size_t>(v)]];
  }
  for (const std::uint32_t v : vertexAt) {
    if (numberOf[groupOf[v]] != kNoGroup) continue;
    numberOf[groupOf[v]] = 0;
    order.push_back(groupOf[v]);
  }
  assert(order.size() == groups);
  for (std::size_t first = 0; first < groups; first += kWindow) {
    const std::size_t last = std::min(first + kWindow, groups);
    std::stable_sort(order.begin() + static_cast<std::ptrdiff_t>(first),
                     order.begin() + static_cast<std::ptrdiff_t>(last),
                     [&](std::uint32_t a, std::uint32_t b) { return triangles[a] < triangles[b]; });
  }
  for (std::size_t k = 0; k < groups; ++k) numberOf[order[k]] = static_cast<std::uint32_t>(k);
  for (std::uint32_t& group : groupOf) group = numberOf[group];
}

/// Copies points [first, last) to four scalars each; the fourth scalar of the last point stays unchanged.
template <class Scalar>
void pad(PointView<const Scalar> points, std::size_t first, std::size_t last, Scalar* to) {
  std::size_t k = first;
  if (points.strideBytes() == 3 * sizeof(Scalar)) {
    for (; k + 1 < last; ++k) std::memcpy(to + 4 * k, points[k], 4 * sizeof(Scalar));
  }
  for (; k < last; ++k) std::memcpy(to + 4 * k, points[k], 3 * sizeof(Scalar));
}

}  // namespace

NormalTopology::NormalTopology(const TriangleMesh& mesh, const std::vector<std::uint32_t>& indices,
                               double hardEdgeDegrees) {
  assert(indices.empty() || indices.size() == mesh.vertexCount());
  const std::size_t count = mesh.vertexCount();
  const auto slotOf = [&](std::size_t v) { return indices.empty() ? static_cast<std::uint32_t>(v) : indices[v]; };
  const std::vector<std::uint32_t> firstAt = weldCoincident(viewOf(mesh.positions));
  std::size_t groups = 0;
  std::vector<std::uint32_t> groupOf = smoothGroups(mesh, firstAt, hardEdgeDegrees, groups);

  std::vector<std::uint32_t> vertexAt(count);
  for (std::size_t v = 0; v < count; ++v) vertexAt[slotOf(v)] = static_cast<std::uint32_t>(v);
  renumber(vertexAt, mesh, groups, groupOf);

  Lists<> placesOf = packLists(groups, [&](auto&& add) {
    for (const std::uint32_t v : vertexAt) add(groupOf[v], slotOf(v));
  });
  groupPositions_ = std::move(placesOf.starts);
  indices_ = std::move(placesOf.values);
  assert(indices_.size() == count);

  const Lists<FarSide> sides = packLists<FarSide>(groups, [&](auto&& add) {
    for (const auto& t : mesh.triangles) {
      for (std::size_t k = 0; k < 3; ++k) {
        const auto from = static_cast<std::size_t>(t[(k + 1) % 3]), to = static_cast<std::size_t>(t[(k + 2) % 3]);
        add(groupOf[static_cast<std::size_t>(t[k])], FarSide{slotOf(from), slotOf(to), firstAt[from], firstAt[to]});
      }
    }
  });
  std::vector<FarSide> ofGroup;
  paths_.reserve(sides.values.size() + 2 * groups);
  for (std::size_t g = 0; g < groups; ++g) {
    ofGroup.assign(sides.values.begin() + sides.starts[g], sides.values.begin() + sides.starts[g + 1]);
    appendPath(ofGroup, indices_[groupPositions_[g]], paths_);
    groupPaths_.push_back(static_cast<std::uint32_t>(paths_.size()));
  }
}

template <class Scalar>
void padPoints(PointView<const Scalar> points, std::vector<Scalar>& padded, ParallelFor* threads) {
  assert(padded.size() == 4 * points.size());
  if (points.empty()) return;
  const std::size_t tasks = taskCount(points.size());
  runTasks(threads, tasks, [&](std::size_t task) {
    pad(points, firstItem(points.size(), tasks, task), firstItem(points.size(), tasks, task + 1), padded.data());
  });
}

template <class Scalar>
void recomputeNormals(const NormalTopology& topology, const std::vector<Scalar>& padded, PointView<float> out,
                      ParallelFor* threads) {
  assert(out.size() == topology.indices().size() && padded.size() == 4 * out.size());
  if (out.empty()) return;
  kernels::PathWork<Scalar> work;
  assert(topology.groupPaths().size() == topology.groupPositions().size());
  work.groupPaths = topology.groupPaths().data();
  work.paths = topology.paths().data();
  work.groupPositions = topology.groupPositions().data();
  work.indices = topology.indices().data();
  work.points = padded.data();
  work.out = out.data();
  work.outStride = out.strideBytes();
  const std::size_t tasks = taskCount(topology.groupCount(), kGroupsPerTask);
  runTasks(threads, tasks, [&](std::size_t task) {
    kernels::PathWork<Scalar> part = work;
    part.firstGroup = firstItem(topology.groupCount(), tasks, task);
    part.lastGroup = firstItem(topology.groupCount(), tasks, task + 1);
    kernels::tableInUse<Scalar>().pathNormals(part);
  });
}

#define TETSKIN_INSTANTIATE(Scalar)                                                     \
  template void padPoints(PointView<const Scalar>, std::vector<Scalar>&, ParallelFor*); \
  template void recomputeNormals(const NormalTopology&, const std::vector<Scalar>&, PointView<float>, ParallelFor*);
TETSKIN_FOR_SCALARS(TETSKIN_INSTANTIATE)
#undef TETSKIN_INSTANTIATE

}  // namespace tetskin
