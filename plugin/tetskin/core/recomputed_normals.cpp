// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/recomputed_normals.h>
#include <tetskin/core/skin_tasks.h>
#include <tetskin/core/weld.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <type_traits>

namespace tetskin {
namespace {

using skin_tasks::firstItem;
using skin_tasks::taskCount;

constexpr std::size_t kGroupsPerTask = 8192;
constexpr std::size_t kWindow = 256;
constexpr double kDegree = 3.14159265358979323846 / 180.0;
constexpr std::uint32_t kNone = 0xFFFFFFFFu;

/// Vertices that share a normal, as lists: those at one position whose rest normals are within an angle of each other.
std::vector<std::uint32_t> smoothGroups(const TriangleMesh& mesh, const std::vector<std::uint32_t>& first,
                                        double hardEdgeDegrees, std::size_t& groupCount) {
  const bool authored = mesh.normals.size() == mesh.vertexCount();
  const auto limit = static_cast<float>(std::cos(hardEdgeDegrees * kDegree));
  // The groups at one position are chained by their first vertices.
  std::vector<std::uint32_t> groupOf(mesh.vertexCount(), kNone), next(mesh.vertexCount(), kNone);
  groupCount = 0;
  for (std::uint32_t v = 0; v < mesh.vertexCount(); ++v) {
    std::uint32_t other = first[v];
    std::uint32_t lastOther = kNone;
    while (other != kNone && other != v) {
      if (!authored || mesh.normals[v].dot(mesh.normals[other]) >= limit) break;
      lastOther = other;
      other = next[other];
    }
    if (other != kNone && other != v) {
      groupOf[v] = groupOf[other];
      continue;
    }
    if (lastOther != kNone) next[lastOther] = v;
    groupOf[v] = static_cast<std::uint32_t>(groupCount++);
  }
  return groupOf;
}

/// The far side of a triangle, as seen from one of its corners: two vertices, and their positions' numbers.
struct FarSide {
  std::uint32_t from, to;
  std::uint32_t fromPosition, toPosition;
};

/// Appends the sides as one path, from each into one that goes on where it ends; `centre` where there is none. It
/// begins with the first, and prefers earlier ones: the same path for a mesh whatever its vertices' numbers.
void appendPath(const std::vector<FarSide>& sides, std::uint32_t centre, std::vector<std::uint32_t>& path) {
  std::vector<std::size_t> byStart(sides.size());
  std::iota(byStart.begin(), byStart.end(), std::size_t{0});
  std::stable_sort(byStart.begin(), byStart.end(),
                   [&](auto a, auto b) { return sides[a].fromPosition < sides[b].fromPosition; });
  // Of the sides that begin at one position the first is taken first: how many are, is counted at its place.
  std::vector<std::size_t> taken(sides.size(), 0);
  std::vector<bool> used(sides.size(), false);
  const auto take = [&](std::uint32_t position) -> const FarSide* {
    const auto first = std::partition_point(byStart.begin(), byStart.end(),
                                            [&](std::size_t s) { return sides[s].fromPosition < position; });
    if (first == byStart.end()) return nullptr;
    const auto place = static_cast<std::size_t>(first - byStart.begin());
    const std::size_t next = place + taken[place];
    if (next == sides.size() || sides[byStart[next]].fromPosition != position) return nullptr;
    ++taken[place];
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

/// Numbers groups in the order of their places, so that neighbours in memory are mostly neighbours on the surface; but
/// within a window by their triangles, as a loop of another length each time is mispredicted each time.
void renumber(const std::vector<std::uint32_t>& vertexAt, const TriangleMesh& mesh, std::size_t groups,
              std::vector<std::uint32_t>& groupOf) {
  std::vector<std::uint32_t> triangles(groups, 0), order, numberOf(groups, kNone);
  for (const auto& t : mesh.triangles) {
    for (const int v : t) ++triangles[groupOf[static_cast<std::size_t>(v)]];
  }
  for (const std::uint32_t v : vertexAt) {
    if (numberOf[groupOf[v]] != kNone) continue;
    numberOf[groupOf[v]] = 0;
    order.push_back(groupOf[v]);
  }
  for (std::size_t first = 0; first < groups; first += kWindow) {
    const std::size_t last = std::min(first + kWindow, groups);
    std::stable_sort(order.begin() + static_cast<std::ptrdiff_t>(first),
                     order.begin() + static_cast<std::ptrdiff_t>(last),
                     [&](std::uint32_t a, std::uint32_t b) { return triangles[a] < triangles[b]; });
  }
  for (std::size_t k = 0; k < groups; ++k) numberOf[order[k]] = static_cast<std::uint32_t>(k);
  for (std::uint32_t& group : groupOf) group = numberOf[group];
}

/// Positions [first, last), each to four scalars; the fourth stays as it is where it is not another position's.
template <class Scalar, class In>
void pad(PointView<const In> positions, std::size_t first, std::size_t last, Scalar* to) {
  if constexpr (std::is_same_v<Scalar, In>) {
    std::size_t k = first;
    if (positions.strideBytes() == 3 * sizeof(Scalar)) {
      for (; k + 1 < last; ++k) std::memcpy(to + 4 * k, positions[k], 4 * sizeof(Scalar));
    }
    for (; k < last; ++k) std::memcpy(to + 4 * k, positions[k], 3 * sizeof(Scalar));
  } else {
    // Relative to one of them, so that far from the origin nothing is lost.
    using Wider = std::common_type_t<Scalar, In>;
    const In* origin = positions[0];
    for (std::size_t k = first; k < last; ++k) {
      for (std::size_t i = 0; i < 3; ++i)
        to[4 * k + i] = static_cast<Scalar>(Wider(positions[k][i]) - Wider(origin[i]));
    }
  }
}

/// Starts of lists from their lengths, which come one place late.
void accumulate(std::vector<std::uint32_t>& starts) {
  std::partial_sum(starts.begin(), starts.end(), starts.begin());
}

}  // namespace

NormalTopology::NormalTopology(const TriangleMesh& mesh, const std::vector<std::uint32_t>& places,
                               double hardEdgeDegrees) {
  assert(places.empty() || places.size() == mesh.vertexCount());
  const std::size_t count = mesh.vertexCount();
  const auto placeOf = [&](std::size_t v) { return places.empty() ? static_cast<std::uint32_t>(v) : places[v]; };
  const std::vector<std::uint32_t> firstAt = weldCoincident(viewOf(mesh.positions));
  std::size_t groups = 0;
  std::vector<std::uint32_t> groupOf = smoothGroups(mesh, firstAt, hardEdgeDegrees, groups);

  std::vector<std::uint32_t> vertexAt(count);
  for (std::size_t v = 0; v < count; ++v) vertexAt[placeOf(v)] = static_cast<std::uint32_t>(v);
  renumber(vertexAt, mesh, groups, groupOf);

  groupPlaces_.assign(groups + 1, 0);
  for (const std::uint32_t group : groupOf) ++groupPlaces_[group + 1];
  accumulate(groupPlaces_);
  places_.resize(count);
  std::vector<std::uint32_t> next(groupPlaces_.begin(), groupPlaces_.end() - 1);
  for (const std::uint32_t v : vertexAt) places_[next[groupOf[v]]++] = placeOf(v);

  std::vector<std::uint32_t> groupSides(groups + 1, 0);
  for (const auto& t : mesh.triangles) {
    for (const int v : t) ++groupSides[groupOf[static_cast<std::size_t>(v)] + 1];
  }
  accumulate(groupSides);
  std::vector<FarSide> sides(3 * mesh.triangleCount());
  next.assign(groupSides.begin(), groupSides.end() - 1);
  for (const auto& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto from = static_cast<std::size_t>(t[(k + 1) % 3]), to = static_cast<std::size_t>(t[(k + 2) % 3]);
      sides[next[groupOf[static_cast<std::size_t>(t[k])]]++] = {placeOf(from), placeOf(to), firstAt[from], firstAt[to]};
    }
  }
  std::vector<FarSide> ofGroup;
  paths_.reserve(sides.size() + 2 * groups);
  for (std::size_t g = 0; g < groups; ++g) {
    ofGroup.assign(sides.begin() + groupSides[g], sides.begin() + groupSides[g + 1]);
    appendPath(ofGroup, places_[groupPlaces_[g]], paths_);
    groupPaths_.push_back(static_cast<std::uint32_t>(paths_.size()));
  }
}

template <class Scalar, class In>
void recomputeNormals(const NormalTopology& topology, PointView<const In> positions, std::vector<Scalar>& padded,
                      PointView<float> out, ParallelFor* threads) {
  assert(positions.size() == topology.places().size() && out.size() == positions.size());
  assert(padded.size() == 4 * positions.size());
  if (positions.empty()) return;
  std::size_t tasks = taskCount(positions.size());
  runTasks(threads, tasks, [&](std::size_t task) {
    pad(positions, firstItem(positions.size(), tasks, task), firstItem(positions.size(), tasks, task + 1),
        padded.data());
  });

  kernels::PathWork<Scalar> work;
  work.groupPaths = topology.groupPaths().data();
  work.paths = topology.paths().data();
  work.groupPlaces = topology.groupPlaces().data();
  work.places = topology.places().data();
  work.points = padded.data();
  work.out = out.data();
  work.outStride = out.strideBytes();
  tasks = taskCount(topology.groupCount(), kGroupsPerTask);
  runTasks(threads, tasks, [&](std::size_t task) {
    kernels::PathWork<Scalar> part = work;
    part.firstGroup = firstItem(topology.groupCount(), tasks, task);
    part.lastGroup = firstItem(topology.groupCount(), tasks, task + 1);
    kernels::tableInUse<Scalar>().pathNormals(part);
  });
}

#define TETSKIN_INSTANTIATE(Scalar, In)                                                                              \
  template void recomputeNormals(const NormalTopology&, PointView<const In>, std::vector<Scalar>&, PointView<float>, \
                                 ParallelFor*);
TETSKIN_INSTANTIATE(float, float)
TETSKIN_INSTANTIATE(float, double)
TETSKIN_INSTANTIATE(double, float)
TETSKIN_INSTANTIATE(double, double)
#undef TETSKIN_INSTANTIATE

}  // namespace tetskin
