// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "bench/contact_cases.h"

#include <BulletSoftBody/btSoftBody.h>
#include <benchmark/benchmark.h>
#include <btBulletDynamicsCommon.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "measure/obstacles.h"
#include "scenes/caged_mesh.h"
#include "scenes/obstacle_mesh.h"
#include "scenes/serpent.h"
#include "scenes/world.h"

namespace tetskin::bench {
namespace {

using benchmark::State;

constexpr std::size_t kContactTets = 1000;
constexpr int kSubsteps = 4;
/// Enough for a landing, and for rest.
constexpr int kContactFrames = 180;
/// Distance between bodies in a row, in units of kSize.
constexpr double kRowSpacing = 2.5;
/// Height above the obstacle's top: of bodies that fall, and of those that begin in contact.
constexpr double kFall = 0.2, kTouching = 0.001 * scenes::kSize;

/// Which search finds contacts. `Bullet`: its own solver, by nodes. `Free`: nothing to collide with, which gives the
/// cost of a step without contact.
enum class Finder { Surface, Cage, Bullet, Free };
constexpr std::pair<Finder, const char*> kFinders[] = {
    {Finder::Surface, "/surface"}, {Finder::Cage, "/cage"}, {Finder::Bullet, "/bullet"}, {Finder::Free, "/free"}};

/// Processor time spent on pairs of bodies.
std::clock_t inPairs = 0;

void timedNearCallback(btBroadphasePair& pair, btCollisionDispatcher& dispatcher, const btDispatcherInfo& info) {
  const std::clock_t begin = std::clock();
  btCollisionDispatcher::defaultNearCallback(pair, dispatcher, info);
  inPairs += std::clock() - begin;
}

/// The obstacle on which a body falls, with its top at the origin, or around which it hangs.
struct ContactObstacle {
  std::unique_ptr<btCollisionShape> shape;
  btVector3 centre{0, 0, 0};
  std::vector<std::unique_ptr<btCollisionShape>> children{};  ///< children of a compound
};

ContactObstacle ground() {
  return {std::make_unique<btBoxShape>(btVector3(10, 1, 10)), btVector3(0, -1, 0)};
}
/// A runway longer than any distance that a body slides.
ContactObstacle runway() {
  return {std::make_unique<btBoxShape>(btVector3(40, 1, 10)), btVector3(0, -1, 0)};
}
ContactObstacle sphere() {
  return {std::make_unique<btSphereShape>(btScalar(1.2)), btVector3(0, btScalar(-1.2), 0)};
}
/// An ellipsoid.
std::unique_ptr<btConvexHullShape> hullOf(const Eigen::Vector3d& radii, int rings) {
  auto shape = std::make_unique<btConvexHullShape>();
  for (int i = 0; i <= rings; ++i) {
    for (int j = 0; j < 2 * rings; ++j) {
      const double theta = EIGEN_PI * i / rings, phi = EIGEN_PI * j / rings;
      const Eigen::Vector3d direction(std::sin(theta) * std::cos(phi), std::cos(theta),
                                      std::sin(theta) * std::sin(phi));
      shape->addPoint(toBullet(direction.cwiseProduct(radii)), false);
    }
  }
  shape->recalcLocalAabb();
  return shape;
}
ContactObstacle hull() {
  return {hullOf({1.5, 0.8, 1.5}, 12), btVector3(0, btScalar(-0.8), 0)};
}
/// A square of shapes, side by side in a compound, with their tops at the height of its origin.
template <class MakeShape>
ContactObstacle paving(int side, double spacing, double height, MakeShape&& makeShape) {
  ContactObstacle paved;
  auto compound = std::make_unique<btCompoundShape>(true, side * side);
  for (int i = 0; i < side; ++i) {
    for (int j = 0; j < side; ++j) {
      paved.children.push_back(makeShape());
      const Eigen::Vector3d centre(spacing * (i - 0.5 * (side - 1)), -height, spacing * (j - 0.5 * (side - 1)));
      compound->addChildShape(btTransform(btQuaternion::getIdentity(), toBullet(centre)), paved.children.back().get());
    }
  }
  paved.shape = std::move(compound);
  return paved;
}
/// Convex hulls of 106 points each; all of them lie under the body.
template <int kSide>
ContactObstacle hulls() {
  const double spacing = scenes::kSize / kSide;
  return paving(kSide, spacing, 0.1, [&] { return hullOf({0.5 * spacing, 0.1, 0.5 * spacing}, 8); });
}
ContactObstacle compound() {
  return paving(100, 0.5, 0.1,
                [] { return std::make_unique<btBoxShape>(btVector3(btScalar(0.25), btScalar(0.1), btScalar(0.25))); });
}
/// A hilly square of 1,152 triangles.
ContactObstacle hills() {
  constexpr int kCells = 24;
  const auto corner = [](int i, int j) {
    const double x = 0.25 * (i - kCells / 2), z = 0.25 * (j - kCells / 2);
    return toBullet({x, 0.12 * std::sin(2 * x) * std::cos(2 * z), z});
  };
  const auto fill = [&](btTriangleMesh& mesh) {
    for (int i = 0; i < kCells; ++i) {
      for (int j = 0; j < kCells; ++j) {
        mesh.addTriangle(corner(i, j), corner(i, j + 1), corner(i + 1, j));
        mesh.addTriangle(corner(i + 1, j), corner(i, j + 1), corner(i + 1, j + 1));
      }
    }
  };
  return {std::make_unique<measure::TriangleShape>(fill), btVector3(0, 0, 0)};
}

/// An obstacle in the body's box, but not near its surface.
ContactObstacle apart() {
  return {std::make_unique<btSphereShape>(btScalar(0.05)), btVector3(btScalar(0.6), 1, 0)};
}

TriangleMesh ball() {
  TriangleMesh mesh;
  scenes::appendSphere(mesh, Eigen::Vector3d::Zero(), 0.5 * scenes::kSize);
  return mesh;
}
TriangleMesh slab() {
  TriangleMesh mesh;
  scenes::appendBox(mesh, Eigen::Vector3d::Zero(), scenes::kSize * Eigen::Vector3d(0.5, 0.2, 0.5), 0.0);
  return mesh;
}
TriangleMesh serpentMesh() {
  return scenes::makeSerpent();
}

struct ContactCase {
  const char* name;
  ContactObstacle (*obstacle)();
  double gravity = scenes::kEarth;
  TriangleMesh (*mesh)() = serpentMesh;
  int bodies = 1;
  double height = kFall;
  double speed = 0.0;     ///< along x
  bool rolls = false;     ///< begins to roll with that speed
  double slope = 0.0;     ///< radians, downwards along x
  double friction = 0.5;  ///< the obstacle's, which is multiplied by the body's 0.5
};

/// A body's mesh and cage, scaled to the world, at their initial position.
struct ContactModel {
  explicit ContactModel(const ContactCase& made) : mesh(made.mesh()) {
    cage = scenes::builtCage(mesh, kContactTets);
    const double scale = scenes::kSize / boundingBox(cage.mesh.nodes).sizes().maxCoeff();
    const double lift = made.height - scale * boundingBox(mesh.positions).min().y();
    for (auto* points : {&cage.mesh.nodes, &mesh.positions}) {
      for (Eigen::Vector3d& p : *points) p = scale * p + lift * Eigen::Vector3d::UnitY();
    }
  }

