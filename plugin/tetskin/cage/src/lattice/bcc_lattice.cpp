// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// This work is based on:
//   François Labelle, Jonathan Richard Shewchuk, "Isosurface Stuffing: Fast Tetrahedral Meshes with Good Dihedral
//   Angles", SIGGRAPH 2007, section 3 (the body-centred cubic lattice and its tets)
#include <tetskin/cage/src/lattice/bcc_lattice.h>
#include <tetskin/core/src/base/hash.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

namespace tetskin::cage_detail {
namespace {

using Point = std::array<int, 3>;

/// The edge on the side `sign` along axis `u`, of the cube's face along axis `b`.
int localOf(int b, int u, int sign) {
  return 4 * b + (u == (b + 1) % 3 ? 0 : 2) + (sign < 0 ? 1 : 0);
}

/// Corners 0 and 1: centres of the two cubes. Corners 2 and 3: ends of an edge of the face between them.
std::array<Point, 4> cornersOf(int local) {
  assert(local >= 0 && local < kTetsPerCube);
  const int b = local / 4;
  const int u = (local % 4 < 2) ? (b + 1) % 3 : (b + 2) % 3;
  const int w = 3 - b - u;
  const int sign = local % 2 == 0 ? 1 : -1;
  std::array<Point, 4> p;
  p.fill({1, 1, 1});
  p[1][b] += 2;
  for (const int e : {2, 3}) {
    p[e][b] += 1;
    p[e][u] += sign;
    p[e][w] += e == 2 ? 1 : -1;
  }
  Eigen::Matrix3i edges;
  for (int row = 0; row < 3; ++row) {
    for (int axis = 0; axis < 3; ++axis) edges(row, axis) = p[row + 1][axis] - p[0][axis];
  }
  if (edges.determinant() < 0) std::swap(p[2], p[3]);
  return p;
}

std::array<int, 6> floorsOf(const std::array<Point, 4>& corners) {
  std::array<int, 6> floors;
  floors.fill(1 << 20);
  for (const Point& c : corners) {
    const std::array<double, 6> d = planeCoordinates(Eigen::Vector3d(c[0], c[1], c[2]));
    for (int i = 0; i < 6; ++i) floors[i] = std::min(floors[i], static_cast<int>(d[i]));
  }
  return floors;
}

Point plus(const Point& p, const std::array<std::int8_t, 3>& cube) {
  return {p[0] + 2 * cube[0], p[1] + 2 * cube[1], p[2] + 2 * cube[2]};
}

/// Calls f with the position of each tet of the 5 x 5 x 5 cubes around cube 0, and with its corners.
template <class F>
void forTetsNearby(const LatticeTables& tables, F f) {
  constexpr std::int8_t kReach = 2;
  for (std::int8_t z = -kReach; z <= kReach; ++z) {
    for (std::int8_t y = -kReach; y <= kReach; ++y) {
      for (std::int8_t x = -kReach; x <= kReach; ++x) {
        for (std::int8_t local = 0; local < kTetsPerCube; ++local) {
          const LatticeStep step{{x, y, z}, local};
          std::array<Point, 4> corners;
          for (int i = 0; i < 4; ++i) corners[i] = plus(tables.corners[local][i], step.cube);
          f(step, corners);
        }
      }
    }
  }
}

int sharedCorners(const std::array<Point, 4>& a, const std::array<Point, 4>& b) {
  return static_cast<int>(
      std::count_if(a.begin(), a.end(), [&](const Point& p) { return std::find(b.begin(), b.end(), p) != b.end(); }));
}

void fillNeighbours(LatticeTables& tables) {
  for (int local = 0; local < kTetsPerCube; ++local) {
    const std::array<Point, 4>& own = tables.corners[local];
    forTetsNearby(tables, [&](const LatticeStep& step, const std::array<Point, 4>& corners) {
      if (sharedCorners(own, corners) != 3) return;
      for (int i = 0; i < 4; ++i) {
        if (std::find(corners.begin(), corners.end(), own[i]) == corners.end()) tables.neighbours[local][i] = step;
      }
    });
  }
}

void fillStars(LatticeTables& tables) {
  for (int kind = 0; kind < 2; ++kind) {
    const Point node{kind, kind, kind};
    std::vector<std::array<Point, 4>> found;
    forTetsNearby(tables, [&](const LatticeStep& step, const std::array<Point, 4>& corners) {
      if (std::find(corners.begin(), corners.end(), node) == corners.end()) return;
      tables.star[kind][found.size()] = step;
      found.push_back(corners);
    });
    assert(found.size() == kStarSize);
    for (std::size_t a = 0; a < found.size(); ++a) {
      std::uint32_t links = 0;
      for (std::size_t b = 0; b < found.size(); ++b) links |= (sharedCorners(found[a], found[b]) == 3 ? 1u : 0u) << b;
      tables.starLinks[kind][a] = links;
    }
  }
}

LatticeTables makeTables() {
  LatticeTables tables{};
  for (int local = 0; local < kTetsPerCube; ++local) {
    tables.corners[local] = cornersOf(local);
    tables.floors[local] = floorsOf(tables.corners[local]);
  }
  fillNeighbours(tables);
  fillStars(tables);
  return tables;
}

std::size_t hashOf(const Cube& c) {
  Hash hash;
  hash.add(std::uint64_t{static_cast<std::uint32_t>(c[0])} << 32 | static_cast<std::uint32_t>(c[1]));
  hash.add(std::uint64_t{static_cast<std::uint32_t>(c[2])});
  return hash.mixed();
}

std::uint8_t openFacesOf(const LatticeSet& set, const LatticeTet& tet) {
  unsigned faces = 0;
  for (int c = 0; c < 4; ++c) {
    faces |= (set.contains(tet.cube + latticeTables().neighbours[tet.local][c]) ? 0u : 1u) << c;
  }
  return static_cast<std::uint8_t>(faces);
}

}  // namespace

const LatticeTables& latticeTables() {
  static const LatticeTables tables = makeTables();
  return tables;
}

LatticeTet locate(const Eigen::Vector3d& p) {
  assert(p.cwiseAbs().maxCoeff() < 8.0 * kMaxCube);
  LatticeTet tet;
  Eigen::Vector3d r;
  for (int axis = 0; axis < 3; ++axis) {
    tet.cube[axis] = static_cast<std::int32_t>(std::floor(0.5 * p[axis]));
    r[axis] = p[axis] - (2.0 * tet.cube[axis] + 1.0);
  }
  // The cube is split into a pyramid for each face, and each pyramid into a quarter for each edge of the face.
  const Eigen::Vector3d size = r.cwiseAbs();
  const int b = size[0] >= size[1] ? (size[0] >= size[2] ? 0 : 2) : (size[1] >= size[2] ? 1 : 2);
  const int next = (b + 1) % 3, last = (b + 2) % 3;
  const int u = size[next] >= size[last] ? next : last;
  if (r[b] < 0.0) --tet.cube[b];
  tet.local = localOf(b, u, r[u] < 0.0 ? -1 : 1);
  return tet;
}

Eigen::Vector3d centroid(const LatticeTet& tet) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Point& c : latticeTables().corners[tet.local]) sum += Eigen::Vector3d(c[0], c[1], c[2]);
  return cubeOrigin(tet.cube) + 0.25 * sum;
}

