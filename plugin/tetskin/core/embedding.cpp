// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// This work is based on:
//   Matthias Müller, "100 x Simulation Speedup with Mesh Embedding", Ten Minute Physics 12, 2022
#include <tetskin/core/embedding.h>
#include <tetskin/core/outside_neighbours.h>
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

/// Distance from what skinning at rest gives to the vertex itself, from its float weights.
double restError(const TetCorners& p, const Embedding& embedding, std::uint32_t slot, const Eigen::Vector3d& vertex) {
  const Eigen::Vector3d skinned = p[3] + embedding.weights(0)[slot] * (p[0] - p[3]) +
                                  embedding.weights(1)[slot] * (p[1] - p[3]) +
                                  embedding.weights(2)[slot] * (p[2] - p[3]);
  return (skinned - vertex).norm();
}

/// The extremes of a finished embedding, with the first vertex where there are several.
void measureFit(const TetMesh& cage, PointView<const double> vertices, const Embedding& embedding,
                EmbedReport& report) {
  report.worstBarycentric = -1.0;
  for (std::size_t r = 0; r + 1 < embedding.runs().size(); ++r) {
    const Embedding::Run& run = embedding.runs()[r];
    const TetCorners corners = cornersOf(cage, cage.tets[run.tet]);
    const BarycentricMap map(corners);
    for (std::uint32_t slot = run.firstSlot; slot < embedding.runs()[r + 1].firstSlot; ++slot) {
      const std::size_t v = embedding.slotVertices()[slot];
      const Eigen::Vector3d vertex(vertices[v][0], vertices[v][1], vertices[v][2]);
      const Eigen::Vector4d weights = map(vertex);
      const double error = restError(corners, embedding, slot, vertex);
      // Weights beyond float's range make the error infinite or NaN.
      report.restErrorMax = std::max(report.restErrorMax, std::isfinite(error) ? error : HUGE_VAL);
      report.worstBarycentric = std::max(report.worstBarycentric, barycentricDistance(weights));
      if (r < embedding.insideRunCount()) continue;
      const double distance = distanceToTet(vertex, corners, weights);
      if (distance < report.worstDistance || (distance == report.worstDistance && v > report.worstVertex)) continue;
      report.worstDistance = distance;
      report.worstVertex = v;
    }
  }
  const double* worst = vertices[report.worstVertex];
  report.worstPosition = {worst[0], worst[1], worst[2]};
  const double diagonal = report.meshBox.diagonal().norm();
  // One point, or all at one place: compare with the cage instead of dividing by nothing.
  report.restErrorMax /= diagonal > 0.0 ? diagonal : report.cageBox.diagonal().norm();
}

Status tooFar(const EmbedReport& report, double maxDistance) {
  char text[256];
  std::snprintf(
      text, sizeof text,
      "vertex %zu at (%.6g, %.6g, %.6g) lies %.4g outside the cage, more than the %.4g allowed; enlarge the cage "
      "or allow more",
      report.worstVertex, report.worstPosition.x(), report.worstPosition.y(), report.worstPosition.z(),
      report.worstDistance, maxDistance);
  return {StatusCode::OutsideCage, text};
}

/// triangles  of the mesh, or null if they are not known
Status embedVertices(const TetMesh& cage, PointView<const double> vertices,
                     const std::vector<std::array<int, 3>>* triangles, const EmbedOptions& options,
                     Embedding& embedding, EmbedReport& report) {
  if (Status status = checkInputs(cage, vertices, report); !status.ok()) return status;
  std::vector<std::uint32_t> placeOf;
  const std::vector<std::uint32_t> first = weldCoincident(vertices);
  const std::vector<Eigen::Vector3d> points = distinctPoints(vertices, first, placeOf);
  const std::vector<SearchTet> tets = searchTets(cage);
  const TetSearch search = findTets(tets, points, options.outside);

  std::vector<std::int32_t> tetOf(vertices.size());
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    const TetHit& hit = search.hits[placeOf[v]];
    tetOf[v] = hit.barycentric <= 0.0 ? tets[hit.tet].index : ~tets[hit.tet].index;
  }
  if (triangles && options.outside == OutsideRule::Nearest) {
    report.keptWithNeighbours = keepWithNeighbours(cage, vertices, first, *triangles, tetOf);
  }
  Embedding made = Embedding::fromTets(cage, vertices, tetOf);
  measureFit(cage, vertices, made, report);
  if (!std::isfinite(report.restErrorMax)) {
    return {StatusCode::Degenerate,
            "some vertices are so far from the cage that their weights overflow; are mesh and "
            "cage in the same unit?"};
  }
  if (report.worstDistance > options.maxDistance) return tooFar(report, options.maxDistance);
  report.inside = made.insideCount();
  report.outside = made.vertexCount() - made.insideCount();
  report.unbound = 0;
  report.coincident = vertices.size() - points.size();
  report.flatTets = cage.tetCount() - tets.size();
  report.overlapping = search.overlapping;
  report.candidates = search.candidates;
  embedding = std::move(made);
  return {};
}

