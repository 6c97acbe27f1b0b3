// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "bench/budget_cases.h"

#include <benchmark/benchmark.h>
#include <tetskin/world/world.h>

#include <cmath>
#include <memory>
#include <string>

#include "scenes/caged_mesh.h"
#include "scenes/serpent.h"
#include "scenes/system.h"
#include "scenes/timer.h"

namespace tetskin::bench {
namespace {

using benchmark::State;

constexpr std::size_t kBudgetTriangles = 20000;
constexpr int kBudgetFrames = 30, kFramesOfLanding = 60;
constexpr double kBudgetFrame = 1.0 / 60.0;

/// Serpents side by side, which fall freely, or have landed on a ground and are kept awake.
void timeWorld(State& state, int bodies, std::size_t tets, bool landed) {
  scenes::CagedMesh model = scenes::inWorld(scenes::makeSerpent({kBudgetTriangles}), tets);
  const auto cage = std::make_shared<const Cage>(std::move(model.cage));
  const auto mesh = std::make_shared<const TriangleMesh>(std::move(model.mesh));
  const Box3 box = boundingBox(mesh->positions);
  const auto side = static_cast<int>(std::ceil(std::sqrt(bodies)));
  WorldBodyOptions options;
  options.material.faceTree = false;
  for (auto _ : state) {
    const std::size_t before = scenes::heapBytes();
    World world;
    if (landed) {
      const auto plane = std::make_shared<btStaticPlaneShape>(btVector3(0, 1, 0), static_cast<btScalar>(box.min().y()));
      (void)world.addRigidBody(plane, 0, btTransform::getIdentity()).value();
    }
    for (int b = 0; b < bodies; ++b) {
      const int row = b / side;
      const Eigen::Affine3d place(Eigen::Translation3d(3.0 * (b % side), 0, 3.0 * row));
      world.addBody(cage, mesh, options, place).value()->body->body().setActivationState(DISABLE_DEACTIVATION);
    }
    for (int frame = 0; frame < (landed ? kFramesOfLanding : 1); ++frame) (void)world.step(kBudgetFrame).value();
    const scenes::CpuTimer timer;
    for (int frame = 0; frame < kBudgetFrames; ++frame) (void)world.step(kBudgetFrame).value();
    state.SetIterationTime(timer.seconds() / kBudgetFrames);
    state.counters["MB"] = 1e-6 * static_cast<double>(scenes::heapBytes() - before);
  }
}

}  // namespace

void registerBudgetCases() {
  for (const std::size_t tets : {500, 3000}) {
    for (const int bodies : {1, 10, 50}) {
      for (const bool landed : {false, true}) {
        const std::string name =
            "Budget/" + std::to_string(bodies) + "x" + std::to_string(tets) + (landed ? "/contact" : "/free");
        benchmark::RegisterBenchmark(name.c_str(), timeWorld, bodies, tets, landed)
            ->UseManualTime()
            ->Iterations(1)
            ->Unit(benchmark::kMillisecond);
      }
    }
  }
}

}  // namespace tetskin::bench
