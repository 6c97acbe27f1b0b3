// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The reference of a scene, and how far it can be trusted.
#include <algorithm>

#include "report/advice.h"
#include "report/scene_runner.h"
#include "scenes/statistics.h"

namespace tetskin::report {
namespace {

/// Of a reference and its coarser levels.
constexpr int kAllRuns = ReferenceShelf::kLevels;

}  // namespace

ReferenceTets SceneRunner::referenceTets(bool bullets) const {
  return bullets ? ReferenceTets::Linear : ReferenceTets::Quadratic;
}

Row SceneRunner::referenceRow(const Job& job, const scenes::SceneOptions& options, const FrameDone& done,
                              Trajectory& trajectory) {
  const ShelvedCage& shelved = references_.at(referenceTets(job.bullets));
  Simulation simulation = simulate(entry_, shelved.cage, options, model_.mesh, {}, done);
  Row row = rowOf(job, shelved);
  row.interpolation = "reference";
  if (job.bullets) row.integrator = "explicit";
  row.substeps = options.substeps;
  row.simulationMs = row.totalMs = simulation.milliseconds;
  row.memoryBytes = static_cast<double>(simulation.bytes);
  row.frames = static_cast<double>(simulation.trajectory.size() - 1);
  row.finite = simulation.finite;
  row.speedup = 1.0;
  trajectory = std::move(simulation.trajectory);
  return row;
}

std::vector<Row> SceneRunner::referenceRows(const Job& job, const std::function<void(double)>& progress) {
  const scenes::SceneOptions usual = withSubsteps(material(job.bullets), job.substeps.front());
  const int finest = referenceSubsteps(job);
  int done = 0;
  const auto count = [&](const scenes::SceneOptions& options) {
    return [&, substeps = options.substeps] {
      const int all = frames_ * (finest + kAllRuns * usual.substeps);
      progress(std::min(1.0, static_cast<double>(done += substeps) / all));
    };
  };
  Trajectory& right = right_[job.bullets].trajectory;
  const scenes::SceneOptions own = finest > 0 ? converged(withSubsteps(usual, finest)) : usual;
  std::vector<Row> rows = {referenceRow(job, own, count(own), right)};
  if (own.substeps != usual.substeps) {
    Trajectory nodes;
    Row row = referenceRow(job, usual, count(usual), nodes);
    row.errorTimeRms = surfaceDistance(model_.mesh, referenceCage(job.bullets), SurfaceKind::Quadratic, nodes, right);
    row.errorTotalRms = row.errorTimeRms;
    rows.insert(rows.begin(), row);
    if (!job.bullets) estimateOwnErrors(job, usual, nodes, count(usual), rows.back());
  } else if (!job.bullets) {
    estimateOwnErrors(job, usual, right, count(usual), rows.back());
  }
  return rows;
}

Reference& SceneRunner::reference(bool bullets) {
  Right& right = right_[bullets];
  if (right.reference) return *right.reference;
  if (isExact()) {
    right.reference =
        std::make_unique<ExactReference>(model_.mesh, scenes::smoothTwistOf(boundingBox(model_.mesh.positions)));
    return *right.reference;
  }
  const Job& job = *referenceJob(bullets);
  if (right.trajectory.empty()) (void)referenceRows(job, [](double) {});
  right.reference = std::make_unique<SimulatedReference>(model_.mesh, referenceCage(bullets), right.trajectory);
  return *right.reference;
}

void SceneRunner::estimateOwnErrors(const Job& job, const scenes::SceneOptions& options, const Trajectory& motion,
                                    const FrameDone& done, Row& row) {
  SimulatedReference own(model_.mesh, referenceCage(), motion);
  const ReferenceTets kind = referenceTets(job.bullets);
  std::vector<CoarserLevel> space;
  std::vector<double> amplitudes;
  for (int level = 1; level < references_.levelCount(kind); ++level) {
    const Cage& cage = references_.at(kind, level).cage;
    Trajectory nodes = simulate(entry_, cage, options, model_.mesh, {}, done).trajectory;
    nodes.resize(std::min(nodes.size(), motion.size()));
    const double edge = meanEdge(cage) / model_.diagonal;
    const SurfaceErrors errors = surfaceErrors(own, model_.mesh, cage, SurfaceKind::Quadratic, nodes);
    space.push_back({edge, errors.rms});
    amplitudes = errors.amplitudeByFrame;
  }
  row.errorSpaceRms = ownError(row.edge, space);
  if (row.errorSpaceRms > 0.0) row.errorOfMotion = row.errorSpaceRms / scenes::rms(amplitudes);
}

}  // namespace tetskin::report
