// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/cage/src/fill/painted_maps.h>
#include <tetskin/core/src/base/arithmetic/logarithms.h>
#include <tetskin/core/src/base/mesh/tet_geometry.h>
#include <tetskin/core/src/base/mesh/triangle_bvh.h>
#include <tetskin/core/src/base/mesh/uniform_refinement.h>
#include <tetskin/core/src/base/mesh/used_vertices.h>
#include <tetskin/core/src/base/mesh/weld.h>
#include <tetskin/core/src/base/progress.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

namespace tetskin {
namespace {

/// Where means are arithmetic.
double scaled(double value, MapMean mean) {
  return mean == MapMean::Geometric ? portableLog(value) : value;
}
double unscaled(double value, MapMean mean) {
  return mean == MapMean::Geometric ? portableExp(value) : value;
}

std::string counted(std::size_t count, const char* what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

enum class Range { Any, Positive, NotNegative };

bool isIn(Range range, double value) {
  return range == Range::Any || value > 0.0 || (range == Range::NotNegative && value == 0.0);
}

/// name  of the map in messages
Status checkMap(const TriangleMesh& mesh, const std::vector<double>& values, Range range, const std::string& name) {
  if (mesh.triangles.empty())
    return {StatusCode::Empty, name + " is on a mesh without triangles, which has no inside; triangulate it first"};
  if (values.size() != mesh.vertexCount()) {
    return {StatusCode::SizeMismatch, name + " has " + counted(values.size(), "value") + ", but the mesh has " +
                                          std::to_string(mesh.vertexCount()) +
                                          " vertices; pass one value for each, copies at seams included"};
  }
  const std::vector<char> used = usedVertices(mesh);
  for (std::size_t v = 0; v < values.size(); ++v) {
    if (std::isfinite(values[v]) && (!used[v] || isIn(range, values[v]))) continue;
    const std::string named = name + " is " + std::to_string(values[v]) + " at vertex " + std::to_string(v);
    if (!std::isfinite(values[v])) return {StatusCode::NonFinite, named + "; pass finite values"};
    if (range == Range::NotNegative) return {StatusCode::InvalidOption, named + ", but must be 0 or more"};
    return {StatusCode::InvalidOption,
            named + ", but must be above 0; pass a small value, such as 0.01, where there is hardly any"};
  }
  return {};
}

/// The values; vertices that no triangle uses get that of one that is used.
std::vector<double> ofUsed(const TriangleMesh& mesh, std::vector<double> values) {
  const std::vector<char> used = usedVertices(mesh);
  const double some = values[static_cast<std::size_t>(mesh.triangles[0][0])];
  for (std::size_t v = 0; v < values.size(); ++v) {
    if (!used[v]) values[v] = some;
  }
  return values;
}

/// The values, with the mean of all vertices at one position in each of these; for the given mean of values.
std::vector<double> welded(const TriangleMesh& mesh, const std::vector<double>& values, MapMean mean) {
  const std::vector<char> isUsed = usedVertices(mesh);
  const std::vector<std::uint32_t> first = weldCoincident(viewOf(mesh.positions));
  std::vector<double> sums(values.size(), 0.0), counts(values.size(), 0.0);
  for (std::size_t v = 0; v < values.size(); ++v) {
    if (!isUsed[v]) continue;
    sums[first[v]] += scaled(values[v], mean);
    ++counts[first[v]];
  }
  for (std::size_t v = 0; v < values.size(); ++v) {  // the first at a position comes before its copies
    sums[v] = first[v] < v ? sums[first[v]] : counts[v] > 0.0 ? sums[v] / counts[v] : scaled(values[v], mean);
  }
  return sums;
}

/// Differences between the eighths of a tet, relative to those of the whole map, up to which they are not divided
/// again.
constexpr double kEven = 0.02;

/// A weighted mean: of all alike, if all weights are 0.
class Mean {
 public:
  void add(double weight, double value) {
    sum_ += weight * value;
    weights_ += weight;
    plain_ += value;
    ++count_;
    least_ = std::min(least_, value);
    greatest_ = std::max(greatest_, value);
  }
  double value() const { return weights_ > 0.0 ? sum_ / weights_ : plain_ / count_; }
  double range() const { return greatest_ - least_; }

 private:
  double sum_ = 0.0, weights_ = 0.0, plain_ = 0.0, count_ = 0.0;
  double least_ = std::numeric_limits<double>::infinity(), greatest_ = -least_;
};

/// The map inside: the value of the nearest point of the surface.
class MapInside {
 public:
  MapInside(const TriangleMesh& mesh, std::vector<double> ofVertices)
      : mesh_(mesh), bvh_(mesh), ofVertices_(std::move(ofVertices)) {
    const auto [least, greatest] = std::minmax_element(ofVertices_.begin(), ofVertices_.end());
    even_ = kEven * (*greatest - *least);
  }

  /// The mean over the tet's eighths or, where these differ, over its 64 small tets.
  /// fractions  volume fractions of the small tets, which weight them; null: 1
  double meanOver(const TetCorners& tet, const std::uint8_t* fractions) {
    constexpr std::size_t kEighth = kFineTets / 8;
    const std::array<TetCorners, 8> eighths = refinedTet(tet);
    Mean rough, fine;
    for (std::size_t e = 0; e < eighths.size(); ++e) {
      const double weight =
          fractions ? std::accumulate(fractions + kEighth * e, fractions + kEighth * (e + 1), 0.0) : 1.0;
      rough.add(weight, at(eighths[e]));
    }
    if (rough.range() <= even_) return rough.value();
    for (const TetCorners& eighth : eighths) {
      for (const TetCorners& small : refinedTet(eighth)) fine.add(fractions ? *fractions++ : 1.0, at(small));
    }
    return fine.value();
  }

 private:
  /// The value at a tet's centroid.
  double at(const TetCorners& tet) {
    const Eigen::Vector3d p = 0.25 * (tet[0] + tet[1] + tet[2] + tet[3]);
    nearest_ = bvh_.nearest(p, nearest_);
    const std::array<int, 3>& triangle = mesh_.triangles[static_cast<std::size_t>(nearest_.triangle)];
    const Eigen::Vector3d weights = closestPointOnTriangle(p, cornersOf(mesh_, triangle)).weights;
    double value = 0.0;
    for (Eigen::Index k = 0; k < 3; ++k)
      value += weights[k] * ofVertices_[static_cast<std::size_t>(triangle[static_cast<std::size_t>(k)])];
    return value;
  }

  const TriangleMesh& mesh_;
  TriangleBvh bvh_;
  std::vector<double> ofVertices_;
  double even_ = 0.0;
  NearestPoint nearest_;
};

double sumOf(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

/// The filled part of each tet's volume.
/// least  fraction that counts as filled in any tet
std::vector<double> filledVolumes(const Cage& cage, double least) {
  std::vector<double> volumes;
  for (std::size_t t = 0; t < cage.mesh.tetCount(); ++t) {
    const double fraction = cage.volumeFraction.empty() ? 1.0 : std::max(cage.volumeFraction[t], least);
    volumes.push_back(fraction * std::abs(signedVolume(cornersOf(cage.mesh, cage.mesh.tets[t]))));
  }
  return volumes;
}

/// Volume of the material by tet; a cage in which all tets are empty counts as full.
std::vector<double> materialOf(const Cage& cage) {
  std::vector<double> material = filledVolumes(cage, 0.0);
  return sumOf(material) > 0.0 ? material : filledVolumes(cage, 1.0);
}

/// Means of tets around each node, by their material; of all tets for a node without any.
std::vector<double> nodeMeans(const Cage& cage, const std::vector<double>& ofTets) {
  const std::vector<double> material = materialOf(cage);
  std::vector<double> sums(cage.mesh.nodeCount(), 0.0), volumes(cage.mesh.nodeCount(), 0.0);
  double sum = 0.0, volume = 0.0;
  for (std::size_t t = 0; t < material.size(); ++t) {
    for (const int n : cage.mesh.tets[t]) {
      sums[static_cast<std::size_t>(n)] += material[t] * ofTets[t];
      volumes[static_cast<std::size_t>(n)] += material[t];
    }
    sum += material[t] * ofTets[t];
    volume += material[t];
  }
  for (std::size_t n = 0; n < sums.size(); ++n)
    sums[n] = volumes[n] > 0.0 ? sums[n] / volumes[n] : volume > 0.0 ? sum / volume : ofTets[0];
  return sums;
}

/// ofAll  values of all vertices, checked
SpreadMap spread(const Cage& cage, const TriangleMesh& mesh, const std::vector<double>& ofAll, MapMean mean) {
  const std::vector<double> values = ofUsed(mesh, ofAll);
  const auto [least, greatest] = std::minmax_element(values.begin(), values.end());
  SpreadMap map;
  if (!(*least < *greatest)) {
    map.tets.assign(cage.mesh.tetCount(), *least);
    map.nodes.assign(cage.mesh.nodeCount(), *least);
    return map;
  }
  MapInside inside(mesh, welded(mesh, values, mean));
  for (std::size_t t = 0; t < cage.mesh.tetCount(); ++t) {
    Progress::goOn(t);
    const bool fine = !cage.fineVolumeFraction.empty();
    map.tets.push_back(inside.meanOver(cornersOf(cage.mesh, cage.mesh.tets[t]),
                                       fine ? &cage.fineVolumeFraction[kFineTets * t] : nullptr));
  }
  map.nodes = nodeMeans(cage, map.tets);
  for (std::vector<double>* all : {&map.tets, &map.nodes}) {
    for (double& value : *all) value = std::clamp(unscaled(value, mean), *least, *greatest);
  }
  return map;
}

/// The values by tet; none for a map of 1.
std::vector<double> factorsOf(const Cage& cage, const TriangleMesh& mesh, const std::vector<double>& values,
                              MapMean mean) {
  std::vector<double> factors = spread(cage, mesh, values, mean).tets;
  const bool none = std::all_of(factors.begin(), factors.end(), [](double factor) { return factor == 1.0; });
  return none ? std::vector<double>() : factors;
}

/// Masses of a cage that has none, for a density of 1: an empty tet gets a share that holds its nodes, a node that no
/// tet uses the least of all. Their sum is the volume of the material.
std::vector<double> massesByVolume(const Cage& cage) {
  const std::vector<double> volumes = filledVolumes(cage, Limits::kMinVolumeFraction);
  std::vector<double> masses(cage.mesh.nodeCount(), 0.0);
  for (std::size_t t = 0; t < volumes.size(); ++t) {
    for (const int n : cage.mesh.tets[t]) masses[static_cast<std::size_t>(n)] += 0.25 * volumes[t];
  }
  double least = std::numeric_limits<double>::infinity();
  for (const double mass : masses) least = mass > 0.0 ? std::min(least, mass) : least;
  for (double& mass : masses) mass = std::max(mass, least);
  const double factor = sumOf(materialOf(cage)) / sumOf(masses);
  for (double& mass : masses) mass *= factor;
  return masses;
}

/// Scales masses for a density of 1 to a painted one, or back; their sum becomes the integral of the density exactly.
std::vector<double> massesFor(const Cage& cage, const std::vector<double>& before, const std::vector<double>& density) {
  std::vector<double> masses = cage.masses.empty() ? massesByVolume(cage) : cage.masses;
  const std::vector<double> material = materialOf(cage);
  const auto integral = [&](const std::vector<double>& ofTets) {
    double sum = 0.0;
    for (std::size_t t = 0; t < material.size(); ++t) sum += material[t] * (ofTets.empty() ? 1.0 : ofTets[t]);
    return sum;
  };
  const double wanted = sumOf(masses) * integral(density) / integral(before);
  const std::vector<double> oldOnes = before.empty() ? before : nodeMeans(cage, before);
  const std::vector<double> newOnes = density.empty() ? density : nodeMeans(cage, density);
  for (std::size_t n = 0; n < masses.size(); ++n) {
    if (!oldOnes.empty()) masses[n] /= oldOnes[n];
    if (!newOnes.empty()) masses[n] *= newOnes[n];
  }
  const double factor = wanted / sumOf(masses);
  for (double& mass : masses) mass *= factor;
  return masses;
}

Status check(const Cage& cage, const TriangleMesh& mesh) {
  const Status status = validate(cage);
  return status.ok() ? validate(mesh) : status;
}

}  // namespace

Status cage_detail::checkMaps(const TriangleMesh& mesh, const PaintedMaps& maps) {
  Status status;
  if (!maps.stiffness.empty()) status = checkMap(mesh, maps.stiffness, Range::Positive, "the stiffness map");
  if (status.ok() && !maps.density.empty()) status = checkMap(mesh, maps.density, Range::Positive, "the density map");
  if (status.ok() && !maps.damping.empty())
    status = checkMap(mesh, maps.damping, Range::NotNegative, "the damping map");
  return status;
}

Result<SpreadMap> spreadMap(const Cage& cage, const TriangleMesh& mesh, const std::vector<double>& values,
                            MapMean mean) {
  if (Status status = check(cage, mesh); !status.ok()) return status;
  if (Status status = checkMap(mesh, values, mean == MapMean::Geometric ? Range::Positive : Range::Any, "the map");
      !status.ok())
    return status;
  return spread(cage, mesh, values, mean);
}

Status paintCage(Cage& cage, const TriangleMesh& mesh, const PaintedMaps& maps) {
  if (Status status = check(cage, mesh); !status.ok()) return status;
  if (Status status = cage_detail::checkMaps(mesh, maps); !status.ok()) return status;
  std::vector<double> stiffness = cage.paintedStiffness, density = cage.paintedDensity, damping = cage.paintedDamping,
                      masses = cage.masses;
  if (!maps.stiffness.empty()) stiffness = factorsOf(cage, mesh, maps.stiffness, MapMean::Geometric);
  if (!maps.density.empty()) density = factorsOf(cage, mesh, maps.density, MapMean::Arithmetic);
  if (!maps.damping.empty()) damping = factorsOf(cage, mesh, maps.damping, MapMean::Arithmetic);
  if (!maps.density.empty() && !(density.empty() && cage.paintedDensity.empty()))
    masses = massesFor(cage, cage.paintedDensity, density);
  if (!std::all_of(masses.begin(), masses.end(), [](double mass) { return mass > 0.0 && std::isfinite(mass); })) {
    return {StatusCode::InvalidOption,
            "the density map gives a node a mass that double cannot hold; pass densities relative to that of the body"};
  }
  cage.paintedStiffness = std::move(stiffness);
  cage.paintedDensity = std::move(density);
  cage.paintedDamping = std::move(damping);
  cage.masses = std::move(masses);
  return {};
}

}  // namespace tetskin