std::array<LatticeNode, 4> nodesOf(const LatticeTet& tet) {
  std::array<LatticeNode, 4> nodes;
  for (int i = 0; i < 4; ++i) {
    const Point& c = latticeTables().corners[tet.local][i];
    nodes[i].kind = c[0] & 1;
    for (int axis = 0; axis < 3; ++axis) nodes[i].cube[axis] = tet.cube[axis] + (c[axis] - nodes[i].kind) / 2;
  }
  return nodes;
}

std::size_t LatticeSet::slotOf(const Cube& cube) const {
  std::size_t slot = hashOf(cube) & (slots_.size() - 1);
  while (slots_[slot] >= 0 && cubes_[slots_[slot]] != cube) slot = (slot + 1) & (slots_.size() - 1);
  return slot;
}

int LatticeSet::find(const Cube& cube) const {
  return slots_[slotOf(cube)];
}

int LatticeSet::insert(const Cube& cube) {
  std::size_t slot = slotOf(cube);
  if (slots_[slot] >= 0) return slots_[slot];
  if (2 * (cubes_.size() + 1) > slots_.size()) {
    grow();
    slot = slotOf(cube);
  }
  slots_[slot] = static_cast<std::int32_t>(cubes_.size());
  cubes_.push_back(cube);
  masks_.push_back(0);
  return slots_[slot];
}