EmbedReport embedTimed(const TetMesh& cage, PointView<const double> vertices,
                       const std::vector<std::array<int, 3>>* triangles, const EmbedOptions& options,
                       Embedding& embedding) {
  const auto start = std::chrono::steady_clock::now();
  EmbedReport report;
  report.status = embedVertices(cage, vertices, triangles, options, embedding, report);
  report.milliseconds = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  return report;
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
  std::snprintf(
      text, sizeof text,
      "%zu vertices: %zu inside, %zu outside the cage; the farthest, vertex %zu at (%.4g, %.4g, %.4g), by %.3g\n"
      "%zu coincident vertices, %zu vertices where the cage overlaps itself, %zu flat tets\n"
      "rest error %.2g box diagonals, %.1f candidates a vertex, %.2f ms\n",
      vertexCount, inside, outside, worstVertex, worstPosition.x(), worstPosition.y(), worstPosition.z(), worstDistance,
      coincident, overlapping, flatTets, restErrorMax,
      static_cast<double>(candidates) / static_cast<double>(vertexCount), milliseconds);
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
      const float b0 = weights_[0][slot], b1 = weights_[1][slot], b2 = weights_[2][slot];
      result[slotVertices_[slot]] = {
          static_cast<int>(runs_[r].tet), {b0, b1, b2, 1.0f - b0 - b1 - b2}, slot < insideCount_};
    }
  }
  return result;
}

Embedding Embedding::fromTets(const TetMesh& cage, PointView<const double> vertices,
                              const std::vector<std::int32_t>& tetOf) {
  assert(vertices.size() == tetOf.size());
  Embedding e;
  e.nodeCount_ = cage.nodeCount();
  e.tetCount_ = cage.tetCount();
  e.sortByTet(cage, tetOf);
  for (std::vector<float>& plane : e.weights_) plane.resize(vertices.size() + kPadding);
  for (std::vector<float>& plane : e.closestWeights_) plane.resize(vertices.size() - e.insideCount_ + kPadding);
  for (std::size_t r = 0; r + 1 < e.runs_.size(); ++r) {
    const TetCorners corners = cornersOf(cage, cage.tets[e.runs_[r].tet]);
    const BarycentricMap map(corners);
    for (std::uint32_t slot = e.runs_[r].firstSlot; slot < e.runs_[r + 1].firstSlot; ++slot) {
      const double* v = vertices[e.slotVertices_[slot]];
      const Eigen::Vector3d point(v[0], v[1], v[2]);
      const Eigen::Vector4d b = map(point);
      for (std::size_t k = 0; k < 3; ++k) e.weights_[k][slot] = static_cast<float>(b[static_cast<int>(k)]);
      if (slot < e.insideCount_) continue;
      const Eigen::Vector4d c = map(closestPointInTet(point, corners, b));
      for (std::size_t k = 0; k < 3; ++k) {
        const double clamped = std::min(std::max(c[static_cast<int>(k)], 0.0), 1.0);  // rounding is a hair off the face
        e.closestWeights_[k][slot - e.insideCount_] = static_cast<float>(clamped);
      }
    }
  }
  return e;
}

/// A counting sort with two bins a tet: the vertices inside, and after all of those the ones outside.
void Embedding::sortByTet(const TetMesh& cage, const std::vector<std::int32_t>& tetOf) {
  const std::size_t tets = cage.tetCount();
  const auto binOf = [&](std::int32_t tet) {
    const std::size_t bin = tet >= 0 ? static_cast<std::size_t>(tet) : tets + static_cast<std::size_t>(~tet);
    assert(bin < 2 * tets);
    return bin;
  };
  std::vector<std::uint32_t> next(2 * tets + 1, 0);
  for (const std::int32_t tet : tetOf) ++next[binOf(tet) + 1];
  for (std::size_t bin = 0; bin < 2 * tets; ++bin) {
    const auto tet = static_cast<std::uint32_t>(bin < tets ? bin : bin - tets);
    if (next[bin + 1] > 0) {
      const Tet& n = cage.tets[tet];
      runs_.push_back({{n[0], n[1], n[2], n[3]}, next[bin], tet});
    }
    next[bin + 1] += next[bin];
    if (bin + 1 != tets) continue;
    insideRunCount_ = runs_.size();
    insideCount_ = next[tets];
  }
  runs_.push_back({{}, static_cast<std::uint32_t>(tetOf.size()), static_cast<std::uint32_t>(tets)});

  slotVertices_.resize(tetOf.size());
  vertexSlots_.resize(tetOf.size());
  for (std::uint32_t v = 0; v < tetOf.size(); ++v) {
    vertexSlots_[v] = next[binOf(tetOf[v])]++;
    slotVertices_[vertexSlots_[v]] = v;
  }
}

EmbedReport embed(const TetMesh& cage, PointView<const double> vertices, const EmbedOptions& options,
                  Embedding& embedding) {
  return embedTimed(cage, vertices, nullptr, options, embedding);
}

EmbedReport embed(const TetMesh& cage, PointView<const float> vertices, const EmbedOptions& options,
                  Embedding& embedding) {
  std::vector<Eigen::Vector3d> copy(vertices.size());
  for (std::size_t v = 0; v < vertices.size(); ++v) copy[v] = {vertices[v][0], vertices[v][1], vertices[v][2]};
  return embed(cage, viewOf(std::as_const(copy)), options, embedding);
}

EmbedReport embed(const TetMesh& cage, const TriangleMesh& mesh, const EmbedOptions& options, Embedding& embedding) {
  EmbedReport report;
  report.vertexCount = report.unbound = mesh.vertexCount();
  report.status = checkTriangleMesh(mesh);
  if (!report.ok()) return report;
  return embedTimed(cage, viewOf(mesh.positions), &mesh.triangles, options, embedding);
}

}  // namespace tetskin
