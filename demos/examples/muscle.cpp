// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// An arm: a muscle between a post and a forearm on a hinge lifts a weight. The law of the lever says which tension
// carries it: more lifts it, less lets it sink, until the muscle's elasticity makes up for the rest. Writes
// out/muscle/frame_0000.obj, frame_0010.obj, ..., in the folder in which it is called. Exit status 1: the arm does not
// obey the law.
#include <tetskin/world/world.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>

#include "materials/seen_boxes.h"

namespace {

using namespace tetskin;

// Metres. The elbow is at the origin, the forearm points along x, the muscle hangs above its insertion.
constexpr double kArm = 0.4, kLever = 0.1, kMuscle = 0.3, kThick = 0.02;
constexpr double kMass = 2.5, kGravity = 9.81;                       // kg, of forearm and weight together; m / s^2
constexpr double kYoung = 3e5, kStress = 9e4;                        // Pa
constexpr double kArea = 4 * kThick * kThick;                        // of the cage
constexpr double kTension = kMass * kGravity * (kArm / 2) / kLever;  // by the law of the lever, of a level forearm

/// A spindle along y, from the forearm to the post, of the same area all along.
TriangleMesh makeSpindle() {
  constexpr int kRings = 80, kAround = 60;
  TriangleMesh spindle;
  for (int k = 0; k < kRings * kAround; ++k) {
    const double along = double(k / kAround) / (kRings - 1), angle = 6.2831853 * (k % kAround) / kAround;
    spindle.positions.emplace_back(kLever + kThick * std::cos(angle), kMuscle * along, kThick * std::sin(angle));
  }
  spindle.positions.emplace_back(kLever, 0, 0);
  spindle.positions.emplace_back(kLever, kMuscle, 0);
  const int low = kRings * kAround;
  for (int k = 0; k < kAround; ++k) {
    const auto vertex = [&](int ring, int on) { return ring * kAround + (k + on) % kAround; };
    spindle.triangles.push_back({low, vertex(0, 0), vertex(0, 1)});
    spindle.triangles.push_back({low + 1, vertex(kRings - 1, 1), vertex(kRings - 1, 0)});
    for (int ring = 0; ring + 1 < kRings; ++ring) {
      spindle.triangles.push_back({vertex(ring, 0), vertex(ring + 1, 0), vertex(ring + 1, 1)});
      spindle.triangles.push_back({vertex(ring, 0), vertex(ring + 1, 1), vertex(ring, 1)});
    }
  }
  return spindle;
}

/// A bar of 2 x 8 x 2 cubes, of five tets each, around the spindle: all of it pulls.
Cage makeCage() {
  constexpr int kCubes[3] = {2, 8, 2};
  Cage cage;
  const auto node = [&](int x, int y, int z) { return x + 3 * (y + 9 * z); };
  for (int k = 0; k < 3 * 9 * 3; ++k) {
    cage.mesh.nodes.emplace_back(kLever + kThick * (k % 3 - 1), kMuscle * (k / 3 % 9) / 8, kThick * (k / 27 - 1));
  }
  constexpr int kTets[5][4] = {{0, 3, 5, 6}, {1, 0, 3, 5}, {2, 0, 3, 6}, {4, 0, 5, 6}, {7, 3, 5, 6}};
  for (int cube = 0; cube < kCubes[0] * kCubes[1] * kCubes[2]; ++cube) {
    const int x = cube % 2, y = cube / 2 % 8, z = cube / 16, mirrored = (x + y + z) % 2;
    for (const auto& corners : kTets) {
      Tet tet;
      for (std::size_t k = 0; k < 4; ++k) {
        const int c = corners[k] ^ mirrored;
        tet[k] = node(x + (c & 1), y + (c >> 1 & 1), z + (c >> 2));
      }
      cage.mesh.tets.push_back(tet);
    }
  }
  (void)repairTetMesh(cage.mesh);  // orients them
  return cage;
}

/// How much the muscle must stretch for a tension, as a share of its length; see Muscle for its law.
double stretchAt(double activation, double tension) {
  const double nu = SoftBodyOptions().poissonRatio, share = activation * kStress / kYoung;
  const double w = 2 * share / (1 + std::sqrt(1 + 8 * nu * share));
  return (1 + tension / (kYoung * kArea * (1 + 2 * nu * w))) / (1 + w) - 1;
}

/// The world of one arm.
class Arm {
 public:
  Arm(const std::shared_ptr<TriangleMesh>& mesh, const std::shared_ptr<Cage>& cage) {
    const auto at = [](double x, double y) {
      return btTransform(btQuaternion::getIdentity(), btVector3(btScalar(x), btScalar(y), 0));
    };
    world_.bullet().setGravity(btVector3(0, -btScalar(kGravity), 0));
    // Forearm and weight are one body, whose centre is at half its length.
    forearm_ = world_.addRigidBody(std::make_shared<btBoxShape>(kHalfForearm), kMass, at(kArm / 2, -0.015)).value();
    forearm_->body->setActivationState(DISABLE_DEACTIVATION);
    world_.addJoint(forearm_, nullptr,
                    std::make_unique<btHingeConstraint>(
                        *forearm_->body, btVector3(-btScalar(kArm / 2), btScalar(0.015), 0), btVector3(0, 0, 1), true));
    post_ = world_.addRigidBody(std::make_shared<btBoxShape>(kHalfPost), 0, at(kLever, kMuscle + 0.02)).value();

    WorldBodyOptions options;
    options.material.density = 1050;
    options.material.youngsModulus = kYoung;
    options.material.stiffnessDamping = 0.03;
    options.material.pinned = [](const Eigen::Vector3d& p) { return p.y() > kMuscle - 1e-3; };
    options.surfaceContact = false;
    muscle_ = world_.addBody(cage, mesh, options).value();
    if (const Status set = muscle_->body->setGravity(btVector3(0, 0, 0)); !set.ok()) {  // the law leaves out its weight
      throw std::runtime_error(set.message);
    }
    btSoftBody& soft = muscle_->body->body();
    for (int n = 0; n < soft.m_nodes.size(); ++n) {
      if (soft.m_nodes[n].m_x.y() < btScalar(1e-3)) soft.appendDeformableAnchor(n, forearm_->body.get());
    }
    Muscle muscle;
    for (std::size_t t = 0; t < cage->mesh.tetCount(); ++t) muscle.tets.push_back(static_cast<int>(t));
    muscle.fibres = {Eigen::Vector3d(0, 1, 0)};
    muscle.stress = kStress;
    (void)muscle_->body->addMuscle(muscle).value();
  }
  void activate(double activation) {
    if (const Status set = muscle_->body->setActivation(0, activation); !set.ok())
      throw std::runtime_error(set.message);
  }
  void step() { world_.step(1.0 / 60).value(); }
  /// Of the forearm above level, degrees.
  double angle() const {
    return 57.29578 * std::asin(double(forearm_->body->getWorldTransform().getBasis().getColumn(0).y()));
  }
  const std::vector<float>& surface() const { return muscle_->positions; }
  std::vector<std::pair<const btRigidBody*, btVector3>> boxes() const {
    return {{post_->body.get(), kHalfPost}, {forearm_->body.get(), kHalfForearm}};
  }

