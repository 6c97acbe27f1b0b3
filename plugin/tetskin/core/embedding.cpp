// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// This work is based on:
//   Matthias Müller, "100 x Simulation Speedup with Mesh Embedding", Ten Minute Physics 12, 2022
#include <tetskin/core/embedding.h>
#include <tetskin/core/tet_search.h>
#include <tetskin/core/weld.h>

#include <chrono>
#include <cstdio>

namespace tetskin {
namespace {

/// Coordinates beyond this are refused: their squares, which distances need, must stay well inside a double.
constexpr double kLargestCoordinate = 1e30;

std::vector<Eigen::Vector3d> distinctPoints(PointView<const double> vertices, const std::vector<std::uint32_t>& first,
                                            std::vector<std::uint32_t>& placeOf) {
  std::vector<Eigen::Vector3d> points;
  placeOf.resize(vertices.size());
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    if (first[v] == v) {
      placeOf[v] = static_cast<std::uint32_t>(points.size());
      points.emplace_back(vertices[v][0], vertices[v][1], vertices[v][2]);
    } else {
      placeOf[v] = placeOf[first[v]];
    }
  }
  return points;
}

VertexBinding bindingOf(const SearchTet& tet, const TetHit& hit, const Eigen::Vector3d& point) {
  const Eigen::Vector4d b = tet.map(point);
  const std::array<float, 3> w{static_cast<float>(b[0]), static_cast<float>(b[1]), static_cast<float>(b[2])};
  return {tet.index, {w[0], w[1], w[2], 1.0f - w[0] - w[1] - w[2]}, hit.barycentric <= 0.0};
}

double restError(const SearchTet& tet, const VertexBinding& binding, const Eigen::Vector3d& point) {
  const TetCorners& p = tet.corners;
  const Eigen::Vector3d skinned = p[3] + binding.weights[0] * (p[0] - p[3]) + binding.weights[1] * (p[1] - p[3]) +
                                  binding.weights[2] * (p[2] - p[3]);
  return (skinned - point).norm();
}

/// Everything that can be known before the search. Boxes too, so that they are reported even for a mesh that fails.
Status checkInputs(const TetMesh& cage, PointView<const double> vertices, EmbedReport& report) {
  report.vertexCount = report.unbound = vertices.size();
  if (vertices.empty()) return {StatusCode::Empty, "the mesh has no vertices"};
  if (vertices.size() >= 0xFFFFFFFFu) return {StatusCode::SizeMismatch, "the mesh has more than 2^32 - 2 vertices"};
  const std::size_t bad = firstNonFinite(vertices);
  if (bad < vertices.size()) {
    return {StatusCode::NonFinite,
            "vertex " + std::to_string(bad) + " of the mesh has a coordinate that is not finite"};
  }
  if (Status cageStatus = usable(cage, checkTetMesh(cage)); !cageStatus.ok()) return cageStatus;
  report.meshBox = boundingBox(vertices);
  report.cageBox = boundingBox(cage.nodes);
  const Box3 both = report.meshBox.merged(report.cageBox);
  if (std::max(both.max().maxCoeff(), -both.min().minCoeff()) > kLargestCoordinate) {
    return {StatusCode::NonFinite, "mesh or cage has coordinates beyond 1e30; is the file damaged?"};
  }
  return {};
}

/// Binds every distinct point and collects the fit's extremes. Vertex v is the point placeOf[v].
std::vector<VertexBinding> bindPoints(const std::vector<SearchTet>& tets, const std::vector<Eigen::Vector3d>& points,
                                      const TetSearch& search, EmbedReport& report, std::size_t& worstPoint) {
  std::vector<VertexBinding> bindings(points.size());
  report.worstBarycentric = search.hits.front().barycentric;
  worstPoint = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const TetHit& hit = search.hits[i];
    bindings[i] = bindingOf(tets[hit.tet], hit, points[i]);
    const double error = restError(tets[hit.tet], bindings[i], points[i]);
    // Weights beyond float's range make the error infinite or NaN.
    report.restErrorMax = std::max(report.restErrorMax, std::isfinite(error) ? error : HUGE_VAL);
    report.worstBarycentric = std::max(report.worstBarycentric, hit.barycentric);
    if (hit.distance > report.worstDistance) {
      report.worstDistance = hit.distance;
      worstPoint = i;
    }
  }
  const double diagonal = report.meshBox.diagonal().norm();
  // One point, or all at one place: compare with the cage instead of dividing by nothing.
  report.restErrorMax /= diagonal > 0.0 ? diagonal : report.cageBox.diagonal().norm();
  return bindings;
}

