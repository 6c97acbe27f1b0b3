// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "measure/promise.h"

#include <cmath>
#include <cstring>

#include "scenes/printed_table.h"

namespace tetskin::measure {
namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();

bool beginsWith(const std::string& name, const char* start) {
  return name.compare(0, std::strlen(start), start) == 0;
}

}  // namespace

const std::vector<Promise>& promises() {
  // Of gaps, in units of S; of claims, energies over the initial one and the work put in.
  static const std::vector<Promise> all = {
      {"gap", "gap at rest by surface", -0.003, 0.003},
      {"claim", "energy", -kNone, 1.02},
      // The point that is dragged is light compared with the rest; in long steps, the spring's full force strains the
      // body for a moment.
      {"claim/dragged", "energy", -kNone, 1.2},
      {"claim/dragged in long steps", "energy", -kNone, 1.5},
      {"claim", "momentum lost", -kNone, 1e-3},
      {"claim", "extent over a fine reference's", -kNone, 1.2},
      {"free flight", "linear momentum lost", -kNone, 1e-5},
      {"free flight", "angular momentum lost", -kNone, 1e-5},
      {"hit", "linear momentum lost", -kNone, 1e-3},
      {"hit", "angular momentum lost", -kNone, 1e-3},
      {"hit", "energy over its start", -kNone, 1.001},
      {"hit in trigger", "linear momentum lost", -kNone, 1e-3},
      {"hit in trigger", "angular momentum lost", -kNone, 1e-3},
      {"hit in ghost", "linear momentum lost", -kNone, 1e-3},
      {"hit in ghost", "angular momentum lost", -kNone, 1e-3},
      {"hit by multibody", "linear momentum lost", -kNone, 1e-2},
      {"hit by multibody", "angular momentum lost", -kNone, 1e-2},
      {"between", "linear momentum lost", -kNone, 1e-2},
      {"between", "angular momentum lost", -kNone, 1e-2},
      {"between", "energy over its start", -kNone, 1.001},
      {"application/anchor", "stretch over analytic value", 0.9, 1.1},
      {"application/anchor", "speed, m/s", -kNone, 0.005},
      {"application/plate and soft", "speed, m/s", -kNone, 0.005},
      {"application/plate and soft", "downward displacement, m", -kNone, 0.02},
      {"application/stack of five", "speed, m/s", -kNone, 0.005},
      {"application/stack of five", "downward displacement, m", -kNone, 0.02},
      {"application/slope", "speed, m/s", -kNone, 1e-4},
      {"application/slope", "asleep", 1.0, 1.0},
      {"application/mouse", "speed, m/s", -kNone, 0.01},
      {"plate", "sinks, S", -kNone, 0.001},
      {"heavy", "box's speed, S/s", -kNone, 0.01},
      {"heavy", "box displacement, S", -kNone, 0.05},
      {"roll/undamped", "acceleration over rigid", 0.9, 1.1},
      {"roll/by default", "ratio of the two", 0.9, 1.1},
      {"table/0.8", "drift in 3 s, S", -kNone, 0.001},
      {"table/0.6", "drift in 3 s, S", 0.1, kNone},
      {"table/in its middle", "spin over the table's", 0.995, 1.005},
      {"creep", "contact points move in 5 s, S", -kNone, 0.0005},
      {"stop", "distance over a point's", 0.97, 1.03},
      {"copies", "10 of each: distance error", -kNone, 0.001},
      {"copies", "300 of each: distance error", -kNone, 0.001},
      {"energy", "energy over its start", -kNone, 1.001},
      {"energy/ball lands", "least gap, S", -0.009, kNone},
      {"energy/box lands", "least gap, S", -0.009, kNone},
      {"energy/crushed by 50kg at 10/k50", "least gap, S", -0.0258, kNone},
      {"energy/crushed by 50kg at 10/k500", "least gap, S", -0.0305, kNone},
      {"energy/squeezed", "least gap, S", -0.001, kNone},
      {"bounce", "rebound beside 64 substeps", -0.2, 0.2},
      {"bounce", "energy over its start", -kNone, 1.06},
      {"moved plate/kicks", "least gap, S", -0.009, kNone},
      {"gripped", "sinks in 2 s, S", -0.0005, 0.0005},
      {"thin plate", "least gap, S", -0.009, kNone},
      {"rest", "gap, S", -0.001, 0.001},
      {"rest/box", "fastest node, m/s", -kNone, 0.005},
      {"rest", "push over weight", 0.999, 1.001},
      {"sleep/forces", "asleep", 1.0, 1.0},
      {"sleep/forces", "force error, weights", -kNone, 0.005},
      {"sleep/flight", "way over a point's", 0.995, 1.005},
      {"sleep/carried", "gap's change, S", -kNone, 0.0005},
      {"sleep/carried", "way over the plate's", 0.99, 1.01},
      {"sleep/woken", "asleep before, awake after", 1.0, 1.0},
      {"deep", "fastest node, S/s", -kNone, 2.2},
      {"deep", "gap at the end, S", -0.005, kNone},
      {"coarse", "least gap as drawn, S", -0.001, kNone},
      {"coarse", "fastest node, S/s", -kNone, 0.005},
      {"coarse/balls", "lowest ball, S", -0.002, kNone},
      {"coarse/cube on cube", "least gap, S", -0.001, kNone},
      {"soft stack", "least gap, S", -0.001, kNone},
      {"soft stack", "fastest node, S/s", -kNone, 0.005},
      {"soft slide/k", "distance over v^2 / (2 mu g)", 0.97, 1.03},
      {"slide", "distance over v^2 / (2 mu g)", 0.97, 1.03},
      {"slide", "aside over v^2 / (2 mu g)", -kNone, 0.01},
      {"slide", "jump, S", -kNone, 0.002},
      {"soft overlap/cubes", "fastest node, S/s", -kNone, 2.0},
      {"soft overlap/balls 0.1 aside/weightless", "fastest node, S/s", -kNone, 2.0},
      {"soft overlap/balls in one place/weightless", "fastest node, S/s", -kNone, 2.0},
      {"soft overlap", "nearest centroids, S", 0.9, kNone},
      {"soft collide", "linear momentum lost", -kNone, 1e-3},
      {"soft collide", "angular momentum lost", -kNone, 1e-3},
      {"soft collide", "energy over its start", -kNone, 1.001},
      {"soft collide", "least gap, S", -0.02, kNone},
      {"soft collide", "most inverted tets", -kNone, 0.0},
      {"pad/weightless", "velocity over its start", 0.99, 1.01},
      {"pad", "creeps, m/s", -kNone, 1e-4},
      {"held bar", "angular momentum lost", -kNone, 1e-5},
      {"links", "separation, S", -kNone, 1e-4},
      {"links", "rotation, rad", -kNone, 0.002},
      {"links", "pull over weight", 0.999, 1.001},
      {"links", "period over a rigid pendulum's", 0.99, 1.01},
  };
  return all;
}

const Promise* promiseFor(const std::string& scene, const std::string& figure) {
  const Promise* best = nullptr;
  for (const Promise& promise : promises()) {
    if (figure != promise.figure || !beginsWith(scene, promise.scene)) continue;
    if (!best || std::strlen(promise.scene) > std::strlen(best->scene)) best = &promise;
  }
  return best;
}

std::string text(double value) {
  return scenes::formatted("%g", value);
}

std::string text(const Promise& promise) {
  if (promise.minimum == promise.maximum) return text(promise.minimum);
  if (std::isinf(promise.minimum)) return "<= " + text(promise.maximum);
  if (std::isinf(promise.maximum)) return ">= " + text(promise.minimum);
  return text(promise.minimum) + " .. " + text(promise.maximum);
}

}  // namespace tetskin::measure
