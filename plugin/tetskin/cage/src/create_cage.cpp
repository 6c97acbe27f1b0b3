// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// From any triangle mesh to a cage for it: a body-centred cubic lattice of tets, of which those are kept that touch the
// surface or lie inside. The mesh need not be watertight, welded, consistently oriented or free of intersections.
//
//   prepareSurface   weld, orient                                      surface, orientation
//   searchLattice    spacing and origin for the wanted number of tets  lattice_search
//     coverSurface     tets that triangles touch                       surface_cover, bcc_lattice
//     fillInside       tets inside                                     inside_fill, winding_number
//     joinPinches      tets that make the boundary a manifold          cage_joints
//   sampleSurface    points that the cage has to contain               surface_samples
//   bindPoints       which tet of the lattice contains which of them   cage_binding
//   findMaterial     which cells of each tet are inside                tet_material, tet_cells
//   copyTets         a duplicate tet for each connected part in it     tet_copies
//     piecesIn         connected parts of the body in a tet            tet_pieces, tet_clip, segment_queries
//   splitLattice     duplicates joined where they are connected        split_lattice
//   fitCage          pull the boundary towards the surface             cage_fit
//   fillOf           volume fraction of each tet, and masses           cage_fill
#include <tetskin/cage/create_cage.h>
#include <tetskin/cage/src/fill/cage_fill.h>
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
using cage_detail::SurfaceSamples;

/// Sizes and coordinates outside of this range would overflow or underflow in areas and their squares.
constexpr double kMaxLength = 1e60;
/// Number of other origins tried when a vertex falls on a lattice plane so exactly that rounding puts it outside of all
/// tets.
constexpr std::size_t kAttempts = 4;
/// Distance in the sequence of origins between two attempts: more than one search uses.
constexpr std::size_t kOriginsPerAttempt = 100;
/// Number of searches for the tet count if splitting changes it, and the deviation at which they end.
constexpr int kSizeRounds = 4;
constexpr double kSizeTolerance = 0.07;
/// Distance, in half cubes, of the points on large triangles that fitting has to keep inside: several of them then lie
/// on each face of a cube, while meshes finer than the lattice get none.
constexpr double kHoldStep = 0.5;

Status checkInput(const TriangleMesh& mesh, const CageOptions& options) {
  if (options.targetTets == 0 || options.targetTets > Limits::kMaxTargetTets) {
    return {StatusCode::InvalidOption, "targetTets is " + std::to_string(options.targetTets) +
                                           "; it must be between 1 and " + std::to_string(Limits::kMaxTargetTets)};
  }
  if (Status status = validate(mesh); !status.ok()) return status;
  if (mesh.triangles.empty()) {
    return {StatusCode::Empty, "the mesh has " + std::to_string(mesh.vertexCount()) +
                                   " vertices but no triangles; a cage needs a surface, so triangulate it first"};
  }
  return {};
}

Status notDivisible(const Surface& surface) {
  std::ostringstream text;
  text << "the vertices lie between (" << surface.box.min().transpose() << ") and (" << surface.box.max().transpose()
       << "), too far apart to divide into tets in double precision; move the mesh to the origin, scale it, or remove "
          "vertices "
          "that are far from all others";
  return {StatusCode::Degenerate, text.str()};
}

Status checkExtent(const Surface& surface) {
  const double size = surface.box.sizes().maxCoeff();
  if (size == 0.0) {
    return {StatusCode::Degenerate,
            "all vertices of the mesh are at the same point; a cage needs a mesh that has an extent"};
  }
  const double farthest = std::max(surface.box.min().cwiseAbs().maxCoeff(), surface.box.max().cwiseAbs().maxCoeff());
  const bool computable = farthest < kMaxLength && size > 1.0 / kMaxLength;
  if (!computable || size < cage_detail::smallestSpacing(surface)) return notDivisible(surface);
  return {};
}

/// A cage on a lattice, with the points that it has to contain.
struct BoundCage {
  LatticeCage cage;
  LatticeMesh lattice;
  SurfaceSamples samples;
  cage_detail::CageTets tets;
  std::size_t outside = 0;  ///< number of the surface's own points outside
};

