// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "report/scene_runner.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <set>

#include "report/coloured_mesh.h"
#include "scenes/statistics.h"

namespace tetskin::report {
namespace {

/// Kinds that only serve to separate causes of error get one surface.
std::vector<SurfaceKind> surfacesOf(CageKind kind, const ReportOptions& options) {
  if (kind == CageKind::Same || kind == CageKind::Calibrated) return options.surfaces;
  return {options.surfaces.front()};
}

/// True for scenes that reduced bodies can also do. In the others nodes are moved by hand, which a body that moves only
/// in its modes cannot follow.
bool isReducible(const std::string& scene) {
  return scene == "sag" || scene == "drop";
}

void appendOthers(const std::vector<std::size_t>& all, std::vector<int>& substeps) {
  for (const std::size_t one : all) {
    if (static_cast<int>(one) != substeps.front()) substeps.push_back(static_cast<int>(one));
  }
}

std::vector<Job> jobsOf(bool exact, const ReportOptions& options) {
  std::vector<Job> jobs;
  std::vector<std::size_t> sizes = options.tets;
  if (exact) sizes.push_back(options.referenceTets);
  const auto distance = [&](std::size_t tets) {
    return std::abs(std::log(static_cast<double>(tets) / static_cast<double>(options.shownTets)));
  };
  const std::size_t shown = *std::min_element(options.tets.begin(), options.tets.end(),
                                              [&](std::size_t a, std::size_t b) { return distance(a) < distance(b); });
  const int usual = usualSubsteps(options);
  if (!exact) jobs.push_back({options.referenceTets, CageKind::Same, {}, {usual}});
  const bool bullets =
      options.solvers.empty() || std::any_of(options.solvers.begin(), options.solvers.end(), isBullets);
  if (!exact && bullets) jobs.push_back({options.referenceTets, CageKind::Same, {}, {0}, false, true});
  if (!options.solvers.empty()) {
    for (const std::size_t tets : options.tets)
      jobs.push_back({tets, CageKind::Calibrated, options.surfaces, {usual}, false, false, 0, true});
    return jobs;
  }
  // If nothing is simulated, the material does not matter.
  const std::vector<CageKind> kinds = exact ? std::vector<CageKind>{CageKind::Same} : options.cages;
  for (const std::size_t tets : sizes) {
    for (const CageKind kind : kinds) {
      const bool coloured = tets == shown && kind == kinds.front();
      jobs.push_back({tets, kind, surfacesOf(kind, options), {usual}, coloured});
      if (!exact && kind == kinds.back()) appendOthers(options.substeps, jobs.back().substeps);
    }
  }
  return jobs;
}

/// One surface of each reduced body, in the coarsest cage and in the one that is shown: the cost of a reduced body's
/// step is the number of its modes times that of the cage's nodes, and its error depends little on the cage.
void appendReduced(const ReportOptions& options, std::vector<Job>& jobs) {
  const auto shown = std::find_if(jobs.begin(), jobs.end(), [](const Job& job) { return job.coloured; });
  if (shown == jobs.end()) return;
  for (const std::size_t tets : std::set<std::size_t>{options.tets.front(), shown->tets}) {
    for (const std::size_t modes : options.modes) {
      jobs.push_back({tets,
                      CageKind::Calibrated,
                      {options.surfaces.front()},
                      {usualSubsteps(options)},
                      false,
                      false,
                      static_cast<int>(modes)});
    }
  }
}

void addFindings(const Job& job, const Simulation& simulation, const scenes::Reduction& reduction, Row& row) {
  row.modes = simulation.modes;
  row.modesLeftOut = job.modes - simulation.modes;
  row.modesMs = reduction.milliseconds();
  row.projectionError = simulation.projectionError;
}

}  // namespace

SceneRunner::SceneRunner(const ReportModel& model, CageShelf& cages, ReferenceShelf& references,
                         const ReportOptions& options, const std::string& scene)
    : model_(model),
      cages_(cages),
      references_(references),
      options_(options),
      entry_(scenes::sceneNamed(scene)),
      frames_(options.frames > 0 && !isExact() ? options.frames : entry_.frames),
      modes_(options.modes.empty() ? 1 : static_cast<int>(options.modes.back())),
      jobs_(jobsOf(isExact(), options)) {
  if (isReducible(scene)) appendReduced(options, jobs_);
}

std::string SceneRunner::integrator() const {
  return isExact() ? "none" : "tetskin";
}

double SceneRunner::costOf(const Job& job) const {
  constexpr double kImplicit = 5.0, kTetskin = 0.15, kCompareOneFrame = 30000.0;  // in tets stepped once by Bullet
  const auto tets = static_cast<double>(job.tets);
  if (isExact()) return kCompareOneFrame;
  const double step = job.bullets ? 1.0 : kTetskin;
  if (job.solvers)
    return frames_ * (tets * kSolvers.size() * kImplicit * static_cast<double>(options_.repetitions + 1));
  int substeps = referenceSubsteps(job);
  for (const int one : job.substeps) substeps += one;
  const double frames = std::max(1.0, static_cast<double>(substeps) / scenes::SceneOptions().substeps);
  const auto comparisons = isReference(job) ? 0.0 : static_cast<double>(job.substeps.size());
  return frames_ * (tets * step * frames + kCompareOneFrame * comparisons);
}

int SceneRunner::referenceSubsteps(const Job& job) const {
  return job.bullets || isExact() ? 0 : static_cast<int>(options_.referenceSubsteps);
}

const Job* SceneRunner::colouredJob() const {
  const auto job = std::find_if(jobs_.begin(), jobs_.end(), [](const Job& j) { return j.coloured; });
  return job == jobs_.end() ? nullptr : &*job;
}

ShownMotion SceneRunner::shownMotion() {
  assert(!isExact() && colouredJob());
  const Job& job = *colouredJob();
  const Cage& cage = cages_.at(job.tets, job.kind).cage;
  Simulation simulation = simulate(entry_, cage, optionsOf(job, cage, job.substeps.front()), model_.mesh, {}, [] {});
  (void)reference();
  return {cage, std::move(simulation.trajectory), referenceCage(), right_[false].trajectory,
          std::move(simulation.obstacles)};
}

const Job* SceneRunner::referenceJob(bool bullets) const {
  const auto found = std::find_if(jobs_.begin(), jobs_.end(),
                                  [&](const Job& job) { return isReference(job) && job.bullets == bullets; });
  return found == jobs_.end() ? nullptr : &*found;
}

const scenes::SceneOptions& SceneRunner::material(bool bullets) {
  std::optional<scenes::SceneOptions>& made = right_[bullets].material;
  if (!made) {
    // A landing body is as stiff as Bullet's forces permit, in all references.
    made = materialOf(entry_, referenceCage(bullets || entry_.lands), options_.stiffness, bullets);
    made->frames = frames_;
    made->box = boundingBox(model_.mesh.positions);
  }
  return *made;
}

Row SceneRunner::rowOf(const Job& job, const ShelvedCage& shelved) const {
  const auto& [cage, calibration] = shelved;
  Row row;
  row.scene = scene();
  row.integrator = integrator();
  row.material = job.modes > 0 ? "reduced" : nameOf(job.kind);
  row.tets = static_cast<double>(cage.mesh.tetCount());
  row.nodes = static_cast<double>(cage.mesh.nodeCount());
  row.edge = meanEdge(cage) / model_.diagonal;
  row.copies = static_cast<double>(copiesIn(cage));
  row.stiffnessFactor = calibration.stiffnessFactor;
  row.calibrationLeft = calibration.remainingError;
  row.calibrateMs = calibration.milliseconds;
  row.diagonal = model_.modelDiagonal;
  return row;
}

void SceneRunner::colour(const SurfaceErrors& errors, int frame) {
  const Points& positions = reference().surfaceAt(frame).positions;
  coloured_ = colouredPly(model_.mesh, positions, errors.rmsByVertex, maxOf(errors.rmsByVertex));
}

scenes::SceneOptions SceneRunner::optionsOf(const Job& job, const Cage& cage, int substeps) {
  scenes::SceneOptions options = withSubsteps(material(), substeps);
  if (job.modes == 0) return options;
  options.force = scenes::Force::Reduced;
  options.reduction = modes_.reductionOf(model_.mesh, references_.at(ReferenceTets::Linear).cage, cage);
  options.modes = job.modes;
  return options;
}

SceneRunner::Motion SceneRunner::move(const Job& job, const ShelvedCage& shelved, int substeps,
                                      const Trajectory& driven, const FrameDone& done) {
  const Cage& cage = shelved.cage;
  Motion motion;
  motion.substeps = substeps;
  motion.row = rowOf(job, shelved);
  if (isExact()) {
    motion.nodes = driven;
    motion.costs = surfaceCosts(cage, model_.mesh, job.surfaces);
  } else {
    const scenes::SceneOptions options = optionsOf(job, cage, substeps);
    std::vector<SurfaceKind> surfaces = job.surfaces;
    if (substeps != job.substeps.front()) surfaces.resize(1);
    Simulation simulation = simulate(entry_, cage, options, model_.mesh, surfaces, done);
    motion.nodes = std::move(simulation.trajectory);
    motion.costs = simulation.surfaces;
    motion.row.substeps = options.substeps;
    motion.row.simulationMs = simulation.milliseconds;
    motion.row.memoryBytes = static_cast<double>(simulation.bytes);
    motion.row.finite = simulation.finite;
    if (job.modes > 0) addFindings(job, simulation, *options.reduction, motion.row);
  }
  // One of the two may have exploded.
  motion.nodes.resize(std::min(motion.nodes.size(), driven.size()));
  motion.row.frames = static_cast<double>(motion.nodes.size() - 1);
  motion.row.errorSimulationRms = nodeErrors(motion.nodes, driven, model_.mesh);
  return motion;
}

std::vector<Row> SceneRunner::run(const Job& job, const std::function<void(double)>& progress) {
  if (isReference(job)) return referenceRows(job, progress);
  if (job.solvers) return solverRows(job, progress);
  const ShelvedCage& shelved = cages_.at(job.tets, job.kind);
  const Cage& cage = shelved.cage;
  const Trajectory driven = reference().drive(cage);
  std::vector<Motion> motions;
  int frame = 0;
  for (const int substeps : job.substeps) {
    motions.push_back(move(job, shelved, substeps, driven, [&] {
      progress(0.5 * static_cast<double>(++frame) / (frames_ * static_cast<double>(job.substeps.size())));
    }));
  }
  const Trajectory fine = convergedMotion(job, cage, motions.front().nodes);
  std::vector<Row> rows;
  for (const SurfaceKind kind : job.surfaces) {
    const double space = surfaceErrors(reference(), model_.mesh, cage, kind, fine).rms;
    const double embedding = surfaceErrors(reference(), model_.mesh, cage, kind, driven).rms;
    for (const Motion& motion : motions) {
      if (kind != job.surfaces.front() && &motion != &motions.front()) continue;
      Row& row = rows.emplace_back(compared(job, cage, kind, motion));
      row.errorSpaceRms = space;
      row.errorTimeRms = surfaceDistance(model_.mesh, cage, kind, motion.nodes, fine);
      row.errorEmbeddingRms = embedding;
    }
  }
  std::stable_sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) { return a.substeps < b.substeps; });
  progress(1.0);
  return rows;
}

