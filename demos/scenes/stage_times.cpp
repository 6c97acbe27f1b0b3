// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "scenes/stage_times.h"

#include <cassert>
#include <nlohmann/json.hpp>
#include <string>

#include "scenes/printed_table.h"

namespace tetskin::scenes {
namespace {

/// A stage's name in a summary, and in print; those of the solver first, in the order of a step.
struct StageName {
  const char* key;
  const char* printed;
  double StepTimes::*solvers = nullptr;  ///< null: not one of the solver's
};

constexpr StageName kSolverStages[] = {{"prediction", "elastic prediction", &StepTimes::prediction},
                                       {"rigid_search", "search, rigid", &StepTimes::rigidSearch},
                                       {"soft_search", "search, soft", &StepTimes::softSearch},
                                       {"rows", "rows", &StepTimes::rows},
                                       {"system", "system", &StepTimes::system}};
constexpr StageName kBullet{"bullet", "rest of Bullet's step"}, kSkin{"skin", "skin"};

}  // namespace

StageTimes StageTimes::operator-(const StageTimes& earlier) const {
  StageTimes difference{{}, simulation - earlier.simulation, skin - earlier.skin};
  for (const StageName& stage : kSolverStages) {
    difference.solver.*stage.solvers = solver.*stage.solvers - earlier.solver.*stage.solvers;
  }
  return difference;
}

nlohmann::ordered_json toJson(const StageTimes& times, int frames) {
  assert(frames > 0);
  const auto perFrame = [&](double seconds) { return 1e3 * seconds / frames; };
  nlohmann::ordered_json stages;
  for (const StageName& stage : kSolverStages) stages[stage.key] = perFrame(times.solver.*stage.solvers);
  stages[kBullet.key] = perFrame(times.simulation - times.solver.total());
  stages[kSkin.key] = perFrame(times.skin);
  return stages;
}

void printStages(const nlohmann::ordered_json& means, const nlohmann::ordered_json& slowest) {
  const auto print = [&](const StageName& stage) {
    const std::string inSlowest =
        slowest.is_null() ? "" : formatted("; %.2f in the slowest second", slowest, stage.key);
    printValue((std::string("  ") + stage.printed).c_str(),
               formatted("%.2f ms per frame", means, stage.key) + inSlowest);
  };
  for (const StageName& stage : kSolverStages) print(stage);
  print(kBullet);
  print(kSkin);
}

}  // namespace tetskin::scenes
