// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/cage.h>
#include <tetskin/core/src/shared/base/hash.h>
#include <tetskin/core/src/shared/mesh/face_neighbours.h>
#include <tetskin/core/src/shared/mesh/tet_geometry.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <queue>
#include <unordered_set>

namespace tetskin {
namespace {

/// Tets that a search leaves by their faces without coming any nearer to the point, before it gives up.
constexpr std::size_t kMostFruitless = 400;
/// Barycentric distance up to which a tet holds a point: one on a face is in both tets, or by rounding in none.
constexpr double kHolds = 1e-12;

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

Status checkNumbers(const std::vector<int>& numbers, std::size_t count, const char* name) {
  if (numbers.empty()) return {};
  if (numbers.size() != count) return wrongCount(name, numbers.size(), count, "tets");
  const auto negative = std::find_if(numbers.begin(), numbers.end(), [](int number) { return number < 0; });
  if (negative == numbers.end()) return {};
  return wrongValue(name, static_cast<std::size_t>(negative - numbers.begin()), "0 or more");
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
  if (status.ok()) status = checkNumbers(parts, tetCount(), "parts");
  if (status.ok()) status = checkNumbers(latticeTets, tetCount(), "latticeTets");
  if (!status.ok()) return status;
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
    double barycentric = std::numeric_limits<double>::infinity();
    bool holds() const { return barycentric <= kHolds; }
  };
  /// A tet on the way to a point; the nearest is the first of a queue.
  struct Reached {
    double distance;
    int tet;
    bool operator<(const Reached& other) const { return distance > other.distance; }
  };

  template <class F>
  void forNeighbours(int tet, F&& f) const {
    const std::size_t face = 4 * static_cast<std::size_t>(tet);
    for (std::uint32_t k = beyond.starts[face]; k < beyond.starts[face + 4]; ++k) f(static_cast<int>(beyond.values[k]));
  }

  /// From the tets of these vertices through faces, from the nearest first. By distance, not by barycentric distance:
  /// that is large in small tets, wherever they are, so that the way to the point would go up and down.
  Found search(const Eigen::Vector3d& point, const std::array<int, 3>& nearVertices) const {
    Found best;
    std::unordered_set<int> seen;
    std::priority_queue<Reached> next;
    const auto reach = [&](int tet) {
      if (best.holds() || !seen.insert(tet).second) return;
      const TetCorners corners = cornersOf(cage, cage.tets[tet]);
      const bool flat = isFlat(corners);
      const Eigen::Vector4d weights = flat ? Eigen::Vector4d::Constant(-1.0) : BarycentricMap(corners)(point);
      const double barycentric = flat ? Found().barycentric : barycentricDistance(weights);
      if (best.tet < 0 || barycentric < best.barycentric) best = {tet, barycentric};
      next.push({distanceToTet(point, corners, weights), tet});
    };
    for (const int vertex : nearVertices) {
      assert(vertex >= 0 && static_cast<std::size_t>(vertex) < cage.vertexTets.size());
      reach(cage.vertexTets[static_cast<std::size_t>(vertex)]);
    }
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t fruitless = 0; fruitless < kMostFruitless && !next.empty() && !best.holds(); ++fruitless) {
      const Reached from = next.top();
      next.pop();
      if (from.distance < nearest) fruitless = 0;
      nearest = std::min(nearest, from.distance);
      forNeighbours(from.tet, reach);
    }
    return best;
  }

  Found nearestOfAll(const Eigen::Vector3d& point) const {
    Found best;
    for (std::size_t t = 0; t < cage.tetCount() && !best.holds(); ++t) {
      const TetCorners corners = cornersOf(cage, cage.tets[t]);
      if (isFlat(corners)) continue;
      const double barycentric = barycentricDistance(BarycentricMap(corners)(point));
      if (barycentric < best.barycentric) best = {static_cast<int>(t), barycentric};
    }
    return best;
  }
};

CageLocator::CageLocator(const Cage& cage) : parts_(std::make_unique<const Parts>(cage)) {}
CageLocator::~CageLocator() = default;
CageLocator::CageLocator(CageLocator&&) noexcept = default;
CageLocator& CageLocator::operator=(CageLocator&&) noexcept = default;

int CageLocator::locate(const Eigen::Vector3d& point, const std::array<int, 3>& nearVertices) const {
  if (!parts_) return -1;
  return (parts_->cage.vertexTets.empty() ? parts_->nearestOfAll(point) : parts_->search(point, nearVertices)).tet;
}

}  // namespace tetskin
