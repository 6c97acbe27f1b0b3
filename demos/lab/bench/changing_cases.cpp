// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "bench/changing_cases.h"

#include <BulletSoftBody/btSoftBody.h>
#include <benchmark/benchmark.h>
#include <tetskin/elastic/elastic_body.h>
#include <tetskin/solver/deformable_body.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "scenes/caged_mesh.h"
#include "scenes/input_error.h"
#include "scenes/solid_meshes.h"
#include "scenes/world.h"

namespace tetskin::bench {
namespace {

using benchmark::State;
using scenes::require;

constexpr int kChangingFrames = 120;
constexpr int kChangingSubsteps = 4;
constexpr double kChangingYoung = 3e4;  ///< Pa

/// Something that makes a frame, and returns the iterations of its solves.
using Frames = std::function<int(int frame)>;

/// Times frames of two runs that begin anew together, in turns: the first one's processor time and, as counters, its
/// ratio to that of the second, and the iterations of either.
void timePair(State& state, const std::function<Frames()>& with, const std::function<Frames()>& without) {
  Frames runs[2];
  double totals[2] = {}, iterations[2] = {};
  int frame = kChangingFrames;
  for (auto _ : state) {
    if (frame == kChangingFrames) {
      runs[0] = with();
      runs[1] = without();
      frame = 0;
    }
    double seconds[2] = {};
    for (const int k : {frame % 2, 1 - frame % 2}) {
      const std::clock_t begin = std::clock();
      iterations[k] += runs[k](frame);
      seconds[k] = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
      totals[k] += seconds[k];
    }
    state.SetIterationTime(seconds[0]);
    ++frame;
  }
  const double steps = kChangingSubsteps * static_cast<double>(state.iterations());
  state.counters["over"] = totals[0] / totals[1];
  state.counters["iterations"] = iterations[0] / steps;
  state.counters["iterations_without"] = iterations[1] / steps;
}

/// From 0 to 1 and back, in a second.
double wave(int frame) {
  return 1.0 - std::abs(frame % 60 - 30) / 30.0;
}

/// What is done to an ElasticBody when it is made, and in each frame.
struct Change {
  std::function<void(ElasticBody<float>&)> begin = [](ElasticBody<float>&) {};
  std::function<void(ElasticBody<float>&, int)> act = [](ElasticBody<float>&, int) {};
};

/// A bar of one kilogram, held at one end, while the other one is pulled by a tenth of its length and pushed back, once
/// in a second.
Frames pulledBar(const Cage& cage, const Change& change) {
  ElasticOptions options;
  options.youngsModulus = kChangingYoung;
  options.stiffnessDamping = 0.005;
  options.density = 1.0 / totalVolume(cage.mesh);
  auto made = ElasticBody<float>::create(cage, options);
  require(made.status());
  const auto body = std::make_shared<ElasticBody<float>>(std::move(made).value());
  const Box3 box = boundingBox(cage.mesh.nodes);
  const double length = box.sizes().x(), near = 0.03 * length;
  std::vector<std::size_t> led;
  for (std::size_t n = 0; n < body->nodeCount(); ++n) {
    const double x = cage.mesh.nodes[n].x();
    body->setPinned(n, x < box.min().x() + near || x > box.max().x() - near);
    if (x > box.max().x() - near) led.push_back(n);
  }
  change.begin(*body);
  return [body, change, led, length](int frame) {
    change.act(*body, frame);
    const double speed = 60.0 * 0.1 * length * (wave(frame + 1) - wave(frame));
    for (const std::size_t n : led) body->velocities()[n][0] = static_cast<float>(speed);
    int iterations = 0;
    for (int k = 0; k < kChangingSubsteps; ++k) {
      iterations += body->step(1.0 / (60 * kChangingSubsteps), {0, -scenes::kEarth, 0});
    }
    return iterations;
  };
}

Change flowing(double yieldStrain) {
  Change change;
  change.begin = [yieldStrain](ElasticBody<float>& body) {
    Plasticity plasticity;
    plasticity.yieldStress = yieldStrain * kChangingYoung;
    require(body.setPlasticity(plasticity));
  };
  return change;
}

std::vector<int> everyTet(std::size_t tets, std::size_t step) {
  std::vector<int> some;
  for (std::size_t t = 0; t < tets; t += step) some.push_back(static_cast<int>(t));
  return some;
}

/// Every fourth tet contracts, as far as the frame says.
Change contracting(std::size_t tets, double (*activation)(int), bool byLength = false) {
  Change change;
  change.begin = [tets, byLength](ElasticBody<float>& body) {
    Muscle muscle;
    muscle.tets = everyTet(tets, 4);
    muscle.fibres = {Eigen::Vector3d::UnitX()};
    muscle.stress = 0.3 * kChangingYoung;
    if (byLength) muscle.lengthFactors = {{0.5, 0.0}, {0.9, 1.0}, {1.1, 1.0}, {1.6, 0.0}};
    require(body.addMuscle(muscle).status());
  };
  change.act = [activation](ElasticBody<float>& body, int frame) { require(body.setActivation(0, activation(frame))); };
  return change;
}

Change withFibres(const std::vector<int>& tets) {
  Change change;
  change.begin = [tets](ElasticBody<float>& body) {
    require(body.addFibres({tets, {Eigen::Vector3d::UnitX()}, kChangingYoung, false}));
  };
  return change;
}

Change growing() {
  Change change;
  change.begin = [](ElasticBody<float>& body) { require(body.setGrowth(1.1)); };
  return change;
}

Change withLaw(const ElasticLaw& law) {
  Change change;
  change.begin = [law](ElasticBody<float>& body) { require(body.setElasticLaw(law)); };
  return change;
}

Change pressed(bool gas) {
  Change change;
  change.begin = [gas](ElasticBody<float>& body) {
    require(gas ? body.setGas(0.02 * kChangingYoung) : body.setPressure(0.02 * kChangingYoung));
  };
  return change;
}

void changingBar(State& state, const Cage& cage, const Change& change) {
  timePair(
      state, [&] { return pulledBar(cage, change); }, [&] { return pulledBar(cage, {}); });
  state.counters["tets"] = static_cast<double>(cage.mesh.tetCount());
}

/// A wall of one layer of prisms, each of three tets, inside a ball's surface.
/// inside  radius over the ball's
TetMesh wallOf(const TriangleMesh& ball, double inside) {
  TetMesh wall;
  wall.nodes = ball.positions;
  for (const Eigen::Vector3d& p : ball.positions) wall.nodes.push_back(inside * p);
  const int inner = static_cast<int>(ball.positions.size());
  for (std::array<int, 3> t : ball.triangles) {
    std::sort(t.begin(), t.end());  // so that neighbours cut their common side along the same diagonal
    for (Tet tet : {Tet{t[0], t[1], t[2], t[2] + inner}, Tet{t[0], t[1], t[1] + inner, t[2] + inner},
                    Tet{t[0], t[0] + inner, t[1] + inner, t[2] + inner}}) {
      const auto edge = [&](int k) -> Eigen::Vector3d { return wall.nodes[tet[k]] - wall.nodes[tet[0]]; };
      if (edge(1).cross(edge(2)).dot(edge(3)) < 0.0) std::swap(tet[2], tet[3]);
      wall.tets.push_back(tet);
    }
  }
  return wall;
}

/// A hollow ball of 3,840 tets that lies on the floor, which touches its surface; and what is done to it.
Frames lyingBall(const std::function<void(DeformableBody&)>& change) {
  const TriangleMesh ball = scenes::icosphere(3);
  Cage cage;
  cage.mesh = wallOf(ball, 0.9);
  const auto world =
      std::make_shared<scenes::World>(scenes::Force::Elastic, btVector3(0, btScalar(-scenes::kEarth), 0));
  world->addBox({0, -2.02, 0}, {10, 1, 10});
  SoftBodyOptions options = scenes::oneKilogram();
  options.youngsModulus = kChangingYoung;
  btSoftBody& body = world->add(cage, options);
  body.setActivationState(DISABLE_DEACTIVATION);
  world->touchBySurface(body, *SoftBodyBinding::create(cage, ball).value(), ball);
  change(world->deformable());
  return [world](int) {
    int iterations = 0;
    for (int k = 0; k < kChangingSubsteps; ++k) {
      world->step(1.0 / (60 * kChangingSubsteps));
      iterations += world->iterations();
    }
    return iterations;
  };
}

void changingBall(State& state, Status (*change)(DeformableBody&)) {
  timePair(
      state, [&] { return lyingBall([&](DeformableBody& body) { require(change(body)); }); },
      [] { return lyingBall([](DeformableBody&) {}); });
}

}  // namespace

void registerChangingCases() {
  const auto add = [](const char* name, auto&& measured) {
    benchmark::RegisterBenchmark((std::string("Changing/") + name).c_str(), measured)
        ->UseManualTime()
        ->Iterations(2 * kChangingFrames)
        ->Unit(benchmark::kMillisecond);
  };
  const auto cage = std::make_shared<std::unique_ptr<Cage>>();  // made by the first case that runs
  const auto addBar = [&](const char* name, const std::function<Change(std::size_t tets)>& change) {
    add(name, [cage, change](State& state) {
      if (!*cage) *cage = std::make_unique<Cage>(scenes::builtCage(scenes::boxOfGrids({1.0, 0.25, 0.25}, 32), 3000));
      changingBar(state, **cage, change((*cage)->mesh.tetCount()));
    });
  };
  addBar("nothing", [](std::size_t) { return Change(); });
  addBar("plasticity/nothing_yields", [](std::size_t) { return flowing(1e3); });
  addBar("plasticity/everything_flows", [](std::size_t) { return flowing(0.01); });
  addBar("growth/constant", [](std::size_t) { return growing(); });
  addBar("muscle/constant", [](std::size_t tets) { return contracting(tets, [](int) { return 0.5; }); });
  addBar("muscle/changing", [](std::size_t tets) { return contracting(tets, wave); });
  addBar("muscle/by_length", [](std::size_t tets) {
    return contracting(
        tets, [](int) { return 0.5; }, true);
  });
  addBar("fibres/quarter", [](std::size_t tets) { return withFibres(everyTet(tets, 4)); });
  addBar("fibres/all", [](std::size_t tets) { return withFibres(everyTet(tets, 1)); });
  addBar("law/neo_hookean", [](std::size_t) { return withLaw(ElasticLaw::neoHookean()); });
  addBar("law/yeoh", [](std::size_t) { return withLaw(ElasticLaw::yeoh(0.4, 0.2)); });
  addBar("pressure/constant", [](std::size_t) { return pressed(false); });
  addBar("pressure/gas", [](std::size_t) { return pressed(true); });
  add("hollow_ball/nothing", [](State& state) { changingBall(state, [](DeformableBody&) { return Status(); }); });
  add("hollow_ball/constant", [](State& state) {
    changingBall(state, [](DeformableBody& body) { return body.setPressure(0.02 * kChangingYoung); });
  });
  add("hollow_ball/gas", [](State& state) {
    changingBall(state, [](DeformableBody& body) { return body.setGas(0.02 * kChangingYoung); });
  });
}

}  // namespace tetskin::bench
