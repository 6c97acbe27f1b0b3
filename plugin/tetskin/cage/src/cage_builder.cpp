// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// From any triangle mesh to a cage for it: a body-centred cubic lattice of tets, of which those are kept that touch the
// surface or lie inside. The mesh need not be watertight, welded, consistently oriented or free of intersections.
//
//   prepareSurface   weld, orient                                        surface, orientation
//   searchLattice    spacing and origin for the wanted number of tets    lattice_search
//     coverSurface     tets that triangles touch                         surface_cover, bcc_lattice
//     fillInside       tets inside                                       inside_fill, winding_number
//     joinPinches      tets that make the boundary a manifold            cage_joints
//   bindPoints       which tet holds which vertex                        cage_binding
//   fitCage          pull the boundary towards the surface               cage_fit
#include <tetskin/cage/cage_builder.h>
#include <tetskin/cage/src/fit/cage_binding.h>
#include <tetskin/cage/src/fit/cage_fit.h>
#include <tetskin/cage/src/fit/cage_quality.h>
#include <tetskin/cage/src/lattice/lattice_search.h>
#include <tetskin/cage/src/surface/surface.h>

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cmath>
#include <sstream>

namespace tetskin {
namespace {

using cage_detail::LatticeCage;
using cage_detail::LatticeMesh;
using cage_detail::Surface;

/// Sizes and coordinates outside this range cannot be raised to the powers that areas and their squares need.
constexpr double kLargestLength = 1e60;
/// Other origins tried when a vertex falls on a lattice plane so exactly that rounding puts it outside all tets.
constexpr std::size_t kAttempts = 4;
/// Origins between two attempts; more than one search uses.
constexpr std::size_t kOriginsPerAttempt = 100;
/// Distance of the points on large triangles that fitting has to keep inside, in half cubes: a cube's face is then
/// supported by several, while meshes finer than the lattice get none.
constexpr double kHoldStep = 0.5;

Status checkInput(const TriangleMesh& mesh, const CageOptions& options) {
  if (options.targetTets == 0 || options.targetTets > kLargestTargetTets) {
    return {StatusCode::InvalidOption, "targetTets is " + std::to_string(options.targetTets) +
                                           "; it has to be between 1 and " + std::to_string(kLargestTargetTets)};
  }
  if (Status status = checkTriangleMesh(mesh); !status.ok()) return status;
  if (mesh.triangles.empty()) {
    return {StatusCode::Empty, "the mesh has " + std::to_string(mesh.vertexCount()) +
                                   " vertices but no triangles; a cage needs a surface, so triangulate it first"};
  }
  return {};
}

Status notDivisible(const Surface& surface) {
  std::ostringstream text;
  text
      << "the vertices lie between (" << surface.box.min().transpose() << ") and (" << surface.box.max().transpose()
      << "), which double precision cannot divide into tets; move the mesh to the origin, scale it, or remove vertices "
         "that are far from all others";
  return {StatusCode::Degenerate, text.str()};
}

Status checkExtent(const Surface& surface) {
  const double size = surface.box.sizes().maxCoeff();
  if (size == 0.0) {
    return {StatusCode::Degenerate,
            "all vertices of the mesh are at the same point; there is nothing to put a cage around"};
  }
  const double farthest = std::max(surface.box.min().cwiseAbs().maxCoeff(), surface.box.max().cwiseAbs().maxCoeff());
  const bool computable = farthest < kLargestLength && size > 1.0 / kLargestLength;
  if (!computable || size < cage_detail::smallestSpacing(surface)) return notDivisible(surface);
  return {};
}

/// A lattice cage as a mesh, with the points it has to hold.
struct BoundCage {
  LatticeCage cage;
  LatticeMesh lattice;
  std::vector<Eigen::Vector3d> points;
  std::vector<int> tetOf;
  std::size_t outside = 0;  ///< of the surface's own points
};

BoundCage bindCage(const Surface& surface, std::size_t target, std::size_t firstOrigin, bool fit) {
  BoundCage bound;
  bound.cage = cage_detail::searchLattice(surface, target, firstOrigin);
  bound.lattice = cage_detail::meshOf(bound.cage.set, bound.cage.frame);
  bound.points = fit ? cage_detail::pointsToHold(surface, kHoldStep * bound.cage.frame.half) : surface.points;
  bound.tetOf = cage_detail::bindPoints(bound.points, bound.cage.set, bound.cage.frame, bound.lattice);
  bound.outside = cage_detail::countOutside(bound.points, surface.points.size(), bound.lattice.mesh, bound.tetOf);
  return bound;
}

/// The first cage in which all vertices are inside; otherwise the one with the fewest outside.
BoundCage firstCageThatHolds(const Surface& surface, const CageOptions& options) {
  BoundCage best;
  for (std::size_t i = 0; i < kAttempts; ++i) {
    BoundCage bound = bindCage(surface, options.targetTets, i * kOriginsPerAttempt, options.fit);
    if (i == 0 || bound.outside < best.outside) best = std::move(bound);
    if (best.outside == 0) break;
  }
  return best;
}

void reportSurface(const Surface& surface, CageReport& report) {
  report.meshComponents = surface.components;
  report.looseVertices = surface.loosePoints.size();
  report.openEdges = surface.openEdges;
  report.meshVolume = surface.volume;
}

void reportLattice(const BoundCage& bound, CageReport& report) {
  report.joiningTets = bound.cage.joiningTets;
  report.spacing = 2.0 * bound.cage.frame.half;
  report.lattices = bound.cage.lattices;
  report.cageVolumeUnfitted = totalVolume(bound.lattice.mesh);
}

void reportCage(const TetMesh& cage, CageReport& report) {
  report.tets = cage.tetCount();
  report.nodes = cage.nodeCount();
  const DihedralRange range = dihedralRange(cage);
  report.minDihedralDeg = range.minDeg;
  report.maxDihedralDeg = range.maxDeg;
  report.cageComponents = cage_detail::connectedComponents(cage);
  report.cageVolume = totalVolume(cage);
  if (!(report.meshVolume > 0.0)) return;
  report.volumeRatio = report.cageVolume / report.meshVolume;
  report.volumeRatioUnfitted = report.cageVolumeUnfitted / report.meshVolume;
}

/// The build proper: everything in the report but the time.
Result<Cage> build(const TriangleMesh& mesh, const CageOptions& options, CageReport& report) {
  report.targetTets = options.targetTets;
  if (Status status = checkInput(mesh, options); !status.ok()) return status;
  const Surface surface = cage_detail::prepareSurface(mesh);
  if (Status status = checkExtent(surface); !status.ok()) return status;
  reportSurface(surface, report);

  BoundCage bound = firstCageThatHolds(surface, options);
  assert(!bound.lattice.mesh.tets.empty());
  reportLattice(bound, report);
  if (options.fit) cage_detail::fitCage(bound.lattice, bound.cage.frame.half, bound.points, bound.tetOf);
  reportCage(bound.lattice.mesh, report);
  report.verticesOutside =
      cage_detail::countOutside(bound.points, surface.points.size(), bound.lattice.mesh, bound.tetOf);
  Cage cage(std::move(bound.lattice.mesh));
  for (const int point : surface.pointOf) cage.vertexTets.push_back(bound.tetOf[point]);
  cage.meshHash = positionsHash(mesh.positions);
  return cage;
}

}  // namespace

bool CageReport::targetMet() const {
  const auto difference = static_cast<double>(tets) - static_cast<double>(targetTets);
  return std::abs(difference) <= cage_detail::kCountTolerance * static_cast<double>(targetTets);
}

std::string CageReport::describe() const {
  std::ostringstream text;
  text << tets << " tets, " << nodes << " nodes, spacing " << spacing;
  if (!targetMet()) text << " (" << targetTets << " tets were asked for; no lattice comes nearer)";
  text << "\n" << verticesOutside << " vertices outside\n";
  text << "dihedral angles " << minDihedralDeg << " to " << maxDihedralDeg << " degrees\n";
  text << meshComponents << " components of the mesh, " << cageComponents << " of the cage";
  if (cageComponents < meshComponents + looseVertices) text << " (some lie so near to each other that they have fused)";
  text << "\n";
  if (openEdges > 0) text << openEdges << " open edges: holes are closed where they see less than half of the inside\n";
  if (looseVertices > 0) text << looseVertices << " loose vertices, which no triangle uses, have tets of their own\n";
  if (joiningTets > 0) text << joiningTets << " tets join parts that would hang together by one node or edge\n";
  if (meshVolume > 0.0) {
    text << "volume " << volumeRatio << " times the mesh's, " << volumeRatioUnfitted << " before fitting\n";
  } else {
    text << "the mesh is a sheet without volume; the cage's is " << cageVolume << "\n";
  }
  text << milliseconds << " ms, " << lattices << " lattices tried\n";
  return text.str();
}

Result<Cage> buildCage(const TriangleMesh& mesh, const CageOptions& options, CageReport* report) {
  const auto start = std::chrono::steady_clock::now();
  CageReport unread;
  CageReport& now = report ? *report : unread;
  now = {};
  Result<Cage> cage = build(mesh, options, now);
  now.milliseconds = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  assert(!cage.ok() || checkTetMesh(cage.value()).clean());
  return cage;
}

}  // namespace tetskin
