// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Many rigid bodies, which soft bodies carry or push, directly or through each other.
#include <tetskin/solver/deformable_world.h>

#include <map>

#include "recorded_forces.h"
#include "rigid_bodies.h"

namespace tetskin::test {
namespace {

constexpr double kTop = 1.2;  ///< height of the mats' upper side

/// A mat of one layer of cubes around the y-axis; its lower side is pinned, above the floor.
struct Mat {
  Mat(int nx, int nz, double edge, double modulus) {
    TetMesh cage =
        shifted(latticeCage(nx, 1, nz, edge), Eigen::Vector3d(-0.5 * nx * edge, kTop - edge, -0.5 * nz * edge));
    SoftBodyOptions options;
    options.youngsModulus = modulus;
    options.stiffnessDamping = 0.05;
    options.margin = kMargin;
    options.pinned = [=](const Eigen::Vector3d& p) { return p.y() < kTop - 0.5 * edge; };
    mat = added(world, cage, options);
    mat->body().setActivationState(DISABLE_DEACTIVATION);
    forces = forcesIn(world);
  }
  /// Adds a body that never sleeps.
  btRigidBody& add(std::unique_ptr<btCollisionShape> shape, btScalar mass, const btVector3& at) {
    rigids.push_back(std::make_unique<Rigid>(world, std::move(shape), mass, at));
    rigids.back()->body->setActivationState(DISABLE_DEACTIVATION);
    return *rigids.back()->body;
  }
  /// pivot  world space
  template <class Joint>
  Joint& join(std::unique_ptr<Joint> joint, const btVector3& pivot) {
    world.deformable().addConstraint(joint.get(), true);
    pivots[joint.get()] = {joint->getRigidBodyA().getWorldTransform().invXform(pivot),
                           joint->getRigidBodyB().getWorldTransform().invXform(pivot)};
    Joint& made = *joint;
    joints.push_back(std::move(joint));
    return made;
  }
  ~Mat() {
    for (const auto& joint : joints) world.deformable().removeConstraint(joint.get());
  }
  Mat(const Mat&) = delete;
  Mat& operator=(const Mat&) = delete;

  double weight() const {
    double mass = 0.0;
    for (const auto& rigid : rigids) mass += 1.0 / static_cast<double>(rigid->body->getInvMass());
    return 10.0 * mass;
  }
  /// By which all rigid bodies together press on the mat: the mean of some frames.
  btVector3 load(int frames = 10) {
    btVector3 sum(0, 0, 0);
    for (int f = 0; f < frames; ++f) {
      step(world, 1);
      for (const auto& rigid : rigids) sum += forces->forcesOn(*rigid->body).total().force;
    }
    return sum / static_cast<btScalar>(frames);
  }
  void expectToCarryAll(double tolerance) {
    const btVector3 carried = load();
    EXPECT_NEAR(carried.y(), weight(), tolerance * weight());
    EXPECT_LT(btVector3(carried.x(), 0, carried.z()).length(), tolerance * weight());
  }
  /// By how far the two ends of a joint are apart, at the most.
  double widestJoint() const {
    btScalar widest = 0;
    for (const auto& joint : joints) {
      const btVector3 a = joint->getRigidBodyA().getWorldTransform() * pivots.at(joint.get())[0];
      const btVector3 b = joint->getRigidBodyB().getWorldTransform() * pivots.at(joint.get())[1];
      widest = std::max(widest, (a - b).length());
    }
    return static_cast<double>(widest);
  }
  double fastest() const {
    btScalar fastest = 0;
    for (const auto& rigid : rigids) fastest = std::max(fastest, rigid->body->getLinearVelocity().length());
    return static_cast<double>(fastest);
  }

