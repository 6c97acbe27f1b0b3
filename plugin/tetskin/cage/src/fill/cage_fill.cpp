// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/cage/src/fill/cage_fill.h>
#include <tetskin/core/cage.h>
#include <tetskin/core/src/base/mesh/tet_geometry.h>
#include <tetskin/core/src/base/mesh/tets_around_nodes.h>
#include <tetskin/core/src/base/mesh/uniform_refinement.h>
#include <tetskin/core/src/base/progress.h>

#include <algorithm>
#include <cassert>
#include <utility>

namespace tetskin::cage_detail {
namespace {

/// A full tet, in the unit of `Cage::fineVolumeFraction`.
constexpr int kFull = 255;
/// Mass of the lightest node, relative to the mean. Mass added to reach it is not where the mesh's mass is: with a
/// fifth, the load of thin ends makes the error of the serpent's sag half as large again.
constexpr double kMinNodeMass = 0.1;
/// Number of rounds in which light nodes take mass from their neighbours, and the fraction of a node's surplus that
/// each may take, because others may take some, too.
constexpr int kMassRounds = 20;
constexpr double kMaxDrawn = 0.1;
/// Number of small tets per tet in one refinement.
constexpr std::size_t kEighths = 8;
/// Samples of a small tet: one near each of its corners, for a quarter of its volume.
constexpr double kNear = 0.55, kFar = 0.15;

class FillSampler {
 public:
  FillSampler(const CageTets& cage, const LatticeFrame& frame, const LatticeSet& set, const LatticeMesh& lattice)
      : cage_(cage), frame_(frame), set_(set), lattice_(lattice) {
    assert(cage.latticeTets.size() == cage.mesh.tetCount());
    inLatticeTet_ = packLists(lattice.mesh.tetCount(), [&](auto&& add) {
      for (std::uint32_t t = 0; t < cage.mesh.tetCount(); ++t) {
        add(static_cast<std::size_t>(cage.latticeTets[t]), t);
      }
    });
  }

  /// Volume fraction in 255ths.
  std::uint8_t fillOf(std::size_t tet, const TetCorners& small) const {
    const Eigen::Vector3d far = kFar * (small[0] + small[1] + small[2] + small[3]);
    int found = 0;
    for (const Eigen::Vector3d& corner : small) found += isMaterial(tet, far + (kNear - kFar) * corner);
    return static_cast<std::uint8_t>((kFull * found + 2) / 4);
  }

 private:
  bool isMaterial(std::size_t tet, const Eigen::Vector3d& p) const {
    const CellPosition position = locateCell(frame_.toLattice(p));
    const int home = lattice_.indexOf(set_, position.tet);
    if (home < 0) return false;
    for (std::uint32_t k = inLatticeTet_.starts[home]; k < inLatticeTet_.starts[home + 1]; ++k) {
      const std::uint32_t other = inLatticeTet_.values[k];
      if ((cage_.cells[other] >> position.cell & 1) != 0) return goesWith(tet, other);
    }
    return false;
  }

  /// True if the two tets share a node: fitting moves a tet over the material of its neighbours.
  bool goesWith(std::size_t tet, std::size_t other) const {
    return shareNode(cage_.mesh.tets[tet], cage_.mesh.tets[other]);
  }

