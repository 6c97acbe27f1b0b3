// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "cage_models.h"
#include "support/odd_meshes.h"

#include <tetskin/cage/src/split/tet_clip.h>
#include <tetskin/cage/src/split/tet_pieces.h>

#include <map>
#include <set>
#include <unordered_map>

namespace tetskin::test {
namespace {

using namespace cage_detail;
using Eigen::Vector3d;

/// A comb 8 x 8.5 x 4 large: a back, and teeth 1 thick, with gaps of 0.5.
bool isInComb(const Vector3d& p) {
  const bool inBox = p.minCoeff() > 0.0 && p.x() < 8.0 && p.y() < 8.5 && p.z() < 4.0;
  return inBox && (p.x() < 1.0 || static_cast<int>(2.0 * p.y()) % 3 != 2);
}

TriangleMesh combMesh() {
  TetMesh tets = latticeCage(8, 17, 4);
  for (Vector3d& p : tets.nodes) p.y() *= 0.5;
  const auto isOut = [&](const Tet& tet) {
    const TetCorners c = cornersOf(tets, tet);
    return !isInComb((c[0] + c[1] + c[2] + c[3]) / 4.0);
  };
  tets.tets.erase(std::remove_if(tets.tets.begin(), tets.tets.end(), isOut), tets.tets.end());
  TriangleMesh mesh;
  mesh.positions = tets.nodes;
  mesh.triangles = boundaryFaces(tets);
  return mesh;
}

/// The pieces of a surface in all tets of the lattice around it.
struct PiecedSurface {
  PiecedSurface(const TriangleMesh& mesh, const LatticeFrame& of) : frame(of), surface(prepareSurface(mesh)) {
    for (int cube = 0; cube < 5 * 5 * 5; ++cube) {
      set.add(static_cast<std::size_t>(set.insert({cube % 5 - 2, cube / 5 % 5 - 2, cube / 25 - 2})), kAllTets);
    }
    lattice = meshOf(set, frame);
    const WindingTree winding = windingTreeOf(surface);
    std::vector<int> tetOf;
    for (const Vector3d& p : surface.points) tetOf.push_back(lattice.indexOf(set, locate(frame.toLattice(p))));
    material = findMaterial(surface, winding, frame, set, lattice);
    const LatticeLinks links(set, lattice);
    const SegmentQueries queries(surface, material, frame, links);
    found = piecesIn(surface, winding, tetOf, material, frame, lattice, links, queries);
    tets = links.tets;
  }
  TetCorners corners(std::size_t tet) const { return cornersOf(lattice.mesh, lattice.mesh.tets[tet]); }

  /// Calls visit(piece, point) for the centroid of each cell of the pieces of a tet, and for a point below each
  /// triangle.
  template <class Visit>
  void forPoints(std::size_t tet, double below, Visit&& visit) const {
    for (int p = found.starts[tet]; p < found.starts[tet + 1]; ++p) {
      const std::array<Vector3d, kCellsPerTet>& centroids = cellTables().centroids[tets[tet].local];
      for (int cell = 0; cell < kCellsPerTet; ++cell) {
        const bool isOwn = (found.pieces[p].cells >> cell & 1) != 0;
        if (isOwn) visit(p, frame.toRest(cubeOrigin(tets[tet].cube) + centroids[cell]));
      }
    }
    const TetCorners c = corners(tet);
    const BarycentricMap map(c);
    for (std::size_t e = material.triangles.starts[tet]; e < material.triangles.starts[tet + 1]; ++e) {
      const auto& t = surface.triangles[material.triangles.values[e]];
      const Eigen::Vector4d w =
          centroidWithin({map(surface.points[t[0]]), map(surface.points[t[1]]), map(surface.points[t[2]])});
      const Vector3d at = w[0] * c[0] + w[1] * c[1] + w[2] * c[2] + w[3] * c[3];
      visit(found.pieceOf[e], at - below * areaVector(surface, t).normalized());
    }
  }

