// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "report/still_body.h"

#include <tetskin/elastic/vibration_modes.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <string>

#include "scenes/input_error.h"
#include "scenes/placement.h"

namespace tetskin::report {
namespace {

/// A body of the scenes swings about once a second. More damping would delay it, and longer steps would take the solver
/// more iterations than it has.
constexpr double kDamping = 0.3;
constexpr int kSubsteps = 2, kFrames = 240;
/// Largest way of a node in the last frame, over the body's size.
constexpr double kStill = 2e-5;

float farthestStep(const std::vector<Eigen::Vector3f>& before, const std::vector<Eigen::Vector3f>& after) {
  float farthest = 0.0f;
  for (std::size_t n = 0; n < before.size(); ++n) farthest = std::max(farthest, (after[n] - before[n]).norm());
  return farthest;
}

Trajectory restOf(const scenes::SceneEntry& entry, const Cage& cage, scenes::SceneOptions options) {
  options.substeps = kSubsteps;
  options.frames = kFrames;
  options.body.stiffnessDamping = kDamping;
  const std::unique_ptr<scenes::Scene> scene = entry.make(cage, options);
  Trajectory rest(2, scenes::nodesOf<float>(scene->body()));
  for (int frame = 1; frame < kFrames; ++frame) scene->step(frame);
  const std::vector<Eigen::Vector3f> before = scenes::nodesOf<float>(scene->body());
  scene->step(kFrames);
  rest[1] = scenes::nodesOf<float>(scene->body());
  if (farthestStep(before, rest[1]) <= static_cast<float>(kStill * options.size)) return rest;
  throw scenes::InputError("scene " + entry.name + ": the body does not come to rest; choose sag or cantilever");
}

}  // namespace

StillBody stillBody(const scenes::SceneEntry& entry, const Cage& cage, scenes::SceneOptions options) {
  StillBody body;
  VibrationOptions vibration;
  vibration.modeCount = kFrequencies;
  vibration.poissonRatio = options.body.poissonRatio;
  const Result<VibrationModes> modes = computeVibrationModes(cage, vibration);
  if (modes.status().code == StatusCode::Degenerate) {
    throw scenes::InputError(
        "a cage of " + std::to_string(cage.mesh.tetCount()) +
        " tets is not connected, and comes neither to rest nor has it frequencies; ask for more by " +
        "--tets, or by --reference-tets, of which a ninth is simulated, too");
  }
  scenes::require(modes.status());
  body.frequencies = modes.value().frequencies(1.0, 1.0);
  body.rest = restOf(entry, cage, std::move(options));
  return body;
}

double frequencyError(const std::vector<double>& frequencies, const std::vector<double>& right) {
  assert(frequencies.size() == right.size() && !right.empty());
  double squared = 0.0;
  for (std::size_t k = 0; k < right.size(); ++k) squared += std::pow(frequencies[k] / right[k] - 1.0, 2);
  return std::sqrt(squared / static_cast<double>(right.size()));
}

}  // namespace tetskin::report
