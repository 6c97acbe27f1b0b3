// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// This work is based on:
//   Matthias Müller, "100 x Simulation Speedup with Mesh Embedding", Ten Minute Physics 12, 2022
#include <tetskin/core/embedding.h>
#include <tetskin/core/src/base/embedding/embedding_data.h>
#include <tetskin/core/src/base/instantiate.h>
#include <tetskin/core/src/base/mesh/mesh_checks.h>
#include <tetskin/core/src/base/mesh/tet_geometry.h>
#include <tetskin/core/src/base/mesh/used_vertices.h>
#include <tetskin/core/src/base/mesh/weld.h>
#include <tetskin/core/src/embedding/mapped_vertices.h>
#include <tetskin/core/src/search/outside_neighbours.h>
#include <tetskin/core/src/search/search_cage.h>
#include <tetskin/core/src/search/tet_search.h>
#include <tetskin/core/src/search/tolerances.h>

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cstdio>

namespace tetskin {
namespace {

using Triangles = std::vector<std::array<int, 3>>;

/// Names the first point beyond Limits::kMaxCoordinate; there must be one.
Status tooLarge(const char* point, const char* owner, PointReader points) {
  std::size_t p = 0;
  while (points[p].lpNorm<Eigen::Infinity>() <= Limits::kMaxCoordinate) ++p;
  char text[160];
  std::snprintf(text, sizeof text,
                "%s %zu of the %s has a coordinate beyond %g, the largest that is supported; is the file damaged?",
                point, p, owner, Limits::kMaxCoordinate);
  return {StatusCode::NonFinite, text};
}

/// All checks that are possible before the search. Also computes the boxes, so that they are reported even for a mesh
/// that fails.
Status checkInputs(const TetMesh& cage, PointReader vertices, const EmbedOptions& options, EmbedReport& report) {
  report.vertexCount = report.unbound = vertices.size();
  if (!(options.maxDistance >= 0.0)) {
    return {StatusCode::InvalidOption, "maxDistance is " + std::to_string(options.maxDistance) +
                                           "; it must be 0 or more (infinity allows any distance)"};
  }
  if (vertices.empty()) return {StatusCode::Empty, "the mesh has no vertices"};
  if (vertices.size() >= 0xFFFFFFFFu) return {StatusCode::SizeMismatch, "the mesh has more than 2^32 - 2 vertices"};
  Box3 meshBox;
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    const Eigen::Vector3d vertex = vertices[v];
    if (!vertex.allFinite()) {
      return {StatusCode::NonFinite,
              "vertex " + std::to_string(v) + " of the mesh has a coordinate that is not finite"};
    }
    meshBox.extend(vertex);
  }
  if (Status cageStatus = validate(cage); !cageStatus.ok()) return cageStatus;
  report.meshBox = meshBox;
  report.cageBox = boundingBox(cage.nodes);
  if (maxCoordinate(meshBox) > Limits::kMaxCoordinate) return tooLarge("vertex", "mesh", vertices);
  if (maxCoordinate(report.cageBox) > Limits::kMaxCoordinate) return tooLarge("node", "cage", viewOf(cage.nodes));
  return {};
}

void reportFit(const EmbeddingFit& fit, EmbedReport& report) {
  report.maxWeight = fit.largestWeight;
  report.maxBarycentricDistance = fit.worstBarycentric;
  const double diagonal = report.meshBox.diagonal().norm(), restError = std::sqrt(fit.restErrorSquared);
  // If all points have one position, the error is relative to the cage: the mesh's own diagonal is 0.
  report.restErrorMax = restError / (diagonal > 0.0 ? diagonal : report.cageBox.diagonal().norm());
}

Status tooFar(const EmbedReport& report, double maxDistance) {
  char text[256];
  std::snprintf(
      text, sizeof text,
      "vertex %zu at (%.6g, %.6g, %.6g) lies %.4g outside the cage, more than the maximum of %.4g; enlarge the cage "
      "or allow a larger distance",
      report.maxDistanceVertex, report.maxDistancePosition.x(), report.maxDistancePosition.y(),
      report.maxDistancePosition.z(), report.maxDistance, maxDistance);
  return {StatusCode::OutsideCage, text};
}

/// The tet of every vertex, in the convention of `embeddingFromTets`, and the search's entries of the report.
/// triangles  of the mesh, or null if unknown
std::vector<std::int32_t> tetsOf(const TetMesh& mesh, PointReader vertices, const Triangles* triangles,
                                 OutsideRule rule, EmbedReport& report) {
  const std::vector<std::uint32_t> first = weldCoincident(vertices);
  const SearchCage cage(mesh);
  TetSearch search = findTets(cage, vertices, first, rule);
  for (std::size_t v = 0; v < vertices.size(); ++v) report.coincident += first[v] != v;
  report.flatTets = mesh.tetCount() - cage.size();
  report.overlapping = search.overlapping;
  report.candidates = search.candidates;
  report.reassignedByWeight =
      static_cast<std::size_t>(std::count(search.reassigned.begin(), search.reassigned.end(), true));
  report.maxDistance = search.farthestDistance;
  report.maxDistanceVertex = search.farthest;
  report.maxDistancePosition = vertices[search.farthest];
  if (triangles && rule == OutsideRule::Nearest) {
    report.reassignedByConnectivity =
        reassignByConnectivity(mesh, vertices, first, *triangles, search.reassigned, search.tetOf);
  }
  return std::move(search.tetOf);
}

/// The embedding of vertices whose tets are known.
Result<Embedding> embedIn(const TetMesh& cage, PointReader vertices, const std::vector<std::int32_t>& tetOf,
                          const EmbedOptions& options, EmbedReport& report) {
  assert(tetOf.size() == vertices.size() && tetOf.size() == report.vertexCount);
  EmbeddingFit fit;
  Embedding made = embeddingFromTets(cage, vertices, tetOf, &fit);
  reportFit(fit, report);
  if (!std::isfinite(report.restErrorMax) || !(report.maxBarycentricDistance <= Limits::kMaxBarycentric)) {
    return Status{StatusCode::Degenerate,
                  "some vertices are so far from their tet, in relation to its size, that weighted sums would "
                  "overflow; are mesh and cage in the same unit?"};
  }
  if (report.maxDistance > options.maxDistance) return tooFar(report, options.maxDistance);
  report.inside = made.insideCount();
  report.outside = made.vertexCount() - made.insideCount();
  report.unbound = 0;
  return made;
}

Result<Embedding> embedVertices(const TetMesh& cage, PointReader vertices, const EmbedOptions& options,
                                EmbedReport& report) {
  if (Status status = checkInputs(cage, vertices, options, report); !status.ok()) return status;
  return embedIn(cage, vertices, tetsOf(cage, vertices, nullptr, options.outside, report), options, report);
}

Result<Embedding> embedMesh(const Cage& cage, const TriangleMesh& mesh, const EmbedOptions& options,
                            EmbedReport& report) {
  const PointReader vertices = viewOf(mesh.positions);
  if (Status status = checkInputs(cage.mesh, vertices, options, report); !status.ok()) return status;
  report.meshBox = surfaceBox(mesh);
  if (cage.vertexTets.empty()) {
    return embedIn(cage.mesh, vertices, tetsOf(cage.mesh, vertices, &mesh.triangles, options.outside, report), options,
                   report);
  }
  const auto tetOf = mappedTets(cage, mesh, report);
  if (!tetOf.ok()) return tetOf.status();
  return embedIn(cage.mesh, vertices, tetOf.value(), options, report);
}

/// make  creates the embedding, and writes the report
template <class Make>
Result<Embedding> timed(EmbedReport* report, Make&& make) {
  const auto start = std::chrono::steady_clock::now();
  EmbedReport unread;
  EmbedReport& now = report ? *report : unread;
  now = {};
  Result<Embedding> made = make(now);
  now.milliseconds = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  return made;
}

/// Reads the weights of a slot: three are stored, and the fourth is 1 minus their sum.
template <class Scalar>
std::array<Scalar, 4> weightsAt(const std::array<std::vector<float>, 3>& planes, std::size_t index) {
  const Scalar a = planes[0][index], b = planes[1][index], c = planes[2][index];
  return {a, b, c, 1 - a - b - c};
}

}  // namespace

