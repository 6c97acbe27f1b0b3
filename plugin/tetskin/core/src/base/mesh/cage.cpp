// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/cage.h>
#include <tetskin/core/src/base/hash.h>
#include <tetskin/core/src/base/mesh/face_neighbours.h>
#include <tetskin/core/src/base/mesh/mesh_checks.h>
#include <tetskin/core/src/base/mesh/tet_geometry.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <queue>
#include <unordered_set>

namespace tetskin {
namespace {

/// A search stops after this many tets whose faces have led it no nearer to the point.
constexpr std::size_t kMaxFruitless = 400;
/// Barycentric distance up to which a tet contains a point: a point on a face is in both tets or, because of rounding,
/// in neither.
constexpr double kHolds = 1e-12;

Status wrongCount(const char* name, std::size_t count, std::size_t wanted, const char* label) {
  return {StatusCode::SizeMismatch, "the cage has " + std::to_string(count) + " " + name + " for " +
                                        std::to_string(wanted) + " " + label + "; pass as many values, or none"};
}

Status wrongValue(const char* name, std::size_t k, const char* range) {
  return {StatusCode::InvalidOption,
          "the cage's " + std::string(name) + "[" + std::to_string(k) + "] must be " + range};
}

template <class Good>
Status checkValues(const std::vector<double>& values, std::size_t count, const char* name, const char* label,
                   const char* range, Good&& good) {
  if (values.empty()) return {};
  if (values.size() != count) return wrongCount(name, values.size(), count, label);
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

std::vector<double> Cage::materialStiffness() const {
  if (paintedStiffness.empty() || stiffnessFactor.empty())
    return paintedStiffness.empty() ? stiffnessFactor : paintedStiffness;
  std::vector<double> scale = paintedStiffness;
  for (std::size_t t = 0; t < scale.size(); ++t) scale[t] *= stiffnessFactor[t];
  return scale;
}

std::vector<double> Cage::stiffnessScale() const {
  std::vector<double> scale = materialStiffness();
  if (volumeFraction.empty()) return scale;
  if (scale.empty()) scale.assign(mesh.tetCount(), 1.0);
  for (std::size_t t = 0; t < scale.size(); ++t) scale[t] *= std::max(volumeFraction[t], Limits::kMinVolumeFraction);
  return scale;
}

void Cage::scaleBy(double scale) {
  for (Eigen::Vector3d& node : mesh.nodes) node *= scale;
  for (double& mass : masses) mass *= scale * scale * scale;
}

bool Cage::hasDuplicates() const {
  std::vector<int> sorted = sourceTet;
  std::sort(sorted.begin(), sorted.end());
  return std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end();
}

Status validateAttributes(const Cage& cage) {
  Status status = checkValues(cage.volumeFraction, cage.mesh.tetCount(), "volumeFraction", "tets", "from 0 to 1",
                              [](double value) { return value >= 0.0 && value <= 1.0; });
  if (status.ok())
    status = checkValues(cage.stiffnessFactor, cage.mesh.tetCount(), "stiffnessFactor", "tets", "above 0", positive);
  if (status.ok())
    status = checkValues(cage.paintedStiffness, cage.mesh.tetCount(), "paintedStiffness", "tets", "above 0", positive);
  if (status.ok())
    status = checkValues(cage.paintedDensity, cage.mesh.tetCount(), "paintedDensity", "tets", "above 0", positive);
  if (status.ok())
    status = checkValues(cage.paintedDamping, cage.mesh.tetCount(), "paintedDamping", "tets", "finite, and 0 or more",
                         [](double value) { return value >= 0.0 && std::isfinite(value); });
  if (status.ok()) status = checkValues(cage.masses, cage.mesh.nodeCount(), "masses", "nodes", "above 0", positive);
  if (status.ok()) status = checkNumbers(cage.component, cage.mesh.tetCount(), "component");
  if (status.ok()) status = checkNumbers(cage.sourceTet, cage.mesh.tetCount(), "sourceTet");
  if (!status.ok()) return status;
  if (!cage.fineVolumeFraction.empty() && cage.fineVolumeFraction.size() != kFineTets * cage.mesh.tetCount()) {
    return wrongCount("fineVolumeFraction", cage.fineVolumeFraction.size(), kFineTets * cage.mesh.tetCount(),
                      "small tets");
  }
  if (Result<std::vector<QuadraticTet>> tets = quadraticTets(cage); !tets.ok()) return tets.status();
  for (std::size_t v = 0; v < cage.vertexTets.size(); ++v) {
    if (cage.vertexTets[v] >= 0 && static_cast<std::size_t>(cage.vertexTets[v]) < cage.mesh.tetCount()) continue;
    return {StatusCode::IndexOutOfRange, "the cage's map assigns tet " + std::to_string(cage.vertexTets[v]) +
                                             " to vertex " + std::to_string(v) + ", but there are " +
                                             std::to_string(cage.mesh.tetCount()) + " tets"};
  }
  return {};
}

Status validate(const Cage& cage) {
  if (Status status = validate(cage.mesh); !status.ok()) return status;
  return validateAttributes(cage);
}

Status Cage::checkMesh(const TriangleMesh& surface) const {
  if (!vertexTets.empty() && vertexTets.size() != surface.vertexCount()) {
    return {StatusCode::CageMismatch, "the cage was built for a mesh of " + std::to_string(vertexTets.size()) +
                                          " vertices, but this one has " + std::to_string(surface.vertexCount()) +
                                          "; build a cage for it"};
  }
  if (!meshHash || meshHash == positionsHash(surface.positions)) return {};
  return {StatusCode::CageMismatch,
          "the cage was built for a mesh with other vertex positions, or another order of vertices; build a cage for "
          "this one"};
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

struct CageLocator::Impl {
  explicit Impl(const Cage& ofCage) : cage(ofCage), beyond(faceNeighbours(ofCage.mesh)) {}

  const Cage& cage;
  Lists<> beyond;

  struct Found {
    int tet = -1;
    double barycentric = std::numeric_limits<double>::infinity();
    bool holds() const { return barycentric <= kHolds; }
  };
  /// A tet on the path to a point. The queue is sorted so that the nearest one comes first and, of two at the same
  /// distance, the lower number, because the heaps of standard libraries differ.
  struct Reached {
    double distance;
    int tet;
    bool operator<(const Reached& other) const {
      return distance > other.distance || (distance == other.distance && tet > other.tet);
    }
  };

  template <class F>
  void forNeighbours(int tet, F&& f) const {
    const std::size_t face = 4 * static_cast<std::size_t>(tet);
    for (std::uint32_t k = beyond.starts[face]; k < beyond.starts[face + 4]; ++k) f(static_cast<int>(beyond.values[k]));
  }

  /// Searches from the tets of these vertices through faces, nearest tets first. It compares distances, not barycentric
  /// distances: those are large in small tets anywhere, so they would not decrease steadily along the path.
  Found search(const Eigen::Vector3d& point, const std::array<int, 3>& nearVertices) const {
    Found best;
    std::unordered_set<int> seen;
    std::priority_queue<Reached> next;
    const auto reach = [&](int tet) {
      if (best.holds() || !seen.insert(tet).second) return;
      const TetCorners corners = cornersOf(cage.mesh, cage.mesh.tets[tet]);
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
    for (std::size_t fruitless = 0; fruitless < kMaxFruitless && !next.empty() && !best.holds(); ++fruitless) {
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
    for (std::size_t t = 0; t < cage.mesh.tetCount() && !best.holds(); ++t) {
      const TetCorners corners = cornersOf(cage.mesh, cage.mesh.tets[t]);
      if (isFlat(corners)) continue;
      const double barycentric = barycentricDistance(BarycentricMap(corners)(point));
      if (barycentric < best.barycentric) best = {static_cast<int>(t), barycentric};
    }
    return best;
  }
};

CageLocator::CageLocator(const Cage& cage) : impl_(std::make_shared<const Impl>(cage)) {}

int CageLocator::locate(const Eigen::Vector3d& point, const std::array<int, 3>& nearVertices) const {
  if (!impl_) return -1;
  return (impl_->cage.vertexTets.empty() ? impl_->nearestOfAll(point) : impl_->search(point, nearVertices)).tet;
}

}  // namespace tetskin
