// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A world whose origin is moved continues like one that was there from the beginning.
#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>
#include <tetskin/contact/soft_contacts.h>
#include <tetskin/contact/surface_contact.h>
#include <tetskin/replay/snapshot.h>

#include "solver/recorded_forces.h"
#include "support/bars.h"
#include "support/cage_surface.h"
#include "touch_test.h"

namespace tetskin::test {
namespace {

using Vector3 = Eigen::Vector3d;

constexpr btScalar kFar = 4096;

/// Soft and rigid boxes in a heap, a pinned bar, a body that hangs on a spring in space, boxes that hang on joints to
/// points in space, a lift, and a multibody that falls.
struct Crowd {
  TetskinWorld world;
  std::unique_ptr<SoftContacts> contacts = SoftContacts::add(world.deformable()).value();
  std::unique_ptr<ForceRecord> forces = forcesIn(world);
  std::vector<std::unique_ptr<DeformableBody>> bodies;
  std::vector<std::unique_ptr<SurfaceContact>> surfaces;
  std::unique_ptr<TouchedBody> hung;
  std::unique_ptr<SurfaceSpring> spring;
  std::vector<std::unique_ptr<RigidBox>> boxes;
  std::vector<std::unique_ptr<btTypedConstraint>> joints;
  btMultiBody links{0, 1, btVector3(1, 1, 1), false, true};
  btSphereShape ballShape{btScalar(0.2)};
  btMultiBodyLinkCollider collider{&links, -1};
  btVector3 place;

