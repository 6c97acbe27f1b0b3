// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "bench/pile_cases.h"

#include <benchmark/benchmark.h>

#include <string>

#include "pile/pile.h"
#include "scenes/timer.h"

namespace tetskin::bench {
namespace {

using benchmark::State;
using scenes::Pile;

constexpr int kFallingFrames = 2 * scenes::kFramesPerSecond, kRestFrames = scenes::kFramesPerSecond;
/// A pile is at rest when nothing is faster than this, metres per second, or after this many frames: some go on
/// rocking.
constexpr double kRestSpeed = 0.01;
constexpr int kMostSettlingFrames = 6 * scenes::kFramesPerSecond;

enum class Phase { Falling, Rest };

struct PileCase {
  const char* scene;
  int bodies;  ///< that fall
  Phase phase;
  int threads = 1;
};

/// Untimed frames until the pile is at rest. Returns false if it explodes.
bool settle(Pile& pile) {
  for (int frame = 0; frame < kMostSettlingFrames; ++frame) {
    if (!pile.step()) return false;
    if (frame > kFallingFrames && pile.fastest() < kRestSpeed) return true;
  }
  return true;
}

/// Totals over the timed frames.
struct PileTimes {
  double wall = 0.0, processor = 0.0;  ///< seconds
  bool exploded = false;
};

PileTimes timedFrames(Pile& pile, int frames) {
  PileTimes times;
  const scenes::WallTimer wall;
  const scenes::ProcessTimer processor;
  for (int frame = 0; frame < frames && !times.exploded; ++frame) times.exploded = !pile.step();
  times.wall = wall.seconds();
  times.processor = processor.seconds();
  return times;
}

/// The time of an iteration is that of a frame: the processor's with one thread, so that other programs do not count,
/// and wall time with several.
void timePile(State& state, const PileCase& made) {
  scenes::PileOptions options = scenes::presetOf(made.scene);
  options.bodies = made.bodies;
  options.threads = made.threads;
  options.model.quiet = true;
  const int frames = made.phase == Phase::Falling ? kFallingFrames : kRestFrames;
  for (auto _ : state) {
    Pile pile(options);
    pile.keepAwake();  // measurements must not depend on when the last body falls asleep
    const bool settled = made.phase == Phase::Falling || settle(pile);
    const scenes::SolveTotals before = pile.world().solveTotals();
    const PileTimes times = timedFrames(pile, frames);
    if (!settled || times.exploded) {
      state.SkipWithError("a body has exploded");
      break;
    }
    const double seconds = made.threads == 1 ? times.processor : times.wall;
    state.SetIterationTime(seconds / frames);
    const scenes::SolveTotals& after = pile.world().solveTotals();
    const double steps = after.steps - before.steps;
    state.counters["step_us"] = 1e6 * seconds / steps;
    state.counters["per_thing_us"] = 1e6 * seconds / steps / made.bodies;
    state.counters["iterations"] = static_cast<double>(after.iterations - before.iterations) / steps;
    state.counters["passes"] = static_cast<double>(after.passes - before.passes) / steps;
    state.counters["unconverged"] = after.unconverged - before.unconverged;
    state.counters["fastest"] = pile.fastest();
  }
}

void add(const PileCase& made) {
  const std::string name = (std::string(made.scene) == "pit" ? "Pit/" : "Bin/") + std::to_string(made.bodies) +
                           (made.phase == Phase::Falling ? "/falling" : "/rest") +
                           (made.threads > 1 ? "/threads:" + std::to_string(made.threads) : "");
  benchmark::RegisterBenchmark(name.c_str(), timePile, made)
      ->UseManualTime()
      ->Iterations(1)
      ->Unit(benchmark::kMillisecond);
}

}  // namespace

void registerPileCases() {
  constexpr int kThreaded = 100;
  for (const char* scene : {"pit", "bin"}) {
    for (const int bodies : {10, 25, 50, 100, 200}) {
      for (const Phase phase : {Phase::Falling, Phase::Rest}) {
        add({scene, bodies, phase});
        if (std::string(scene) == "bin" && bodies == kThreaded) add({scene, bodies, phase, 2});
      }
    }
  }
}

}  // namespace tetskin::bench