/// Splits the lattice if that creates duplicates; otherwise it stays as it is.
cage_detail::CageTets splitTets(const Surface& surface, const WindingTree& winding, const BoundCage& bound,
                                const std::vector<int>& tetOf, bool split) {
  assert(tetOf.size() == bound.samples.points.size());
  const cage_detail::LatticeFrame& frame = bound.cage.frame;
  const auto material = cage_detail::findMaterial(surface, winding, frame, bound.cage.set, bound.lattice);
  if (split && surface.oriented) {
    const cage_detail::LatticeLinks links(bound.cage.set, bound.lattice);
    const auto copies =
        cage_detail::copyTets(surface, winding, bound.samples, tetOf, material, frame, bound.lattice, links);
    cage_detail::CageTets tets = cage_detail::splitLattice(copies, bound.samples, bound.lattice, links);
    if (tets.split) return tets;
  }
  return cage_detail::wholeLattice(bound.lattice, material, tetOf);
}

BoundCage bindCage(const Surface& surface, const WindingTree& winding, std::size_t target, std::size_t firstOrigin,
                   const CageOptions& options) {
  BoundCage bound;
  bound.cage = cage_detail::searchLattice(surface, winding, target, firstOrigin);
  bound.lattice = cage_detail::meshOf(bound.cage.set, bound.cage.frame);
  bound.samples = cage_detail::sampleSurface(surface, kHoldStep * bound.cage.frame.half);
  const std::vector<int> tetOf =
      cage_detail::bindPoints(bound.samples.points, bound.cage.set, bound.cage.frame, bound.lattice);
  bound.tets = splitTets(surface, winding, bound, tetOf, options.duplicateElements);
  bound.outside = cage_detail::countOutside(surface.points, surface.points.size(), bound.tets.mesh, bound.tets.tetOf);
  return bound;
}

/// Splitting adds and removes tets: the resulting number is known only afterwards.
BoundCage bindCageOfSize(const Surface& surface, const WindingTree& winding, const CageOptions& options,
                         std::size_t firstOrigin) {
  const auto target = static_cast<double>(options.targetTets);
  const auto miss = [&](const BoundCage& bound) {
    return std::abs(static_cast<double>(bound.tets.mesh.tetCount()) / target - 1.0);
  };
  BoundCage best;
  double wanted = target;
  std::size_t lattices = 0;
  for (int round = 0; round < kSizeRounds; ++round) {
    BoundCage bound = bindCage(surface, winding, static_cast<std::size_t>(std::max(wanted, 1.0)), firstOrigin, options);
    lattices += bound.cage.lattices;
    const double grown = static_cast<double>(bound.tets.mesh.tetCount()) / target;
    const bool whole = !bound.tets.split;
    if (round == 0 || miss(bound) < miss(best)) best = std::move(bound);
    if (whole || miss(best) <= kSizeTolerance) break;
    wanted /= grown;
  }
  best.cage.lattices = lattices;
  return best;
}