 private:
  const btVector3 kHalfPost{btScalar(0.06), btScalar(0.02), btScalar(0.06)};
  const btVector3 kHalfForearm{btScalar(kArm / 2), btScalar(0.015), btScalar(0.03)};
  World world_;
  std::shared_ptr<World::RigidBody> post_, forearm_;
  std::shared_ptr<World::Body> muscle_;
};

}  // namespace

int main() try {
  const auto mesh = std::make_shared<TriangleMesh>(makeSpindle());
  const auto cage = std::make_shared<Cage>(makeCage());
  Arm arm(mesh, cage);
  materials::SeenBoxes frames("out/muscle", *mesh, arm.boxes());
  // It holds the weight, lifts it, lets it sink, and holds it again.
  constexpr double kShares[] = {1.0, 1.3, 0.7, 1.0};
  constexpr int kEach = 180;
  bool obeys = true;  // away from level the muscle's clamped ends bend, which makes the arm stiffer
  for (int frame = 0; frame <= 4 * kEach; ++frame) {
    const int phase = std::min(frame / kEach, 3);
    const double from = phase == 0 ? 0.0 : kShares[phase - 1], way = std::min((frame % kEach) / 30.0, 1.0);
    const double share = frame == 4 * kEach ? 1.0 : from + (kShares[phase] - from) * way;
    arm.activate(share * kTension / (kStress * kArea));
    if (frame % 10 == 0) {
      std::printf("%s: %.2f of the tension that the law of the lever asks for, the forearm at %+.1f degrees\n",
                  frames.write(frame, arm.surface()).c_str(), share, arm.angle());
    }
    if (frame % kEach == kEach - 1) {
      const double activation = kShares[phase] * kTension / (kStress * kArea);
      const double expected = -57.29578 * stretchAt(activation, kTension) * kMuscle / kLever;
      std::printf("at rest at %+.2f degrees; by the law of the lever %+.2f\n", arm.angle(), expected);
      obeys &= std::abs(arm.angle() - expected) < 0.1 + 0.25 * std::abs(expected);
    }
    if (frame < 4 * kEach) arm.step();
  }
  std::printf("the arm obeys the law of the lever: %s\n", obeys ? "yes" : "no");
  return obeys ? 0 : 1;
} catch (const std::exception& fault) {  // value() of a failed result: what, where, and the cure
  return std::puts(fault.what()), 2;
}
