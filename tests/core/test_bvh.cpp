// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The hierarchy finds what testing all items finds, and it is the same with every standard library.
#include "support/odd_meshes.h"

#include <tetskin/core/src/base/bvh/bvh.h>
#include <tetskin/core/src/base/mesh/triangle_bvh.h>

#include <numeric>
#include <set>

namespace tetskin::test {
namespace {

using Eigen::Vector3d;
using Box = BvhBox<double>;
using Centroids = Bvh::Centroids<double>;

const Box3 kUnit(Vector3d(0, 0, 0), Vector3d(1, 1, 1));
const Box3 kAround(Vector3d(-1, -1, -1), Vector3d(2, 2, 2));
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Boxes and a hierarchy fitted to them.
struct BoxTree {
  std::vector<Box> items, nodes;
  Bvh bvh;

  BoxTree(const Centroids& centroids, double halfSide, int leafSize) : bvh(centroids, leafSize) {
    for (const Vector3d& p : centroids) {
      Box box;
      box.extend(p.data());
      items.push_back(box.grownBy(halfSide));
    }
    fit();
  }
  void fit() {
    bvh.fit(nodes, [this](int index) { return items[static_cast<std::size_t>(bvh.item(index))]; });
  }
};

/// Centroids on an integer lattice: along each axis, many are equal.
Centroids latticePoints(int side) {
  Centroids points;
  for (int x = 0; x < side; ++x) {
    for (int y = 0; y < side; ++y) {
      for (int z = 0; z < side; ++z) points.emplace_back(x, y, z);
    }
  }
  return points;
}

/// Appends the items leaf by leaf, found by full sorts.
void appendSorted(const Centroids& centroids, std::vector<int> items, std::size_t leafSize, std::vector<int>& leaves) {
  if (items.size() <= leafSize) {
    leaves.insert(leaves.end(), items.begin(), items.end());
    return;
  }
  Box3 box;
  for (const int i : items) box.extend(centroids[static_cast<std::size_t>(i)]);
  Eigen::Index axis = 0;
  box.sizes().maxCoeff(&axis);
  const auto at = [&](int i) { return centroids[static_cast<std::size_t>(i)][axis]; };
  std::sort(items.begin(), items.end(), [&](int a, int b) { return std::pair(at(a), a) < std::pair(at(b), b); });
  const auto half = items.begin() + static_cast<std::ptrdiff_t>(items.size() / 2);
  appendSorted(centroids, {items.begin(), half}, leafSize, leaves);
  appendSorted(centroids, {half, items.end()}, leafSize, leaves);
}

std::vector<int> numbersUpTo(std::size_t count) {
  std::vector<int> numbers(count);
  std::iota(numbers.begin(), numbers.end(), 0);
  return numbers;
}

void expectTree(const Bvh& bvh, std::size_t count, int leafSize) {
  ASSERT_EQ(bvh.items().size(), count);
  EXPECT_EQ(bvh.empty(), count == 0);
  for (std::size_t n = 0; n < bvh.nodes().size(); ++n) {
    const Bvh::Node& node = bvh.nodes()[n];
    if (node.isLeaf()) {
      EXPECT_LE(node.last - node.first, leafSize);
      continue;
    }
    const Bvh::Node &left = bvh.nodes()[n + 1], &right = bvh.nodes()[static_cast<std::size_t>(node.right)];
    EXPECT_EQ(left.first, node.first);
    EXPECT_EQ(left.last, right.first);
    EXPECT_EQ(right.last, node.last);
    EXPECT_LE(std::abs((right.last - right.first) - (left.last - left.first)), 1);
  }
}

TEST(Bvh, HalvesItemsUntilFewAreLeft) {
  for (const int leafSize : {1, 4, 12}) {
    for (const std::size_t count : {0, 1, 2, 12, 13, 1000}) {
      const Bvh bvh(randomPoints(count, kUnit, 1), leafSize);
      expectTree(bvh, count, leafSize);
      std::vector<int> items = bvh.items();
      std::sort(items.begin(), items.end());
      EXPECT_EQ(items, numbersUpTo(count));
    }
  }
}

TEST(Bvh, IsThatOfFullSorts) {
  for (const Centroids& centroids : {randomPoints(777, kUnit, 2), latticePoints(9)}) {
    for (const int leafSize : {1, 6}) {
      std::vector<int> expected;
      appendSorted(centroids, numbersUpTo(centroids.size()), static_cast<std::size_t>(leafSize), expected);
      EXPECT_EQ(Bvh(centroids, leafSize).items(), expected);
    }
  }
}

TEST(Bvh, OfBoxesIsSplitAlongTheBoxAroundThem) {
  std::vector<Box> boxes(8);
  for (int i = 0; i < 8; ++i) {
    const Vector3d low(i % 4, -20.0 - i, 0), high(i % 4, 20.0 + i, 1);  // long along y, where all have the same centre
    boxes[static_cast<std::size_t>(i)].extend(low.data(), high.data());
  }
  EXPECT_EQ(Bvh(boxes, numbersUpTo(8), 2).items(), numbersUpTo(8));
  Centroids centroids;
  for (int i = 0; i < 8; ++i) centroids.emplace_back(i % 4, 0, 0.5);
  EXPECT_EQ(Bvh(centroids, 2).items(), (std::vector<int>{0, 4, 1, 5, 2, 6, 3, 7}));
}

TEST(Bvh, ItemsAtOnePointAreInOrder) {
  const Bvh bvh(Centroids(100, Vector3d(3, 4, 5)), 4);
  expectTree(bvh, 100, 4);
  EXPECT_EQ(bvh.items(), numbersUpTo(100));
}

TEST(Bvh, OfSomeItemsHasTheirNumbers) {
  const Centroids centroids = randomPoints(100, kUnit, 3);
  const std::vector<int> some = {3, 99, 17, 50, 51, 52, 8};
  const Bvh bvh(centroids, some, 2);
  expectTree(bvh, some.size(), 2);
  EXPECT_EQ(std::set<int>(bvh.items().begin(), bvh.items().end()), std::set<int>(some.begin(), some.end()));
}

TEST(Bvh, ItemsThatAreNotFiniteAreThereStill) {
  Centroids centroids = randomPoints(200, kUnit, 4);
  for (std::size_t i = 0; i < centroids.size(); i += 3) {
    centroids[i] = i % 2 ? Vector3d(kNaN, 0, 1) : Vector3d(0, kInfinity, -kInfinity);
  }
  BoxTree tree(centroids, 0.1, 4);
  expectTree(tree.bvh, centroids.size(), 4);
  std::set<int> near;
  tree.bvh.visitNear(tree.nodes, Vector3d(0.5, 0.5, 0.5), 100.0,
                     [&](int k, double&) { near.insert(tree.bvh.item(k)); });
  for (std::size_t i = 0; i < centroids.size(); ++i) {
    EXPECT_TRUE(i % 3 == 0 || near.count(static_cast<int>(i)) == 1);
  }
}

TEST(Bvh, FitsBoxesToItemsThatHaveMoved) {
  BoxTree tree(randomPoints(300, kUnit, 5), 0.05, 4);
  for (std::size_t i = 0; i < tree.items.size(); ++i) {
    const Vector3d by = 5.0 * randomPoints(1, kUnit, static_cast<unsigned>(i))[0];
    for (int k = 0; k < 3; ++k) {
      tree.items[i].low[k] += by[k];
      tree.items[i].high[k] += by[k];
    }
  }
  tree.fit();
  for (std::size_t n = 0; n < tree.nodes.size(); ++n) {
    const Bvh::Node& node = tree.bvh.nodes()[n];
    Box expected;
    for (int k = node.first; k < node.last; ++k) {
      expected.extend(tree.items[static_cast<std::size_t>(tree.bvh.item(k))]);
    }
    for (int k = 0; k < 3; ++k) {
      EXPECT_EQ(tree.nodes[n].low[k], expected.low[k]);
      EXPECT_EQ(tree.nodes[n].high[k], expected.high[k]);
    }
  }
}

TEST(Bvh, WhatIsNotANumberExtendsNoBox) {
  BoxTree tree(randomPoints(100, kUnit, 6), 0.05, 4);
  for (std::size_t i = 0; i < tree.items.size(); ++i) {
    if (i % 2 == 0) std::fill_n(tree.items[i].low, 3, kNaN);
    if (i % 2 == 0) std::fill_n(tree.items[i].high, 3, kNaN);
  }
  tree.fit();
  EXPECT_GE(tree.nodes[0].low[0], -0.05);
  EXPECT_LE(tree.nodes[0].high[0], 1.05);
  for (Box& box : tree.items) box = Box().grownBy(kNaN);
  tree.fit();
  int visited = 0;
  const auto count = [&](int, double&) { ++visited; };
  tree.bvh.visitNear(tree.nodes, Vector3d(0, 0, 0), 1.0, count);
  visitPairs(
      tree.bvh, tree.bvh, [&](int a, int b) { return tree.nodes[size_t(a)].collides(tree.nodes[size_t(b)]); },
      [&](const Bvh::Node&, const Bvh::Node&) { ++visited; });
  EXPECT_EQ(visited, 0);
  // To a ray, an empty box seems to be everywhere; the visitor must test its items.
  tree.bvh.visitAlong(tree.nodes, Vector3d(-1, 0.5, 0.5), Vector3d(3, 0, 0), 1.0, count);
  EXPECT_LE(visited, 100);
}

TEST(Bvh, FillsNodesFromItemsAndChildren) {
  const Bvh bvh(randomPoints(500, kUnit, 7), 3);
  std::vector<long> sums;
  const auto sumOfLeaf = [&](const Bvh::Node& leaf) {
    return std::accumulate(bvh.items().begin() + leaf.first, bvh.items().begin() + leaf.last, 0L);
  };
  bvh.fill(sums, sumOfLeaf, [](long left, long right) { return left + right; });
  for (std::size_t n = 0; n < sums.size(); ++n) EXPECT_EQ(sums[n], sumOfLeaf(bvh.nodes()[n]));
  EXPECT_EQ(sums[0], 499L * 500 / 2);
}

TEST(Bvh, FindsTheNearestBoxAsTestingAllDoes) {
  for (const Centroids& centroids : {randomPoints(400, kUnit, 8), latticePoints(6), randomPoints(1, kUnit, 9),
                                     Centroids(50, Vector3d(0.5, 0.5, 0.5)), Centroids()}) {
    const BoxTree tree(centroids, 0.02, 4);
    for (const Vector3d& p : randomPoints(200, kAround, 10)) {
      double expected = kInfinity, found = kInfinity;
      for (const Box& box : tree.items) expected = std::min(expected, box.squaredDistance(p.data()));
      tree.bvh.visitNear(tree.nodes, p, kInfinity, [&](int index, double& squared) {
        found = std::min(found, tree.items[static_cast<std::size_t>(tree.bvh.item(index))].squaredDistance(p.data()));
        squared = found;
      });
      EXPECT_EQ(found, expected);
    }
  }
}

TEST(Bvh, LooksAtFewItemsForTheNearest) {
  const BoxTree tree(randomPoints(100000, kUnit, 11), 0.0, 4);
  int visited = 0;
  for (const Vector3d& p : randomPoints(100, kUnit, 12)) {
    tree.bvh.visitNear(tree.nodes, p, kInfinity, [&](int index, double& squared) {
      ++visited;
      squared = std::min(squared, tree.items[static_cast<std::size_t>(tree.bvh.item(index))].squaredDistance(p.data()));
    });
  }
  EXPECT_LT(visited, 100 * 100);
}

struct Segment {
  Vector3d start, direction;
};

/// Segments, some of them along the axes and within the planes of a lattice's boxes.
std::vector<Segment> someSegments() {
  std::vector<Segment> segments;
  const std::vector<Vector3d> from = randomPoints(300, kAround, 13), to = randomPoints(300, kAround, 14);
  for (std::size_t i = 0; i < from.size(); ++i) segments.push_back({from[i], to[i] - from[i]});
  for (const double offset : {-0.25, 0.0, 0.1, 0.25, 0.75, 1.0}) {
    segments.push_back({{offset, 0.1, -2.0}, {0.0, 0.0, 9.0}});
    segments.push_back({{9.0, offset, 0.25}, {-12.0, 0.0, 0.0}});
  }
  return segments;
}

TEST(Bvh, ShowsASegmentAllBoxesThatItMeetsOnce) {
  for (const Centroids& centroids :
       {randomPoints(400, kUnit, 15), latticePoints(5), randomPoints(1, kUnit, 16), Centroids()}) {
    const BoxTree tree(centroids, 0.25, 4);
    for (const Segment& s : someSegments()) {
      std::vector<int> shown(centroids.size(), 0);
      tree.bvh.visitAlong(tree.nodes, s.start, s.direction, 1.0,
                          [&](int index, double&) { ++shown[static_cast<std::size_t>(tree.bvh.item(index))]; });
      const Vector3d inverse = s.direction.cwiseInverse();
      for (std::size_t i = 0; i < shown.size(); ++i) {
        const bool collides = tree.items[i].entry(s.start.data(), inverse.data(), 1.0) <= 1.0;
        EXPECT_LE(shown[i], 1);
        EXPECT_TRUE(shown[i] == 1 || !collides);
      }
    }
  }
}

/// This had made cages of few tets slow: every triangle of a tet sends out segments, and each was tested against all
/// triangles.
TEST(Bvh, ShowsASegmentFewTriangles) {
  for (const int rings : {50, 100, 200}) {
    const TriangleMesh mesh = sphere(rings, 1.0, Vector3d::Zero());
    Centroids centroids;
    std::vector<Box> boxes;
    for (const auto& triangle : mesh.triangles) {
      const TriangleCorners t = cornersOf(mesh, triangle);
      centroids.emplace_back((t[0] + t[1] + t[2]) / 3.0);
      Box box;
      for (const Vector3d& p : t) box.extend(p.data());
      boxes.push_back(box.grownBy(1e-4));
    }
    const Bvh bvh(centroids, 4);
    std::vector<Box> nodes;
    bvh.fit(nodes, [&](int index) { return boxes[static_cast<std::size_t>(bvh.item(index))]; });
    std::size_t shown = 0;
    const std::vector<Segment> segments = someSegments();
    for (const Segment& s : segments) {
      bvh.visitAlong(nodes, s.start, s.direction, 1.0, [&](int, double&) { ++shown; });
    }
    EXPECT_GT(shown, segments.size() / 2);
    EXPECT_LT(shown, 40 * segments.size()) << "of " << mesh.triangleCount() << " triangles";
  }
}

TEST(Bvh, FindsTheFirstBoxOfASegmentWhoseEndShrinks) {
  const BoxTree tree(randomPoints(2000, kUnit, 17), 0.02, 4);
  int hits = 0, visited = 0;
  for (const Segment& s : someSegments()) {
    const Vector3d inverse = s.direction.cwiseInverse();
    double expected = kInfinity, found = kInfinity;
    for (const Box& box : tree.items) expected = std::min(expected, box.entry(s.start.data(), inverse.data(), 1.0));
    tree.bvh.visitAlong(tree.nodes, s.start, s.direction, 1.0, [&](int index, double& end) {
      ++visited;
      const Box& box = tree.items[static_cast<std::size_t>(tree.bvh.item(index))];
      found = std::min(found, box.entry(s.start.data(), inverse.data(), end));
      end = std::min(end, found);
    });
    EXPECT_EQ(found, expected);
    hits += found <= 1.0 ? 1 : 0;
  }
  EXPECT_GT(hits, 50);
  EXPECT_LT(visited, 50 * 300);
}

TEST(Bvh, FindsThePairsOfTwoTreesThatTestingAllFinds) {
  for (const double offset : {0.0, 0.6, 5.0}) {
    const BoxTree a(randomPoints(150, kUnit, 18), 0.05, 4);
    Centroids moved = randomPoints(90, kUnit, 19);
    for (Vector3d& p : moved) p.x() += offset;
    const BoxTree b(moved, 0.04, 2);
    std::multiset<std::pair<int, int>> found, expected;
    const auto meet = [&](int i, int j) {
      return a.nodes[static_cast<std::size_t>(i)].collides(b.nodes[static_cast<std::size_t>(j)]);
    };
    visitPairs(a.bvh, b.bvh, meet, [&](const Bvh::Node& left, const Bvh::Node& right) {
      for (int i = left.first; i < left.last; ++i) {
        for (int j = right.first; j < right.last; ++j) {
          const int first = a.bvh.item(i), second = b.bvh.item(j);
          if (a.items[static_cast<std::size_t>(first)].collides(b.items[static_cast<std::size_t>(second)])) {
            found.emplace(first, second);
          }
        }
      }
    });
    for (std::size_t i = 0; i < a.items.size(); ++i) {
      for (std::size_t j = 0; j < b.items.size(); ++j) {
        if (a.items[i].collides(b.items[j])) expected.emplace(i, j);
      }
    }
    EXPECT_EQ(found, expected);
    EXPECT_EQ(found.empty(), offset > 2.0);
  }
  const Bvh none;
  visitPairs(
      none, none, [](int, int) { return true; }, [](const auto&, const auto&) { FAIL(); });
}

TEST(TriangleBvh, FindsTheNearestPointAsTestingAllTrianglesDoes) {
  const TriangleMesh mesh = sphere(12, 0.4, Vector3d(0.5, 0.5, 0.5));
  const TriangleBvh tree(mesh);
  NearestPoint guess;
  for (const Vector3d& p : randomPoints(300, kAround, 3)) {
    std::vector<double> squared;
    for (const auto& t : mesh.triangles) {
      squared.push_back((p - closestPointOnTriangle(p, cornersOf(mesh, t)).point).squaredNorm());
    }
    const double minimum = *std::min_element(squared.begin(), squared.end());
    const NearestPoint found = tree.nearest(p);
    EXPECT_EQ(found.squaredDistance, minimum);
    EXPECT_NEAR((found.point - p).squaredNorm(), minimum, 1e-12);
    EXPECT_EQ(tree.nearest(p, minimum).triangle, -1) << "nothing is nearer than the nearest";
    guess = tree.nearest(p, guess);
    EXPECT_EQ(guess.squaredDistance, minimum) << "whatever the guess";
    for (const NearestPoint& n : {found, guess}) EXPECT_EQ(squared[static_cast<std::size_t>(n.triangle)], minimum);
  }
}

TEST(TriangleBvh, OfSomeTrianglesKnowsTheseAlone) {
  const TriangleMesh mesh = sphere(12, 0.4, Vector3d(0.5, 0.5, 0.5));
  const std::vector<int> some = {100, 7, 33};
  const TriangleBvh tree(mesh, some);
  for (const int t : some) {
    const TriangleCorners corners = cornersOf(mesh, mesh.triangles[static_cast<std::size_t>(t)]);
    const NearestPoint found = tree.nearest((corners[0] + corners[1] + corners[2]) / 3.0);
    EXPECT_EQ(found.triangle, t);
    EXPECT_LT(found.squaredDistance, 1e-20);
  }
  EXPECT_EQ(TriangleBvh(mesh, {}).nearest(Vector3d(0, 0, 0)).triangle, -1);
}

}  // namespace
}  // namespace tetskin::test