Status embedVertices(const TetMesh& cage, PointView<const double> vertices, const EmbedOptions& options,
                     Embedding& embedding, EmbedReport& report) {
  if (Status status = checkInputs(cage, vertices, report); !status.ok()) return status;
  std::vector<std::uint32_t> placeOf;
  const std::vector<Eigen::Vector3d> points = distinctPoints(vertices, weldCoincident(vertices), placeOf);
  const std::vector<SearchTet> tets = searchTets(cage);
  const TetSearch search = findTets(tets, points, options.outside);

  std::size_t worstPoint = 0;
  const std::vector<VertexBinding> ofPoint = bindPoints(tets, points, search, report, worstPoint);
  if (!std::isfinite(report.restErrorMax)) {
    return {StatusCode::Degenerate,
            "some vertices are so far from the cage that their weights overflow; are mesh and "
            "cage in the same unit?"};
  }
  std::vector<VertexBinding> bindings(vertices.size());
  report.worstVertex = vertices.size();
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    bindings[v] = ofPoint[placeOf[v]];
    ++(bindings[v].inside ? report.inside : report.outside);
    if (placeOf[v] == worstPoint) report.worstVertex = std::min(report.worstVertex, v);
  }
  report.unbound = 0;
  report.coincident = vertices.size() - points.size();
  report.flatTets = cage.tetCount() - tets.size();
  report.overlapping = search.overlapping;
  report.candidates = search.candidates;
  embedding = Embedding::fromBindings(bindings, cage);
  return {};
}

}  // namespace

bool EmbedReport::unitsDiffer() const {
  if (meshBox.isEmpty() || cageBox.isEmpty()) return false;
  const double mesh = meshBox.diagonal().norm(), cage = cageBox.diagonal().norm();
  return !meshBox.intersects(cageBox) || (mesh > 0.0 && (mesh > kUnitRatio * cage || cage > kUnitRatio * mesh));
}

std::string EmbedReport::describe() const {
  if (!ok()) return status.message;
  char text[512];
  std::snprintf(text, sizeof text,
                "%zu vertices: %zu inside, %zu outside the cage; the farthest, vertex %zu, by %.3g\n"
                "%zu coincident vertices, %zu vertices where the cage overlaps itself, %zu flat tets\n"
                "rest error %.2g box diagonals, %.1f candidates a vertex, %.2f ms\n",
                vertexCount, inside, outside, worstVertex, worstDistance, coincident, overlapping, flatTets,
                restErrorMax, static_cast<double>(candidates) / static_cast<double>(vertexCount), milliseconds);
  std::string result = text;
  if (unitsDiffer()) {
    std::snprintf(text, sizeof text,
                  "mesh and cage do not fit: their boxes have diagonals of %.4g and %.4g and %s; different units?\n",
                  meshBox.diagonal().norm(), cageBox.diagonal().norm(),
                  meshBox.intersects(cageBox) ? "overlap" : "lie apart");
    result += text;
  }
  return result;
}

std::vector<VertexBinding> Embedding::bindings() const {
  std::vector<VertexBinding> result(vertexCount());
  for (std::size_t r = 0; r + 1 < runs_.size(); ++r) {
    for (std::uint32_t slot = runs_[r].firstSlot; slot < runs_[r + 1].firstSlot; ++slot) {
      const Weights& w = slotWeights_[slot];
      result[slotVertices_[slot]] = {
          static_cast<int>(runs_[r].tet), {w[0], w[1], w[2], 1.0f - w[0] - w[1] - w[2]}, true};
    }
  }
  for (const std::uint32_t slot : outsideSlots_) result[slotVertices_[slot]].inside = false;
  return result;
}

Embedding Embedding::fromBindings(const std::vector<VertexBinding>& bindings, const TetMesh& cage) {
  Embedding e;
  e.nodeCount_ = cage.nodeCount();
  e.tetCount_ = cage.tetCount();
  std::vector<std::uint32_t> nextSlot(cage.tetCount() + 1, 0);
  for (const VertexBinding& b : bindings) {
    assert(b.tet >= 0 && static_cast<std::size_t>(b.tet) < cage.tetCount());
    ++nextSlot[b.tet + 1];
  }
  for (std::size_t t = 0; t < cage.tetCount(); ++t) {
    if (nextSlot[t + 1] > 0) e.runs_.push_back({cage.tets[t], nextSlot[t], static_cast<std::uint32_t>(t)});
    nextSlot[t + 1] += nextSlot[t];
  }
  e.runs_.push_back({{}, static_cast<std::uint32_t>(bindings.size()), static_cast<std::uint32_t>(cage.tetCount())});

  e.slotWeights_.resize(bindings.size());
  e.slotVertices_.resize(bindings.size());
  std::vector<char> outside(bindings.size(), 0);
  for (std::uint32_t v = 0; v < bindings.size(); ++v) {
    const VertexBinding& b = bindings[v];
    const std::uint32_t slot = nextSlot[b.tet]++;
    e.slotWeights_[slot] = {b.weights[0], b.weights[1], b.weights[2]};
    e.slotVertices_[slot] = v;
    outside[slot] = !b.inside;
  }
  for (std::uint32_t slot = 0; slot < bindings.size(); ++slot) {
    if (outside[slot]) e.outsideSlots_.push_back(slot);
  }
  return e;
}

EmbedReport embed(const TetMesh& cage, PointView<const double> vertices, const EmbedOptions& options,
                  Embedding& embedding) {
  const auto start = std::chrono::steady_clock::now();
  EmbedReport report;
  report.status = embedVertices(cage, vertices, options, embedding, report);
  report.milliseconds = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  return report;
}

EmbedReport embed(const TetMesh& cage, PointView<const float> vertices, const EmbedOptions& options,
                  Embedding& embedding) {
  std::vector<Eigen::Vector3d> copy(vertices.size());
  for (std::size_t v = 0; v < vertices.size(); ++v) copy[v] = {vertices[v][0], vertices[v][1], vertices[v][2]};
  return embed(cage, viewOf(std::as_const(copy)), options, embedding);
}

}  // namespace tetskin