bool EmbedReport::unitsDiffer() const {
  if (meshBox.isEmpty() || cageBox.isEmpty()) return false;
  const double mesh = meshBox.diagonal().norm(), cage = cageBox.diagonal().norm();
  return !meshBox.intersects(cageBox) ||
         (mesh > 0.0 && (mesh > Limits::kMaxUnitRatio * cage || cage > Limits::kMaxUnitRatio * mesh));
}

std::string EmbedReport::unitsMessage() const {
  if (!unitsDiffer()) return {};
  char text[160];
  std::snprintf(
      text, sizeof text, "their bounding boxes have diagonals of %.4g and %.4g and %s; are they in different units?",
      meshBox.diagonal().norm(), cageBox.diagonal().norm(), meshBox.intersects(cageBox) ? "overlap" : "do not overlap");
  return text;
}

std::string EmbedReport::describe() const {
  if (unbound > 0) return "none of " + std::to_string(vertexCount) + " vertices is embedded\n";
  char text[512];
  std::snprintf(text, sizeof text, "%zu vertices: %zu inside, %zu outside the cage", vertexCount, inside, outside);
  std::string result = text;
  if (outside > 0) {
    std::snprintf(text, sizeof text, "; the farthest is vertex %zu at (%.4g, %.4g, %.4g), at a distance of %.3g",
                  maxDistanceVertex, maxDistancePosition.x(), maxDistancePosition.y(), maxDistancePosition.z(),
                  maxDistance);
    result += text;
  }
  std::snprintf(text, sizeof text,
                "\n%zu coincident vertices, %zu vertices where the cage overlaps itself, %zu flat tets\n"
                "rest error %.2g of the bounding box's diagonal, %.1f candidates per vertex, %.2f ms\n",
                coincident, overlapping, flatTets, restErrorMax,
                static_cast<double>(candidates) / static_cast<double>(vertexCount), milliseconds);
  result += text;
  if (reassignedByConnectivity > 0) {
    std::snprintf(
        text, sizeof text,
        "%zu vertices outside the cage were reassigned by connectivity: another component of the cage was closer than "
        "their own\n",
        reassignedByConnectivity);
    result += text;
  }
  if (reassignedByWeight > 0 || maxWeight > kMaxWeight) {
    std::snprintf(text, sizeof text,
                  "%zu vertices outside the cage were reassigned by weight: their nearest tet would extrapolate them "
                  "by more than %g "
                  "times its size; largest "
                  "weight %.3g\n",
                  reassignedByWeight, kMaxWeight, maxWeight);
    result += text;
  }
  if (overlapping > 0)
    result += "where a cage with duplicate elements overlaps itself, only a Cage with its map distinguishes them\n";
  if (unitsDiffer()) result += "mesh and cage do not match: " + unitsMessage() + "\n";
  return result;
}

