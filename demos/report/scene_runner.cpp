// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "report/scene_runner.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <set>

#include <nlohmann/json.hpp>

#include "report/build_id.h"
#include "report/coloured_mesh.h"

namespace tetskin::report {
namespace {

/// Version of the stored results: raise it when older rows are no longer comparable.
constexpr int kVersion = 4;
/// For the estimate of the reference's own error, the finest compared cage has the reference's number of tets divided
/// by this.
constexpr std::size_t kCoarserLevel = 3;
/// A cage with a number of tets this close to that serves as well.
constexpr double kNearEnough = 0.7;
/// Bullet tests all pairs of vertices and tets, and takes minutes if there are more than this.
constexpr double kMaxBulletPairs = 1e9;

std::vector<SurfaceKind> ours(std::vector<SurfaceKind> kinds) {
  kinds.erase(std::remove(kinds.begin(), kinds.end(), SurfaceKind::Bullet), kinds.end());
  return kinds;
}

/// Kinds that only serve to separate causes of error get one surface.
std::vector<SurfaceKind> surfacesOf(CageKind kind, const ReportOptions& options, bool bullet) {
  if (kind == CageKind::Same && bullet) return options.surfaces;
  if (kind == CageKind::Same || kind == CageKind::Calibrated) return ours(options.surfaces);
  return {options.surfaces.front()};
}

/// True for scenes in which bodies move by vibration modes, too. In the others nodes are moved by hand, which a body
/// that has only its modes cannot follow.
bool isReducible(const std::string& scene) {
  return scene == "sag" || scene == "drop";
}

std::vector<Job> jobsOf(bool exact, const ReportModel& model, const ReportOptions& options, bool both) {
  std::vector<Job> jobs;
  const std::size_t level = options.referenceTets / kCoarserLevel;
  std::vector<std::size_t> sizes = options.tets;
  if (exact) sizes.push_back(options.referenceTets);
  const bool levelIsNear = static_cast<double>(sizes.back()) >= kNearEnough * static_cast<double>(level);
  if (!exact && isBuilt(model.reference) && !levelIsNear) sizes.push_back(level);
  const auto distance = [&](std::size_t tets) {
    return std::abs(std::log(static_cast<double>(tets) / static_cast<double>(options.shownTets)));
  };
  const std::size_t shown = *std::min_element(options.tets.begin(), options.tets.end(),
                                              [&](std::size_t a, std::size_t b) { return distance(a) < distance(b); });
  if (!exact) jobs.push_back({options.referenceTets, CageKind::Same, {}, false, false});
  if (!exact && both) jobs.push_back({options.referenceTets, CageKind::Same, {}, false, true});
  // Where nothing is simulated, the material does not matter.
  const std::vector<CageKind> kinds = exact ? std::vector<CageKind>{CageKind::Same} : options.cages;
  // The kind of the reference, if such cages are compared at all.
  const bool likeReference = std::count(kinds.begin(), kinds.end(), CageKind::Calibrated) > 0;
  const CageKind levelKind = likeReference ? CageKind::Calibrated : CageKind::Same;
  for (const std::size_t tets : sizes) {
    const bool asked = std::count(options.tets.begin(), options.tets.end(), tets) > 0;
    const bool bullet = static_cast<double>(tets) * static_cast<double>(model.mesh.vertexCount()) <= kMaxBulletPairs;
    for (const CageKind kind : kinds) {
      const bool coloured = tets == shown && kind == kinds.front();
      if (asked || kind == levelKind) {
        jobs.push_back({tets, kind, surfacesOf(kind, options, bullet), coloured, false});
      }
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
      jobs.push_back(
          {tets, CageKind::Calibrated, {ours(options.surfaces).front()}, false, false, static_cast<int>(modes)});
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

SceneRunner::SceneRunner(const ReportModel& model, CageShelf& cages, const ResultStore& store,
                         const ReportOptions& options, const std::string& scene, Elasticity elasticity)
    : model_(model),
      cages_(cages),
      store_(store),
      options_(options),
      entry_(scenes::sceneNamed(scene)),
      frames_(options.frames > 0 && !isExact() ? options.frames : entry_.frames),
      modes_(options.modes.empty() ? 1 : static_cast<int>(options.modes.back())),
      elasticity_(elasticity),
      jobs_(jobsOf(isExact(), model, options, elasticity == Elasticity::Tetskin)) {
  if (isReducible(scene) && elasticity == Elasticity::Tetskin && !ours(options.surfaces).empty()) {
    appendReduced(options, jobs_);
  }
}

std::string SceneRunner::integrator() const {
  if (isExact()) return "none";
  return nameOf(elasticity_);
}

double SceneRunner::costOf(const Job& job) const {
  constexpr double kImplicit = 5.0, kTetskin = 0.15, kCompareOneFrame = 30000.0;  // in tets stepped once by Bullet
  const auto tets = static_cast<double>(job.tets);
  if (isExact()) return kCompareOneFrame;
  const double step = job.bullets                                 ? 1.0
                      : elasticity_ == Elasticity::BulletImplicit ? kImplicit
                      : elasticity_ == Elasticity::Tetskin        ? kTetskin
                                                                  : 1.0;
  return frames_ * (tets * step + (isReference(job) ? 0.0 : kCompareOneFrame));
}

nlohmann::ordered_json SceneRunner::settings(const Job& job) const {
  nlohmann::ordered_json json;
  json["version"] = kVersion;
  json["build"] = buildId();
  json["mesh"] = model_.hash;
  json["scene"] = scene();
  json["frames"] = frames_;
  json["integrator"] = integrator();
  json["stiffness"] = options_.stiffness;
  json["reference_tets"] = isExact() ? 0 : options_.referenceTets;
  json["reference"] = model_.reference.hash;
  json["tets"] = job.tets;
  json["cage"] = nameOf(job.kind);
  json["coloured"] = job.coloured;
  json["bullets"] = job.bullets;
  json["modes"] = job.modes;
  json["surfaces"] = nlohmann::ordered_json::array();
  for (const SurfaceKind kind : job.surfaces) json["surfaces"].push_back(nameOf(kind));
  return json;
}

std::optional<std::vector<Row>> SceneRunner::stored(const Job& job) const {
  if (job.coloured && !store_.text(settings(job))) return {};
  return store_.rows(settings(job));
}

const Job* SceneRunner::colouredJob() const {
  const auto job = std::find_if(jobs_.begin(), jobs_.end(), [](const Job& j) { return j.coloured; });
  return job == jobs_.end() ? nullptr : &*job;
}

std::optional<std::string> SceneRunner::colouredMesh() const {
  const Job* job = colouredJob();
  return job ? store_.text(settings(*job)) : std::nullopt;
}

ShownMotion SceneRunner::shownMotion() {
  assert(!isExact() && colouredJob());
  const Job& job = *colouredJob();
  const Cage& cage = cages_.at(job.tets, job.kind).cage;
  Simulation simulation = simulate(entry_, cage, optionsOf(job, cage), model_.mesh, {}, [] {});
  (void)reference();
  return {cage, std::move(simulation.trajectory), cages_.reference().cage, right_[false].trajectory,
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
    made = materialOf(entry_, cages_.reference().cage, options_.stiffness,
                      bullets ? Elasticity::BulletExplicit : elasticity_);
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

std::vector<Row> SceneRunner::referenceRows(const Job& job, const std::function<void(double)>& progress) {
  const ShelvedCage& shelved = cages_.reference();
  int frame = 0;
  Simulation simulation = simulate(entry_, shelved.cage, material(job.bullets), model_.mesh, {},
                                   [&] { progress(static_cast<double>(++frame) / frames_); });
  Row row = rowOf(job, shelved);
  row.interpolation = "reference";
  if (job.bullets) row.integrator = nameOf(Elasticity::BulletExplicit);
  row.simulationMs = row.totalMs = simulation.milliseconds;
  row.memoryBytes = static_cast<double>(simulation.bytes);
  row.frames = static_cast<double>(simulation.trajectory.size() - 1);
  row.finite = simulation.finite;
  row.speedup = 1.0;
  right_[job.bullets].trajectory = std::move(simulation.trajectory);
  store_.keep(settings(job), right_[job.bullets].trajectory);
  store_.keep(settings(job), std::vector<Row>{row});
  return {row};
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
  if (right.trajectory.empty()) {
    if (std::optional<Trajectory> kept = store_.trajectory(settings(job))) {
      right.trajectory = std::move(*kept);
    } else {
      (void)referenceRows(job, [](double) {});
    }
  }
  right.reference = std::make_unique<SimulatedReference>(model_.mesh, cages_.reference().cage, right.trajectory);
  return *right.reference;
}

void SceneRunner::colour(const Job& job, const SurfaceErrors& errors, int frame) {
  const Points& positions = reference().surfaceAt(frame).positions;
  store_.keep(settings(job), colouredPly(model_.mesh, positions, errors.rmsByVertex, maxOf(errors.rmsByVertex)));
}

scenes::SceneOptions SceneRunner::optionsOf(const Job& job, const Cage& cage) {
  scenes::SceneOptions options = material();
  if (job.modes == 0) return options;
  options.force = scenes::Force::Reduced;
  options.reduction = modes_.reductionOf(model_.mesh, cages_.reference().cage, cage);
  options.modes = job.modes;
  return options;
}

SceneRunner::Motion SceneRunner::move(const Job& job, const ShelvedCage& shelved,
                                      const std::function<void(double)>& progress) {
  const Cage& cage = shelved.cage;
  Motion motion;
  motion.row = rowOf(job, shelved);
  motion.driven = reference().drive(cage);
  if (isExact()) {
    motion.nodes = motion.driven;
    motion.costs = surfaceCosts(cage, model_.mesh, job.surfaces);
  } else {
    int frame = 0;
    const scenes::SceneOptions options = optionsOf(job, cage);
    Simulation simulation = simulate(entry_, cage, options, model_.mesh, job.surfaces,
                                     [&] { progress(0.5 * static_cast<double>(++frame) / frames_); });
    motion.nodes = std::move(simulation.trajectory);
    motion.costs = simulation.surfaces;
    motion.row.simulationMs = simulation.milliseconds;
    motion.row.memoryBytes = static_cast<double>(simulation.bytes);
    motion.row.finite = simulation.finite;
    if (job.modes > 0) addFindings(job, simulation, *options.reduction, motion.row);
  }
  // One of the two may have exploded.
  const std::size_t frames = std::min(motion.nodes.size(), motion.driven.size());
  motion.nodes.resize(frames);
  motion.driven.resize(frames);
  motion.row.frames = static_cast<double>(frames - 1);
  motion.row.errorSimulationRms = nodeErrors(motion.nodes, motion.driven, model_.mesh);
  return motion;
}

std::vector<Row> SceneRunner::run(const Job& job, const std::function<void(double)>& progress) {
  if (isReference(job)) return referenceRows(job, progress);
  Reference& right = reference();
  const ShelvedCage& shelved = cages_.at(job.tets, job.kind);
  const Cage& cage = shelved.cage;
  const Motion motion = move(job, shelved, progress);
  std::vector<Row> rows;
  for (const SurfaceKind kind : job.surfaces) {
    const SurfaceErrors total = surfaceErrors(right, model_.mesh, cage, kind, motion.nodes);
    const SurfaceCost& cost = motion.costs[static_cast<std::size_t>(kind)];
    Row& row = rows.emplace_back(motion.row);
    row.interpolation = nameOf(kind);
    row.errorTotalRms = total.rms;
    row.errorTotalMax = total.max;
    row.normalErrorMeanDeg = total.normalMeanDeg;
    row.errorByFrame = total.rmsByFrame;
    row.amplitudeByFrame = total.amplitudeByFrame;
    if (referenceJob(true)) {
      row.errorAgainstBullet = surfaceErrors(reference(true), model_.mesh, cage, kind, motion.nodes).rms;
    }
    row.errorEmbeddingRms = surfaceErrors(right, model_.mesh, cage, kind, motion.driven).rms;
    row.skinUs = cost.updateUs;
    row.totalMs = row.simulationMs + cost.updateUs / 1000.0;
    row.attachMs = cost.attachMs;
    row.memoryBytes += static_cast<double>(cost.bytes);
    if (job.coloured && rows.size() == 1) colour(job, total, static_cast<int>(motion.nodes.size()) - 1);
  }
  progress(1.0);
  store_.keep(settings(job), rows);
  return rows;
}

}  // namespace tetskin::report
