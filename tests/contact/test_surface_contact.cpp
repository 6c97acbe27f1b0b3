// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "contact_test.h"

#include <BulletCollision/CollisionShapes/btHeightfieldTerrainShape.h>
#include <tetskin/solver/src/base/exact_distance.h>

namespace tetskin::test {

using namespace bullet_detail;

namespace {

constexpr double kAllowedGap = 0.003 * kBodySize;

/// A function that gives a point's distance from a body with an exact shape.
auto distanceFrom(Obstacle& obstacle) {
  return [&obstacle](const Eigen::Vector3d& p) {
    const btVector3 local = obstacle.body().getWorldTransform().inverse() * toBullet(p);
    return ExactShape::exactShape(obstacle.shape())->distance(local).distance;
  };
}

TEST(SurfaceContact, RestsOnTheFloorAsDrawn) {
  TetskinWorld world;
  TouchingBody body(world, ballMesh(24, 0.35), btVector3(0, btScalar(0.4), 0));
  step(world, 150);
  EXPECT_NEAR(body.height(), 0.0, kAllowedGap);
  EXPECT_LT(lowest(body.body->body()), -0.02);  // the cage reaches below the floor, the surface does not
}

TEST(SurfaceContact, RestsOnAnEdgeASphereAndAPole) {
  const btQuaternion turned(btVector3(0, 0, 1), SIMD_PI / 4);
  for (int kind = 0; kind < 3; ++kind) {
    TetskinWorld world;
    std::unique_ptr<btCollisionShape> shape;
    if (kind == 0) shape = std::make_unique<btBoxShape>(btVector3(1, 1, 1) / btSqrt(btScalar(2)));
    if (kind == 1) shape = std::make_unique<btSphereShape>(1);
    if (kind == 2) shape = std::make_unique<btCapsuleShapeZ>(btScalar(0.03), 2);
    const btScalar top = kind == 2 ? btScalar(0.03) : btScalar(1);
    Obstacle obstacle(world, std::move(shape),
                      placeAt(btVector3(0, 2, 0), kind == 0 ? turned : btQuaternion(0, 0, 0, 1)));
    // A lattice cube holds a ball that is wider than the pole is thick; it stays balanced because all is symmetric
    // enough.
    TouchingBody body(world, ballMesh(48, 0.35), btVector3(0, 2 + top + btScalar(0.36), 0));
    double worst = HUGE_VAL;
    for (int f = 0; f < 40; ++f) {
      step(world, 1);
      worst = std::min(worst, body.gap(distanceFrom(obstacle)));
    }
    EXPECT_NEAR(body.gap(distanceFrom(obstacle)), 0.0, kAllowedGap) << kind;
    EXPECT_GT(worst, -kAllowedGap) << kind;
  }
}

TEST(SurfaceContact, StopsAFastBodyThatWouldPassAThinPlate) {
  TetskinWorld world;
  Obstacle plate(world, std::make_unique<btBoxShape>(btVector3(2, btScalar(0.01), 2)), placeAt(btVector3(0, 3, 0)));
  TouchingBody body(world, ballMesh(24, 0.35), btVector3(0, btScalar(3.6), 0));
  body.body->body().setVelocity(btVector3(0, -15, 0));
  double worst = HUGE_VAL;
  for (int f = 0; f < 60; ++f) {
    step(world, 1);
    worst = std::min(worst, body.height() - 3.01);
  }
  EXPECT_GT(worst, -0.02 * kBodySize);
}

TEST(SurfaceContact, ThinAndSharpObstaclesDoNotCutInAtFifteenSizesASecond) {
  const btQuaternion turned(btVector3(0, 0, 1), SIMD_PI / 4);
  for (int kind = 0; kind < 4; ++kind) {
    TetskinWorld world;
    std::unique_ptr<btCollisionShape> shape;
    if (kind == 0) shape = std::make_unique<btBoxShape>(btVector3(1, 1, 1) / btSqrt(btScalar(2)));
    if (kind == 1) shape = std::make_unique<btSphereShape>(1);
    if (kind == 2) shape = std::make_unique<btCapsuleShapeZ>(btScalar(0.03), 2);
    if (kind == 3) shape = std::make_unique<btSphereShape>(btScalar(0.075));
    const btScalar tops[] = {1, 1, btScalar(0.03), btScalar(0.075)};
    Obstacle obstacle(world, std::move(shape),
                      placeAt(btVector3(0, 3, 0), kind == 0 ? turned : btQuaternion::getIdentity()));
    TouchingBody body(world, ballMesh(48, 0.35), btVector3(btScalar(0.01), 3 + tops[kind] + btScalar(0.5), 0));
    body.body->body().setVelocity(btVector3(0, -15, 0));
    double worst = HUGE_VAL;
    for (int k = 0; k < 60; ++k) {
      world.deformable().stepSimulation(btScalar(1) / 240, 1, btScalar(1) / 240);
      worst = std::min(worst, body.gap(distanceFrom(obstacle)));
    }
    EXPECT_LT(worst, 0.01) << kind;  // the two were in contact
    EXPECT_GT(worst, -0.005 * kBodySize) << kind;
  }
}

TEST(SurfaceContact, PushesADynamicBodyAsMuchAsItIsPushed) {
  TetskinWorld world;
  world.deformable().setGravity(btVector3(0, 0, 0));
  Obstacle ball(world, std::make_unique<btSphereShape>(btScalar(0.2)), placeAt(btVector3(0, 5, 0)), 1);
  TouchingBody body(world, ballMesh(24, 0.35), btVector3(0, btScalar(5.8), 0));
  body.body->body().setVelocity(btVector3(0, -2, 0));
  step(world, 30);
  const btScalar rigid = ball.body().getLinearVelocity().y();
  EXPECT_LT(rigid, -0.5);
  btScalar momentum = 0;
  btSoftBody& soft = body.body->body();
  for (int n = 0; n < soft.m_nodes.size(); ++n) momentum += soft.m_nodes[n].m_v.y() / soft.m_nodes[n].m_im;
  EXPECT_NEAR(momentum + rigid, -2, 0.02);
}

TEST(SurfaceContact, FallsAsleepWhereItLies) {
  TetskinWorld world;
  TouchingBody body(world, ballMesh(24, 0.35), btVector3(0, btScalar(0.36), 0));
  btSoftBody& soft = body.body->body();
  std::vector<btVector3> before;
  for (int f = 0; f < 400 && soft.isActive(); ++f) {
    if (f == 120) soft.m_sleepingThreshold = 1;  // so that the test need not wait for the last rocking motion to stop
    before = nodesOf(soft);
    step(world, 1);
  }
  ASSERT_FALSE(soft.isActive());
  step(world, 2);
  double maximum = 0.0;
  for (int n = 0; n < soft.m_nodes.size(); ++n) {
    maximum = std::max<double>(maximum, (soft.m_nodes[n].m_x - before[static_cast<std::size_t>(n)]).length());
  }
  EXPECT_LT(maximum, 0.0002 * kBodySize);
  EXPECT_NEAR(body.height(), 0.0, kAllowedGap);
}

/// The sum of kinetic, elastic and gravitational energy.
double energyOf(EmptyWorld& world, const btSoftBody& body) {
  double energy = kineticEnergyOf(body) + elasticEnergyIn(world);
  for (int n = 0; n < body.m_nodes.size(); ++n) {
    energy += 10.0 * static_cast<double>(body.m_nodes[n].m_x.y() / body.m_nodes[n].m_im);
  }
  return energy;
}

TEST(SurfaceContact, GainsNoEnergyInALanding) {
  TetskinWorld world;
  TouchingBody body(world, ballMesh(24, 0.35), btVector3(0, btScalar(0.55), 0));
  btSoftBody& soft = body.body->body();
  soft.setVelocity(btVector3(0, -2, 0));
  const double impact = 0.5 * 4.0;
  double minimum = energyOf(world, soft), risen = 0.0;
  for (int k = 0; k < 480; ++k) {
    world.deformable().stepSimulation(btScalar(1) / 240, 1, btScalar(1) / 240);
    const double energy = energyOf(world, soft);
    minimum = std::min(minimum, energy);
    risen = std::max(risen, energy - minimum);
  }
  EXPECT_LT(risen, 0.01 * impact);
}

/// Rounding in the stiffness of a body is not taken for its mass, which would throw it off.
TEST(SurfaceContact, BringsABodyOfAnyStiffnessToRest) {
  for (const double modulus : {1e6, 1e8, 1e9, 1e10, 1e11}) {
    for (const int steps : {1, 2, 4, 8}) {
      TetskinWorld world;
      SoftBodyOptions material;
      material.youngsModulus = modulus;
      TouchingBody body(world, boxMesh(Eigen::Vector3d::Constant(0.3)), btVector3(0, btScalar(0.4), 0), {}, material);
      const btScalar dt = btScalar(1) / static_cast<btScalar>(60 * steps);
      double fastest = 0.0;
      for (int f = 0; f < 80; ++f) {
        world.deformable().stepSimulation(btScalar(1) / 60, steps, dt);
        if (f >= 60) fastest = std::max(fastest, rmsSpeed(body.body->body()));
      }
      EXPECT_LT(fastest, 0.01) << modulus << " Pa, " << steps << " steps per frame";
      EXPECT_NEAR(body.height(), 0.0, kAllowedGap) << modulus << " Pa, " << steps << " steps per frame";
    }
  }
}

TEST(SurfaceContact, RestsOnConvexHullsMeshesHeightFieldsAndChildrenOfCompounds) {
  const auto flat = [](btScalar y) {
    auto* mesh = new btTriangleMesh;
    for (int i = -3; i < 3; ++i) {
      for (int j = -3; j < 3; ++j) {
        const btVector3 a(i, y, j), b(i + 1, y, j), c(i, y, j + 1), d(i + 1, y, j + 1);
        mesh->addTriangle(a, c, b);
        mesh->addTriangle(b, c, d);
      }
    }
    return mesh;
  };
  const std::unique_ptr<btTriangleMesh> mesh(flat(1));
  std::vector<btScalar> heights(16 * 16, btScalar(0.5));
  btBoxShape child(btVector3(2, btScalar(0.5), 2));
  btCompoundShape inner;
  inner.addChildShape(placeAt(btVector3(0, btScalar(0.25), 0)), &child);
  for (int kind = 0; kind < 4; ++kind) {
    TetskinWorld world;
    std::unique_ptr<btCollisionShape> shape;
    if (kind == 0) {
      auto hull = std::make_unique<btConvexHullShape>();
      for (const Eigen::Vector3d& p : boxMesh(Eigen::Vector3d(2, 1, 2)).positions) hull->addPoint(toBullet(p));
      shape = std::move(hull);
    } else if (kind == 1) {
      shape = std::make_unique<btBvhTriangleMeshShape>(mesh.get(), true);
    } else if (kind == 2) {
      auto field = std::make_unique<btHeightfieldTerrainShape>(
          16, 16, static_cast<const void*>(heights.data()), btScalar(1), btScalar(0), btScalar(2), 1, PHY_FLOAT, false);
      shape = std::move(field);
    } else {
      auto compound = std::make_unique<btCompoundShape>();
      // A compound in a compound, which Bullet's own algorithm puts in the wrong position where both are turned.
      compound->addChildShape(placeAt(btVector3(0, btScalar(0.25), 0), btQuaternion(btVector3(0, 1, 0), 1)), &inner);
      shape = std::move(compound);
    }
    Obstacle obstacle(world, std::move(shape), placeAt(btVector3(0, 3, 0)));
    btVector3 low, high;
    obstacle.body().getAabb(low, high);
    // Hulls and meshes count as drawn, without Bullet's margin; height fields are centred.
    const double top = kind == 2 ? 3.0 - 0.5 : 4.0;
    TouchingBody body(world, ballMesh(24, 0.35), btVector3(btScalar(0.1), btScalar(top + 0.4), btScalar(0.05)));
    step(world, 120);
    EXPECT_NEAR(body.height(), top, kAllowedGap) << kind;
  }
}

/// A floor of 900 boxes, each turned, in a compound that is also turned.
std::unique_ptr<btCompoundShape> paving(btBoxShape& stone, bool withTree) {
  auto compound = std::make_unique<btCompoundShape>(withTree);
  for (int i = -15; i < 15; ++i) {
    for (int j = -15; j < 15; ++j) {
      const btVector3 at(btScalar(0.2) * i, 0, btScalar(0.2) * j);
      compound->addChildShape(placeAt(at, btQuaternion(btVector3(0, 1, 0), btScalar(0.1) * (i + j))), &stone);
    }
  }
  return compound;
}

TEST(SurfaceContact, FindsTheChildrenOfACompoundByItsTreeAsAllOfThemOneByOne) {
  btBoxShape stone(btVector3(btScalar(0.12), btScalar(0.1), btScalar(0.12)));
  struct Scene {
    Scene(btBoxShape& stone, bool withTree)
        : floor(world, paving(stone, withTree), placeAt(btVector3(0, 3, 0), btQuaternion(btVector3(1, 12, 1), 1))),
          body(world, ballMesh(48, 0.35), btVector3(btScalar(0.2), btScalar(3.5), btScalar(0.1))) {
      // The floor sweeps upwards, first slowly and then fast, and turns.
      floor.body().setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
      floor.body().setActivationState(DISABLE_DEACTIVATION);
    }
    TetskinWorld world;
    Obstacle floor;
    TouchingBody body;
  };
  Scene byTree(stone, true), oneByOne(stone, false);
  std::size_t found = 0;
  for (int k = 0; k < 90; ++k) {
    for (Scene* scene : {&byTree, &oneByOne}) {
      btRigidBody& floor = scene->floor.body();
      auto& compound = static_cast<btCompoundShape&>(*floor.getCollisionShape());
      // Removing a child changes the indices of others.
      if (k % 10 == 9) compound.removeChildShapeByIndex(k * 7);
      const btScalar turn = 1 + btScalar(0.003) * k;
      floor.setWorldTransform(
          placeAt(btVector3(0, 3 + btScalar(0.0001) * k * k, 0), btQuaternion(btVector3(1, 12, 1), turn)));
      step(scene->world, 1);
    }
    const auto a = byTree.body.contact->contacts(), b = oneByOne.body.contact->contacts();
    ASSERT_EQ(a.size(), b.size()) << k;
    for (std::size_t c = 0; c < a.size(); ++c) {
      EXPECT_EQ(a[c].point, b[c].point) << k;
      EXPECT_EQ(a[c].normal, b[c].normal) << k;
      EXPECT_EQ(a[c].distance, b[c].distance) << k;
    }
    found += a.size();
  }
  EXPECT_GT(found, 100U);
}

TEST(SurfaceContact, CountsGroupsMasksFlagsAndIgnoredBodies) {
  for (int kind = 0; kind < 3; ++kind) {
    TetskinWorld world;
    Obstacle shelf(world, std::make_unique<btBoxShape>(btVector3(2, btScalar(0.1), 2)), placeAt(btVector3(0, 2, 0)));
    if (kind == 0) {
      world.deformable().removeRigidBody(&shelf.body());
      world.deformable().addRigidBody(&shelf.body(), 64, 64);
    }
    TouchingBody body(world, ballMesh(16, 0.35), btVector3(0, btScalar(2.5), 0));
    if (kind == 1)
      shelf.body().setCollisionFlags(shelf.body().getCollisionFlags() | btCollisionObject::CF_NO_CONTACT_RESPONSE);
    if (kind == 2) body.body->body().setIgnoreCollisionCheck(&shelf.body(), true);
    step(world, 90);
    EXPECT_LT(body.height(), 1.0) << kind;
  }
}

TEST(SurfaceContact, HoldsByFrictionWhatWouldSlideWithout) {
  for (const bool highFriction : {true, false}) {
    TetskinWorld world;
    const btQuaternion slope(btVector3(0, 0, 1), btScalar(-0.2));
    Obstacle ramp(world, std::make_unique<btBoxShape>(btVector3(6, 1, 6)), placeAt(btVector3(0, 2, 0), slope));
    ramp.body().setFriction(highFriction ? 2 : 0);
    SurfaceContactOptions options;
    options.sampleSpacing = 0.1;
    TouchingBody body(world, boxMesh(Eigen::Vector3d(0.35, 0.2, 0.35)), btVector3(0, btScalar(3.35), 0), options);
    step(world, 60);
    const btScalar x = body.body->body().m_nodes[0].m_x.x();
    step(world, 60);
    const btScalar slid = body.body->body().m_nodes[0].m_x.x() - x;
    if (highFriction) {
      EXPECT_LT(slid, 0.01);
    } else {
      EXPECT_GT(slid, 0.5);
    }
  }
}

TEST(SurfaceContact, OfACoarseMeshHoldsByItsSamples) {
  SurfaceContactOptions none, given;
  none.sampleSpacing = SurfaceContactOptions::kNoSamples;
  given.sampleSpacing = 0.03;
  for (const SurfaceContactOptions& options : {none, given, SurfaceContactOptions{}}) {
    const bool sampled = options.sampleSpacing != none.sampleSpacing;
    TetskinWorld world;
    Obstacle pole(world, std::make_unique<btCapsuleShapeZ>(btScalar(0.03), 2), placeAt(btVector3(0, 3, 0)));
    TouchingBody body(world, boxMesh(Eigen::Vector3d(0.35, 0.35, 0.35)), btVector3(0, btScalar(3.45), 0), options);
    EXPECT_EQ(body.contact->sampleCount() > 8, sampled);
    step(world, 20);
    const double underside = body.height() - 3.03;
    if (sampled) {
      EXPECT_GT(underside, -0.03);
    } else {
      EXPECT_LT(underside, -0.1);
    }
  }
}

TEST(SurfaceContact, TellsItsContacts) {
  TetskinWorld world;
  TouchingBody body(world, ballMesh(24, 0.35), btVector3(0, btScalar(0.36), 0));
  EXPECT_TRUE(body.contact->contacts().empty());
  step(world, 60);
  const std::vector<SurfaceContactPoint> contacts = body.contact->contacts();
  ASSERT_FALSE(contacts.empty());
  btScalar sum = 0;
  for (const SurfaceContactPoint& at : contacts) {
    EXPECT_EQ(at.object, world.world->getCollisionObjectArray()[0]);
    EXPECT_NEAR(at.normal.y(), 1, 1e-5);
    EXPECT_NEAR(at.point.y(), 0.002, 0.002);
    sum += at.impulse.y();
  }
  // The impulse of the weight of a mass of 1 over 1/240 s.
  EXPECT_NEAR(sum, 10.0 / 240, 0.3 * 10.0 / 240);
}

double pushedUp(const TouchingBody& body) {
  double sum = 0;
  for (const SurfaceContactPoint& at : body.contact->contacts()) sum += static_cast<double>(at.impulse.y());
  return sum;
}

TEST(SurfaceContact, KeepsItsContactsWhenTheWorldIsAskedForOthers) {
  struct Nothing : btCollisionWorld::ContactResultCallback {
    btScalar addSingleResult(btManifoldPoint&, const btCollisionObjectWrapper*, int, int,
                             const btCollisionObjectWrapper*, int, int) override {
      return 0;
    }
  } nothing;
  TetskinWorld made;
  TouchingBody body(made, ballMesh(24, 0.35), btVector3(0, btScalar(0.36), 0));
  step(made, 60);
  const double before = pushedUp(body);
  const std::size_t count = body.contact->contacts().size();
  ASSERT_GT(before, 0.01);
  btCollisionObject* floor = made.world->getCollisionObjectArray()[0];
  made.world->contactTest(floor, nothing);
  made.world->contactTest(&body.body->body(), nothing);
  made.world->contactPairTest(floor, &body.body->body(), nothing);
  EXPECT_EQ(pushedUp(body), before);
  EXPECT_EQ(body.contact->contacts().size(), count);
}

TEST(SurfaceContact, IsOffWhereTheBodyIsToMeetNoRigidBodies) {
  TetskinWorld world;
  TouchingBody body(world, ballMesh(16, 0.35), btVector3(0, btScalar(0.36), 0));
  btSoftBody& soft = body.body->body();
  step(world, 10);
  const int before = soft.m_cfg.collisions;
  soft.m_cfg.collisions = 0;
  step(world, 30);
  EXPECT_TRUE(body.contact->contacts().empty());
  EXPECT_LT(body.height(), -0.5);
  soft.m_cfg.collisions = before;
}

TEST(SurfaceContact, SetsAMarginAndGivesItBack) {
  TetskinWorld world;
  TouchingBody body(world, ballMesh(8, 0.35), btVector3(0, 2, 0));
  btCollisionShape& shape = *body.body->body().getCollisionShape();
  EXPECT_NEAR(shape.getMargin(), 0.002 * kBodySize, 1e-6);
  body.contact.reset();
  EXPECT_NEAR(shape.getMargin(), 0.02 * kBodySize, 1e-6);
}

TEST(SurfaceContact, RefusesWhatDoesNotBelongTogether) {
  TetskinWorld world, other;
  TouchingBody body(world, ballMesh(8, 0.35), btVector3(0, 2, 0));
  btSoftBody& soft = body.body->body();
  const auto codeOf = [&](btDeformableMultiBodyDynamicsWorld& in, const TriangleMesh& mesh,
                          const SurfaceContactOptions& options) {
    return SurfaceContact::add(in, soft, *body.binding, mesh, options).status().code;
  };
  EXPECT_EQ(codeOf(world.deformable(), body.mesh, {}), StatusCode::InvalidOption);  // the body already has contact
  body.contact.reset();
  EXPECT_EQ(codeOf(other.deformable(), body.mesh, {}), StatusCode::InvalidOption);
  EXPECT_EQ(codeOf(world.deformable(), ballMesh(9, 0.35), {}), StatusCode::SizeMismatch);
  for (const double bad : {-1.0, 0.0, -HUGE_VAL, std::nan(""), 1e-9, 1e-5}) {
    SurfaceContactOptions options;
    options.sampleSpacing = bad;
    EXPECT_EQ(codeOf(world.deformable(), body.mesh, options), StatusCode::InvalidOption);
  }
  SurfaceContactOptions options;
  options.margin = std::nan("");
  EXPECT_EQ(codeOf(world.deformable(), body.mesh, options), StatusCode::InvalidOption);
  EXPECT_EQ(codeOf(world.deformable(), body.mesh, {}), StatusCode::Ok);
}

TEST(SurfaceContact, RefusesBodiesMadeByOthers) {
  TetskinWorld world;
  const TetMesh cage = looseCage();
  const TriangleMesh mesh = ballMesh(8, 0.35);
  const auto binding = SoftBodyBinding::create(cage, mesh).value();
  std::vector<btVector3> nodes;
  for (const Eigen::Vector3d& p : cage.nodes) nodes.push_back(toBullet(p));
  btSoftBody soft(&world.deformable().getWorldInfo(), static_cast<int>(nodes.size()), nodes.data(), nullptr);
  world.deformable().addSoftBody(&soft);
  EXPECT_EQ(SurfaceContact::add(world.deformable(), soft, *binding, mesh).status().code, StatusCode::InvalidOption);
  world.deformable().removeSoftBody(&soft);
}

TEST(SurfaceContact, IsRefusedInAWorldWithAnotherSolver) {
  EmptyWorld world;
  const Result<std::unique_ptr<btSoftBody>> made = createSoftBody(looseCage(), world.deformable().getWorldInfo());
  btSoftBody& soft = *made.value();
  world.deformable().addSoftBody(&soft);
  const TriangleMesh mesh = ballMesh(8, 0.35);
  const Status status =
      SurfaceContact::add(world.deformable(), soft, *SoftBodyBinding::create(looseCage(), mesh).value(), mesh).status();
  EXPECT_EQ(status.code, StatusCode::InvalidOption);
  EXPECT_NE(status.message.find("DeformableSolver"), std::string::npos) << status.message;
  world.deformable().removeSoftBody(&soft);
}

}  // namespace
}  // namespace tetskin::test
