// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "report/report.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "report/advice.h"
#include "report/report_files.h"
#include "report/report_view.h"
#include "scenes/files.h"
#include "scenes/input_error.h"
#include "scenes/placement.h"
#include "scenes/progress.h"
#include "scenes/view_page.h"

namespace tetskin::report {
namespace {

ReportModel loadReportModel(const ReportOptions& options) {
  scenes::Surface surface = scenes::loadSurface(options.model);
  Cage none;
  scenes::gatherLooseVertices(surface, none, options.quiet);
  ReportModel model;
  model.name = std::move(surface.name);
  model.modelDiagonal = boundingBox(surface.mesh.positions).diagonal().norm();
  model.mesh = std::move(surface.mesh);
  model.placement = scenes::placementOf(boundingBox(model.mesh.positions));
  model.reference = referenceFor(model.mesh, options, model.placement);
  model.placement.toWorld(model.mesh.positions);
  model.diagonal = boundingBox(model.mesh.positions).diagonal().norm();
  return model;
}

/// Shows progress over jobs with very different costs.
class JobProgress {
 public:
  JobProgress(double cost, bool quiet) : cost_(cost), bar_("measuring", kSteps, quiet, stderr) {}

  void share(double jobCost, double fraction) { bar_.show(stepsAt(done_ + fraction * jobCost)); }
  void finish(double jobCost) { bar_.show(stepsAt(done_ += jobCost)); }

 private:
  static constexpr int kSteps = 1000;
  int stepsAt(double cost) const { return std::min(kSteps, static_cast<int>(std::lround(kSteps * cost / cost_))); }

  double cost_, done_ = 0.0;
  scenes::Progress bar_;
};

SceneResult runScene(SceneRunner& runner, JobProgress& progress) {
  SceneResult result{runner.scene(), runner.integrator(), {}};
  for (const Job& job : runner.jobs()) {
    const double cost = runner.costOf(job);
    const std::vector<Row> rows = runner.run(job, [&](double fraction) { progress.share(cost, fraction); });
    progress.finish(cost);
    result.rows.insert(result.rows.end(), rows.begin(), rows.end());
  }
  const Row& first = result.rows.front();
  const auto bullets = std::find_if(result.rows.begin(), result.rows.end(), [&](const Row& row) {
    return row.isReference() && row.integrator != first.integrator;
  });
  const double bulletsMs = bullets == result.rows.end() ? 0.0 : bullets->totalMs;
  for (Row& row : result.rows) {
    if (first.isReference()) row.speedup = first.totalMs / row.totalMs;
    row.speedupAgainstBullet = bulletsMs / row.totalMs;
  }
  markPareto(result.rows);
  result.referenceError = referenceError(result.rows);
  markResolved(result.rows);
  result.referenceTimeError = referenceTimeError(result.rows);
  return result;
}

void requireFolder(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (std::filesystem::is_directory(folder, error)) return;
  throw scenes::InputError(folder + ": cannot be created; check the path and its permissions");
}

using Runners = std::vector<std::unique_ptr<SceneRunner>>;

const SceneRunner* runnerOf(const std::string& scene, const Runners& runners) {
  return std::find_if(runners.begin(), runners.end(), [&](const auto& runner) { return runner->scene() == scene; })
      ->get();
}

}  // namespace

ReportResult makeReport(const ReportOptions& desired) {
  ReportOptions options = desired;
  ReportModel model = loadReportModel(options);
  options.referenceTets = model.reference.tets;
  requireFolder(options.out);
  scenes::requireWritable(options.json);
  if (!options.view.empty()) scenes::requireViewable();
  CageShelf cages(model.mesh);
  ReferenceShelf references(model.mesh, model.reference);
  Runners runners;
  double cost = 0.0;
  for (const std::string& scene : options.scenes) {
    runners.push_back(std::make_unique<SceneRunner>(model, cages, references, options, scene));
    for (const Job& job : runners.back()->jobs()) cost += runners.back()->costOf(job);
  }
  const SceneRunner* shown = options.view.empty() ? nullptr : runnerOf(shownScene(options), runners);
  ReportResult result{model.name, model.mesh.vertexCount(), model.mesh.triangleCount(), model.reference, {}};
  JobProgress progress(cost, options.quiet);
  for (std::unique_ptr<SceneRunner>& runner : runners) {
    result.scenes.push_back(runScene(*runner, progress));
    writeReport(result, options, runner->colouredMesh());
    if (runner.get() == shown) writeView(*runner, model, options);
    runner.reset();  // also frees its reference, which may be large
  }
  return result;
}

bool allFinite(const ReportResult& result) {
  for (const SceneResult& scene : result.scenes) {
    for (const Row& row : scene.rows) {
      // That another solver explodes is a finding.
      if (row.finite == 0.0 && (row.isReference() || row.integrator == scene.integrator)) return false;
    }
  }
  return true;
}

}  // namespace tetskin::report
