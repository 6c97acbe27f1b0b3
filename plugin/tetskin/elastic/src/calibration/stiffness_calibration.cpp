// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// This work is based on:
//   Lewis Fry Richardson, "The Deferred Approach to the Limit", Phil. Trans. A 226, 1927 (the extrapolation)
#include <tetskin/elastic/src/calibration/refined_bodies.h>
#include <tetskin/elastic/stiffness_calibration.h>

#include <algorithm>
#include <chrono>

namespace tetskin {
namespace {

using elastic_detail::ElasticBody;
using elastic_detail::RefinedBodies;

/// Quotient of the changes from one refinement to the next: 4 is order 2, that of linear tets; 2 is order 1. Coarse
/// cages are not yet near their limit, and change by less than that at first.
constexpr double kLeastQuotient = 2.0, kMostQuotient = 4.0;

Status check(const TetMesh& cage, const CalibrationOptions& options) {
  if (!(options.poissonRatio >= 0.0 && options.poissonRatio < 0.5) || options.modes < 1 || options.refinements < 1) {
    return {StatusCode::InvalidOption,
            "a calibration needs a Poisson ratio from 0 to below 0.5, one mode and one refinement at least"};
  }
  const TetMeshReport report = checkForUse(cage);
  if (Status status = usable(cage, report); !status.ok()) return status;
  if (report.zeroVolume.count + report.repeatedNode.count > 0) {
    return {StatusCode::Degenerate, "a cage with flat tets has no stiffness; remove them"};
  }
  return {};
}

/// The mesh without the nodes that no tet uses: they would have no mass.
TetMesh used(const TetMesh& cage) {
  std::vector<int> number(cage.nodeCount(), -1);
  TetMesh result;
  for (const Tet& tet : cage.tets) {
    Tet& copy = result.tets.emplace_back();
    for (int k = 0; k < 4; ++k) {
      int& n = number[tet[k]];
      if (n < 0) {
        n = static_cast<int>(result.nodeCount());
        result.nodes.push_back(cage.nodes[tet[k]]);
      }
      copy[k] = n;
    }
  }
  return result;
}

/// How far every level moves under the accelerations of a vibration of the coarsest, along that vibration. Each with
/// its own lumped masses: those of coarse bodies lie farther out and slow turning motions, as softness would; what they
/// do already must not be done again.
std::vector<double> responsesTo(const RefinedBodies& bodies, Eigen::VectorXd mode) {
  std::vector<double> responses;
  Eigen::VectorXd displacement;
  for (std::size_t level = 0; level < bodies.levelCount(); ++level) {
    const ElasticBody& body = bodies.body(level);
    if (level > 0) {
      mode = bodies.refined(level - 1, mode);
      displacement = bodies.refined(level - 1, displacement);
    }
    Eigen::VectorXd load = mode.cwiseProduct(body.masses);
    body.rigid.balance(load);
    displacement = level == 0 ? bodies.direct().solve(load) : bodies.solve(level, load, displacement);
    responses.push_back(load.dot(displacement) / load.dot(mode));
  }
  return responses;
}

/// Their limit under refinement.
double limitOf(const std::vector<double>& responses) {
  const std::size_t last = responses.size() - 1;
  const double change = responses[last] - responses[last - 1];
  double quotient = kMostQuotient;
  if (last >= 2 && change > 0.0) {
    quotient = std::clamp((responses[last - 1] - responses[last - 2]) / change, kLeastQuotient, kMostQuotient);
  }
  return responses[last] + std::max(change, 0.0) / (quotient - 1.0);
}

/// Share of the mass that takes part in a vibration: 1 where all of it moves alike, 1/N where one node of N moves.
double participation(const Eigen::VectorXd& mode, const Eigen::VectorXd& masses) {
  double second = 0.0, fourth = 0.0, mass = 0.0;
  for (Eigen::Index n = 0; n < mode.size(); n += 3) {
    const double squared = mode.segment<3>(n).squaredNorm();
    second += masses[n] * squared;
    fourth += masses[n] * squared * squared;
    mass += masses[n];
  }
  return second * second / (mass * fourth);
}

}  // namespace

Result<StiffnessCalibration> calibrateStiffness(const TetMesh& cage, const CalibrationOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  if (Status status = check(cage, options); !status.ok()) return status;
  const RefinedBodies bodies(used(cage), options.poissonRatio, options.refinements);
  if (!bodies.ok())
    return Status{StatusCode::Degenerate, "the cage's stiffness cannot be factorised; are tets nearly flat?"};
  const Eigen::MatrixXd modes = softestModes(bodies.body(0), bodies.direct(), options.modes);
  StiffnessCalibration result;
  result.responses.assign(bodies.levelCount(), 0.0);
  double limits = 0.0;
  for (Eigen::Index k = 0; k < modes.cols(); ++k) {
    const std::vector<double> responses = responsesTo(bodies, modes.col(k));
    const double weight = participation(modes.col(k), bodies.body(0).masses);
    for (std::size_t level = 0; level < responses.size(); ++level) result.responses[level] += weight * responses[level];
    limits += weight * limitOf(responses);
  }
  for (double& response : result.responses) response /= limits;
  result.factor = std::min(result.responses.front(), 1.0);
  result.milliseconds = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  return result;
}

}  // namespace tetskin
