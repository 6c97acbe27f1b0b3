// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/cage.h>
#include <tetskin/core/src/base/hash.h>
#include <tetskin/core/src/mesh/face_neighbours.h>
#include <tetskin/core/src/mesh/tet_geometry.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tetskin {
namespace {

/// Tets looked at around the end of a walk that got stuck.
constexpr std::size_t kMostVisited = 400;

Status wrongCount(const char* name, std::size_t count, std::size_t wanted, const char* of) {
  return {StatusCode::SizeMismatch, "the cage has " + std::to_string(count) + " " + name + " for " +
                                        std::to_string(wanted) + " " + of + "; it takes one for each, or none"};
}

Status wrongValue(const char* name, std::size_t k, const char* range) {
  return {StatusCode::InvalidOption,
          "the cage's " + std::string(name) + "[" + std::to_string(k) + "] must be " + range};
}

template <class Good>
Status checkValues(const std::vector<double>& values, std::size_t count, const char* name, const char* of,
                   const char* range, Good&& good) {
  if (values.empty()) return {};
  if (values.size() != count) return wrongCount(name, values.size(), count, of);
  for (std::size_t k = 0; k < count; ++k) {
    if (!(std::isfinite(values[k]) && good(values[k]))) return wrongValue(name, k, range);
  }
  return {};
}

bool positive(double value) {
  return value > 0.0;
}

}  // namespace

std::vector<double> Cage::stiffnessScale() const {
  if (fill.empty()) return factor;
  std::vector<double> scale = factor.empty() ? std::vector<double>(tetCount(), 1.0) : factor;
  for (std::size_t t = 0; t < scale.size(); ++t) scale[t] *= std::max(fill[t], kLeastFill);
  return scale;
}

void Cage::scaleBy(double scale) {
  for (Eigen::Vector3d& node : nodes) node *= scale;
  for (double& mass : masses) mass *= scale * scale * scale;
}

bool Cage::split() const {
  std::vector<int> sorted = latticeTets;
  std::sort(sorted.begin(), sorted.end());
  return std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end();
}

Status Cage::check() const {
  Status status = checkValues(fill, tetCount(), "fill", "tets", "from 0 to 1",
                              [](double value) { return value >= 0.0 && value <= 1.0; });
  if (status.ok()) status = checkValues(factor, tetCount(), "factor", "tets", "above 0", positive);
  if (status.ok()) status = checkValues(masses, nodeCount(), "masses", "nodes", "above 0", positive);
  if (!status.ok()) return status;
  if (!parts.empty() && parts.size() != tetCount()) return wrongCount("parts", parts.size(), tetCount(), "tets");
  if (!latticeTets.empty() && latticeTets.size() != tetCount()) {
    return wrongCount("latticeTets", latticeTets.size(), tetCount(), "tets");
  }
  if (!fineFill.empty() && fineFill.size() != kFineTets * tetCount()) {
    return wrongCount("fineFill", fineFill.size(), kFineTets * tetCount(), "small tets");
  }
  for (std::size_t v = 0; v < vertexTets.size(); ++v) {
    if (vertexTets[v] >= 0 && static_cast<std::size_t>(vertexTets[v]) < tetCount()) continue;
    return {StatusCode::IndexOutOfRange, "the cage's map names tet " + std::to_string(vertexTets[v]) + " for vertex " +
                                             std::to_string(v) + ", of " + std::to_string(tetCount()) + " tets"};
  }
  return {};
}

Status Cage::checkMesh(const TriangleMesh& mesh) const {
  if (!vertexTets.empty() && vertexTets.size() != mesh.vertexCount()) {
    return {StatusCode::CageMismatch, "the cage was built for a mesh of " + std::to_string(vertexTets.size()) +
                                          " vertices, and this one has " + std::to_string(mesh.vertexCount()) +
                                          "; build a cage for it"};
  }
  if (meshHash == 0 || meshHash == positionsHash(mesh.positions)) return {};
  return {
      StatusCode::CageMismatch,
      "the cage was built for a mesh with vertices at other places, or in another order; build a cage for this one"};
}

int Cage::locate(const Eigen::Vector3d& point, const std::array<int, 3>& nearVertices) const {
  return CageLocator(*this).locate(point, nearVertices);
}

