// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "bench/step_cases.h"

#include <BulletSoftBody/btDeformableGravityForce.h>
#include <BulletSoftBody/btDeformableMassSpringForce.h>
#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <BulletSoftBody/btSoftBodyHelpers.h>
#include <benchmark/benchmark.h>
#include <tetskin/contact/soft_contacts.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "measure/xpbd.h"
#include "scenes/caged_mesh.h"
#include "scenes/serpent.h"
#include "scenes/table.h"

namespace tetskin::bench {
namespace {

using benchmark::State;
using scenes::Force;

/// A third of a second of falling, and two of landing and rocking.
constexpr int kFrames = 140;
/// Substeps of XPBD per frame.
constexpr int kXpbdSubsteps = 10;

/// A cage scaled to the world.
TetMesh worldCage(std::size_t tets) {
  return scenes::inWorld(scenes::makeSerpent(), tets).cage.mesh;
}

/// Times frames of a run of kFrames that are spread evenly over it, however few the library asks for: a landing costs
/// more than a fall.
/// restart  begins the run, untimed
/// step     makes one frame
template <class Restart, class Step>
void timeFrames(State& state, Restart&& restart, Step&& step) {
  const auto wanted = static_cast<int>(std::min<benchmark::IterationCount>(state.max_iterations, kFrames));
  int frame = 0, timed = wanted;
  for (auto _ : state) {
    const bool over = timed == wanted;
    const int next = over ? kFrames / (2 * wanted) : (2 * timed + 1) * kFrames / (2 * wanted);
    if (over || frame != next) {
      state.PauseTiming();
      if (over) {
        restart();
        frame = timed = 0;
      }
      for (; frame < next; ++frame) step();
      state.ResumeTiming();
    }
    step();
    ++frame;
    ++timed;
  }
}

/// The drop scene with four steps per frame. All forces have the same Young's modulus: the default of bodies in
/// Bullet's solver, at which their steps are stable.
void drop(State& state, Force force, std::size_t tets) {
  const TetMesh cage = worldCage(tets);
  scenes::SceneOptions options;
  options.force = force;
  options.body.youngsModulus = scenes::defaultStiffness(cage, options.body);
  std::unique_ptr<scenes::Scene> scene;
  int frame = 0;
  const auto restart = [&] {
    scene = scenes::sceneNamed("obstacles").make(cage, options);
    frame = 0;
  };
  timeFrames(state, restart, [&] { scene->step(++frame); });
  if (scene->check().exploded) state.SkipWithError("the body has exploded");
  state.counters["tets"] = static_cast<double>(cage.tetCount());
}

/// One kilogram above the floor, with the tutorial's constants.
measure::XpbdBody fallingXpbd(std::size_t tets) {
  constexpr double kAboveFloor = 0.9;
  /// Metres per newton; with rigid volumes this gives a body that wobbles but keeps its volume.
  constexpr double kEdgeCompliance = 2e-4;
  const TetMesh cage = worldCage(tets);
  measure::XpbdBody body;
  body.floor = true;
  const double lift = kAboveFloor - boundingBox(cage.nodes).min().y();
  for (const Eigen::Vector3d& p : cage.nodes) body.nodes.emplace_back(p.x(), p.y() + lift, p.z());
  for (const auto& [a, b] : uniqueEdges(cage)) body.edges.push_back({a, b, kEdgeCompliance});
  std::vector<double> volumes(cage.nodeCount(), 0.0);
  for (const Tet& tet : cage.tets) {
    const auto edge = [&](int k) -> Eigen::Vector3d { return cage.nodes[tet[k]] - cage.nodes[tet[0]]; };
    const double volume = edge(1).cross(edge(2)).dot(edge(3)) / 6.0;
    body.volumes.push_back({tet, 0.0});
    for (const int n : tet) volumes[static_cast<std::size_t>(n)] += volume / 4.0;
  }
  const double total = totalVolume(cage);
  for (const double volume : volumes) body.inverseMasses.push_back(volume > 0.0 ? total / volume : 0.0);
  return body;
}

void dropXpbd(State& state, std::size_t tets) {
  const measure::XpbdBody falling = fallingXpbd(tets);
  std::unique_ptr<measure::Xpbd> body;
  timeFrames(
      state, [&] { body = std::make_unique<measure::Xpbd>(falling); },
      [&] { body->step(1.0f / 60.0f, kXpbdSubsteps); });
  for (const Eigen::Vector3f& p : body->nodes()) {
    if (!(p.y() < 10.0f)) return state.SkipWithError("the body has exploded");
  }
  const auto count = static_cast<double>(falling.volumes.size());
  state.counters["tets"] = count;
  state.counters["s_per_tet_and_substep"] = benchmark::Counter(
      count * kXpbdSubsteps, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

/// 500 bodies of 200 tets in free fall; 450 of them sleep.
void crowd(State& state, Force force) {
  constexpr std::size_t kBodies = 500, kAsleep = 450;
  scenes::SceneOptions options;
  options.force = force;
  options.bodies = kBodies;
  const auto scene = scenes::sceneNamed("crowd").make(worldCage(200), options);
  for (std::size_t b = 0; b < kAsleep; ++b) scene->body(b).forceActivationState(ISLAND_SLEEPING);
  int frame = 0;
  for (auto _ : state) scene->step(++frame);
  std::size_t asleep = 0;
  for (std::size_t b = 0; b < kBodies; ++b) asleep += !scene->body(b).isActive();
  state.counters["asleep"] = static_cast<double>(asleep);
}

/// A cloth of Bullet's springs that hangs by two corners: the cost of Bullet's own bodies in a world with either
/// solver. Bullet projects contacts in both.
void cloth(State& state, Force force) {
  constexpr int kSettled = 240;
  constexpr btScalar kFrame = btScalar(1.0 / 60.0);
  const btVector3 gravity(0, btScalar(-scenes::kEarth), 0);
  scenes::World owner(force, gravity);
  auto& world = static_cast<btDeformableMultiBodyDynamicsWorld&>(owner.bullet());
  world.setUseProjection(true);
  btDeformableMassSpringForce springs(30, 1, true);
  btDeformableGravityForce weight(gravity);
  const std::unique_ptr<btSoftBody> body(btSoftBodyHelpers::CreatePatch(world.getWorldInfo(), {-4, 0, -4}, {4, 0, -4},
                                                                        {-4, 0, 4}, {4, 0, 4}, 9, 9, 1 + 2, true));
  body->generateBendingConstraints(2);
  body->setTotalMass(1);
  body->setActivationState(DISABLE_DEACTIVATION);
  world.addSoftBody(body.get());
  world.addForce(body.get(), &springs);
  world.addForce(body.get(), &weight);
  const auto step = [&] { world.stepSimulation(kFrame, 4, kFrame / 4); };
  for (int f = 0; f < kSettled; ++f) step();
  for (auto _ : state) step();
  world.removeSoftBody(body.get());
}

/// The position of the node at the free end after each step of a second.
std::vector<btVector3> swing(const TetMesh& cage, const SoftBodyOptions& options) {
  constexpr int kSteps = 240;
  scenes::World world(Force::Elastic, btVector3(0, btScalar(-scenes::kEarth), 0));
  btSoftBody& body = world.add(cage, options);
  body.setActivationState(DISABLE_DEACTIVATION);
  const auto before = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return a.x() < b.x(); };
  const auto end = std::max_element(cage.nodes.begin(), cage.nodes.end(), before) - cage.nodes.begin();
  std::vector<btVector3> path = {body.m_nodes[static_cast<int>(end)].m_x};
  for (int step = 0; step < kSteps; ++step) {
    world.step(1.0 / kSteps);
    path.push_back(body.m_nodes[static_cast<int>(end)].m_x);
  }
  return path;
}

/// RMS distance of the free end from its position with an accurate solve of each step, divided by its longest swing.
double swingError(const TetMesh& cage, SoftBodyOptions options) {
  const std::vector<btVector3> path = swing(cage, options);
  options.solverTolerance = 1e-5;
  options.maxIterations = 1000;
  const std::vector<btVector3> exact = swing(cage, options);
  double squared = 0.0, way = 0.0;
  for (std::size_t k = 0; k < path.size(); ++k) {
    squared += static_cast<double>((path[k] - exact[k]).length2());
    way = std::max(way, static_cast<double>((exact[k] - exact[0]).length()));
  }
  return std::sqrt(squared / static_cast<double>(path.size())) / way;
}

/// Four steps per frame of a serpent of one kilogram that is held at one end, and swings.
/// stiffness  Young's modulus, Pa
void held(State& state, std::size_t tets, double stiffness) {
  constexpr double kHeld = 0.08;  // of its length
  const TetMesh cage = worldCage(tets);
  const Box3 box = boundingBox(cage.nodes);
  const double end = box.min().x() + kHeld * (box.max().x() - box.min().x());
  SoftBodyOptions options = scenes::oneKilogram();
  options.youngsModulus = stiffness;
  options.pinned = [end](const Eigen::Vector3d& p) { return p.x() < end; };
  std::unique_ptr<scenes::World> world;
  double iterations = 0.0, steps = 0.0;
  const auto restart = [&] {
    world = std::make_unique<scenes::World>(Force::Elastic, btVector3(0, btScalar(-scenes::kEarth), 0));
    world->add(cage, options).setActivationState(DISABLE_DEACTIVATION);
  };
  timeFrames(state, restart, [&] {
    for (int k = 0; k < 4; ++k, ++steps) {
      world->step(1.0 / 240.0);
      iterations += world->iterations();
    }
  });
  state.counters["iterations"] = iterations / std::max(steps, 1.0);
  state.counters["error"] = swingError(cage, options);
  state.counters["tets"] = static_cast<double>(cage.tetCount());
}

/// The serpent scaled to the world, and its contact shape with 4,000 samples.
struct TouchingModel {
  explicit TouchingModel(std::size_t tets) {
    scenes::CagedMesh serpent = scenes::inWorld(scenes::makeSerpent(), tets);
    ContactShapeOptions options;
    options.sampleCount = 4000;
    shape = ContactShape::create(serpent.cage, serpent.mesh, options).value();
    cage = std::move(serpent.cage);
  }

  Cage cage;
  std::shared_ptr<const ContactShape> shape;
};

/// The speed of the fastest node of all soft bodies, units per second.
double fastestNode(scenes::World& world) {
  const btCollisionObjectArray& objects = world.bullet().getCollisionObjectArray();
  btScalar fastest = 0;
  for (int k = 0; k < objects.size(); ++k) {
    const btSoftBody* body = btSoftBody::upcast(objects[k]);
    for (int n = 0; body && n < body->m_nodes.size(); ++n) fastest = std::max(fastest, body->m_nodes[n].m_v.length());
  }
  return static_cast<double>(fastest);
}

/// Steps of a world in which everything has come to rest.
void timeSettled(State& state, scenes::World& world, const Cage& cage) {
  constexpr int kSettled = 2400;
  for (int s = 0; s < kSettled; ++s) world.step(1.0 / 240.0);
  int iterations = 0;
  for (auto _ : state) {
    world.step(1.0 / 240.0);
    iterations += world.iterations();
  }
  state.counters["iterations"] = benchmark::Counter(iterations, benchmark::Counter::kAvgIterations);
  state.counters["fastest"] = fastestNode(world);
  state.counters["contacts"] = static_cast<double>(world.softContacts().size());
  state.counters["tets"] = static_cast<double>(cage.mesh.tetCount());
}

/// A step of two bodies that lie on each other, or far apart, with their contact or without.
void softPair(State& state, std::size_t tets, double apart, bool touch) {
  const TouchingModel model(tets);
  scenes::World world(Force::Elastic, btVector3(0, btScalar(-scenes::kEarth), 0));
  world.addBox({0, -2.0, 0}, {10, 1, 10});
  for (int k = 0; k < 2; ++k) {
    Cage placed = model.cage;
    const Eigen::AngleAxisd turn(1.1 * k, Eigen::Vector3d(0.3, 1.0, 0.2).normalized());
    for (Eigen::Vector3d& p : placed.mesh.nodes)
      p = turn * p + Eigen::Vector3d(apart * k, apart > 0.0 ? 0.0 : 1.25 * k, 0);
    btSoftBody& body = world.add(placed, scenes::oneKilogram());
    body.setActivationState(DISABLE_DEACTIVATION);
    if (touch) world.touchEachOther(body, model.shape);
  }
  timeSettled(state, world, model.cage);
}

/// A serpent on the floor, with self-contact or without: so soft that its coils sink onto each other, or stiff.
void softSelf(State& state, std::size_t tets, bool sinks, bool itself) {
  const TouchingModel model(tets);
  scenes::World world(Force::Elastic, btVector3(0, btScalar(-scenes::kEarth), 0));
  world.addBox({0, -2.0, 0}, {10, 1, 10});
  SoftBodyOptions how = scenes::oneKilogram();
  how.relativeStiffness = sinks ? 5.0 : 100.0;
  btSoftBody& body = world.add(model.cage, how);
  body.setActivationState(DISABLE_DEACTIVATION);
  if (itself) world.touchEachOther(body, model.shape, true);
  timeSettled(state, world, model.cage);
}

/// A frame with four substeps, of bodies that float beside each other.
void floating(State& state, int bodies, bool faceTree) {
  scenes::SceneOptions options;
  options.bodies = static_cast<std::size_t>(bodies);
  options.body.faceTree = faceTree;
  const auto scene = scenes::sceneNamed("float").make(worldCage(3000), options);
  for (auto _ : state) scene->step(1);
}

void registerFaceTrees() {
  for (const int bodies : {1, 2}) {
    for (const bool faceTree : {true, false}) {
      const std::string name = std::string("Step/face_tree:") + (faceTree ? "yes" : "no") + "/bodies:";
      benchmark::RegisterBenchmark((name + std::to_string(bodies)).c_str(), floating, bodies, faceTree)
          ->Unit(benchmark::kMillisecond);
    }
  }
}

void registerHeld() {
  for (const std::size_t tets : {500, 3000, 30000}) {
    for (const int kilopascals : {3, 30, 300}) {
      const std::string name = "Step/held/kPa:" + std::to_string(kilopascals) + "/tets:" + std::to_string(tets);
      benchmark::RegisterBenchmark(name.c_str(), held, tets, 1e3 * kilopascals)->Unit(benchmark::kMillisecond);
    }
  }
}

void registerSoftPairs() {
  for (const std::size_t tets : {503, 1004}) {
    for (const bool apart : {false, true}) {
      for (const bool touch : {false, true}) {
        const std::string name = "Step/soft_pair/" + std::string(apart ? "apart" : "touching") +
                                 (touch ? "/contact" : "/none") + "/tets:" + std::to_string(tets);
        benchmark::RegisterBenchmark(name.c_str(), softPair, tets, apart ? 4.0 : 0.0, touch)
            ->Unit(benchmark::kMicrosecond);
      }
    }
  }
}

void registerSoftSelves() {
  for (const std::size_t tets : {503, 1004}) {
    for (const bool sinks : {true, false}) {
      for (const bool itself : {false, true}) {
        const std::string name = "Step/soft_self/" + std::string(sinks ? "touching" : "apart") +
                                 (itself ? "/contact" : "/none") + "/tets:" + std::to_string(tets);
        benchmark::RegisterBenchmark(name.c_str(), softSelf, tets, sinks, itself)->Unit(benchmark::kMicrosecond);
      }
    }
  }
}

}  // namespace

void registerStepCases() {
  benchmark::RegisterBenchmark("Step/cloth/bullet", cloth, Force::NeoHookean)->Unit(benchmark::kMicrosecond);
  benchmark::RegisterBenchmark("Step/cloth/tetskin", cloth, Force::Elastic)->Unit(benchmark::kMicrosecond);
  registerFaceTrees();
  registerHeld();
  registerSoftPairs();
  registerSoftSelves();
  const std::pair<const char*, Force> forces[] = {{"bullet_neo_hookean", Force::NeoHookean},
                                                  {"bullet_linear", Force::LinearElasticity},
                                                  {"tetskin", Force::Elastic}};
  for (const std::size_t tets : {300, 3000, 10000, 30000, 100000}) {
    const std::string size = "/tets:" + std::to_string(tets);
    for (const auto& [name, force] : forces) {
      const std::string full = std::string("Step/") + name + size;
      benchmark::RegisterBenchmark(full.c_str(), drop, force, tets)->Unit(benchmark::kMillisecond);
    }
    benchmark::RegisterBenchmark(("Step/xpbd" + size).c_str(), dropXpbd, tets)->Unit(benchmark::kMillisecond);
  }
  for (const auto& [name, force] : {forces[0], forces[2]}) {
    const std::string full = std::string("Step/sleeping_crowd/") + name;
    benchmark::RegisterBenchmark(full.c_str(), crowd, force)->Unit(benchmark::kMillisecond);
  }
}

}  // namespace tetskin::bench