  static constexpr double kMargin = 0.01;
  TetskinWorld world;
  std::unique_ptr<DeformableBody> mat;
  std::unique_ptr<ForceRecord> forces;
  std::vector<std::unique_ptr<Rigid>> rigids;
  std::vector<std::unique_ptr<btTypedConstraint>> joints;
  std::map<const btTypedConstraint*, std::array<btVector3, 2>> pivots;  ///< of joints, in the frames of both bodies
};

std::unique_ptr<btCollisionShape> box(double x, double y, double z) {
  return std::make_unique<btBoxShape>(btVector3(btScalar(x), btScalar(y), btScalar(z)));
}

TEST(ManyRigidBodies, OfATowerStandOnAMat) {
  constexpr int kBoxes = 30;
  constexpr double kHalf = 0.1;
  Mat at(6, 6, 0.08, 1e5);
  for (int k = 0; k < kBoxes; ++k) {
    at.add(box(kHalf, kHalf, kHalf), btScalar(0.1),
           btVector3(0, btScalar(kTop + Mat::kMargin + (2 * k + 1) * kHalf), 0));
  }
  step(at.world, 60);
  at.expectToCarryAll(0.02);
  for (int k = 0; k < kBoxes; ++k) {
    const btVector3 place = at.rigids[k]->body->getWorldTransform().getOrigin();
    EXPECT_LT(btVector3(place.x(), 0, place.z()).length(), 0.5 * kHalf) << k;
    if (k > 0) {
      EXPECT_NEAR(place.y() - at.rigids[k - 1]->height(), 2 * kHalf, 0.05 * kHalf) << k;
    }
  }
  EXPECT_LT(at.fastest(), 0.1);
}

TEST(ManyRigidBodies, OfAChainLieOnAMat) {
  constexpr int kLinks = 50;
  constexpr btScalar kHalf = btScalar(0.06);
  Mat at(32, 3, 0.2, 5e4);
  for (int k = 0; k < kLinks; ++k) {
    const btScalar x = 2 * kHalf * (static_cast<btScalar>(k) - btScalar(0.5) * (kLinks - 1));
    at.add(box(0.95 * kHalf, 0.03, 0.25), btScalar(0.1), btVector3(x, btScalar(kTop + 0.06), 0));
  }
  for (int k = 1; k < kLinks; ++k) {
    btRigidBody &one = *at.rigids[k - 1]->body, &next = *at.rigids[k]->body;
    const btVector3 half(kHalf, 0, 0), axis(0, 0, 1);
    at.join(std::make_unique<btHingeConstraint>(one, next, half, -half, axis, axis), one.getWorldTransform() * half);
  }
  double widest = 0.0;
  forEachSubstep(at.world, 240, [&] { widest = std::max(widest, at.widestJoint()); });
  EXPECT_LT(widest, 0.02 * kHalf);
  at.expectToCarryAll(0.02);
}

TEST(ManyRigidBodies, LieAsDeepAsOneAlone) {
  constexpr int kRows = 6, kColumns = 10;
  constexpr double kEdge = 0.2, kRadius = 0.17;
  const auto heights = [&](bool all) {
    Mat at(2 * kColumns, 2 * kRows, kEdge, 3e4);
    for (int r = 0; r < kRows; ++r) {
      for (int c = 0; c < kColumns; ++c) {
        if (!all && (r != 2 || c != 4)) continue;
        // Each above the middle of a cube, where four nodes hold it, and every second one: none touches another.
        const double x = (2 * c - kColumns + 0.5) * kEdge, z = (2 * r - kRows + 0.5) * kEdge;
        at.add(std::make_unique<btSphereShape>(btScalar(kRadius)), btScalar(0.2),
               btVector3(btScalar(x), btScalar(kTop + kRadius), btScalar(z)));
      }
    }
    step(at.world, 45);
    EXPECT_LT(at.fastest(), 0.02);
    at.expectToCarryAll(0.02);
    std::vector<double> found;
    for (const auto& rigid : at.rigids) found.push_back(rigid->height() - kTop);
    return found;
  };
  const double alone = heights(false).front();
  EXPECT_GT(alone, 0.3 * kRadius);
  for (const double height : heights(true)) EXPECT_NEAR(height, alone, 0.02 * alone);
}

/// Boxes that touch each other, and a block that hits the first of them, unless it stands still.
struct Row {
  explicit Row(btScalar speed) {
    constexpr int kBoxes = 40;
    // Bullet finds no contact of boxes that are a rounding apart.
    constexpr btScalar kHalf = btScalar(0.15), kOverlap = btScalar(2e-4);
    for (int k = 0; k < kBoxes; ++k) {
      const btScalar x = btScalar(0.5) + (2 * kHalf - kOverlap) * static_cast<btScalar>(k) + kHalf;
      boxes.push_back(std::make_unique<Rigid>(item.world, box(kHalf, kHalf, kHalf), btScalar(0.05),
                                              btVector3(x, btScalar(5.45), 0)));
    }
    item.body().setVelocity(btVector3(speed, 0, 0));
  }
  void step() {
    forEachSubstep(item.world, 1, [] {});
  }
  btVector3 momentum() {
    btVector3 sum = momentumOf(item.body());
    for (const auto& each : boxes) sum += each->momentum();
    return sum;
  }

  FlyingBlock item;
  std::vector<std::unique_ptr<Rigid>> boxes;
};

TEST(ManyRigidBodies, OfALongRowTakeTheMomentumThatTheFirstIsGiven) {
  Row row(2);
  const btVector3 before = row.momentum();
  btScalar lost = 0;
  for (int k = 0; k < 60; ++k) {
    row.step();
    lost = std::max(lost, (row.momentum() - before).length());
  }
  EXPECT_LT(momentumOf(row.item.body()).x(), 0.5 * before.x());
  EXPECT_LT(lost, 1e-4 * before.x());
}

/// Boxes that overlap push each other out, which the row without an impact shows.
TEST(ManyRigidBodies, OfALongRowMoveInTheStepInWhichTheFirstIsMet) {
  Row row(2), still(0);
  for (int k = 0; k < 10; ++k) {
    row.step();
    still.step();
    const auto given = [&](std::size_t number) {
      return (row.boxes[number]->momentum() - still.boxes[number]->momentum()).x();
    };
    if (!(given(0) > 0.001)) continue;
    for (const std::size_t number : {10U, 20U, 30U, 39U}) EXPECT_GT(given(number), 0.01 * given(0)) << number;
    return;
  }
  FAIL() << "they have not met";
}

}  // namespace
}  // namespace tetskin::test