Embedding::Embedding() {
  static const EmbeddingData empty;
  data_ = {std::shared_ptr<const EmbeddingData>(), &empty};  // with no owner
}

Embedding::Embedding(std::shared_ptr<const EmbeddingData> data) : data_(std::move(data)) {
  assert(data_);
}

std::size_t Embedding::insideCount() const {
  return data_->insideCount;
}
std::size_t Embedding::nodeCount() const {
  return data_->nodeCount;
}
std::size_t Embedding::tetCount() const {
  return data_->tetCount;
}
const std::vector<std::uint32_t>& Embedding::slotVertices() const {
  return data_->slotVertices;
}
const std::vector<std::uint32_t>& Embedding::vertexSlots() const {
  return data_->vertexSlots;
}

std::vector<VertexBinding> Embedding::bindings() const {
  std::vector<VertexBinding> result(vertexCount());
  assert(data_->vertexSlots.size() == data_->slotVertices.size());
  const EmbeddingData& d = *data_;
  for (std::size_t r = 0; r + 1 < d.runs.size(); ++r) {
    for (std::uint32_t slot = d.runs[r].firstSlot; slot < d.runs[r + 1].firstSlot; ++slot) {
      result[d.slotVertices[slot]] = {static_cast<int>(d.runs[r].tet), weightsAt<float>(d.weights, slot),
                                      slot < d.insideCount};
    }
  }
  return result;
}

template <class Scalar>
EmbeddedPoint<Scalar> Embedding::at(std::size_t vertex) const {
  const EmbeddingData& d = *data_;
  assert(vertex < d.vertexCount());
  const std::uint32_t slot = d.vertexSlots[vertex];
  const auto next = std::upper_bound(d.runs.begin(), d.runs.end(), slot,
                                     [](std::uint32_t s, const EmbeddingData::Run& run) { return s < run.firstSlot; });
  const EmbeddingData::Run& run = *std::prev(next);
  assert(slot >= run.firstSlot && run.tet < d.tetCount);
  EmbeddedPoint<Scalar> point;
  point.tet = static_cast<int>(run.tet);
  std::copy_n(run.nodes, 4, point.nodes.begin());
  point.inside = slot < d.insideCount;
  point.weights = weightsAt<Scalar>(d.weights, slot);
  point.clampedWeights = point.inside ? point.weights : weightsAt<Scalar>(d.closestWeights, slot - d.insideCount);
  for (Scalar& weight : point.clampedWeights) weight = std::max(weight, Scalar(0));  // below 0 because of rounding
  return point;
}

#define TETSKIN_INSTANTIATE(Scalar) \
  template TETSKIN_CORE_API EmbeddedPoint<Scalar> Embedding::at<Scalar>(std::size_t) const;
TETSKIN_FOR_SCALARS(TETSKIN_INSTANTIATE)
#undef TETSKIN_INSTANTIATE

Result<Embedding> embed(const TetMesh& cage, PointView<const double> vertices, const EmbedOptions& options,
                        EmbedReport* report) {
  return timed(report, [&](EmbedReport& now) { return embedVertices(cage, vertices, options, now); });
}

Result<Embedding> embed(const TetMesh& cage, PointView<const float> vertices, const EmbedOptions& options,
                        EmbedReport* report) {
  return timed(report, [&](EmbedReport& now) { return embedVertices(cage, vertices, options, now); });
}

Result<Embedding> embed(const Cage& cage, const TriangleMesh& mesh, const EmbedOptions& options, EmbedReport* report) {
  if (Status status = validate(mesh); !status.ok()) {
    if (report) *report = notEmbedded(mesh);
    return status;
  }
  return timed(report, [&](EmbedReport& now) { return embedMesh(cage, mesh, options, now); });
}

}  // namespace tetskin
