// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/replay/snapshot.h>
#include <limits>

#include "soft_fixtures.h"

namespace tetskin::test {
namespace {

using Eigen::Vector3d;

double depth(const DeformableBody& a, const DeformableBody& b) {
  const Ball& model = ball();
  return deepest(a.body(), model.cage, model.mesh, b.body(), model.cage, model.mesh);
}

TEST(SoftContacts, ABodyRestsOnAnotherAtItsSurface) {
  const auto world = std::make_unique<TetskinWorld>();
  SoftBodyOptions held;
  held.youngsModulus = 2000.0;
  held.pinned = pinnedIn(Box3(Vector3d(-9, -9, -9), Vector3d(9, 2.35, 9)));
  const auto below = added(*world, ball().at(Vector3d(0, 2, 0)), held);
  held.pinned = {};
  const auto above = addBall(*world, Vector3d(0, 2.95, 0));
  SoftContactOptions options;
  options.friction = 1.0;
  const auto contacts = contactsIn(*world, options);
  ASSERT_TRUE(contacts->add(below->body(), ball().shape).ok());
  ASSERT_TRUE(contacts->add(above->body(), ball().shape).ok());
  step(*world, 30);
  EXPECT_FALSE(contacts->contacts().empty());
  EXPECT_GT(centreOf(above->body()).y(), 3.0) << "it has not fallen through";
  EXPECT_LT(std::max(depth(*above, *below), depth(*below, *above)), 0.005);
}

TEST(SoftContacts, BodiesThatWereNotIncludedPass) {
  const auto world = worldWith(btVector3(0, 0, 0));
  const auto a = addBall(*world, Vector3d(0, 2, 0)), b = addBall(*world, Vector3d(0.7, 2, 0));
  const auto contacts = contactsIn(*world);
  ASSERT_TRUE(contacts->add(a->body(), ball().shape).ok());
  step(*world, 5);
  EXPECT_TRUE(contacts->contacts().empty());
  EXPECT_NEAR(centreOf(b->body()).x(), 1.2, 1e-4);
  EXPECT_EQ(contacts->status(a->body()), StatusCode::Ok);
  EXPECT_EQ(contacts->status(b->body()), StatusCode::NotAdded);
}

/// There is no gravity: only contact acts between the bodies.
TEST(SoftContacts, ACollisionKeepsMomentumAndGainsNoEnergy) {
  const auto world = worldWith(btVector3(0, 0, 0));
  const auto a = addBall(*world, Vector3d(0, 2, 0), 1.0), b = addBall(*world, Vector3d(1.0, 2.1, 0), 3.0);
  const auto contacts = contactsIn(*world);
  for (DeformableBody* body : {a.get(), b.get()}) ASSERT_TRUE(contacts->add(body->body(), ball().shape).ok());
  a->body().addVelocity(btVector3(4, 0, 0));
  const btVector3 before = momentumOf(a->body()) + momentumOf(b->body());
  const double impact = 8.0;
  double minimum = impact, risen = 0.0;
  bool touched = false;
  for (int frame = 0; frame < 40; ++frame) {
    step(*world, 1);
    touched |= !contacts->contacts().empty();
    const double energy = kineticEnergyOf(a->body()) + kineticEnergyOf(b->body()) + elasticEnergyIn(*world);
    minimum = std::min(minimum, energy);
    risen = std::max(risen, energy - minimum);
  }
  EXPECT_TRUE(touched);
  EXPECT_LT(risen, 0.01 * impact);
  const btVector3 after = momentumOf(a->body()) + momentumOf(b->body());
  EXPECT_NEAR((after - before).length(), 0.0, 0.06 * before.length());
  EXPECT_GT(momentumOf(b->body()).x(), 0.5) << "the other one was hit";
  EXPECT_LT(depth(*a, *b), 0.005);
  EXPECT_LT(minimum, 0.999 * impact);
}

TEST(SoftContacts, FrictionSlowsWhatSlidesAndNoneDoesNot) {
  btScalar speed[2];
  for (const bool highFriction : {false, true}) {
    const auto world = std::make_unique<TetskinWorld>();
    SoftBodyOptions held;
    held.youngsModulus = 20000.0;
    held.pinned = pinnedIn(Box3(Vector3d(-9, -9, -9), Vector3d(9, 9, 9)));
    TetMesh cage = plate().cage;
    for (Vector3d& p : cage.nodes) p.y() += 2.0;
    const auto table = added(*world, cage, held);
    const auto slider = addBall(*world, Vector3d(0, 2.16 - 0.08, 0));
    SoftContactOptions options;
    options.friction = highFriction ? 0.8 : 0.0;
    const auto contacts = contactsIn(*world, options);
    ASSERT_TRUE(contacts->add(table->body(), plate().shape).ok());
    ASSERT_TRUE(contacts->add(slider->body(), ball().shape).ok());
    slider->body().addVelocity(btVector3(btScalar(0.8), 0, 0));
    step(*world, 15);
    speed[highFriction] = momentumOf(slider->body()).x();
  }
  EXPECT_GT(speed[false], 0.7);
  EXPECT_LT(speed[true], 0.75 * speed[false]);
}

/// A plate that slides on a slab travels as far as a point with Coulomb friction does. Its edges do not catch.
TEST(SoftContacts, FrictionStopsAPlateAsItStopsAPoint) {
  constexpr double kFriction = 0.4, kSpeed = 0.8, kGravity = 9.81;
  const auto world = std::make_unique<TetskinWorld>();
  SoftBodyOptions held;
  held.youngsModulus = 2e5;
  TetMesh below = plate().cage, above = plate().cage;
  for (Vector3d& p : below.nodes) p.y() += 2.0;
  for (Vector3d& p : above.nodes) p += Vector3d(0.0, 2.0 + 2.0 * Plate::kHalfThickness + 1e-4, 0.0);
  const auto slider = added(*world, above, held);
  held.pinned = pinnedIn(Box3(Vector3d(-9, -9, -9), Vector3d(9, 9, 9)));
  const auto slab = added(*world, below, held);
  SoftContactOptions options;
  options.friction = kFriction;
  const auto contacts = contactsIn(*world, options);
  for (DeformableBody* body : {slab.get(), slider.get()}) {
    ASSERT_TRUE(contacts->add(body->body(), plate().shape).ok());
  }
  step(*world, 10);
  const double start = static_cast<double>(centreOf(slider->body()).x());
  slider->body().addVelocity(btVector3(btScalar(kSpeed), 0, 0));
  step(*world, 30);
  const double stopped = static_cast<double>(centreOf(slider->body()).x());
  EXPECT_NEAR((stopped - start) / (kSpeed * kSpeed / (2.0 * kFriction * kGravity)), 1.0, 0.05);
  step(*world, 30);
  EXPECT_NEAR(static_cast<double>(centreOf(slider->body()).x()), stopped, 1e-4) << "it stays";
}

/// Three bodies stacked on each other stand still.
TEST(SoftContacts, AStackStands) {
  const auto world = std::make_unique<TetskinWorld>();
  std::vector<std::unique_ptr<DeformableBody>> bodies;
  const auto contacts = contactsIn(*world);
  for (int k = 0; k < 4; ++k) {
    SoftBodyOptions options;
    options.youngsModulus = k == 2 ? 1e6 : 1e4;
    if (k == 0) options.pinned = pinnedIn(Box3(Vector3d(-9, -9, -9), Vector3d(9, 9, 9)));
    TetMesh cage = plate().cage;
    for (Vector3d& p : cage.nodes) p.y() += 2.0 + (2.0 * Plate::kHalfThickness + 1e-4) * k;
    bodies.push_back(added(*world, cage, options));
    ASSERT_TRUE(contacts->add(bodies.back()->body(), plate().shape).ok());
  }
  step(*world, 90);
  double fastest = 0.0;
  btScalar deepest = 0;
  for (int frame = 0; frame < 30; ++frame) {
    step(*world, 1);
    fastest = std::max(fastest, fastestNode(bodies));
    for (const SoftContact& contact : contacts->contacts()) deepest = std::min(deepest, contact.distance);
  }
  EXPECT_LT(fastest, 0.005);
  EXPECT_GT(deepest, -0.001);
  EXPECT_NEAR(centreOf(bodies[3]->body()).x(), 0.5, 0.001);
}

/// All nodes of the pad are pinned, and moved one metre by their m_x, once per frame or once per step.
TEST(SoftContacts, CarryABodyOnAPadThatIsMovedByHand) {
  for (const int steps : {4, 1}) {
    const auto world = std::make_unique<TetskinWorld>();
    SoftBodyOptions held;
    held.pinned = pinnedIn(Box3(Vector3d(-9, -9, -9), Vector3d(9, 9, 9)));
    TetMesh cage = plate().cage;
    for (Vector3d& p : cage.nodes) p.y() += 2.0;
    const auto pad = added(*world, cage, held);
    for (Vector3d& p : cage.nodes) p.y() += 2 * Plate::kHalfThickness;
    SoftBodyOptions stiff;
    stiff.youngsModulus = 20000.0;
    const auto carried = added(*world, cage, stiff);
    SoftContactOptions options;
    options.friction = 1.0;
    const auto contacts = contactsIn(*world, options);
    ASSERT_TRUE(contacts->add(pad->body(), plate().shape).ok());
    ASSERT_TRUE(contacts->add(carried->body(), plate().shape).ok());
    step(*world, 15);
    const btScalar before = centreOf(carried->body()).x();
    const int moves = 360 / steps;
    for (int k = 1; k <= moves; ++k) {
      // The pad starts and stops smoothly.
      const auto directionAt = [&](int n) {
        const btScalar fraction = static_cast<btScalar>(n) / static_cast<btScalar>(moves);
        return fraction * fraction * (3 - 2 * fraction);
      };
      for (int n = 0; n < pad->body().m_nodes.size(); ++n) {
        pad->body().m_nodes[n].m_x += btVector3(directionAt(k) - directionAt(k - 1), 0, 0);
      }
      const btScalar dt = btScalar(1) / 240;
      world->deformable().stepSimulation(static_cast<btScalar>(steps) * dt, steps, dt);
    }
    EXPECT_NEAR(centreOf(carried->body()).x() - before, 1.0, 0.03) << steps;
  }
}

TEST(SoftContacts, ABodyMayLeaveTheWorldWhileItTouches) {
  const auto world = std::make_unique<TetskinWorld>();
  auto a = addBall(*world, Vector3d(0, 0, 0)), b = addBall(*world, Vector3d(0.3, 0.77, 0));
  auto c = addBall(*world, Vector3d(0.1, 1.58, 0.1));
  auto contacts = contactsIn(*world);
  for (DeformableBody* body : {a.get(), b.get(), c.get()}) {
    ASSERT_TRUE(contacts->add(body->body(), ball().shape).ok());
  }
  step(*world, 10);
  ASSERT_FALSE(contacts->contacts().empty());
  world->deformable().removeSoftBody(&b->body());
  EXPECT_EQ(contacts->status(b->body()), StatusCode::NotInWorld);
  step(*world, 10);
  for (const SoftContact& contact : contacts->contacts()) {
    EXPECT_NE(contact.body, &b->body());
    EXPECT_NE(contact.other, &b->body());
  }
  a.reset();
  step(*world, 5);
  contacts->remove(c->body());
  EXPECT_EQ(contacts->status(c->body()), StatusCode::NotAdded);
  step(*world, 5);
  contacts.reset();
  step(*world, 5);
  EXPECT_TRUE(std::isfinite(centreOf(c->body()).y()));
}

TEST(SoftContacts, ABodyThatReturnsMeetsTheOthersAgain) {
  const auto world = worldWith(btVector3(0, -10, 0));
  const auto lies = addBall(*world, Vector3d(0, 0.4, 0)), falls = addBall(*world, Vector3d(0, 1.5, 0));
  auto gone = addBall(*world, Vector3d(3, 1.5, 0));
  const auto contacts = contactsIn(*world);
  for (DeformableBody* body : {lies.get(), falls.get(), gone.get()}) {
    ASSERT_TRUE(contacts->add(body->body(), ball().shape).ok());
  }
  step(*world, 2);
  for (DeformableBody* body : {falls.get(), gone.get()}) body->removeFromWorld();
  EXPECT_EQ(contacts->status(falls->body()), StatusCode::NotInWorld);
  gone.reset();
  step(*world, 30);
  EXPECT_TRUE(contacts->contacts().empty());
  ASSERT_TRUE(falls->addToWorld(world->deformable()).ok());
  EXPECT_EQ(contacts->status(falls->body()), StatusCode::Ok);
  EXPECT_EQ(contactsIn(*world)->add(falls->body(), ball().shape).code, StatusCode::InvalidOption) << "in others";
  std::vector<unsigned char> snapshot(saveSnapshot(world->deformable(), nullptr, 0).value());
  ASSERT_TRUE(saveSnapshot(world->deformable(), snapshot.data(), snapshot.size()).ok());
  step(*world, 1);
  const Status restored = restoreSnapshot(world->deformable(), snapshot.data(), snapshot.size());
  EXPECT_TRUE(restored.ok()) << restored.message;
  bool hasTouched = false;
  for (int frame = 0; frame < 30; ++frame) {
    step(*world, 1);
    hasTouched |= !contacts->contacts().empty();
  }
  EXPECT_TRUE(hasTouched);
  EXPECT_EQ(contacts->status(falls->body()), StatusCode::Ok);
  falls->removeFromWorld();
  contacts->remove(falls->body());
  ASSERT_TRUE(falls->addToWorld(world->deformable()).ok());
  step(*world, 1);
  EXPECT_EQ(contacts->status(falls->body()), StatusCode::NotAdded);
}

TEST(SoftContacts, SaysThatABodyHasLostItsTets) {
  const auto world = worldWith(btVector3(0, 0, 0));
  const auto contacts = contactsIn(*world);
  const auto a = addBall(*world, Eigen::Vector3d(0, 2, 0));
  ASSERT_TRUE(contacts->add(a->body(), ball().shape).ok());
  EXPECT_EQ(contacts->status(a->body()), StatusCode::Ok);
  a->body().m_tetras.resize(0);
  EXPECT_EQ(contacts->status(a->body()), StatusCode::TopologyChanged);
}

TEST(SoftContacts, ABodyThatIsNotFiniteMeetsNothing) {
  const auto world = std::make_unique<TetskinWorld>();
  const auto a = addBall(*world, Vector3d(0, 2, 0)), b = addBall(*world, Vector3d(0.3, 2.7, 0));
  const auto contacts = contactsIn(*world);
  for (DeformableBody* body : {a.get(), b.get()}) ASSERT_TRUE(contacts->add(body->body(), ball().shape).ok());
  step(*world, 2);
  a->body().m_nodes[5].m_x.setX(std::numeric_limits<btScalar>::quiet_NaN());
  step(*world, 1);
  EXPECT_TRUE(contacts->contacts().empty());
  EXPECT_TRUE(std::isfinite(centreOf(b->body()).y()));
}

TEST(SoftContacts, SaysWhatItCannotServe) {
  const auto world = std::make_unique<TetskinWorld>();
  SoftContactOptions options;
  options.friction = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(SoftContacts::add(world->deformable(), options).status().code, StatusCode::InvalidOption);
  EmptyWorld bullets;
  const Status status = SoftContacts::add(bullets.deformable()).status();
  EXPECT_EQ(status.code, StatusCode::InvalidOption);
  EXPECT_NE(status.message.find("DeformableSolver"), std::string::npos) << status.message;
}

TEST(SoftContacts, RefuseABodyThatOthersHave) {
  const auto world = std::make_unique<TetskinWorld>();
  const auto body = added(*world, ball().at(Vector3d(0, 2, 0)));
  const auto first = contactsIn(*world), second = contactsIn(*world);
  ASSERT_TRUE(first->add(body->body(), ball().shape).ok());
  EXPECT_TRUE(first->add(body->body(), ball().shape).ok());  // adding the body again with the same shape is accepted
  EXPECT_EQ(second->add(body->body(), ball().shape).code, StatusCode::InvalidOption);
  first->remove(body->body());
  EXPECT_TRUE(second->add(body->body(), ball().shape).ok());
}

TEST(SoftContacts, RefusesBodiesThatAreNotTheShapes) {
  const auto world = std::make_unique<TetskinWorld>(), elsewhere = std::make_unique<TetskinWorld>();
  const auto contacts = contactsIn(*world);
  const auto body = added(*world, ball().cage), other = added(*world, latticeCage(2, 2, 2));
  const auto stranger = added(*elsewhere, ball().cage);
  EXPECT_EQ(contacts->add(body->body(), nullptr).code, StatusCode::Empty);
  EXPECT_EQ(contacts->add(other->body(), ball().shape).code, StatusCode::SizeMismatch);
  EXPECT_EQ(contacts->add(stranger->body(), ball().shape).code, StatusCode::InvalidOption);
  EXPECT_TRUE(contacts->add(body->body(), ball().shape).ok());
}

/// A thin plate is hit by a ball so fast that the ball is past the plate's middle when it is first detected.
TEST(SoftContacts, AThinPlateIsNotPassedThrough) {
  const auto world = worldWith(btVector3(0, 0, 0));
  SoftBodyOptions options;
  options.youngsModulus = 20000.0;
  options.pinned = pinnedIn(Box3(Vector3d(-9, -9, -9), Vector3d(0.01, 9, 9)));
  TetMesh cage = plate().cage;
  for (Vector3d& p : cage.nodes) p.y() += 2.0;
  const auto table = added(*world, cage, options);
  options.pinned = {};
  options.youngsModulus = 2000.0;
  const auto thrown = added(*world, ball().at(Vector3d(0, 2.2, 0)), options);
  const auto contacts = contactsIn(*world);
  ASSERT_TRUE(contacts->add(table->body(), plate().shape).ok());
  ASSERT_TRUE(contacts->add(thrown->body(), ball().shape).ok());
  thrown->body().addVelocity(btVector3(0, -15, 0));
  step(*world, 60);
  EXPECT_LT(deepest(thrown->body(), ball().cage, ball().mesh, table->body(), plate().cage, plate().mesh), 0.02);
  EXPECT_GT(centreOf(thrown->body()).y() - centreOf(table->body()).y(), 0.2);
}

/// Two components of one body, 0.4 apart at rest, that move towards each other.
TEST(SoftContacts, ABodyMeetsItself) {
  TetMesh cage = latticeCage(3, 3, 3, 0.2);
  TriangleMesh mesh = sphere(16, 0.25, Vector3d(0.3, 0.3, 0.3));
  const int nodes = static_cast<int>(cage.nodeCount()), vertices = static_cast<int>(mesh.vertexCount());
  const std::vector<Tet> tets = cage.tets;
  const std::vector<std::array<int, 3>> triangles = mesh.triangles;
  for (int n = 0; n < nodes; ++n) cage.nodes.push_back(cage.nodes[n] + Vector3d(1, 0, 0));
  for (const Tet& t : tets) cage.tets.push_back({t[0] + nodes, t[1] + nodes, t[2] + nodes, t[3] + nodes});
  for (int v = 0; v < vertices; ++v) mesh.positions.push_back(mesh.positions[v] + Vector3d(1, 0, 0));
  for (const auto& [a, b, c] : triangles) mesh.triangles.push_back({a + vertices, b + vertices, c + vertices});
  const auto shape = ContactShape::create(cage, mesh).value();
  for (const bool self : {false, true}) {
    const auto world = worldWith(btVector3(0, 0, 0));
    TetMesh placed = cage;
    for (Vector3d& p : placed.nodes) p.y() += 3.0;
    SoftBodyOptions options;
    const auto body = added(*world, placed, options);
    const auto contacts = contactsIn(*world);
    ASSERT_TRUE(contacts->add(body->body(), shape, self).ok());
    for (int n = 0; n < nodes; ++n) body->body().m_nodes[n].m_v = btVector3(2, 0, 0);
    step(*world, 40);
    double left = 0.0, right = 0.0;
    for (int n = 0; n < nodes; ++n) {
      left += body->body().m_nodes[n].m_x.x() / nodes;
      right += body->body().m_nodes[nodes + n].m_x.x() / nodes;
    }
    if (self) {
      EXPECT_LT(left, right - 0.4);
    } else {
      EXPECT_GT(left, right);
    }
  }
}

}  // namespace
}  // namespace tetskin::test