void LatticeSet::grow() {
  slots_.assign(2 * slots_.size(), -1);
  for (std::size_t i = 0; i < cubes_.size(); ++i) slots_[slotOf(cubes_[i])] = static_cast<std::int32_t>(i);
}

bool LatticeSet::contains(const LatticeTet& tet) const {
  const int i = find(tet.cube);
  return i >= 0 && (masks_[i] >> tet.local & 1) != 0;
}

void LatticeSet::add(std::size_t i, std::uint16_t tets) {
  assert(i < masks_.size() && (tets & ~kAllTets) == 0);
  for (unsigned fresh = tets & static_cast<unsigned>(~masks_[i]); fresh != 0; fresh &= fresh - 1) ++tetCount_;
  masks_[i] |= tets;
}

std::vector<std::int32_t> columnOrder(const LatticeSet& set) {
  std::vector<std::int32_t> order(set.cubeCount());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](std::int32_t a, std::int32_t b) {
    const Cube &p = set.cube(a), &q = set.cube(b);
    if (p[2] != q[2]) return p[2] < q[2];
    return p[1] != q[1] ? p[1] < q[1] : p[0] < q[0];
  });
  return order;
}

LatticeMesh meshOf(const LatticeSet& set, const LatticeFrame& frame) {
  LatticeMesh result;
  result.tetOf.assign(kTetsPerCube * set.cubeCount(), -1);
  result.mesh.tets.reserve(set.tetCount());
  LatticeSet nodeCubes;
  std::vector<std::array<int, 2>> nodeOf;  // by cube and kind
  const auto nodeIndex = [&](const LatticeNode& node) {
    const auto i = static_cast<std::size_t>(nodeCubes.insert(node.cube));
    if (i == nodeOf.size()) nodeOf.push_back({-1, -1});
    int& index = nodeOf[i][node.kind];
    if (index < 0) {
      index = static_cast<int>(result.mesh.nodes.size());
      result.mesh.nodes.push_back(frame.toRest(cubeOrigin(node.cube) + Eigen::Vector3d::Constant(node.kind)));
    }
    return index;
  };
  for (const std::int32_t i : columnOrder(set)) {
    for (int local = 0; local < kTetsPerCube; ++local) {
      if ((set.mask(i) >> local & 1) == 0) continue;
      result.tetOf[kTetsPerCube * i + local] = static_cast<std::int32_t>(result.mesh.tets.size());
      const LatticeTet tet{set.cube(i), local};
      result.openFaces.push_back(openFacesOf(set, tet));
      const std::array<LatticeNode, 4> nodes = nodesOf(tet);
      result.mesh.tets.push_back({nodeIndex(nodes[0]), nodeIndex(nodes[1]), nodeIndex(nodes[2]), nodeIndex(nodes[3])});
    }
  }
  assert(result.mesh.tetCount() == set.tetCount());
  return result;
}

}  // namespace tetskin::cage_detail
