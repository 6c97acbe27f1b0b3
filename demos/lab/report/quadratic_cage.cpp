// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "report/quadratic_cage.h"

#include <tetskin/core/cage.h>
#include <tetskin/core/src/base/mesh/tet_geometry.h>
#include <tetskin/core/src/base/mesh/uniform_refinement.h>

#include <numeric>

#include "scenes/input_error.h"

namespace tetskin::report {
namespace {

constexpr std::size_t kCells = kFineTets / kSubTets;  ///< of one of the eight tets, whose volume fractions are known
/// Mass of the lightest node over the mean: nodes that lie outside of the mesh have hardly any.
constexpr double kMinMass = 1e-3;

/// The volume fraction of a cell of a tet of the refined cage.
double fractionOf(const Cage& coarse, std::size_t tet, std::size_t cell) {
  if (!coarse.fineVolumeFraction.empty()) return coarse.fineVolumeFraction[kCells * tet + cell] / 255.0;
  return coarse.volumeFraction.empty() ? 1.0 : coarse.volumeFraction[tet / kSubTets];
}

void refineFractions(const Cage& coarse, Cage& cage) {
  const bool fine = !coarse.fineVolumeFraction.empty();
  for (std::size_t t = 0; t < cage.mesh.tetCount(); ++t) {
    double sum = 0.0;
    for (std::size_t cell = 0; cell < kCells; ++cell) {
      sum += fractionOf(coarse, t, cell);
      if (fine)
        cage.fineVolumeFraction.insert(cage.fineVolumeFraction.end(), kSubTets,
                                       coarse.fineVolumeFraction[kCells * t + cell]);
    }
    cage.volumeFraction.push_back(sum / kCells);
  }
}

/// By the weights of its centroid, each cell's mass goes to the nodes of its tet: that keeps the centre of mass.
std::vector<double> massesOf(const Cage& coarse, const Cage& cage) {
  std::vector<double> masses(cage.mesh.nodeCount(), 0.0);
  for (std::size_t t = 0; t < cage.mesh.tetCount(); ++t) {
    const TetCorners corners = cornersOf(cage.mesh, cage.mesh.tets[t]);
    const BarycentricMap weightsOf(corners);
    const double volume = std::abs(signedVolume(corners)) / kCells;
    const double density = coarse.paintedDensity.empty() ? 1.0 : coarse.paintedDensity[t / kSubTets];
    std::size_t cell = 0;
    for (const TetCorners& small : refinedTet(corners)) {
      const Eigen::Vector4d weights = weightsOf(0.25 * (small[0] + small[1] + small[2] + small[3]));
      const double mass = density * volume * fractionOf(coarse, t, cell++);
      for (int k = 0; k < 4; ++k) masses[cage.mesh.tets[t][k]] += mass * weights[k];
    }
  }
  const double whole = std::accumulate(coarse.masses.begin(), coarse.masses.end(), 0.0);
  const double least = kMinMass * whole / static_cast<double>(masses.size());
  const double found = std::accumulate(masses.begin(), masses.end(), 0.0);
  for (double& mass : masses) mass = std::max(least, mass * whole / found);
  return masses;
}

/// Which of the eight tets of a tet holds a point in it.
int holderOf(const Cage& cage, int tet, const Eigen::Vector3d& point) {
  int best = -1;
  double most = 0.0;
  for (int t = kSubTets * tet; t < static_cast<int>(kSubTets) * (tet + 1); ++t) {
    const double inside = BarycentricMap(cornersOf(cage.mesh, cage.mesh.tets[t]))(point).minCoeff();
    if (best >= 0 && inside <= most) continue;
    best = t;
    most = inside;
  }
  return best;
}

}  // namespace

Cage quadraticCage(const Cage& coarse, const TriangleMesh& mesh) {
  // Only the mesh: for a cage, duplicate elements are refused, and masses are less exact than these.
  Result<Cage> made = refineQuadratic(coarse.mesh);
  scenes::require(made.status());
  Cage cage = std::move(made).value();
  if (!coarse.volumeFraction.empty()) refineFractions(coarse, cage);
  if (!coarse.masses.empty()) cage.masses = massesOf(coarse, cage);
  for (std::size_t v = 0; v < coarse.vertexTets.size(); ++v)
    cage.vertexTets.push_back(holderOf(cage, coarse.vertexTets[v], mesh.positions[v]));
  for (std::size_t t = 0; t < coarse.mesh.tetCount(); ++t) {
    for (int k = 0; k < static_cast<int>(kSubTets); ++k) {
      if (!coarse.component.empty()) cage.component.push_back(coarse.component[t]);
      if (!coarse.sourceTet.empty()) cage.sourceTet.push_back(static_cast<int>(kSubTets) * coarse.sourceTet[t] + k);
      if (!coarse.paintedStiffness.empty()) cage.paintedStiffness.push_back(coarse.paintedStiffness[t]);
      if (!coarse.paintedDensity.empty()) cage.paintedDensity.push_back(coarse.paintedDensity[t]);
      if (!coarse.paintedDamping.empty()) cage.paintedDamping.push_back(coarse.paintedDamping[t]);
      if (!coarse.stiffnessFactor.empty()) cage.stiffnessFactor.push_back(coarse.stiffnessFactor[t]);
    }
  }
  cage.meshHash = coarse.meshHash;
  return cage;
}

}  // namespace tetskin::report
