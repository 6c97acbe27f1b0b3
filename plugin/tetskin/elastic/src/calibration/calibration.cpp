// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// This work is based on:
//   Lewis Fry Richardson, "The Deferred Approach to the Limit", Phil. Trans. A 226, 1927 (the extrapolation)
#include <tetskin/core/src/base/mesh/mesh_checks.h>
#include <tetskin/elastic/calibration.h>
#include <tetskin/elastic/src/calibration/refined_bodies.h>

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cmath>
#include <iomanip>
#include <sstream>

namespace tetskin {
namespace {

using elastic_detail::Fields;
using elastic_detail::RefinedBodies;

/// Quotient of the changes from one refinement to the next: 4 is order 2, that of linear tets; 2 is order 1. Coarse
/// cages are not yet near their limit, and change by less than that at first.
constexpr double kMinQuotient = 2.0, kMaxQuotient = 4.0;
/// Response of a vibration relative to its limit, below which the refinements cannot represent the vibration.
constexpr double kMinResponse = 0.1;

Status check(const Cage& cage, const CalibrationOptions& options) {
  if (!(options.poissonRatio >= 0.0 && options.poissonRatio < 0.5) || options.modeCount < 1) {
    return {StatusCode::InvalidOption,
            "calibration needs a Poisson's ratio of at least 0 and below 0.5, and at least one mode"};
  }
  const TetMeshReport report = inspectForUse(cage.mesh);
  if (Status status = validate(cage.mesh, report); !status.ok()) return status;
  if (report.zeroVolume.count + report.repeatedNode.count > 0) {
    return {StatusCode::Degenerate, "a cage with flat tets has no stiffness; remove them"};
  }
  return validateAttributes(cage);
}

int refinementsFor(std::size_t tets) {
  int refinements = 2;
  for (std::size_t refined = kFineTets * tets; refinements > 0 && refined > Limits::kMaxRefinedTets; refined /= 8)
    --refinements;
  return refinements;
}

/// The cage without nodes that no tet uses, which would have no mass, and without stiffness factors.
Cage used(const Cage& cage) {
  std::vector<int> number(cage.mesh.nodeCount(), -1);
  Cage result;
  for (const Tet& tet : cage.mesh.tets) {
    Tet& copy = result.mesh.tets.emplace_back();
    for (int k = 0; k < 4; ++k) {
      int& n = number[tet[k]];
      if (n < 0) {
        n = static_cast<int>(result.mesh.nodeCount());
        result.mesh.nodes.push_back(cage.mesh.nodes[tet[k]]);
        if (!cage.masses.empty()) result.masses.push_back(cage.masses[tet[k]]);
      }
      copy[k] = n;
    }
  }
  result.volumeFraction = cage.volumeFraction;
  result.fineVolumeFraction = cage.fineVolumeFraction;
  return result;
}

/// By level and vibration of the coarsest level: the displacement that the vibration's accelerations cause, projected
/// to that vibration. Each level has its own lumped masses: those of coarse bodies are farther out and slow rotations
/// down, as a softer material would; calibration must not include that effect twice.
std::vector<Eigen::RowVectorXd> responsesTo(const RefinedBodies& bodies, Fields modes) {
  std::vector<Eigen::RowVectorXd> responses;
  Fields displacements;
  for (std::size_t level = 0; level < bodies.levelCount(); ++level) {
    if (level > 0) {
      modes = bodies.refined(level - 1, modes);
      displacements = bodies.refined(level - 1, displacements);
    }
    Fields loads = bodies.masses(level).asDiagonal() * modes;
    bodies.balance(level, loads);
    displacements = level == 0 ? bodies.direct().solve(loads) : bodies.solve(level, loads, displacements);
    responses.push_back(loads.cwiseProduct(displacements).colwise().sum().array() /
                        loads.cwiseProduct(modes).colwise().sum().array());
  }
  return responses;
}

/// The limit of a vibration's responses under refinement.
double limitOf(const std::vector<Eigen::RowVectorXd>& responses, Eigen::Index mode) {
  assert(responses.size() >= 2 && mode < responses.front().size());
  const std::size_t last = responses.size() - 1;
  const double change = responses[last][mode] - responses[last - 1][mode];
  double quotient = kMaxQuotient;
  if (last >= 2 && change > 0.0) {
    quotient = std::clamp((responses[last - 1][mode] - responses[last - 2][mode]) / change, kMinQuotient, kMaxQuotient);
  }
  return responses[last][mode] + std::max(change, 0.0) / (quotient - 1.0);
}

/// Share of the mass that takes part in a vibration: 1 where all of it moves alike, 1/N where one node of N moves.
double participation(const Eigen::VectorXd& mode, const Eigen::VectorXd& masses) {
  assert(mode.size() == masses.size() && mode.size() % 3 == 0);
  double second = 0.0, fourth = 0.0, mass = 0.0;
  for (Eigen::Index n = 0; n < mode.size(); n += 3) {
    const double squared = mode.segment<3>(n).squaredNorm();
    second += masses[n] * squared;
    fourth += masses[n] * squared * squared;
    mass += masses[n];
  }
  return second * second / (mass * fourth);
}

/// Summarises the results of all vibrations.
void summarise(const RefinedBodies& bodies, const Eigen::MatrixXd& modes, CalibrationReport& report) {
  assert(modes.rows() == bodies.masses(0).size());
  const std::vector<Eigen::RowVectorXd> responses = responsesTo(bodies, modes);
  report.responses.assign(responses.size(), 0.0);
  std::vector<std::array<double, 2>> seen;  // weight, and response of the cage relative to its limit
  double limits = 0.0;
  for (Eigen::Index k = 0; k < modes.cols(); ++k) {
    const double limit = limitOf(responses, k);
    // For parts that rotate freely about a node or an edge, rounding alone determines the responses and their signs.
    if (!(limit > 0.0 && responses.front()[k] > kMinResponse * limit)) {
      ++report.skippedModes;
      continue;
    }
    const double weight = participation(modes.col(k), bodies.masses(0));
    for (std::size_t level = 0; level < responses.size(); ++level) {
      report.responses[level] += weight * responses[level][k];
    }
    limits += weight * limit;
    seen.push_back({weight * limit, responses.front()[k] / limit});
  }
  if (seen.empty()) {
    report.responses.assign(responses.size(), 1.0);
    return;
  }
  for (double& response : report.responses) response /= limits;
  report.stiffnessFactor = std::min(report.responses.front(), 1.0);
  double squared = 0.0;
  for (const auto& [weight, response] : seen)
    squared += weight / limits * std::pow(response / report.stiffnessFactor - 1.0, 2);
  report.remainingError = std::hypot(std::sqrt(squared), 0.5 * std::max(0.0, 1.0 - report.responses.back()));
}

}  // namespace

std::string CalibrationReport::describe() const {
  std::ostringstream text;
  if (refinements == 0) {
    text << "not calibrated: the cage has more tets than can be refined; the stiffness is not scaled\n";
  } else {
    text << "stiffness scaled by " << std::setprecision(2) << stiffnessFactor << " (" << refinements
         << (refinements == 1 ? " refinement" : " refinements") << ", the finest with " << refinedTets
         << " tets); estimated remaining error " << std::lround(100.0 * remainingError)
         << " % of a displacement, less with more tets\n"
         << std::setprecision(6);
  }
  if (skippedModes > 0) text << skippedModes << " vibrations of loosely connected components were left out\n";
  text << milliseconds << " ms\n";
  return text.str();
}

Result<CalibrationReport> calibrate(Cage& cage, const CalibrationOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  if (Status status = check(cage, options); !status.ok()) return status;
  CalibrationReport report;
  report.refinements = refinementsFor(cage.mesh.tetCount());
  report.refinedTets = cage.mesh.tetCount() << 3 * report.refinements;
  if (report.refinements > 0) {
    const RefinedBodies bodies(used(cage), options.poissonRatio, report.refinements);
    if (!bodies.ok()) {
      return Status{StatusCode::Degenerate,
                    "the stiffness matrix of the cage cannot be factorised; are there nearly flat tets?"};
    }
    summarise(bodies, softestModes(bodies.coarsest(), bodies.direct(), options.modeCount), report);
  }
  cage.stiffnessFactor.assign(cage.mesh.tetCount(), report.stiffnessFactor);
  report.milliseconds = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  return report;
}

}  // namespace tetskin