/// The first cage that contains all vertices; otherwise the one with the fewest outside.
BoundCage firstEnclosingCage(const Surface& surface, const WindingTree& winding, const CageOptions& options) {
  BoundCage best;
  for (std::size_t i = 0; i < kAttempts; ++i) {
    BoundCage bound = bindCageOfSize(surface, winding, options, i * kOriginsPerAttempt);
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
  report.bridgingTets = bound.tets.split ? 0 : bound.cage.joiningTets;
  report.spacing = 2.0 * bound.cage.frame.half;
  report.latticesTried = bound.cage.lattices;
  report.cageVolumeUnfitted = totalVolume(bound.tets.mesh);
  report.duplicateTets = bound.tets.copies();
}

void reportCage(const TetMesh& cage, CageReport& report) {
  assert(report.cageVolumeUnfitted > 0.0);
  report.tets = cage.tetCount();
  report.nodes = cage.nodeCount();
  const DihedralRange range = dihedralRange(cage);
  report.minDihedralDegrees = range.minDeg;
  report.maxDihedralDegrees = range.maxDeg;
  const std::vector<int> components = cage_detail::componentNumbers(cage);
  report.components =
      components.empty() ? 0 : static_cast<std::size_t>(*std::max_element(components.begin(), components.end())) + 1;
  const std::size_t meshParts = report.meshComponents + report.looseVertices;
  report.fusedComponents = meshParts > report.components ? meshParts - report.components : 0;
  report.cageVolume = totalVolume(cage);
  if (!(report.meshVolume > 0.0)) return;
  report.volumeRatio = report.cageVolume / report.meshVolume;
  report.volumeRatioUnfitted = report.cageVolumeUnfitted / report.meshVolume;
}

Cage cageOf(const TriangleMesh& mesh, const Surface& surface, BoundCage bound) {
  assert(bound.tets.tetOf.size() >= surface.points.size() && surface.pointOf.size() == mesh.vertexCount());
  Cage cage(bound.tets.mesh);
  // For a sheet, or where inside and outside cannot be told apart, the whole of a tet counts as material.
  const bool solid = surface.oriented && surface.volume > 0.0;
  if (solid) {
    cage_detail::CageFill fill = cage_detail::fillOf(bound.tets, bound.cage.frame, bound.cage.set, bound.lattice);
    cage.volumeFraction = std::move(fill.fill);
    cage.fineVolumeFraction = std::move(fill.fine);
  }
  cage.masses =
      cage_detail::nodeMasses(cage.mesh, cage.volumeFraction, solid ? surface.volume : totalVolume(cage.mesh));
  cage.sourceTet = std::move(bound.tets.latticeTets);
  cage.component = cage_detail::componentNumbers(cage.mesh);
  for (const int point : surface.pointOf) cage.vertexTets.push_back(bound.tets.tetOf[point]);
  // Rounding may leave a vertex outside of all tets: then the map is dropped, and `embed` finds the nearest tet.
  if (std::count(cage.vertexTets.begin(), cage.vertexTets.end(), -1) > 0) cage.vertexTets.clear();
  cage.meshHash = positionsHash(mesh.positions);
  return cage;
}

/// The build itself: everything in the report except for the time.
Result<Cage> build(const TriangleMesh& mesh, const CageOptions& options, CageReport& report) {
  report.targetTets = options.targetTets;
  if (Status status = checkInput(mesh, options); !status.ok()) return status;
  const Surface surface = cage_detail::prepareSurface(mesh);
  if (Status status = checkExtent(surface); !status.ok()) return status;
  reportSurface(surface, report);

  const WindingTree winding = windingTreeOf(surface);
  BoundCage bound = firstEnclosingCage(surface, winding, options);
  assert(!bound.tets.mesh.tets.empty());
  reportLattice(bound, report);
  if (options.fit) cage_detail::fitCage(bound.tets, bound.cage.frame.half, bound.samples.points);
  reportCage(bound.tets.mesh, report);
  report.verticesOutside =
      cage_detail::countOutside(surface.points, surface.points.size(), bound.tets.mesh, bound.tets.tetOf);
  return cageOf(mesh, surface, std::move(bound));
}

}  // namespace

bool CageReport::targetMet() const {
  const auto difference = static_cast<double>(tets) - static_cast<double>(targetTets);
  return std::abs(difference) <= cage_detail::kCountTolerance * static_cast<double>(targetTets);
}

std::string CageReport::describe() const {
  std::ostringstream text;
  const auto counted = [](std::size_t count, const char* one, const char* several) {
    return std::to_string(count) + " " + (count == 1 ? one : several);
  };
  text << counted(tets, "tet", "tets") << ", " << nodes << " nodes, spacing " << spacing;
  if (!targetMet()) text << " (" << targetTets << " tets were requested; no lattice comes closer)";
  text << "\n" << counted(verticesOutside, "vertex", "vertices") << " outside the cage\n";
  text << "dihedral angles " << minDihedralDegrees << " to " << maxDihedralDegrees << " degrees\n";
  text << counted(meshComponents, "component", "components") << " of the mesh, " << components << " of the cage";
  if (fusedComponents > 0) text << " (" << fusedComponents << " are fused with others, which are closer than a tet)";
  if (duplicateTets > 0)
    text << "; " << duplicateTets << " tets are duplicates, for components of the mesh closer than a tet";
  text << "\n";
  if (openEdges > 0) text << openEdges << " open edges; holes are closed implicitly, by the winding number\n";
  if (looseVertices > 0) text << looseVertices << " loose vertices, which no triangle uses, have their own tets\n";
  if (bridgingTets > 0)
    text << bridgingTets << " tets were added to join components that shared only a node or an edge\n";
  if (meshVolume > 0.0) {
    text << "volume " << volumeRatio << " times that of the mesh, " << volumeRatioUnfitted << " before fitting\n";
  } else {
    text << "the mesh is a sheet without volume; the volume of the cage is " << cageVolume << "\n";
  }
  text << milliseconds << " ms, " << latticesTried << " lattices tried\n";
  return text.str();
}

Result<Cage> createCage(const TriangleMesh& mesh, const CageOptions& options, CageReport* report) {
  const auto start = std::chrono::steady_clock::now();
  CageReport unread;
  CageReport& now = report ? *report : unread;
  now = {};
  Result<Cage> cage = build(mesh, options, now);
  now.milliseconds = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  assert(!cage.ok() || checkTetMesh(cage.value().mesh).clean());
  return cage;
}

}  // namespace tetskin
