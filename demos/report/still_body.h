// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <vector>

#include "report/simulation.h"

namespace tetskin::report {

/// What a body does apart from moving.
struct StillBody {
  Trajectory rest;                  ///< two frames: without loads, and at rest under those of a scene
  std::vector<double> frequencies;  ///< the lowest of the free body, ascending, for a Young's modulus and density of 1
};

/// Number of frequencies that are compared.
constexpr int kFrequencies = 6;

/// Simulates a cage in a scene with much damping until it rests, and computes its modes.
/// options  of the scene, with the body's material; their time steps and damping are not used
/// Throws InputError if the body does not come to rest, or has no vibrations
StillBody stillBody(const scenes::SceneEntry& entry, const Cage& cage, scenes::SceneOptions options);

/// Root mean square of the relative differences of as many frequencies.
double frequencyError(const std::vector<double>& frequencies, const std::vector<double>& right);

}  // namespace tetskin::report
