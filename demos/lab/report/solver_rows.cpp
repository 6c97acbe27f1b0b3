// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The comparison of solvers: each in its substeps, with the constants that suit it best, in one cage.
#include <algorithm>
#include <cmath>

#include "report/scene_runner.h"
#include "scenes/statistics.h"

namespace tetskin::report {

std::vector<SceneRunner::Setting> SceneRunner::settingsOf(const Job& job, const Cage& cage) {
  std::vector<Setting> settings;
  for (const Solver solver : options_.solvers) {
    const auto& counts = solver == Solver::Tetskin ? options_.substeps
                         : isXpbd(solver)          ? options_.xpbdSubsteps
                                                   : options_.bulletSubsteps;
    for (const std::size_t substeps : counts) {
      const auto options = withSolver(optionsOf(job, cage, 0), solver, static_cast<int>(substeps));
      settings.push_back({solver, options, constantsOf(options)});
    }
  }
  return settings;
}

Simulation SceneRunner::simulated(const Setting& setting, const Cage& cage, const XpbdModel& model) const {
  if (isXpbd(setting.solver)) return simulateXpbd(model.with(setting.constants), setting.options, [] {});
  return simulate(entry_, cage, setting.options, model_.mesh, {}, [] {});
}

void SceneRunner::choose(Setting& setting, const Cage& cage, const XpbdModel& model, const SampledErrors& errors) {
  if (setting.solver == Solver::Tetskin || setting.solver == Solver::XpbdUnfitted) return;
  const auto errorOf = [&](const Setting& tried) {
    const Simulation simulation = simulated(tried, cage, model);
    return simulation.finite ? errors.rms(simulation.trajectory) : HUGE_VAL;
  };
  const std::vector<double> seconds = dampings(material(), setting.solver, setting.options.substeps);
  if (setting.solver == Solver::Xpbd) {
    setting.constants = bestConstants(seconds, [&](const XpbdConstants& constants) {
      return errorOf({setting.solver, setting.options, constants});
    });
    setting.options.body.stiffnessDamping = setting.constants.damping;
    return;
  }
  if (seconds.size() == 1) return;
  double least = HUGE_VAL;
  const Setting asked = setting;
  for (const double damping : seconds) {
    Setting tried = asked;
    tried.options.body.stiffnessDamping = damping;
    const double error = errorOf(tried);
    if (!(error < least)) continue;
    least = error;
    setting = tried;
  }
}

std::vector<Row> SceneRunner::solverRows(const Job& job, const std::function<void(double)>& progress) {
  const ShelvedCage& shelved = cages_.at(job.tets, job.kind);
  const Cage& cage = shelved.cage;
  const SurfaceKind kind = job.surfaces.front();
  const Trajectory driven = reference().drive(cage);
  const Trajectory fine = convergedMotion(job, cage, {});
  const XpbdModel model(entry_, cage, optionsOf(job, cage, 0));
  const SampledErrors errors(reference(), model_.mesh, cage);
  std::vector<Setting> settings = settingsOf(job, cage);
  const auto steps = static_cast<double>(settings.size() * (options_.repetitions + 1));
  int done = 0;
  for (Setting& setting : settings) {
    choose(setting, cage, model, errors);
    progress(++done / steps);
  }
  // In turn, so that a busy machine is as busy for all.
  std::vector<Simulation> simulations(settings.size());
  std::vector<std::vector<double>> milliseconds(settings.size());
  for (std::size_t repetition = 0; repetition < options_.repetitions; ++repetition) {
    for (std::size_t k = 0; k < settings.size(); ++k) {
      simulations[k] = simulated(settings[k], cage, model);
      milliseconds[k].push_back(simulations[k].milliseconds);
      progress(++done / steps);
    }
  }
  const SurfaceCosts costs = surfaceCosts(cage, model_.mesh, {kind});
  const double space = surfaceErrors(reference(), model_.mesh, cage, kind, fine).rms;
  const double embedding = surfaceErrors(reference(), model_.mesh, cage, kind, driven).rms;
  std::vector<Row> rows;
  for (std::size_t k = 0; k < settings.size(); ++k) {
    const Setting& setting = settings[k];
    Motion motion;
    motion.substeps = setting.options.substeps;
    motion.nodes = std::move(simulations[k].trajectory);
    motion.nodes.resize(std::min(motion.nodes.size(), driven.size()));
    motion.costs = costs;
    motion.row = rowOf(job, shelved);
    motion.row.integrator = nameOf(setting.solver);
    motion.row.interpolation = nameOf(kind);
    motion.row.substeps = motion.substeps;
    motion.row.simulationMs = scenes::median(milliseconds[k]);
    motion.row.memoryBytes = static_cast<double>(simulations[k].bytes);
    motion.row.finite = simulations[k].finite;
    motion.row.frames = static_cast<double>(motion.nodes.size() - 1);
    motion.row.dampingMs = 1e3 * setting.options.body.stiffnessDamping;
    if (isXpbd(setting.solver)) {
      motion.row.xpbdStiffness = setting.constants.stiffness;
      motion.row.xpbdVolume = std::isinf(setting.constants.volume) ? -1.0 : setting.constants.volume;
    }
    if (motion.row.frames > 0.0) motion.row.errorSimulationRms = nodeErrors(motion.nodes, driven, model_.mesh);
    Row& row = rows.emplace_back(motion.row.frames > 0.0 ? compared(job, cage, kind, motion) : motion.row);
    row.errorSpaceRms = space;
    row.errorTimeRms = surfaceDistance(model_.mesh, cage, kind, motion.nodes, fine);
    row.errorEmbeddingRms = embedding;
  }
  return rows;
}

}  // namespace tetskin::report
