// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/mesh/mesh_checks.h>
#include <tetskin/core/src/base/progress.h>
#include <tetskin/elastic/calibration.h>
#include <tetskin/elastic/src/calibration/stiffness_fit.h>

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cmath>
#include <iomanip>
#include <numeric>
#include <sstream>

namespace tetskin {
namespace {

using elastic_detail::RefinedBodies;
using elastic_detail::StiffnessFit;

/// Approximate fraction of the time after which the refinements are ready.
constexpr double kBodiesDone = 0.2;

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

/// The cage without unused nodes, which would have no mass, and without stiffness factors.
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
  result.paintedStiffness = cage.paintedStiffness;
  result.paintedDensity = cage.paintedDensity;
  result.paintedDamping = cage.paintedDamping;
  result.volumeFraction = cage.volumeFraction;
  result.fineVolumeFraction = cage.fineVolumeFraction;
  result.quadraticTet = cage.quadraticTet;
  return result;
}

/// True if all tets are quadratic and full: such a cage is hardly stiffer than its refinements.
bool isQuadraticAndFull(const Cage& cage) {
  const auto in = [](int number) { return number >= 0; };
  const auto full = [](double fraction) { return fraction == 1.0; };
  return !cage.quadraticTet.empty() && std::all_of(cage.quadraticTet.begin(), cage.quadraticTet.end(), in) &&
         std::all_of(cage.volumeFraction.begin(), cage.volumeFraction.end(), full);
}

void report(const StiffnessFit& fit, CalibrationReport& report) {
  const std::vector<double>& factors = fit.factors();
  const auto [least, greatest] = std::minmax_element(factors.begin(), factors.end());
  report.leastFactor = *least;
  report.greatestFactor = *greatest;
  const double sum = std::accumulate(factors.begin(), factors.end(), 0.0);
  report.stiffnessFactor = *least < *greatest ? sum / static_cast<double>(factors.size()) : *least;
  report.byRegion = fit.byRegion();
  report.responses = fit.responses();
  report.skippedModes = fit.skippedModes();
  report.modeError = fit.modeError();
  report.sagError = fit.sagError();
  report.plainStretchError = fit.plainStretchError();
  report.stretchError = fit.stretchError();
  const double extrapolated = std::max(0.0, 1.0 - report.responses.back());
  report.remainingError = std::hypot(std::sqrt(0.5) * std::hypot(fit.modeError(), fit.sagError()), 0.5 * extrapolated);
}

}  // namespace

std::string CalibrationReport::describe() const {
  std::ostringstream text;
  text << std::setprecision(2);
  if (needless) {
    text << "not calibrated: all tets are quadratic and full, and bend as they should; the stiffness is not scaled\n";
  } else if (refinements == 0) {
    text << "not calibrated: the cage has more tets than can be refined; the stiffness is not scaled\n";
  } else {
    text << "stiffness scaled by " << stiffnessFactor;
    if (leastFactor < greatestFactor) {
      text << " on average, " << (byRegion ? "by region " : "") << "from " << leastFactor << " to " << greatestFactor;
    }
    text << " (" << refinements << (refinements == 1 ? " refinement" : " refinements") << ", the finest with "
         << refinedTets << " tets); estimated remaining error " << std::lround(100.0 * remainingError)
         << " % of a displacement, less with more tets\n"
         << "compared with the limit of the refinements: " << std::lround(100.0 * modeError)
         << " % in vibrations (half of that in their frequencies), " << std::lround(100.0 * sagError) << " % in sags\n"
         << "stretched or compressed, its displacement is off by " << std::showpos << std::lround(100.0 * stretchError)
         << " %, without calibration by " << std::lround(100.0 * plainStretchError) << std::noshowpos << " %\n";
  }
  if (skippedModes > 0) text << skippedModes << " vibrations of loosely connected components were left out\n";
  text << std::setprecision(6) << milliseconds << " ms\n";
  return text.str();
}

Result<CalibrationReport> calibrate(Cage& cage, const CalibrationOptions& options) try {
  const auto start = std::chrono::steady_clock::now();
  if (Status status = check(cage, options); !status.ok()) return status;
  Progress progress(options.progress);
  if (!progress.reach(0.0)) return cancelledStatus("calibrate");
  CalibrationReport result;
  std::vector<double> factors(cage.mesh.tetCount(), 1.0);
  result.needless = isQuadraticAndFull(cage);
  if (!result.needless) result.refinements = refinementsFor(cage.mesh.tetCount());
  result.refinedTets = cage.mesh.tetCount() << 3 * result.refinements;
  if (result.refinements > 0) {
    const RefinedBodies bodies(used(cage), options.poissonRatio, result.refinements);
    if (!bodies.ok()) {
      return Status{StatusCode::Degenerate,
                    "the stiffness matrix of the cage cannot be factorised; are there nearly flat tets?"};
    }
    if (!progress.reach(kBodiesDone)) return cancelledStatus("calibrate");
    const StiffnessFit fit(bodies, options.modeCount, progress);
    if (progress.cancelled()) return cancelledStatus("calibrate");
    report(fit, result);
    factors = fit.factors();
  }
  if (!progress.reach(1.0)) return cancelledStatus("calibrate");
  cage.stiffnessFactor = std::move(factors);
  result.milliseconds = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  return result;
} catch (const Cancellation&) {
  return cancelledStatus("calibrate");
}

}  // namespace tetskin
