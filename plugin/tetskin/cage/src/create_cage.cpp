// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// From any triangle mesh to a cage for it: the tets of a body-centred cubic lattice that touch the surface or lie
// inside. The mesh need not be watertight, welded, consistently oriented or free of intersections.
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
//   paintCage        maps of the vertices, spread inside                    painted_maps
//   embed            vertices that no triangle uses, in what was built for the others
#include <tetskin/cage/create_cage.h>
#include <tetskin/cage/src/fill/cage_fill.h>
#include <tetskin/cage/src/fill/painted_maps.h>
#include <tetskin/cage/src/fit/cage_binding.h>
#include <tetskin/cage/src/fit/cage_fit.h>
#include <tetskin/cage/src/fit/cage_quality.h>
#include <tetskin/cage/src/lattice/lattice_search.h>
#include <tetskin/cage/src/surface/surface.h>
#include <tetskin/core/embedding.h>
#include <tetskin/core/src/base/progress.h>

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
/// Number of other origins to try if a vertex falls so exactly on a lattice plane that rounding puts it outside of all
/// tets.
constexpr std::size_t kAttempts = 4;
/// Distance in the sequence of origins between two attempts: more than one search uses.
constexpr std::size_t kOriginsPerAttempt = 100;
/// Largest number of searches for the tet count if splitting changes it, and the deviation at which they end.
constexpr int kSizeRounds = 4;
constexpr double kSizeTolerance = 0.07;
/// Distance, in half cubes, of the points on large triangles that fitting must keep inside: with this, several lie on
/// each face of a cube, while meshes finer than the lattice get none.
constexpr double kHoldStep = 0.5;
/// Loose vertices farther from the cage's centre than this, in diagonals of its box, get the tet nearest to the point
/// in their direction at this distance: the result is the same within a hundredth of their distance, and no coordinate
/// is too large for the search.
constexpr double kLooseReach = 100.0;

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
  return cage_detail::checkMaps(mesh, {options.stiffness, options.density, options.damping});
}

Status notDivisible(const Surface& surface) {
  std::ostringstream text;
  text << "the vertices lie between (" << surface.box.min().transpose() << ") and (" << surface.box.max().transpose()
       << "), too far apart to divide into tets in double precision; move the mesh to the origin, scale it, or remove "
          "vertices that are far from all others";
  return {StatusCode::Degenerate, text.str()};
}

Status checkExtent(const Surface& surface) {
  if (surface.triangles.empty()) {
    return {StatusCode::Degenerate,
            "the corners of each triangle of the mesh are at the same point; a cage needs a mesh that has an extent"};
  }
  const double size = surface.box.sizes().maxCoeff();
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

/// Approximate fractions of the time at which stages end: those of 3,000 tets for 60,000 triangles.
constexpr double kSurfaceDone = 0.1, kLatticesDone = 0.8, kFitDone = 0.95;
/// Share of the remaining progress given to each lattice: the number of lattices is not known.
constexpr double kLatticeShare = 0.5;

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
                         std::size_t firstOrigin, Progress& progress, double& told) {
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
    told += kLatticeShare * (kLatticesDone - told);
    if (!progress.reach(told) || whole || miss(best) <= kSizeTolerance) break;
    wanted /= grown;
  }
  best.cage.lattices = lattices;
  return best;
}

/// The first cage that contains all vertices; otherwise the one with the fewest outside.
BoundCage firstEnclosingCage(const Surface& surface, const WindingTree& winding, const CageOptions& options,
                             Progress& progress) {
  BoundCage best;
  double told = kSurfaceDone;
  for (std::size_t i = 0; i < kAttempts; ++i) {
    BoundCage bound = bindCageOfSize(surface, winding, options, i * kOriginsPerAttempt, progress, told);
    if (i == 0 || bound.outside < best.outside) best = std::move(bound);
    if (best.outside == 0 || progress.cancelled()) break;
  }
  return best;
}

void reportSurface(const Surface& surface, CageReport& report) {
  report.meshComponents = surface.components;
  report.looseVertices = surface.looseVertices;
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
  report.fusedComponents = report.meshComponents - std::min(report.meshComponents, report.components);
  report.cageVolume = totalVolume(cage);
  if (!(report.meshVolume > 0.0)) return;
  report.volumeRatio = report.cageVolume / report.meshVolume;
  report.volumeRatioUnfitted = report.cageVolumeUnfitted / report.meshVolume;
}