  TriangleMesh mesh;
  Cage cage;
};

btVector3 gravityOf(const ContactCase& made, Finder finder) {
  if (finder == Finder::Free) return {0, 0, 0};
  return toBullet(made.gravity * Eigen::Vector3d(std::sin(made.slope), -std::cos(made.slope), 0));
}

/// Bodies on an obstacle, and the cost of a step.
class ContactRun {
 public:
  ContactRun(const ContactModel& model, const ContactCase& made, Finder finder)
      : obstacle_(made.obstacle()),
        world_(finder == Finder::Bullet ? scenes::Force::NeoHookean : scenes::Force::Elastic, gravityOf(made, finder)) {
    if (finder != Finder::Free) {
      const btTransform at(btQuaternion::getIdentity(), obstacle_.centre);
      world_.addRigid(std::move(obstacle_.shape), at, 0.0).setFriction(static_cast<btScalar>(made.friction));
    }
    const auto binding = SoftBodyBinding::create(model.cage, model.mesh).value();
    for (int b = 0; b < made.bodies; ++b) {
      Cage cage = model.cage;
      for (Eigen::Vector3d& p : cage.mesh.nodes) p.x() += kRowSpacing * (b - 0.5 * (made.bodies - 1));
      btSoftBody& body = world_.add(cage, scenes::oneKilogram());
      body.setActivationState(DISABLE_DEACTIVATION);
      if (finder == Finder::Surface) world_.touchBySurface(body, *binding, model.mesh);
      setMotion(body, made);
    }
    static_cast<btCollisionDispatcher*>(world_.bullet().getDispatcher())->setNearCallback(timedNearCallback);
  }

