// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// How long the stages of a run's frames take.
#pragma once

#include <tetskin/solver/deformable_world.h>

#include <nlohmann/json_fwd.hpp>

namespace tetskin::scenes {

/// Seconds, wall time; sums over any number of frames.
struct StageTimes {
  StepTimes solver;         ///< the solver's stages; 0 with other solvers than the library's
  double simulation = 0.0;  ///< all of Bullet's steps, the solver's stages included
  double skin = 0.0;        ///< updates of surfaces, after the steps

  StageTimes operator-(const StageTimes& earlier) const;
};

/// The mean of each stage, milliseconds per frame.
/// frames  at least 1
nlohmann::ordered_json toJson(const StageTimes& times, int frames);
/// Prints one line per stage.
/// means   from `toJson`
/// slowest  from there too, of the slowest second of the run; or null
void printStages(const nlohmann::ordered_json& means, const nlohmann::ordered_json& slowest);

}  // namespace tetskin::scenes
