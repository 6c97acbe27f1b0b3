// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/disjoint_sets.h>
#include <tetskin/core/src/base/mesh/mesh_checks.h>
#include <tetskin/core/src/base/positive_values.h>
#include <tetskin/elastic/src/modes/softest_vibrations.h>
#include <tetskin/elastic/vibration_modes.h>

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cmath>

namespace tetskin {
namespace {

using elastic_detail::BlockRows;
using elastic_detail::Fields;
using elastic_detail::VibrationProblem;
using elastic_detail::Vibrations;

/// Relative to a body's largest eigenvalue: a smaller eigenvalue belongs to a motion that nothing resists.
constexpr double kNoStiffness = 1e-13;

Status invalid(std::string message) {
  return {StatusCode::InvalidOption, std::move(message)};
}

/// Ok if all nodes are in tets and belong to one component.
Status checkComponents(const TetMesh& tets) {
  DisjointSets sets(tets.nodeCount());
  std::vector<char> used(tets.nodeCount(), 0);
  for (const Tet& tet : tets.tets) {
    for (const int node : tet) {
      used[node] = 1;
      sets.unite(tet[0], node);
    }
  }
  std::size_t components = 0, unused = 0;
  for (std::size_t n = 0; n < tets.nodeCount(); ++n) {
    if (!used[n]) ++unused;
    if (used[n] && sets.find(static_cast<int>(n)) == static_cast<int>(n)) ++components;
  }
  if (unused > 0) {
    return {StatusCode::Degenerate,
            std::to_string(unused) + " nodes are in no tet and would have no mass; remove them"};
  }
  if (components == 1) return {};
  return {StatusCode::Degenerate,
          "the tets form " + std::to_string(components) +
              " components that are not connected; a reduced body must be one: compute the modes of "
              "each component separately"};
}

Status checkTets(const TetMesh& tets) {
  const TetMeshReport report = inspectForUse(tets);
  if (Status status = validate(tets, report); !status.ok()) return status;
  const TetMeshReport::Fault& flat = report.zeroVolume.count > 0 ? report.zeroVolume : report.repeatedNode;
  if (flat.count > 0) {
    return {StatusCode::Degenerate, std::to_string(report.zeroVolume.count + report.repeatedNode.count) +
                                        " tets are flat and have no stiffness, the first of them tet " +
                                        std::to_string(flat.first) + "; remove them"};
  }
  return checkComponents(tets);
}

/// free  by node; set if the options are valid
Status checkVibrationOptions(const TetMesh& tets, const VibrationOptions& options, std::vector<char>& free) {
  if (options.modeCount < 1) return invalid("the number of modes must be at least 1");
  if (!(options.poissonRatio >= 0.0 && options.poissonRatio < 0.5)) {
    return invalid("Poisson's ratio must be at least 0 and below 0.5");
  }
  for (Status status : {checkPositive<double>(options.stiffnessScale, tets.tetCount(), "stiffnessScale", "tet"),
                        checkPositive<double>(options.nodeMasses, tets.nodeCount(), "nodeMasses", "node")}) {
    if (!status.ok()) return status;
  }
  free.assign(tets.nodeCount(), 1);
  for (const int node : options.pinned) {
    if (node < 0 || static_cast<std::size_t>(node) >= tets.nodeCount()) {
      return {StatusCode::IndexOutOfRange, "pinned node " + std::to_string(node) + " does not exist"};
    }
    free[node] = 0;
  }
  const auto freeNodes = static_cast<std::size_t>(std::count(free.begin(), free.end(), 1));
  if (freeNodes == 0) return invalid("all nodes are pinned; at least one must be free");
  if (static_cast<std::size_t>(options.modeCount) > freeNodes) {
    return invalid(std::to_string(options.modeCount) + " modes are more than the " + std::to_string(freeNodes) +
                   " free nodes; request fewer modes, or use more tets");
  }
  return {};
}

std::vector<double> massesOf(const Cage& cage, const VibrationOptions& options) {
  const TetMesh& tets = cage.mesh;
  if (!options.nodeMasses.empty()) return options.nodeMasses;
  if (!cage.masses.empty()) return cage.masses;
  const Eigen::VectorXd lumped = elastic_detail::lumpedVolumes(tets, std::vector<double>(tets.tetCount(), 1.0));
  std::vector<double> masses(tets.nodeCount());
  for (std::size_t n = 0; n < masses.size(); ++n) masses[n] = lumped[static_cast<Eigen::Index>(3 * n)];
  return masses;
}

/// The sign is chosen so that the largest component is positive, which makes it independent of how the vector was
/// found.
std::vector<double> shapeOf(const Fields& displacements, Eigen::Index mode) {
  assert(mode < displacements.cols());
  const Eigen::VectorXd shape = displacements.col(mode);
  // The first component that is about as large as the largest: symmetric bodies have several, of either sign.
  const double maximum = shape.cwiseAbs().maxCoeff();
  Eigen::Index first = 0;
  while (std::abs(shape[first]) < 0.999 * maximum) ++first;
  const double sign = shape[first] < 0.0 ? -1.0 : 1.0;
  std::vector<double> result(static_cast<std::size_t>(shape.size()));
  for (std::size_t k = 0; k < result.size(); ++k) result[k] = sign * shape[static_cast<Eigen::Index>(k)];
  return result;
}

}  // namespace

Result<VibrationModes> computeVibrationModes(const Cage& cage, const VibrationOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  const TetMesh& tets = cage.mesh;
  std::vector<char> free;
  if (Status status = checkTets(tets); !status.ok()) return status;
  if (Status status = validateAttributes(cage); !status.ok()) return status;
  if (Status status = checkVibrationOptions(tets, options, free); !status.ok()) return status;
  VibrationModes modes;
  modes.nodes = tets.nodes;
  modes.masses = massesOf(cage, options);
  modes.poissonRatio = options.poissonRatio;
  for (std::size_t n = 0; n < free.size(); ++n) {
    if (!free[n]) modes.pinned.push_back(static_cast<int>(n));
  }
  const VibrationProblem problem(tets, BlockRows(cage, options.poissonRatio, options.stiffnessScale), modes.masses,
                                 free);
  const Status hinged = {StatusCode::Degenerate,
                         "the body can deform without resistance: components of it share only a node or an edge, or "
                         "too few nodes are pinned"};
  if (!problem.ok()) return hinged;
  const Vibrations found = softestVibrations(problem, options.modeCount, options.progress);
  if (!(found.eigenvalues[0] > kNoStiffness * problem.largestFrequency())) return hinged;
  if (!found.converged) {
    return Status{StatusCode::Degenerate,
                  "the modes did not converge in " + std::to_string(found.iterations) +
                      " iterations; the tets are badly shaped, or their stiffnesses differ too much"};
  }
  modes.eigenvalues.assign(found.eigenvalues.data(), found.eigenvalues.data() + found.eigenvalues.size());
  const Fields displacements = problem.displacements(found.vectors);
  for (Eigen::Index k = 0; k < displacements.cols(); ++k) modes.shapes.push_back(shapeOf(displacements, k));
  modes.iterations = found.iterations;
  modes.milliseconds = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
  return modes;
}

std::vector<double> VibrationModes::frequencies(double youngsModulus, double density) const {
  std::vector<double> result;
  for (const double value : eigenvalues) result.push_back(std::sqrt(value * youngsModulus / density));
  return result;
}

}  // namespace tetskin