  /// Simulates one frame. Returns seconds per substep, for pairs alone and in total.
  std::pair<double, double> step() {
    inPairs = 0;
    const std::clock_t begin = std::clock();
    for (int k = 0; k < kSubsteps; ++k) world_.step(1.0 / (60 * kSubsteps));
    const auto seconds = [](std::clock_t ticks) { return static_cast<double>(ticks) / CLOCKS_PER_SEC / kSubsteps; };
    return {seconds(inPairs), seconds(std::clock() - begin)};
  }

 private:
  /// A body that rolls turns about the centre of its height.
  static void setMotion(btSoftBody& body, const ContactCase& made) {
    btScalar low = BT_LARGE_FLOAT, high = -BT_LARGE_FLOAT;
    for (int n = 0; n < body.m_nodes.size(); ++n) {
      low = std::min(low, body.m_nodes[n].m_x.y());
      high = std::max(high, body.m_nodes[n].m_x.y());
    }
    const auto speed = static_cast<btScalar>(made.speed);
    const btScalar turning = made.rolls ? 2 * speed / (high - low) : 0;
    for (int n = 0; n < body.m_nodes.size(); ++n) {
      btSoftBody::Node& node = body.m_nodes[n];
      const btVector3 arm = node.m_x - btVector3(0, (low + high) / 2, 0);
      node.m_v = btVector3(speed + turning * arm.y(), -turning * arm.x(), 0);
    }
  }

  ContactObstacle obstacle_;
  scenes::World world_;
};

void findContacts(State& state, const ContactCase& made, Finder finder) {
  const ContactModel model(made);
  std::unique_ptr<ContactRun> run;
  int frame = kContactFrames;
  double steps = 0.0;
  for (auto _ : state) {
    if (frame == kContactFrames) {
      run = std::make_unique<ContactRun>(model, made, finder);
      frame = 0;
    }
    const auto [pairs, step] = run->step();
    state.SetIterationTime(pairs);
    steps += step;
    ++frame;
  }
  state.counters["step_us"] = 1e6 * steps / static_cast<double>(state.iterations());
  state.counters["tets"] = static_cast<double>(model.cage.mesh.tetCount());
  state.counters["triangles"] = static_cast<double>(model.mesh.triangleCount());
}

std::vector<ContactCase> contactCases() {
  std::vector<ContactCase> cases = {{"box", ground}, {"sphere", sphere},     {"hull", hull},
                                    {"mesh", hills}, {"hulls_64", hulls<8>}, {"hulls_81", hulls<9>}};
  ContactCase beside{"apart", apart};
  beside.gravity = 0.0;
  ContactCase row{"compound_10000", compound};
  row.bodies = 10;
  ContactCase rolling{"rolling", runway};
  rolling.mesh = ball;
  rolling.height = kTouching;
  rolling.speed = 2.0;
  rolling.rolls = true;
  // This body comes to a stop as the run ends.
  ContactCase sliding{"sliding", runway};
  sliding.mesh = slab;
  sliding.height = kTouching;
  sliding.speed = 5.8;
  sliding.friction = 0.4;
  ContactCase slope{"slope", runway};
  slope.mesh = slab;
  slope.height = kTouching;
  slope.friction = 1.0;
  slope.slope = std::atan(0.975 * 0.5);
  cases.insert(cases.end(), {beside, row, rolling, sliding, slope});
  return cases;
}

}  // namespace

void registerContactCases() {
  for (const ContactCase& made : contactCases()) {
    for (const auto& [finder, suffix] : kFinders) {
      const std::string full = std::string("Contact/") + made.name + suffix;
      benchmark::RegisterBenchmark(full.c_str(), findContacts, made, finder)
          ->UseManualTime()
          ->Iterations(kContactFrames)
          ->Unit(benchmark::kMicrosecond);
    }
  }
}

}  // namespace tetskin::bench