  explicit Crowd(btScalar x) : place(x, 0, 0) {
    // The world's own floor lies at 0 alone.
    addBox(0, {0, -1, 0}, btVector3(30, 1, 30));
    SoftBodyOptions firm;
    firm.relativeStiffness = 200;
    const TetMesh cube = makeBox({2, 2, 2}, {0.5, 0.5, 0.5});
    const TriangleMesh mesh = surfaceBeside(cube, -0.01, 1);
    const auto binding = SoftBodyBinding::create(cube, mesh).value();
    const auto shape = ContactShape::create(cube, mesh, ContactShapeOptions{500, 24}).value();
    for (int k = 0; k < 5; ++k) {
      const Vector3 offset(k < 3 ? 0.52 * k : 0.52 * k - 1.3, k < 3 ? 0.0 : 0.49, 0);
      btSoftBody& body = add(cube, offset, firm).body();
      EXPECT_TRUE(contacts->add(body, shape).ok());
      surfaces.push_back(SurfaceContact::add(world.deformable(), body, *binding, mesh).value());
    }
    for (int k = 0; k < 2; ++k) addBox(0.2, {0.3 + 0.52 * k, 1.08, 0.25}, btVector3(0.15, 0.1, 0.15));
    SoftBodyOptions pinned;
    const double left = static_cast<double>(x) - 3.99;
    pinned.pinned = [left](const Vector3& rest) { return rest.x() < left; };
    add(makeBox({6, 2, 2}, {1.2, 0.4, 0.4}), {-4, 2, 0}, pinned);
    hang();
  }
  ~Crowd() {
    for (const auto& joint : joints) world.deformable().removeConstraint(joint.get());
    world.deformable().removeMultiBody(&links);
    world.deformable().removeCollisionObject(&collider);
  }
  btVector3 at(const Vector3& offset) const { return place + toBullet(offset); }
  RigidBox& addBox(double mass, const Vector3& offset, const btVector3& half) {
    boxes.push_back(std::make_unique<RigidBox>(world, mass, at(offset), half));
    return *boxes.back();
  }
  DeformableBody& add(TetMesh cage, const Vector3& offset, const SoftBodyOptions& options = {}) {
    for (Vector3& p : cage.nodes) p += offset + toEigen(place);
    bodies.push_back(added(world, cage, options));
    return *bodies.back();
  }
  void join(std::unique_ptr<btTypedConstraint> joint) {
    world.deformable().addConstraint(joint.get());
    joints.push_back(std::move(joint));
  }
  void hang() {
    TouchModel model;
    for (auto* points : {&model.cage.nodes, &model.mesh.positions}) {
      for (Vector3& p : *points) p += Vector3(static_cast<double>(place.x()) + 4, 3, 0);
    }
    hung = std::make_unique<TouchedBody>(world, model);
    const SurfacePoint top = hung->vertex(hung->furthest(Vector3(0, 1, 0)));
    spring = SurfaceSpring::add(world.deformable(), top, {}).value();
    EXPECT_EQ(spring->setTarget(at({4.5, 4, 0.5})), StatusCode::Ok);
    const btVector3 half(0.2, 0.2, 0.2);
    btRigidBody& swings = *addBox(1, {7, 3, 0}, half);
    join(std::make_unique<btPoint2PointConstraint>(swings, btVector3(-1, 0, 0)));
    btRigidBody& turns = *addBox(1, {10, 3, 0}, half);
    join(std::make_unique<btHingeConstraint>(turns, btVector3(-1, 0, 0), btVector3(0, 0, 1)));
    btRigidBody& slides = *addBox(1, {13, 3, 0}, half);
    join(std::make_unique<btGeneric6DofSpring2Constraint>(slides, btTransform::getIdentity()));
    links.setBasePos(at({16, 5, 0}));
    links.finalizeMultiDof();
    world.deformable().addMultiBody(&links);
    collider.setCollisionShape(&ballShape);
    collider.setWorldTransform(btTransform(btQuaternion::getIdentity(), links.getBasePos()));
    links.setBaseCollider(&collider);
    world.deformable().addCollisionObject(&collider, 1, -1);
    btRigidBody& lift = *addBox(0, {-8, 1, 0}, half);
    lift.setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
    lift.setActivationState(DISABLE_DEACTIVATION);
  }
  btRigidBody& lift() { return **boxes.back(); }
  void frame() {
    btTransform next = lift().getWorldTransform();
    next.getOrigin() += btVector3(0, btScalar(0.01), 0);
    lift().setWorldTransform(next);
    step(world, 1);
  }
  /// All positions, relative to a place.
  std::vector<Vector3> positions(btScalar from) {
    std::vector<Vector3> all;
    const btCollisionObjectArray& objects = world.deformable().getCollisionObjectArray();
    for (int k = 1; k < objects.size(); ++k) {  // without the world's own floor
      const btSoftBody* soft = btSoftBody::upcast(objects[k]);
      for (int n = 0; soft && n < soft->m_nodes.size(); ++n) all.push_back(toEigen(soft->m_nodes[n].m_x));
      if (!soft) all.push_back(toEigen(objects[k]->getWorldTransform().getOrigin()));
    }
    for (Vector3& p : all) p.x() -= static_cast<double>(from);
    return all;
  }
  /// The speed of the fastest node in the heap.
  double fastest() {
    double maximum = 0;
    for (std::size_t k = 0; k < 5; ++k) maximum = std::max(maximum, fastestOf(bodies[k]->body()));
    return maximum;
  }
};

double farthest(const std::vector<Vector3>& a, const std::vector<Vector3>& b) {
  EXPECT_EQ(a.size(), b.size());
  double maximum = 0;
  for (std::size_t k = 0; k < std::min(a.size(), b.size()); ++k) maximum = std::max(maximum, (a[k] - b[k]).norm());
  return maximum;
}

/// Near the origin, rounding is the same in both.
TEST(ShiftOrigin, ChangesNoMotion) {
  Crowd shifted(8), beside(8);
  for (int frame = 0; frame < 45; ++frame) {
    shifted.frame();
    beside.frame();
  }
  ASSERT_TRUE(shiftOrigin(shifted.world.deformable(), btVector3(8, 0, 0)).ok());
  EXPECT_LT(farthest(shifted.positions(0), beside.positions(8)), 1e-6);
  for (int frame = 0; frame < 20; ++frame) {
    shifted.frame();
    beside.frame();
  }
  EXPECT_LT(farthest(shifted.positions(0), beside.positions(8)), 1e-4);
}

TEST(ShiftOrigin, OfAWorldFarAwayBreaksNoContact) {
  Crowd crowd(kFar);
  for (int frame = 0; frame < 200; ++frame) crowd.frame();
  std::vector<double> before;
  for (const auto& box : crowd.boxes) before.push_back(crowd.forces->forcesOn(**box).total().force.length());
  const double speed = crowd.fastest();
  const std::size_t count = crowd.contacts->contacts().size();
  EXPECT_GT(count, 10u);
  EXPECT_GT(before[0], 50);  // the floor
  ASSERT_TRUE(shiftOrigin(crowd.world.deformable(), btVector3(kFar, 0, 0)).ok());
  crowd.frame();
  for (std::size_t k = 0; k < before.size(); ++k) {
    EXPECT_NEAR(crowd.forces->forcesOn(**crowd.boxes[k]).total().force.length(), before[k], 0.01 * before[k]) << k;
  }
  for (int frame = 0; frame < 60; ++frame) {
    EXPECT_LT(crowd.fastest(), speed + 1e-3);
    EXPECT_EQ(crowd.contacts->contacts().size(), count);
    crowd.frame();
  }
}

TEST(ShiftOrigin, LeavesSleepersAsleep) {
  Crowd crowd(64);
  const btCollisionObjectArray& objects = crowd.world.deformable().getCollisionObjectArray();
  const auto asleep = [&] {
    std::vector<int> all;
    for (int k = 0; k < objects.size(); ++k) {
      if (!objects[k]->isActive()) all.push_back(k);
    }
    return all;
  };
  for (int frame = 0; frame < 900 && asleep().size() < 12; ++frame) crowd.frame();
  const std::vector<int> before = asleep();
  ASSERT_GE(before.size(), 10u);
  for (const btScalar to : {64, -4096}) {
    ASSERT_TRUE(shiftOrigin(crowd.world.deformable(), btVector3(to, 0, 0)).ok());
    for (int frame = 0; frame < 5; ++frame) {
      crowd.frame();
      EXPECT_EQ(asleep(), before) << "frame " << frame;
    }
  }
}

TEST(ShiftOrigin, IsUndoneByASnapshot) {
  Crowd crowd(8);
  for (int frame = 0; frame < 10; ++frame) crowd.frame();
  std::vector<unsigned char> saved(saveSnapshot(crowd.world.deformable(), nullptr, 0).value());
  ASSERT_TRUE(saveSnapshot(crowd.world.deformable(), saved.data(), saved.size()).ok());
  for (int frame = 0; frame < 10; ++frame) crowd.frame();
  const std::vector<Vector3> expected = crowd.positions(0);
  ASSERT_TRUE(shiftOrigin(crowd.world.deformable(), btVector3(1, -2, 512)).ok());
  for (int frame = 0; frame < 10; ++frame) crowd.frame();
  ASSERT_TRUE(restoreSnapshot(crowd.world.deformable(), saved.data(), saved.size()).ok());
  for (int frame = 0; frame < 10; ++frame) crowd.frame();
  EXPECT_EQ(farthest(crowd.positions(0), expected), 0);
}

TEST(ShiftOrigin, RefusesWhatIsNotFinite) {
  Crowd crowd(0);
  const std::vector<Vector3> before = crowd.positions(0);
  EXPECT_EQ(shiftOrigin(crowd.world.deformable(), btVector3(NAN, 0, 0)).code, StatusCode::NonFinite);
  EXPECT_EQ(farthest(crowd.positions(0), before), 0);
}

TEST(ShiftOrigin, RefusesPlacesThatNoSurfaceFollows) {
  tetskin::DeformableWorld world;
  const auto body = DeformableBody::add(world, smallCageAbove(2)).value();
  const btVector3& node = body->body().m_nodes[0].m_x;
  const btVector3 start = node, far(0, 0, btScalar(0.8e18));
  for (int k = 0; k < 3; ++k) {
    const Status refused = shiftOrigin(world, btVector3(0, btScalar(2e38), 0));
    EXPECT_EQ(refused.code, StatusCode::InvalidOption);
    EXPECT_NE(refused.message.find("kMaxCoordinate"), std::string::npos);
    EXPECT_EQ(node, start);
  }
  ASSERT_TRUE(shiftOrigin(world, far).ok());
  EXPECT_EQ(shiftOrigin(world, far).code, StatusCode::InvalidOption);
  ASSERT_TRUE(body->teleport(btTransform(btQuaternion::getIdentity(), far)).ok());
  EXPECT_EQ(node.z(), 0);
  EXPECT_EQ(shiftOrigin(world, far).code, StatusCode::InvalidOption) << "the body's start would be there";
  ASSERT_TRUE(shiftOrigin(world, -far).ok());
  EXPECT_EQ(node.z(), far.z());
}

TEST(ShiftOrigin, OfAWorldWithABodyThatHasExplodedGoesOn) {
  tetskin::DeformableWorld world;
  const auto wild = DeformableBody::add(world, smallCageAbove(2)).value();
  const auto calm = DeformableBody::add(world, smallCageAbove(4)).value();
  wild->body().m_nodes[0].m_x.setY(btScalar(3e18));
  const btVector3 before = calm->body().m_nodes[0].m_x, origin(8, 0, 0);
  ASSERT_TRUE(shiftOrigin(world, origin).ok());
  EXPECT_EQ(calm->body().m_nodes[0].m_x, before - origin);
}

TEST(ShiftOrigin, MovesBothPlacesOfAMultibodyOnce) {
  for (const int type : {0, int(btCollisionObject::CF_KINEMATIC_OBJECT)}) {
    tetskin::DeformableWorld world;
    btMultiBody links(0, 1, btVector3(1, 1, 1), false, true);
    links.setBaseDynamicType(type);
    links.finalizeMultiDof();
    const btVector3 base(1000, 2, 0), interpolated(999, 2, 0), origin(100, 0, -50);
    links.setBasePos(base);
    links.setInterpolateBasePos(interpolated);
    world.addMultiBody(&links);
    EXPECT_TRUE(shiftOrigin(world, origin).ok());
    EXPECT_EQ(links.getBasePos(), base - origin) << type;
    EXPECT_EQ(links.getInterpolateBasePos(), interpolated - origin) << type;
    world.removeMultiBody(&links);
  }
}

TEST(ShiftOrigin, TakesTheStartAlong) {
  TetskinWorld world;
  const auto body = added(world, smallCageAbove(2));
  const btVector3 start = body->body().m_nodes[0].m_x, origin(64, 0, -32);
  step(world, 3);
  ASSERT_TRUE(shiftOrigin(world.deformable(), origin).ok());
  ASSERT_TRUE(body->reset().ok());
  EXPECT_EQ(body->body().m_nodes[0].m_x, start - origin);
}

}  // namespace
}  // namespace tetskin::test
