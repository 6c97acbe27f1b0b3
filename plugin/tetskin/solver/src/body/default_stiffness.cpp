// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/median.h>
#include <tetskin/core/src/base/mesh/tet_geometry.h>
#include <tetskin/solver/src/body/default_stiffness.h>
#include <tetskin/solver/src/forces/elastic_force.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <utility>

namespace tetskin::bullet_detail {
namespace {

/// Largest median of (time step x natural frequency of a node)^2 for a default stiffness. Elastic forces are explicit;
/// above 4 only the implicit damping keeps them stable. In free motion it does so at any stiffness; in a hard landing
/// of thin parts it fails between 15 and 30 (measured with cages of 300 to 30,000 tets).
constexpr double kStableFrequency = 8.0;

/// Median over the nodes of the squared natural frequency for a Young's modulus of 1: the stiffness of the node's tets
/// with its neighbours pinned, divided by its mass.
double medianSquaredFrequency(const TetMesh& cage, const SoftBodyOptions& options, const std::vector<double>& masses) {
  assert(masses.size() == cage.nodeCount());
  const elastic_detail::Lame unit = elastic_detail::lameOf(1.0, options.poissonRatio);
  std::vector<double> stiffness(cage.nodeCount(), 0.0);
  for (std::size_t t = 0; t < cage.tetCount(); ++t) {
    const Tet& tet = cage.tets[t];
    const TetCorners corners = cornersOf(cage, tet);
    const Eigen::Vector4d gradients = BarycentricMap(corners).gradientLengths();
    const double scale = options.stiffnessScale.empty() ? 1.0 : options.stiffnessScale[t];
    const double modulus = scale * (unit.lambda + 2.0 * unit.mu) * std::abs(signedVolume(corners));
    for (int k = 0; k < 4; ++k) stiffness[tet[k]] += modulus * gradients[k] * gradients[k];
  }
  for (std::size_t n = 0; n < masses.size(); ++n) stiffness[n] /= masses[n];
  return median(std::move(stiffness));
}

/// Volume of the material. A cage's masses are those of a density of 1, unless a density is painted.
double materialVolume(const Cage& cage) {
  if (cage.paintedDensity.empty() && !cage.masses.empty())
    return std::accumulate(cage.masses.begin(), cage.masses.end(), 0.0);
  double filled = 0.0;
  for (std::size_t t = 0; t < cage.volumeFraction.size(); ++t)
    filled += cage.volumeFraction[t] * std::abs(signedVolume(cornersOf(cage.mesh, cage.mesh.tets[t])));
  return !cage.masses.empty() && filled > 0.0 ? filled : totalVolume(cage.mesh);
}

}  // namespace

double weightPressure(const Cage& cage, const std::vector<double>& masses, double gravity) {
  assert(masses.size() == cage.mesh.nodeCount());
  const double density = std::accumulate(masses.begin(), masses.end(), 0.0) / materialVolume(cage);
  // Without gravity nothing sags; the earth's gravity then sets the scale.
  constexpr double kEarth = 9.81;
  return density * (gravity > 0.0 ? gravity : kEarth) * boundingBox(cage.mesh.nodes).sizes().maxCoeff();
}

double defaultYoungsModulus(const TetMesh& cage, const SoftBodyOptions& options, const std::vector<double>& masses,
                            double pressure, bool bounded) {
  const double wanted = options.relativeStiffness * pressure;
  if (!bounded) return wanted;
  const double frequency = medianSquaredFrequency(cage, options, masses);
  return std::min(wanted, kStableFrequency / (options.timeStep * options.timeStep * frequency));
}

}  // namespace tetskin::bullet_detail
