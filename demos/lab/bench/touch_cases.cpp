// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "bench/touch_cases.h"

#include <BulletSoftBody/btDeformableBodySolver.h>
#include <BulletSoftBody/btDeformableMousePickingForce.h>
#include <benchmark/benchmark.h>
#include <btBulletDynamicsCommon.h>
#include <tetskin/touch/surface_joint.h>
#include <tetskin/touch/surface_point.h>

#include <cmath>
#include <memory>
#include <random>
#include <string>

#include "measure/body_model.h"
#include "scenes/caged_mesh.h"
#include "scenes/serpent.h"
#include "scenes/world.h"

namespace tetskin::bench {
namespace {

using benchmark::State;
using Eigen::Vector3d;

constexpr std::size_t kTouchTets = 1000;
constexpr double kFrameTime = 1.0 / 60.0;
/// Two seconds, in each of which it turns once.
constexpr int kSwingFrames = 120;
/// Farther than any body is sent, in units of its size: a body beyond it has exploded.
constexpr double kLost = 50.0;

/// The serpent, kSize long, with its cage's centre two of its sizes above the origin.
const measure::BodyModel& serpent() {
  static const measure::ModelPtr model = [] {
    scenes::CagedMesh made = scenes::inWorld(scenes::makeSerpent(), kTouchTets);
    for (auto* points : {&made.cage.mesh.nodes, &made.mesh.positions}) {
      for (Vector3d& p : *points) p.y() += 2 * scenes::kSize;
    }
    return measure::makeModel(std::move(made.mesh), std::move(made.cage));
  }();
  return *model;
}

/// The vertex of the mesh that is furthest along an axis.
int furthest(const TriangleMesh& mesh, const Vector3d& along) {
  const auto less = [&](const Vector3d& a, const Vector3d& b) { return a.dot(along) < b.dot(along); };
  return static_cast<int>(std::max_element(mesh.positions.begin(), mesh.positions.end(), less) -
                          mesh.positions.begin());
}

void bend(btSoftBody& body, double phase) {
  for (int n = 0; n < body.m_nodes.size(); ++n) {
    btVector3& x = body.m_nodes[n].m_x;
    x.setZ(x.z() + static_cast<btScalar>(0.02 * std::sin(3 * static_cast<double>(x.x()) + phase)));
  }
}

std::vector<std::array<btVector3, 2>> raysThrough(const SoftBodySkin& skin, std::size_t count) {
  std::mt19937 random(1);
  const Vector3d low = skin.bounds().min(), size = skin.bounds().sizes();
  std::uniform_real_distribution<double> number(-0.5, 1.5);
  const auto point = [&] {
    return toBullet(low + size.cwiseProduct(Vector3d(number(random), number(random), number(random))));
  };
  std::vector<std::array<btVector3, 2>> rays(count);
  for (auto& ray : rays) ray = {point(), point()};
  return rays;
}

/// fits  the face tree is refitted, as the body moves before every ray
void castRays(State& state, bool fits) {
  const measure::BodyModel& model = serpent();
  scenes::World world(scenes::Force::Elastic, btVector3(0, 0, 0));
  btSoftBody& body = world.add(model.cage, scenes::oneKilogram());
  SoftBodySkin skin;
  (void)skin.bind(body, model.binding);
  const SurfaceTree tree = SurfaceTree::create(model.binding, model.mesh).value();
  bend(body, 1);
  (void)skin.update();
  const auto rays = raysThrough(skin, 10'000);
  std::size_t r = 0, hits = 0;
  for (auto _ : state) {
    if (fits) {
      btVector3& x = body.m_nodes[0].m_x;
      x.setX(x.x() + btScalar(1e-6));
    }
    const auto& [from, to] = rays[r++ % rays.size()];
    hits += static_cast<bool>(tree.raycast(skin, from, to));
  }
  state.counters["hits"] = static_cast<double>(hits) / static_cast<double>(r);
  state.counters["triangles"] = static_cast<double>(model.mesh.triangleCount());
}

/// Moves around a circle, half the body's size across, once per second.
btVector3 swung(const btVector3& start, double seconds) {
  const double angle = 2 * EIGEN_PI * seconds, radius = 0.25 * scenes::kSize;
  return start + toBullet({radius * std::sin(angle), 0, radius * (1 - std::cos(angle))});
}

enum class Puller { Spring, Bullets };

/// Bullet's own force on the face nearest to the point, with the same stiffness.
std::unique_ptr<btDeformableMousePickingForce> bulletsForce(btSoftBody& body, const SurfacePoint& point,
                                                            double stiffness) {
  const btVector3 at = *point.position();
  int nearest = 0;
  btScalar minimum = BT_LARGE_FLOAT;
  for (int f = 0; f < body.m_faces.size(); ++f) {
    const auto& n = body.m_faces[f].m_n;
    const btScalar distance = ((n[0]->m_x + n[1]->m_x + n[2]->m_x) / 3 - at).length();
    if (distance >= minimum) continue;
    minimum = distance;
    nearest = f;
  }
  double mass = 0;
  for (int n = 0; n < body.m_nodes.size(); ++n) mass += 1 / static_cast<double>(body.m_nodes[n].m_im);
  const double k = stiffness * 4 * mass / body.m_nodes.size() * 240 * 240 / 3;  // shared by three nodes
  auto force = std::make_unique<btDeformableMousePickingForce>(static_cast<btScalar>(k), btScalar(0),
                                                               body.m_faces[nearest], at, btScalar(1e30));
  auto* solver = static_cast<btDeformableBodySolver*>(body.getSoftBodySolver());
  force->addSoftBody(&body);
  force->setIndices(solver->getIndices());
  solver->getLagrangianForceArray()->push_back(force.get());
  return force;
}

/// The serpent hangs by its top, and is swung. The lag is the largest distance between point and target after a frame,
/// from half a second onwards.
void swing(State& state, Puller puller, double stiffness, int rate) {
  const measure::BodyModel& model = serpent();
  double lag = 0;
  bool lost = false;
  for (auto _ : state) {
    scenes::World world(scenes::Force::Elastic, btVector3(0, btScalar(-9.81), 0));
    btSoftBody& body = world.add(model.cage, scenes::oneKilogram());
    body.setActivationState(DISABLE_DEACTIVATION);
    const SurfaceTree tree = SurfaceTree::create(model.binding, model.mesh).value();
    const SurfacePoint point = tree.pointAtVertex(body, furthest(model.mesh, Vector3d::UnitY())).value();
    const btVector3 start = *point.position();
    std::unique_ptr<SurfaceSpring> spring;
    std::unique_ptr<btDeformableMousePickingForce> bullets;
    SurfaceSpringOptions options;
    options.stiffness = stiffness;
    if (puller == Puller::Spring) {
      spring = SurfaceSpring::add(world.bullet(), point, options).value();
    } else {
      bullets = bulletsForce(body, point, stiffness);
    }
    const int substeps = static_cast<int>(std::lround(rate * kFrameTime));
    for (int frame = 1; frame <= kSwingFrames && !lost; ++frame) {
      const btVector3 target = swung(start, frame * kFrameTime);
      if (spring) (void)spring->setTarget(target);
      if (bullets) bullets->setMousePos(target);
      for (int s = 0; s < substeps; ++s) world.step(kFrameTime / substeps);
      const auto at = point.position();
      lost = !at || (*at - target).length() > kLost;
      if (frame > kSwingFrames / 4 && !lost) lag = std::max(lag, static_cast<double>((*at - target).length()));
    }
    if (bullets) {
      static_cast<btDeformableBodySolver*>(body.getSoftBodySolver())->getLagrangianForceArray()->remove(bullets.get());
    }
  }
  state.counters["lag_S"] = lost ? HUGE_VAL : lag / scenes::kSize;
  state.counters["tets"] = static_cast<double>(model.cage.mesh.tetCount());
}

/// A rigid body of the given mass (the soft body's is 1) hangs from the serpent's lowest point, while its top is swung.
void hang(State& state, bool welded, double mass, int rate) {
  const measure::BodyModel& model = serpent();
  double worst = 0;
  for (auto _ : state) {
    scenes::World world(scenes::Force::Elastic, btVector3(0, btScalar(-9.81), 0));
    btSoftBody& body = world.add(model.cage, scenes::oneKilogram());
    body.setActivationState(DISABLE_DEACTIVATION);
    const SurfaceTree tree = SurfaceTree::create(model.binding, model.mesh).value();
    const SurfacePoint top = tree.pointAtVertex(body, furthest(model.mesh, Vector3d::UnitY())).value();
    const SurfacePoint low = tree.pointAtVertex(body, furthest(model.mesh, -Vector3d::UnitY())).value();
    const btVector3 start = *top.position(), pivot(0, btScalar(0.1), 0);
    btRigidBody& box = world.addRigid(std::make_unique<btBoxShape>(toBullet(Vector3d(0.1, 0.1, 0.1))),
                                      btTransform(btMatrix3x3::getIdentity(), *low.position() - pivot), mass);
    box.setActivationState(DISABLE_DEACTIVATION);
    SurfaceSpringOptions stiff;
    stiff.stiffness = 100;
    const auto holder = SurfaceSpring::add(world.bullet(), top, stiff).value();
    std::unique_ptr<SurfaceWeld> weld;
    std::unique_ptr<SurfaceSpring> joint;
    if (welded) {
      weld = SurfaceWeld::add(world.bullet(), low, box).value();
    } else {
      joint = SurfaceSpring::add(world.bullet(), low, box, pivot).value();
    }
    const int substeps = static_cast<int>(std::lround(rate * kFrameTime));
    for (int frame = 1; frame <= kSwingFrames; ++frame) {
      (void)holder->setTarget(swung(start, frame * kFrameTime));
      for (int s = 0; s < substeps; ++s) {
        world.step(kFrameTime / substeps);
        worst = std::max(worst, static_cast<double>(weld ? weld->separation() : joint->stretch()));
      }
    }
    if (!toEigen(*low.position()).allFinite() || low.position()->length() > kLost) worst = HUGE_VAL;
  }
  state.counters["separation_S"] = worst / scenes::kSize;
}

std::string named(const std::string& what, double value) {
  std::string text = std::to_string(value);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return "/" + what + ":" + text;
}

void registerSwings() {
  const std::pair<const char*, Puller> pullers[] = {{"spring", Puller::Spring}, {"bullets_picking", Puller::Bullets}};
  for (const auto& [pullerName, puller] : pullers) {
    for (const double stiffness : {1.0, 10.0, 1000.0}) {
      for (const int rate : {60, 240, 1000}) {
        const std::string name =
            std::string("Touch/") + pullerName + named("stiffness", stiffness) + named("rate", rate);
        const auto run = [=, puller = puller](State& state) { swing(state, puller, stiffness, rate); };
        benchmark::RegisterBenchmark(name.c_str(), run)->Iterations(1)->Unit(benchmark::kMillisecond);
      }
    }
  }
}

}  // namespace

void registerTouchCases() {
  benchmark::RegisterBenchmark("Touch/ray", castRays, false)->Unit(benchmark::kMicrosecond);
  benchmark::RegisterBenchmark("Touch/ray_after_a_step", castRays, true)->Unit(benchmark::kMicrosecond);
  registerSwings();
  for (const bool welded : {true, false}) {
    for (const double mass : {0.01, 0.1, 1.0, 10.0}) {
      for (const int rate : {60, 240}) {
        const std::string name =
            std::string("Touch/") + (welded ? "weld" : "ball_joint") + named("mass", mass) + named("rate", rate);
        benchmark::RegisterBenchmark(name.c_str(), hang, welded, mass, rate)
            ->Iterations(1)
            ->Unit(benchmark::kMillisecond);
      }
    }
  }
}

}  // namespace tetskin::bench
