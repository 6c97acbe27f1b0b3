// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// This work is based on:
//   Matthias Müller, "100 x Simulation Speedup with Mesh Embedding", Ten Minute Physics 12, 2022
#include <tetskin/core/embedding.h>
#include <tetskin/core/src/mesh/tet_geometry.h>
#include <tetskin/core/src/mesh/weld.h>
#include <tetskin/core/src/search/outside_neighbours.h>
#include <tetskin/core/src/search/search_cage.h>
#include <tetskin/core/src/search/tet_search.h>

#include <chrono>
#include <cstdio>

namespace tetskin {
namespace {

using Triangles = std::vector<std::array<int, 3>>;

/// Names the first point beyond kLargestCoordinate; there must be one.
Status tooLarge(const char* point, const char* owner, PointReader points) {
  std::size_t p = 0;
  while (points[p].lpNorm<Eigen::Infinity>() <= kLargestCoordinate) ++p;
  char text[160];
  std::snprintf(text, sizeof text,
                "%s %zu of the %s has a coordinate beyond %g, the largest that is possible; is the file damaged?",
                point, p, owner, kLargestCoordinate);
  return {StatusCode::NonFinite, text};
}

/// Everything that can be known before the search. Boxes too, so that they are reported even for a mesh that fails.
Status checkInputs(const TetMesh& cage, PointReader vertices, const EmbedOptions& options, EmbedReport& report) {
  report.vertexCount = report.unbound = vertices.size();
  if (!(options.maxDistance >= 0.0)) {
    return {StatusCode::InvalidOption, "maxDistance is " + std::to_string(options.maxDistance) +
                                           "; it must be 0 or more (infinity: any distance)"};
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
  if (Status cageStatus = usable(cage, checkForUse(cage)); !cageStatus.ok()) return cageStatus;
  report.meshBox = meshBox;
  report.cageBox = boundingBox(cage.nodes);
  if (largestCoordinate(meshBox) > kLargestCoordinate) return tooLarge("vertex", "mesh", vertices);
  if (largestCoordinate(report.cageBox) > kLargestCoordinate) return tooLarge("node", "cage", viewOf(cage.nodes));
  return {};
}

void reportFit(const Embedding::Fit& fit, EmbedReport& report) {
  report.largestWeight = fit.largestWeight;
  report.worstBarycentric = fit.worstBarycentric;
  const double diagonal = report.meshBox.diagonal().norm(), restError = std::sqrt(fit.restErrorSquared);
  // One point, or all at one place: compare with the cage instead of dividing by nothing.
  report.restErrorMax = restError / (diagonal > 0.0 ? diagonal : report.cageBox.diagonal().norm());
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

/// The tet of every vertex, by `fromTets`' convention; with what the search has to report.
/// triangles  of the mesh, or null if they are not known
std::vector<std::int32_t> tetsOf(const TetMesh& mesh, PointReader vertices, const Triangles* triangles,
                                 OutsideRule rule, EmbedReport& report) {
  const std::vector<std::uint32_t> first = weldCoincident(vertices);
  const SearchCage cage(mesh);
  TetSearch search = findTets(cage, vertices, first, rule);
  for (std::size_t v = 0; v < vertices.size(); ++v) report.coincident += first[v] != v;
  report.flatTets = mesh.tetCount() - cage.size();
  report.overlapping = search.overlapping;
  report.candidates = search.candidates;
  report.rescued = static_cast<std::size_t>(std::count(search.rescued.begin(), search.rescued.end(), true));
  report.worstDistance = search.farthestDistance;
  report.worstVertex = search.farthest;
  report.worstPosition = vertices[search.farthest];
  if (triangles && rule == OutsideRule::Nearest) {
    report.keptWithNeighbours = keepWithNeighbours(mesh, vertices, first, *triangles, search.rescued, search.tetOf);
  }
  return std::move(search.tetOf);
}

Status embedVertices(const TetMesh& cage, PointReader vertices, const Triangles* triangles, const EmbedOptions& options,
                     Embedding& embedding, EmbedReport& report) {
  if (Status status = checkInputs(cage, vertices, options, report); !status.ok()) return status;
  const std::vector<std::int32_t> tetOf = tetsOf(cage, vertices, triangles, options.outside, report);
  Embedding::Fit fit;
  Embedding made = Embedding::fromTets(cage, vertices, tetOf, &fit);
  reportFit(fit, report);
  if (!std::isfinite(report.restErrorMax) || !(report.worstBarycentric <= kLargestBarycentric)) {
    return {StatusCode::Degenerate,
            "some vertices are so many times the size of their tet away from it that weighted sums would overflow; are "
            "mesh and cage in the same unit?"};
  }
  if (report.worstDistance > options.maxDistance) return tooFar(report, options.maxDistance);
  report.inside = made.insideCount();
  report.outside = made.vertexCount() - made.insideCount();
  report.unbound = 0;
  embedding = std::move(made);
  return {};
}

EmbedReport timedEmbed(const TetMesh& cage, PointReader vertices, const Triangles* triangles,
                       const EmbedOptions& options, Embedding& embedding) {
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
  if (keptWithNeighbours > 0) {
    std::snprintf(text, sizeof text, "%zu vertices outside kept from another part of the cage, nearer than their own\n",
                  keptWithNeighbours);
    result += text;
  }
  if (rescued > 0 || largestWeight > kLargestWeight) {
    std::snprintf(
        text, sizeof text,
        "%zu vertices outside taken from a nearest tet that would extrapolate them more than %g times; largest "
        "weight %.3g\n",
        rescued, kLargestWeight, largestWeight);
    result += text;
  }
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

namespace {

/// Some vertices of one tet, coordinate by coordinate, so that loops take several at a time.
struct VertexBlock {
  static constexpr std::size_t kSize = 16;
  double x[kSize], y[kSize], z[kSize];
  double smallest[kSize];  ///< weight
  double error[kSize];     ///< squared distance of what the rounded weights give

  void set(std::size_t k, const Eigen::Vector3d& vertex) {
    x[k] = vertex.x();
    y[k] = vertex.y();
    z[k] = vertex.z();
  }
  void weigh(const BarycentricMap& map, std::size_t count, const std::array<float*, 3>& weights) {
    for (std::size_t k = 0; k < count; ++k) {
      double b[4];
      map.weightsAt(x[k], y[k], z[k], b[0], b[1], b[2], b[3]);
      for (std::size_t i = 0; i < 3; ++i) weights[i][k] = static_cast<float>(b[i]);
      const double low = b[0] < b[1] ? b[0] : b[1], high = b[2] < b[3] ? b[2] : b[3];
      smallest[k] = low < high ? low : high;
    }
  }
  void measure(const TetCorners& p, std::size_t count, const std::array<float*, 3>& weights) {
    const Eigen::Vector3d edges[3] = {p[0] - p[3], p[1] - p[3], p[2] - p[3]};
    for (std::size_t k = 0; k < count; ++k) {
      const double b0 = weights[0][k], b1 = weights[1][k], b2 = weights[2][k];
      const double dx = p[3].x() + b0 * edges[0].x() + b1 * edges[1].x() + b2 * edges[2].x() - x[k];
      const double dy = p[3].y() + b0 * edges[0].y() + b1 * edges[1].y() + b2 * edges[2].y() - y[k];
      const double dz = p[3].z() + b0 * edges[0].z() + b1 * edges[1].z() + b2 * edges[2].z() - z[k];
      error[k] = dx * dx + dy * dy + dz * dz;
    }
  }
};

}  // namespace

Embedding Embedding::fromTets(const TetMesh& cage, PointReader vertices, const std::vector<std::int32_t>& tetOf,
                              Fit* fit) {
  assert(vertices.size() == tetOf.size());
  Embedding e;
  e.nodeCount_ = cage.nodeCount();
  e.tetCount_ = cage.tetCount();
  e.sortByTet(cage, tetOf);
  for (std::vector<float>& plane : e.weights_) plane.resize(vertices.size() + kPadding);
  for (std::vector<float>& plane : e.closestWeights_) plane.resize(vertices.size() - e.insideCount_ + kPadding);
  Fit unread;
  for (std::size_t r = 0; r + 1 < e.runs_.size(); ++r) {
    e.bindRun(r, cornersOf(cage, cage.tets[e.runs_[r].tet]), vertices, fit ? *fit : unread);
  }
  return e;
}

/// Computes the weights of the vertices of one run, and how well they fit.
void Embedding::bindRun(std::size_t run, const std::array<Eigen::Vector3d, 4>& corners, PointReader vertices,
                        Fit& fit) {
  const BarycentricMap map(corners);
  VertexBlock block;
  const std::uint32_t last = runs_[run + 1].firstSlot;
  for (std::uint32_t slot = runs_[run].firstSlot; slot < last; slot += VertexBlock::kSize) {
    const std::size_t count = std::min<std::size_t>(last - slot, VertexBlock::kSize);
    for (std::size_t k = 0; k < count; ++k) block.set(k, vertices[slotVertices_[slot + k]]);
    block.weigh(map, count, {&weights_[0][slot], &weights_[1][slot], &weights_[2][slot]});
    block.measure(corners, count, {&weights_[0][slot], &weights_[1][slot], &weights_[2][slot]});
    for (std::size_t k = 0; k < count; ++k) {
      fit.worstBarycentric = std::max(fit.worstBarycentric, -block.smallest[k]);
      // Weights beyond float's range make the error infinite or NaN.
      const double error = block.error[k] < HUGE_VAL ? block.error[k] : HUGE_VAL;
      fit.restErrorSquared = std::max(fit.restErrorSquared, error);
    }
    for (std::uint32_t s = std::max<std::uint32_t>(slot, insideCount_); s < slot + count; ++s) {
      bindOutside(s, corners, map, vertices[slotVertices_[s]], fit);
    }
  }
}

/// What a vertex outside has besides: its closest point.
void Embedding::bindOutside(std::uint32_t slot, const std::array<Eigen::Vector3d, 4>& corners,
                            const BarycentricMap& map, const Eigen::Vector3d& vertex, Fit& fit) {
  const Eigen::Vector4d weights = map(vertex);
  fit.largestWeight = std::max(fit.largestWeight, largestWeight(weights));
  const Eigen::Vector3d closest = closestPointInTet(vertex, corners, weights);
  const Eigen::Vector4d c = map(closest);
  for (std::size_t k = 0; k < 3; ++k) {
    const double clamped = std::min(std::max(c[static_cast<int>(k)], 0.0), 1.0);  // rounding is a hair off the face
    closestWeights_[k][slot - insideCount_] = static_cast<float>(clamped);
  }
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
  runs_.reserve(static_cast<std::size_t>(std::count_if(next.begin(), next.end(), [](auto n) { return n > 0; })) + 1);
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
  return timedEmbed(cage, vertices, nullptr, options, embedding);
}

EmbedReport embed(const TetMesh& cage, PointView<const float> vertices, const EmbedOptions& options,
                  Embedding& embedding) {
  return timedEmbed(cage, vertices, nullptr, options, embedding);
}

EmbedReport embed(const TetMesh& cage, const TriangleMesh& mesh, const EmbedOptions& options, Embedding& embedding) {
  EmbedReport report;
  report.vertexCount = report.unbound = mesh.vertexCount();
  report.status = checkTriangleMesh(mesh);
  if (!report.ok()) return report;
  return timedEmbed(cage, viewOf(mesh.positions), &mesh.triangles, options, embedding);
}

}  // namespace tetskin