/// The nearest tet of each loose vertex, in order.
std::vector<int> tetsOfLoose(const TriangleMesh& mesh, const Surface& surface, const TetMesh& cage) {
  std::vector<Eigen::Vector3d> loose;
  const Box3 box = boundingBox(cage.nodes);
  const double reach = kLooseReach * box.diagonal().norm();
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
    if (surface.pointOf[v] >= 0) continue;
    const Eigen::Vector3d way = mesh.positions[v] - box.center();
    loose.push_back(box.center() + std::min(1.0, reach / way.norm()) * way);
  }
  assert(loose.size() == surface.looseVertices);
  std::vector<int> tets(loose.size(), 0);
  if (loose.empty()) return tets;
  const Result<Embedding> embedded = embed(cage, viewOf(std::as_const(loose)));
  if (!embedded.ok()) return tets;  // the cage is too large to embed anything in it
  const std::vector<VertexBinding> bindings = embedded.value().bindings();
  std::transform(bindings.begin(), bindings.end(), tets.begin(), [](const VertexBinding& b) { return b.tet; });
  return tets;
}

/// By vertex: its tet. Empty if rounding has left a vertex outside of all tets: `embed` then finds the nearest tet.
std::vector<int> vertexTets(const TriangleMesh& mesh, const Surface& surface, const BoundCage& bound) {
  std::vector<int> tets;
  const std::vector<int> loose = tetsOfLoose(mesh, surface, bound.tets.mesh);
  auto next = loose.begin();
  for (const int point : surface.pointOf) tets.push_back(point < 0 ? *next++ : bound.tets.tetOf[point]);
  if (std::count(tets.begin(), tets.end(), -1) > 0) tets.clear();
  return tets;
}

Cage cageOf(const TriangleMesh& mesh, const Surface& surface, BoundCage bound) {
  assert(bound.tets.tetOf.size() >= surface.points.size() && surface.pointOf.size() == mesh.vertexCount());
  Cage cage(bound.tets.mesh);
  // For a sheet, or if inside and outside cannot be distinguished, the whole tet counts as material.
  const bool solid = surface.oriented && surface.volume > 0.0;
  if (solid) {
    cage_detail::CageFill fill = cage_detail::fillOf(bound.tets, bound.cage.frame, bound.cage.set, bound.lattice);
    cage.volumeFraction = std::move(fill.fill);
    cage.fineVolumeFraction = std::move(fill.fine);
  }
  cage.masses =
      cage_detail::nodeMasses(cage.mesh, cage.volumeFraction, solid ? surface.volume : totalVolume(cage.mesh));
  cage.vertexTets = vertexTets(mesh, surface, bound);
  cage.sourceTet = std::move(bound.tets.latticeTets);
  cage.component = cage_detail::componentNumbers(cage.mesh);
  cage.meshHash = positionsHash(mesh.positions);
  return cage;
}

/// The build itself: everything in the report except for the time.
Result<Cage> build(const TriangleMesh& mesh, const CageOptions& options, CageReport& report) try {
  report.targetTets = options.targetTets;
  if (Status status = checkInput(mesh, options); !status.ok()) return status;
  Progress progress(options.progress);
  const auto cancelled = [] { return cancelledStatus("createCage"); };
  if (!progress.reach(0.0)) return cancelled();
  const Surface surface = cage_detail::prepareSurface(mesh);
  if (Status status = checkExtent(surface); !status.ok()) return status;
  reportSurface(surface, report);

  const WindingTree winding = windingTreeOf(surface);
  if (!progress.reach(kSurfaceDone)) return cancelled();
  BoundCage bound = firstEnclosingCage(surface, winding, options, progress);
  if (progress.cancelled()) return cancelled();
  assert(!bound.tets.mesh.tets.empty());
  reportLattice(bound, report);
  if (options.fit) cage_detail::fitCage(bound.tets, bound.cage.frame.half, bound.samples.points);
  if (!progress.reach(kFitDone)) return cancelled();
  reportCage(bound.tets.mesh, report);
  report.verticesOutside =
      cage_detail::countOutside(surface.points, surface.points.size(), bound.tets.mesh, bound.tets.tetOf);
  Cage cage = cageOf(mesh, surface, std::move(bound));
  if (Status status = paintCage(cage, mesh, {options.stiffness, options.density, options.damping}); !status.ok())
    return status;
  if (!progress.reach(1.0)) return cancelled();
  return cage;
} catch (const Cancellation&) {
  return cancelledStatus("createCage");
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
  text << "\n" << counted(verticesOutside, "vertex", "vertices") << " of triangles outside the cage\n";
  text << "dihedral angles " << minDihedralDegrees << " to " << maxDihedralDegrees << " degrees\n";
  text << counted(meshComponents, "component", "components") << " of the mesh, " << components << " of the cage";
  if (fusedComponents > 0) text << " (" << fusedComponents << " are fused with others, which are closer than a tet)";
  if (duplicateTets > 0)
    text << "; " << duplicateTets << " tets are duplicates, for components of the mesh closer than a tet";
  text << "\n";
  if (openEdges > 0) text << openEdges << " open edges; holes are closed implicitly, by the winding number\n";
  if (looseVertices > 0) {
    text << counted(looseVertices, "vertex shapes", "vertices shape")
         << " no cage, as no triangle uses them; the nearest tet carries them\n";
  }
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
