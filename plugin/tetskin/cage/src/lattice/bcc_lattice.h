// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The body-centred cubic lattice and sparse sets of its tets.
//
// Nodes have integer coordinates that are all even (corners of cubes with sides of 2) or all odd (centres of cubes). A
// tet joins the centres of two neighbouring cubes with one of the four edges of the face between them, so all tets are
// congruent, with dihedral angles of 60 and 90 degrees. All their faces lie in planes x+y, x-y, y+z, y-z, z+x, z-x =
// even, so finding a point's tet, and most tests against one, only compare six numbers.
#pragma once

#include <tetskin/core/mesh.h>

#include <array>
#include <cassert>
#include <cstdint>
#include <vector>

namespace tetskin::cage_detail {

/// Cube (i, j, k) spans [2i, 2i+2] x [2j, 2j+2] x [2k, 2k+2] in lattice coordinates.
using Cube = std::array<std::int32_t, 3>;

/// A cube owns the 12 tets around its faces towards +x, +y and +z.
constexpr int kTetsPerCube = 12;
constexpr std::uint16_t kAllTets = (1u << kTetsPerCube) - 1;
/// Tets around every node.
constexpr int kStarSize = 24;
/// Volume of a tet in lattice coordinates: two edges of length 2, crossing at distance 1.
constexpr double kLatticeTetVolume = 2.0 / 3.0;
/// Largest coordinate of a cube: leaves room in 32 bits for doubling it and for steps to neighbours.
constexpr double kMaxCube = 1 << 29;

struct LatticeTet {
  Cube cube{};
  int local = 0;  ///< 4 * axis of the face + which edge of it, below kTetsPerCube
};

/// A node: the lower corner of its cube (kind 0) or its centre (kind 1).
struct LatticeNode {
  Cube cube{};
  int kind = 0;
};

/// The position of a tet relative to a cube.
struct LatticeStep {
  std::array<std::int8_t, 3> cube{};
  std::int8_t local = 0;
};

/// All tables about the twelve tets and two nodes of a cube.
struct LatticeTables {
  std::array<std::array<std::array<int, 3>, 4>, kTetsPerCube> corners;  ///< relative to 2 * cube, positive orientation
  std::array<std::array<int, 6>, kTetsPerCube> floors;  ///< each tet spans [f, f+2] along each plane direction
  std::array<std::array<LatticeStep, 4>, kTetsPerCube> neighbours;  ///< across the face opposite to each corner
  std::array<std::array<LatticeStep, kStarSize>, 2> star;           ///< tets around a node of each kind
  std::array<std::array<std::uint32_t, kStarSize>, 2> starLinks;    ///< bits of those that share a face and that node
                                                                    ///< with it
};
const LatticeTables& latticeTables();

/// Projections on the six plane directions x+y, x-y, y+z, y-z, z+x, z-x.
inline std::array<double, 6> planeCoordinates(const Eigen::Vector3d& p) {
  return {p.x() + p.y(), p.x() - p.y(), p.y() + p.z(), p.y() - p.z(), p.z() + p.x(), p.z() - p.x()};
}

inline Cube operator+(const Cube& a, const std::array<std::int8_t, 3>& step) {
  return {a[0] + step[0], a[1] + step[1], a[2] + step[2]};
}
inline LatticeTet operator+(const Cube& a, const LatticeStep& step) {
  return {a + step.cube, step.local};
}
inline Eigen::Vector3d cubeOrigin(const Cube& c) {
  return {2.0 * c[0], 2.0 * c[1], 2.0 * c[2]};
}

/// The tet that contains a point in lattice coordinates; on a face, one of its two tets. O(1).
LatticeTet locate(const Eigen::Vector3d& p);

/// Centroid of a tet in lattice coordinates.
Eigen::Vector3d centroid(const LatticeTet& tet);

std::array<LatticeNode, 4> nodesOf(const LatticeTet& tet);

/// The position and size of the lattice in the mesh's space.
struct LatticeFrame {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< position of lattice coordinates 0, rest space
  double half = 1.0;                                 ///< length of one lattice coordinate: half a cube

  Eigen::Vector3d toLattice(const Eigen::Vector3d& p) const { return (p - origin) / half; }
  Eigen::Vector3d toRest(const Eigen::Vector3d& x) const { return origin + half * x; }
};

/// A sparse set of tets: memory is proportional to the number of cubes ever inserted, wherever they are. Cubes keep
/// their order of insertion, so that everything built from a set is reproducible.
class LatticeSet {
 public:
  LatticeSet() : slots_(64, -1) {}

  std::size_t cubeCount() const { return cubes_.size(); }
  std::size_t tetCount() const { return tetCount_; }
  const Cube& cube(std::size_t i) const { return cubes_[i]; }
  /// Bit t is set if tet t of cube i is in the set.
  std::uint16_t mask(std::size_t i) const { return masks_[i]; }
  /// Index of a cube, or -1.
  int find(const Cube& cube) const;
  /// Index of a cube; adds it, without tets, if it is not in the set yet.
  int insert(const Cube& cube);
  bool contains(const LatticeTet& tet) const;
  void add(std::size_t i, std::uint16_t tets);
  void add(const LatticeTet& tet) { add(insert(tet.cube), static_cast<std::uint16_t>(1u << tet.local)); }

 private:
  std::size_t slotOf(const Cube& cube) const;
  void grow();

  std::vector<Cube> cubes_;
  std::vector<std::uint16_t> masks_;
  std::vector<std::int32_t> slots_;  ///< open addressing, a power of two
  std::size_t tetCount_ = 0;
};

/// The tets of a set as a mesh with shared nodes. Tets are sorted by cube (z, y, x) for locality.
struct LatticeMesh {
  TetMesh mesh;
  std::vector<std::int32_t> tetOf;  ///< 12 per cube of the set: index of its tet t at 12 i + t, or -1
  /// One per tet: bit c is set if no tet lies beyond the face opposite to corner c.
  std::vector<std::uint8_t> openFaces;

  /// Index of a tet of the set from which the mesh was made, or -1 if the tet is not in it.
  int indexOf(const LatticeSet& set, const LatticeTet& tet) const {
    assert(tet.local >= 0 && tet.local < kTetsPerCube && tetOf.size() == kTetsPerCube * set.cubeCount());
    const int cube = set.find(tet.cube);
    return cube < 0 ? -1 : tetOf[kTetsPerCube * static_cast<std::size_t>(cube) + static_cast<std::size_t>(tet.local)];
  }
};
LatticeMesh meshOf(const LatticeSet& set, const LatticeFrame& frame);

/// Cubes sorted by (z, y, x): one column along x after the other.
std::vector<std::int32_t> columnOrder(const LatticeSet& set);

}  // namespace tetskin::cage_detail