  LatticeFrame frame;
  Surface surface;
  LatticeSet set;
  LatticeMesh lattice;
  TetMaterial material;
  std::vector<LatticeTet> tets;
  TetPieces found;
};

/// A fine grid of points, which are numbered: those of the next rows and layers are this much further.
constexpr double kFine = 0.25;
constexpr int kRow = 1000, kLayer = kRow * kRow;
int numberOf(const Vector3d& p) {
  const Vector3d at = (p / kFine).array().floor() + kRow / 2;
  return static_cast<int>(at.x() + kRow * at.y() + kLayer * at.z());
}

/// The connected parts of the comb within a tet, by flooding the grid: by number of a point, its part. The tet is
/// slightly enlarged, so that necks are as wide as the grid is fine.
std::unordered_map<int, int> floodedParts(const TetCorners& corners) {
  std::unordered_map<int, int> parts;
  Box3 box;
  for (const Vector3d& corner : corners) box.extend(corner);
  const BarycentricMap map(corners);
  for (double x = box.min().x(); x < box.max().x(); x += kFine) {
    for (double y = box.min().y(); y < box.max().y(); y += kFine) {
      for (double z = box.min().z(); z < box.max().z(); z += kFine) {
        if (isInComb({x, y, z}) && map({x, y, z}).minCoeff() > -0.05) parts[numberOf({x, y, z})] = -1;
      }
    }
  }
  int count = 0;
  for (const auto& [number, part] : parts) {
    if (part >= 0) continue;
    for (std::vector<int> open{number}; !open.empty();) {
      const int at = open.back();
      open.pop_back();
      parts[at] = count;
      for (const int step : {1, -1, kRow, -kRow, kLayer, -kLayer}) {
        if (const auto next = parts.find(at + step); next != parts.end() && next->second < 0) open.push_back(at + step);
      }
    }
    ++count;
  }
  return parts;
}

/// Some parts are divided: at a neck that is narrower than the cells, or where there are none.
TEST(TetPieces, OfACombAreThePartsThatFloodingFinds) {
  for (const double offset : {0.11, 0.47}) {
    const PiecedSurface pieces(combMesh(), {Vector3d(4.0, 4.5, 2.0) + offset * Vector3d(1.0, -0.7, 1.3), 3.0});
    int whole = 0, divided = 0, several = 0;
    for (std::size_t t = 0; t < pieces.tets.size(); ++t) {
      if (pieces.material.cells[t] == 0) continue;
      const std::unordered_map<int, int> parts = floodedParts(pieces.corners(t));
      std::map<int, int> partOf;
      std::map<int, std::set<int>> piecesOf;
      pieces.forPoints(t, 0.5 * kFine, [&](int piece, const Vector3d& point) {
        const auto part = parts.find(numberOf(point));
        if (part == parts.end()) return;  // in a corner that is finer than the grid
        EXPECT_EQ(partOf.emplace(piece, part->second).first->second, part->second) << "joined in tet " << t;
        piecesOf[part->second].insert(piece);
      });
      for (const auto& [part, ofPart] : piecesOf) ++(ofPart.size() == 1 ? whole : divided);
      several += piecesOf.size() > 1 ? 1 : 0;
    }
    EXPECT_LE(15 * divided, whole);
    EXPECT_GT(several, 10);
  }
}

/// Boxes around the centroid of a tet that is 2 long.
TEST(TetPieces, OfComponentsAreOneWhereTheseLieInEachOtherOrWithinAnEighthOfATet) {
  const LatticeTet tet{{0, 0, 0}, 0};
  const auto count = [&](double size, double x, double otherSize, double otherX) {
    const auto box = [&](double s, double at) {
      return transformed(boxMesh({s, s, s}), 1.0, centroid(tet) + Vector3d(at, 0, 0));
    };
    const PiecedSurface pieces(joined(box(size, x), box(otherSize, otherX)), {});
    const int t = pieces.lattice.indexOf(pieces.set, tet);
    return pieces.found.starts[t + 1] - pieces.found.starts[t];
  };
  EXPECT_EQ(count(0.15, 0.215, 0.15, -0.215), 2);
  EXPECT_EQ(count(0.15, 0.185, 0.15, -0.185), 1);
  EXPECT_EQ(count(0.8, 0.0, 0.1, 0.0), 1);
}

}  // namespace
}  // namespace tetskin::test
