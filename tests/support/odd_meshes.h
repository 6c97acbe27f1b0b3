// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Meshes that tests generate, both well-behaved and badly shaped.
#pragma once

#include <tetskin/core/mesh.h>

#include <cstddef>
#include <functional>
#include <iosfwd>
#include <string>
#include <utility>
#include <vector>

namespace tetskin::test {

inline TetMesh shifted(TetMesh mesh, const Eigen::Vector3d& by) {
  for (Eigen::Vector3d& p : mesh.nodes) p += by;
  return mesh;
}
inline TetMesh lifted(TetMesh mesh, double height) {
  return shifted(std::move(mesh), {0, height, 0});
}

/// The unit corner tet: nodes at the origin and the three unit points.
TetMesh singleTet();

/// nx x ny x nz cubes of the given edge, starting at the origin, six tets each, mirrored in alternate cubes; all
/// positive.
TetMesh latticeCage(int nx, int ny, int nz, double edge = 1.0);

/// The same lattice as latticeCage, but with the same diagonal in all cubes.
TetMesh plainLatticeCage(int nx, int ny, int nz, double edge = 1.0);

/// nx x ny x nz cubes, each with a node at its centre: tets join the centres of neighbouring cubes with the edges of
/// the face between them; all positive.
TetMesh bodyCentredCage(int nx, int ny, int nz, double edge = 1.0);

/// The cage with every coordinate moved by up to `amount`; reproducible; all positive.
TetMesh jittered(TetMesh cage, double amount, unsigned seed);

/// The three lattices over the unit cube, and the same three jittered by a quarter of their cubes' edges.
struct LatticeKind {
  std::string name;
  std::function<TetMesh(int)> make;  ///< argument: number of cubes along each axis
};
const std::vector<LatticeKind>& latticeKinds();
void PrintTo(const LatticeKind& kind, std::ostream* out);  ///< for GoogleTest

/// Indices of the tets with a node on the boundary.
std::vector<int> boundaryTets(const TetMesh& cage);

/// One uniformly distributed point in each of these tets; reproducible.
std::vector<Eigen::Vector3d> pointsIn(const TetMesh& cage, const std::vector<int>& tets, unsigned seed);

/// `count` of these values, chosen at random; reproducible.
std::vector<int> someOf(const std::vector<int>& values, std::size_t count, unsigned seed);

/// Independent positive tets with edges up to `size` in the unit cube; they overlap at random.
TetMesh randomTets(std::size_t count, double size, unsigned seed);

/// A lattice over the unit cube whose cells grow from about 0.001 to 0.3 along each axis.
TetMesh gradedCage();

/// A lattice over the unit square, 0.5 high, with one thin layer of tets on top.
TetMesh thinLayerCage(double thickness);

/// Two equal lattices, the second shifted by half a cell: every vertex inside both lies in two tets.
TetMesh overlappingCage();

/// Closed sphere of about 2 x rings x `around` triangles; 0 means about as many around as there are rings.
TriangleMesh sphere(int rings, double radius, const Eigen::Vector3d& centre, int around = 0);

/// The bounding box of the cage's nodes, scaled about its centre.
Box3 around(const TetMesh& cage, double factor);

/// Uniformly distributed points in a box; reproducible.
std::vector<Eigen::Vector3d> randomPoints(std::size_t count, const Box3& box, unsigned seed);

std::vector<Eigen::Vector3d> scaledAndMoved(std::vector<Eigen::Vector3d> points, double scale,
                                            const Eigen::Vector3d& offset);

}  // namespace tetskin::test