std::uint64_t positionsHash(const std::vector<Eigen::Vector3d>& positions) {
  Hash hash;
  for (const Eigen::Vector3d& p : positions) {
    for (int i = 0; i < 3; ++i) hash.add(p[i]);
  }
  return hash.value();
}

struct CageLocator::Parts {
  explicit Parts(const Cage& ofCage) : cage(ofCage), beyond(faceNeighbours(ofCage)) {}

  const Cage& cage;
  Lists<> beyond;

  struct Found {
    int tet = -1;
    double distance = std::numeric_limits<double>::infinity();
    bool holds() const { return distance <= 0.0; }
  };

  double distance(int tet, const Eigen::Vector3d& point, Eigen::Vector4d& weights) const {
    const TetCorners corners = cornersOf(cage, cage.tets[tet]);
    if (isFlat(corners)) return std::numeric_limits<double>::infinity();
    weights = BarycentricMap(corners)(point);
    return barycentricDistance(weights);
  }

  template <class F>
  void forBeyond(int tet, int corner, F&& f) const {
    const std::size_t face = 4 * static_cast<std::size_t>(tet) + static_cast<std::size_t>(corner);
    for (std::uint32_t k = beyond.starts[face]; k < beyond.starts[face + 1]; ++k) f(static_cast<int>(beyond.values[k]));
  }

  /// From tet to tet, each nearer than the one before.
  Found walk(int tet, const Eigen::Vector3d& point) const {
    Eigen::Vector4d weights = Eigen::Vector4d::Zero();
    Found at{tet, distance(tet, point, weights)};
    while (!at.holds()) {
      Found best = at;
      Eigen::Vector4d bestWeights = weights;
      for (int corner = 0; corner < 4; ++corner) {
        if (weights[corner] > 0.0) continue;
        forBeyond(at.tet, corner, [&](int other) {
          Eigen::Vector4d w = weights;
          const double d = distance(other, point, w);
          if (!(d < best.distance)) return;
          best = {other, d};
          bestWeights = w;
        });
      }
      if (best.tet == at.tet) break;
      at = best;
      weights = bestWeights;
    }
    return at;
  }

  /// Ring by ring through faces.
  Found searchAround(Found start, const Eigen::Vector3d& point) const {
    std::vector<int> visited = {start.tet};
    for (std::size_t k = 0; k < visited.size() && visited.size() < kMostVisited && !start.holds(); ++k) {
      for (int corner = 0; corner < 4; ++corner) {
        forBeyond(visited[k], corner, [&](int other) {
          if (std::find(visited.begin(), visited.end(), other) != visited.end()) return;
          visited.push_back(other);
          Eigen::Vector4d weights;
          const double d = distance(other, point, weights);
          if (d < start.distance) start = {other, d};
        });
      }
    }
    return start;
  }

  Found nearestOfAll(const Eigen::Vector3d& point) const {
    Found best;
    Eigen::Vector4d weights;
    for (std::size_t t = 0; t < cage.tetCount() && !best.holds(); ++t) {
      const double d = distance(static_cast<int>(t), point, weights);
      if (d < best.distance) best = {static_cast<int>(t), d};
    }
    return best;
  }
};

CageLocator::CageLocator(const Cage& cage) : parts_(std::make_unique<const Parts>(cage)) {}
CageLocator::~CageLocator() = default;
CageLocator::CageLocator(CageLocator&&) noexcept = default;
CageLocator& CageLocator::operator=(CageLocator&&) noexcept = default;

int CageLocator::locate(const Eigen::Vector3d& point, const std::array<int, 3>& nearVertices) const {
  const Cage& cage = parts_->cage;
  if (cage.vertexTets.empty()) return parts_->nearestOfAll(point).tet;
  Parts::Found best;
  for (const int vertex : nearVertices) {
    assert(vertex >= 0 && static_cast<std::size_t>(vertex) < cage.vertexTets.size());
    const Parts::Found found = parts_->walk(cage.vertexTets[static_cast<std::size_t>(vertex)], point);
    if (found.distance < best.distance || best.tet < 0) best = found;
    if (best.holds()) return best.tet;
  }
  return parts_->searchAround(best, point).tet;
}

}  // namespace tetskin