Trajectory SceneRunner::convergedMotion(const Job& job, const Cage& cage, const Trajectory& usual) {
  const int finest = referenceSubsteps(job);
  if (finest == 0) return usual;
  Trajectory nodes = simulate(entry_, cage, converged(optionsOf(job, cage, finest)), model_.mesh, {}, [] {}).trajectory;
  nodes.resize(std::min(nodes.size(), right_[false].trajectory.size()));
  return nodes;
}

Row SceneRunner::compared(const Job& job, const Cage& cage, SurfaceKind kind, const Motion& motion) {
  const SurfaceErrors total = surfaceErrors(reference(), model_.mesh, cage, kind, motion.nodes);
  const SurfaceCost& cost = motion.costs[static_cast<std::size_t>(kind)];
  Row row = motion.row;
  row.interpolation = nameOf(kind);
  row.errorTotalRms = total.rms;
  row.errorTotalMax = total.max;
  row.errorOfMotion = total.rms / scenes::rms(total.amplitudeByFrame);
  row.normalErrorMeanDeg = total.normalMeanDeg;
  row.errorByFrame = total.rmsByFrame;
  row.amplitudeByFrame = total.amplitudeByFrame;
  if (referenceJob(true)) {
    row.errorAgainstBullet = surfaceErrors(reference(true), model_.mesh, cage, kind, motion.nodes).rms;
  }
  row.skinUs = cost.updateUs;
  row.totalMs = row.simulationMs + cost.updateUs / 1000.0;
  row.attachMs = cost.attachMs;
  row.memoryBytes += static_cast<double>(cost.bytes);
  const bool isFirst = kind == job.surfaces.front() && motion.substeps == job.substeps.front();
  if (job.coloured && isFirst) colour(total, static_cast<int>(motion.nodes.size()) - 1);
  return row;
}

}  // namespace tetskin::report
