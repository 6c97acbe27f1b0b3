// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "report/simulation.h"

#include <tetskin/bullet/soft_body_skin.h>
#include <tetskin/reduced/reduced_body.h>

#include <algorithm>

#include "scenes/input_error.h"
#include "scenes/placement.h"
#include "scenes/statistics.h"
#include "scenes/system.h"
#include "scenes/timer.h"

namespace tetskin::report {
namespace {

/// Number of frames in which the surfaces of a body that nothing moves are timed.
constexpr int kTimedFrames = 15;

std::size_t indexOf(SurfaceKind kind) {
  return static_cast<std::size_t>(kind);
}

/// Surfaces of one body, and the time that each takes.
class TimedSurfaces {
 public:
  TimedSurfaces(const btSoftBody& body, const Cage& cage, const TriangleMesh& mesh,
                const std::vector<SurfaceKind>& kinds)
      : kinds_(kinds) {
    for (const SurfaceKind kind : kinds) {
      SurfaceCost& cost = costs_[indexOf(kind)];
      SkinOptions options;
      options.interpolation = interpolationOf(kind);
      const std::size_t before = scenes::heapBytes();
      const scenes::CpuTimer timer;
      scenes::require(skins_[indexOf(kind)].bind(body, cage, mesh, options).status());
      cost.attachMs = timer.milliseconds();
      cost.bytes = scenes::heapBytes() - before;
    }
  }

  /// The order changes every frame, as the first one finds the nodes in slower memory.
  void update(int frame) {
    for (std::size_t k = 0; k < kinds_.size(); ++k) {
      const std::size_t kind = indexOf(kinds_[(k + static_cast<std::size_t>(frame)) % kinds_.size()]);
      const scenes::CpuTimer timer;
      (void)skins_[kind].update();
      times_[kind].push_back(timer.microseconds());
    }
  }

  std::size_t bytes() const {
    std::size_t sum = 0;
    for (const SurfaceCost& cost : costs_) sum += cost.bytes;
    return sum;
  }
  SurfaceCosts costs() const {
    SurfaceCosts costs = costs_;
    for (std::size_t k = 0; k < costs.size(); ++k) costs[k].updateUs = scenes::median(times_[k]);
    return costs;
  }

 private:
  std::vector<SurfaceKind> kinds_;
  std::array<SoftBodySkin, 2> skins_;
  SurfaceCosts costs_;
  std::array<std::vector<double>, 2> times_;
};

}  // namespace

const char* nameOf(SurfaceKind kind) {
  return kind == SurfaceKind::Linear ? "linear" : "quadratic";
}

Interpolation interpolationOf(SurfaceKind kind) {
  return kind == SurfaceKind::Quadratic ? Interpolation::Quadratic : Interpolation::Linear;
}

Simulation simulate(const scenes::SceneEntry& entry, const Cage& cage, const scenes::SceneOptions& options,
                    const TriangleMesh& mesh, const std::vector<SurfaceKind>& kinds, const FrameDone& done) {
  Simulation result;
  const std::size_t before = scenes::heapBytes();
  const std::unique_ptr<scenes::Scene> scene = entry.make(cage, options);
  result.obstacles = scene->world().obstacles();
  if (const ReductionReport* report = scene->world().reduction()) {
    result.modes = static_cast<int>(report->projectionErrors.size());
    result.projectionError = *std::max_element(report->projectionErrors.begin(), report->projectionErrors.end());
  }
  TimedSurfaces surfaces(scene->body(), cage, mesh, kinds);
  std::vector<double> milliseconds;
  result.trajectory.push_back(scenes::nodesOf<float>(scene->body()));
  for (int frame = 1; frame <= scene->options().frames; ++frame) {
    const scenes::CpuTimer timer;
    scene->step(frame);
    milliseconds.push_back(timer.milliseconds());
    if (frame == 1) result.bytes = scenes::heapBytes() - before - surfaces.bytes();
    result.finite = !scene->check().exploded;
    if (!result.finite) break;
    surfaces.update(frame);
    result.trajectory.push_back(scenes::nodesOf<float>(scene->body()));
    done();
  }
  result.milliseconds = scenes::median(std::move(milliseconds));
  result.surfaces = surfaces.costs();
  return result;
}

SurfaceCosts surfaceCosts(const Cage& cage, const TriangleMesh& mesh, const std::vector<SurfaceKind>& kinds) {
  btSoftBodyWorldInfo worldInfo;
  auto body = createSoftBody(cage, worldInfo);
  scenes::require(body.status());
  const std::unique_ptr<btSoftBody> owned(std::move(body).value());
  TimedSurfaces surfaces(*owned, cage, mesh, kinds);
  for (int frame = 0; frame < kTimedFrames; ++frame) surfaces.update(frame);
  return surfaces.costs();
}

}  // namespace tetskin::report