  const CageTets& cage_;
  const LatticeFrame& frame_;
  const LatticeSet& set_;
  const LatticeMesh& lattice_;
  Lists<> inLatticeTet_;
};

double roughFill(const FillSampler& sampler, std::size_t tet, const TetCorners& corners) {
  int sum = 0;
  for (const TetCorners& eighth : refinedTet(corners)) sum += sampler.fillOf(tet, eighth);
  return static_cast<double>(sum) / (kFull * static_cast<double>(kEighths));
}

/// Computes and stores the volume fractions of the tet's small tets.
double fineFill(const FillSampler& sampler, std::size_t tet, const TetCorners& corners, std::uint8_t* fine) {
  int sum = 0;
  for (const TetCorners& eighth : refinedTet(corners)) {
    for (const TetCorners& small : refinedTet(eighth)) {
      *fine = sampler.fillOf(tet, small);
      sum += *fine++;
    }
  }
  return static_cast<double>(sum) / (kFull * static_cast<double>(kFineTets));
}

/// True for tets whose nodes are in full tets only: these stay full wherever fitting moves the nodes.
std::vector<char> deepTets(const CageTets& cage) {
  std::vector<char> full(cage.mesh.nodeCount(), 1), deep(cage.mesh.tetCount(), 1);
  for (std::size_t t = 0; t < deep.size(); ++t) {
    if (cage.cells[t] == kAllCells && cage.openFaces[t] == 0) continue;
    for (const int n : cage.mesh.tets[t]) full[n] = 0;
  }
  for (std::size_t t = 0; t < deep.size(); ++t) {
    for (const int n : cage.mesh.tets[t]) deep[t] = static_cast<char>(deep[t] & full[n]);
  }
  return deep;
}

/// Light nodes take the mass that they lack from their neighbours, in proportion to the neighbours' surplus.
void drawFromNeighbours(const std::vector<std::array<int, 2>>& edges, double minimum, std::vector<double>& masses) {
  assert(minimum >= 0.0);
  std::vector<double> spare(masses.size(), 0.0);  // sum around each node
  for (const auto& [a, b] : edges) {
    spare[a] += std::max(masses[b] - minimum, 0.0);
    spare[b] += std::max(masses[a] - minimum, 0.0);
  }
  std::vector<double> change(masses.size(), 0.0);
  for (const auto& [a, b] : edges) {
    for (const auto& [light, heavy] : {std::array<int, 2>{a, b}, std::array<int, 2>{b, a}}) {
      const double missing = minimum - masses[light], has = masses[heavy] - minimum;
      if (!(missing > 0.0 && has > 0.0)) continue;
      const double given = has * std::min(missing / spare[light], kMaxDrawn);
      change[light] += given;
      change[heavy] -= given;
    }
  }
  for (std::size_t n = 0; n < masses.size(); ++n) masses[n] += change[n];
}

/// Raises values below the bound, and lowers all values above it to compensate.
void keepAtLeast(double minimum, std::vector<double>& masses) {
  assert(!masses.empty() && minimum >= 0.0);
  for (bool changed = true; changed;) {
    changed = false;
    double missing = 0.0, spare = 0.0;
    for (double& mass : masses) {
      if (mass < minimum) missing += minimum - std::exchange(mass, minimum);
      spare += mass - minimum;
    }
    if (!(missing > 0.0 && spare > missing)) return;
    for (double& mass : masses) {
      mass -= (mass - minimum) * (missing / spare);
      changed |= mass < minimum;
    }
  }
}

}  // namespace

CageFill fillOf(const CageTets& cage, const LatticeFrame& frame, const LatticeSet& set, const LatticeMesh& lattice) {
  assert(cage.cells.size() == cage.mesh.tetCount() && cage.openFaces.size() == cage.cells.size());
  const FillSampler sampler(cage, frame, set, lattice);
  const std::vector<char> deep = deepTets(cage);
  CageFill result;
  result.fill.assign(cage.mesh.tetCount(), 1.0);
  if (kEighths * cage.mesh.tetCount() <= Limits::kMaxRefinedTets)
    result.fine.assign(kFineTets * cage.mesh.tetCount(), kFull);
  for (std::size_t t = 0; t < result.fill.size(); ++t) {
    Progress::goOn(t);
    if (deep[t]) continue;
    const TetCorners corners = cornersOf(cage.mesh, cage.mesh.tets[t]);
    if (result.fine.empty()) {
      result.fill[t] = roughFill(sampler, t, corners);
    } else {
      result.fill[t] = fineFill(sampler, t, corners, &result.fine[kFineTets * t]);
    }
  }
  return result;
}

std::vector<double> nodeMasses(const TetMesh& mesh, const std::vector<double>& fill, double volume) {
  assert(fill.empty() || fill.size() == mesh.tetCount());
  std::vector<double> masses(mesh.nodeCount(), 0.0);
  double sum = 0.0;
  for (std::size_t t = 0; t < mesh.tetCount(); ++t) {
    Progress::goOn(t);
    const double filled = (fill.empty() ? 1.0 : fill[t]) * std::abs(signedVolume(cornersOf(mesh, mesh.tets[t])));
    for (const int n : mesh.tets[t]) masses[n] += 0.25 * filled;
    sum += filled;
  }
  if (!fill.empty() && !(sum > 0.0)) return nodeMasses(mesh, {}, volume);
  assert(sum > 0.0 && volume > 0.0);
  for (double& mass : masses) mass *= volume / sum;
  const double minimum = kMinNodeMass * volume / static_cast<double>(masses.size());
  const auto edges = uniqueEdges(mesh);
  for (int round = 0; round < kMassRounds; ++round) drawFromNeighbours(edges, minimum, masses);
  keepAtLeast(minimum, masses);
  return masses;
}

}  // namespace tetskin::cage_detail
