// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/cage/src/surface/orientation.h>
#include <tetskin/core/src/base/disjoint_sets.h>
#include <tetskin/core/src/base/lists.h>
#include <tetskin/core/src/base/mesh/winding_tree.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

namespace tetskin::cage_detail {
namespace {

/// Fraction of the half-edges that must have an opposite partner for the surface to count as oriented. Small scans with
/// holes are far above it; a soup of unconnected triangles has 0.
constexpr double kOrientedFraction = 0.8;
/// Number of triangles of a patch that are tested for being inside other patches.
constexpr std::size_t kCavitySamples = 9;
/// How far below its surface a patch is sampled, as a fraction of the sampled triangle's size: near enough to stay
/// inside thin patches, far enough that rounding does not dominate the winding number.
constexpr double kCavityDepth = 1e-3;

/// One side of a triangle, from its lower to its higher point.
struct Side {
  int high = 0;
  int triangle = 0;
  bool forward = false;  ///< the triangle runs from the lower to the higher point
};

/// All sides of the solid triangles, bucketed by lower point and sorted by higher point.
class Sides {
 public:
  explicit Sides(const Surface& surface)
      : byLow_(packLists<Side>(surface.points.size(), [&](auto&& add) {
          for (std::size_t t = 0; t < surface.solidCount; ++t) {
            for (int i = 0; i < 3; ++i) {
              const int a = surface.triangles[t][i], b = surface.triangles[t][(i + 1) % 3];
              add(static_cast<std::size_t>(std::min(a, b)), Side{std::max(a, b), static_cast<int>(t), a < b});
            }
          }
        })) {
    Side* sides = byLow_.values.data();
    for (std::size_t p = 0; p + 1 < byLow_.starts.size(); ++p) {
      std::sort(sides + byLow_.starts[p], sides + byLow_.starts[p + 1], [](const Side& a, const Side& b) {
        return a.high != b.high ? a.high < b.high : a.triangle < b.triangle;
      });
    }
  }

  /// Calls f(first, last) with the range of sides of every edge.
  template <class F>
  void forEdges(F f) const {
    const Side* sides = byLow_.values.data();
    for (std::size_t p = 0; p + 1 < byLow_.starts.size(); ++p) {
      for (std::uint32_t i = byLow_.starts[p]; i < byLow_.starts[p + 1];) {
        std::uint32_t end = i + 1;
        while (end < byLow_.starts[p + 1] && sides[end].high == sides[i].high) ++end;
        f(sides + i, sides + end);
        i = end;
      }
    }
  }

 private:
  Lists<Side> byLow_;
};

/// Properties of a patch, indexed by its representative triangle.
struct Patch {
  bool mixed = false;  ///< neighbours disagreed
  bool open = false;
  double volume = 0.0;  ///< about the patch's own centre, the best choice for an open patch
  double area = 0.0;
  std::vector<int> triangles;
};

void turn(Surface& surface, const Patch& patch) {
  for (const int t : patch.triangles) std::swap(surface.triangles[t][1], surface.triangles[t][2]);
}

void measurePatch(const Surface& surface, Patch& patch) {
  assert(!patch.triangles.empty());
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (const int t : patch.triangles) centre += surface.points[surface.triangles[t][0]];
  centre /= static_cast<double>(patch.triangles.size());
  for (const int t : patch.triangles) {
    const Eigen::Vector3d normal = areaVector(surface, surface.triangles[t]);
    patch.area += normal.norm();
    patch.volume += normal.dot(surface.points[surface.triangles[t][0]] - centre) / 3.0;
  }
}

bool isSheet(const Patch& patch) {
  return std::abs(patch.volume) <= kSheetVolume * patch.area * std::sqrt(patch.area);
}

/// Groups the triangles into patches, and makes the orientations within each consistent.
std::vector<Patch> makePatches(Surface& surface, const Sides& sides) {
  DisjointSets sets(surface.solidCount);
  sides.forEdges([&](auto first, auto last) {
    if (last - first == 2) sets.unite(first->triangle, (first + 1)->triangle, first->forward == (first + 1)->forward);
  });
  std::vector<Patch> patches;
  std::vector<int> patchOf(surface.solidCount, -1);
  for (std::size_t i = 0; i < surface.solidCount; ++i) {
    const auto t = static_cast<int>(i);
    const int root = sets.find(t);
    if (root == t) {
      patchOf[t] = static_cast<int>(patches.size());
      patches.emplace_back();
    }
    patchOf[t] = patchOf[root];
    Patch& patch = patches[patchOf[t]];
    patch.triangles.push_back(t);
    if (sets.parity(t) == 0) continue;
    patch.mixed = true;
    std::swap(surface.triangles[t][1], surface.triangles[t][2]);
  }
  sides.forEdges([&](auto first, auto last) {
    if (last - first == 2) return;
    for (auto side = first; side != last; ++side) patches[patchOf[side->triangle]].open = true;
  });
  for (Patch& patch : patches) measurePatch(surface, patch);
  return patches;
}

/// True if the patch, closed and of negative volume, lies inside others: just inside itself it contributes -1 to the
/// winding number, so anything above -1/2 comes from others around it.
bool isCavity(const Surface& surface, const WindingTree& tree, const Patch& patch) {
  const std::size_t step = std::max<std::size_t>(1, patch.triangles.size() / kCavitySamples);
  for (std::size_t i = 0; i < patch.triangles.size(); i += step) {
    const std::array<int, 3>& t = surface.triangles[patch.triangles[i]];
    const Eigen::Vector3d normal = areaVector(surface, t);
    const Eigen::Vector3d centroid = (surface.points[t[0]] + surface.points[t[1]] + surface.points[t[2]]) / 3.0;
    // The normal of a patch of negative volume points into it.
    const Eigen::Vector3d inside = centroid + normal.normalized() * (kCavityDepth * std::sqrt(normal.norm()));
    if (tree.windingNumber(inside) < -0.5) return false;
  }
  return true;
}

void turnInsideOut(Surface& surface, std::vector<Patch>& patches) {
  for (const Patch& patch : patches) {
    if (patch.mixed && patch.volume < 0.0) turn(surface, patch);
  }
  const auto suspicious = [](const Patch& p) { return !p.mixed && !p.open && p.volume < 0.0 && !isSheet(p); };
  if (std::none_of(patches.begin(), patches.end(), suspicious)) return;
  const WindingTree tree = windingTreeOf(surface);
  std::vector<const Patch*> wrong;
  for (const Patch& patch : patches) {
    if (suspicious(patch) && !isCavity(surface, tree, patch)) wrong.push_back(&patch);
  }
  for (const Patch* patch : wrong) turn(surface, *patch);
}

}  // namespace

void orient(Surface& surface) {
  assert(surface.solidCount <= surface.triangles.size());
  std::vector<Patch> patches = makePatches(surface, Sides(surface));
  turnInsideOut(surface, patches);
  std::size_t open = 0;
  Sides(surface).forEdges([&](auto first, auto last) {
    int balance = 0;
    for (auto side = first; side != last; ++side) balance += side->forward ? 1 : -1;
    open += static_cast<std::size_t>(std::abs(balance));
  });
  surface.openEdges = open;
  const auto all = static_cast<double>(3 * surface.solidCount);
  surface.oriented = static_cast<double>(open) <= (1.0 - kOrientedFraction) * all;
}

}  // namespace tetskin::cage_detail
