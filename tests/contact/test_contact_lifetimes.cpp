// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Bodies, contacts and worlds are destroyed in any order.
#include "contact_test.h"

#include <cstdlib>

namespace tetskin::test {
namespace {

std::unique_ptr<TouchingBody> lying(EmptyWorld& world) {
  auto body = std::make_unique<TouchingBody>(world, ballMesh(12, 0.35), btVector3(0, btScalar(0.36), 0));
  step(world, 10);
  EXPECT_FALSE(body->contact->contacts().empty());
  return body;
}

TEST(ContactLifetimes, ContactGoesFirstAndTheCageIsMetAgain) {
  TetskinWorld world;
  const auto body = lying(world);
  body->contact.reset();
  step(world, 120);
  EXPECT_GT(lowest(body->body->body()), -0.02);  // the cage was at -0.15
}

TEST(ContactLifetimes, BodyGoesFirst) {
  TetskinWorld world;
  const auto body = lying(world);
  body->body.reset();
  EXPECT_TRUE(body->contact->contacts().empty());
  step(world, 3);
  body->contact.reset();
  step(world, 3);
}

TEST(ContactLifetimes, ABodyAtTheOldAddressIsAnother) {
  TetskinWorld world;
  for (int k = 0; k < 4; ++k) {
    const auto body = lying(world);
    body->body.reset();
    // Without surface contact, the new body rests on the floor by its cage, whatever remains of the other body.
    TetMesh cage = lifted(looseCage(), 0.52);
    const auto plain = added(world, cage);
    step(world, 60);
    EXPECT_GT(lowest(plain->body()), 0.0);
  }
}

TEST(ContactLifetimes, ContactBodyAndWorldGoInAnyOrder) {
  enum Owned { Contact, Body, World };
  std::vector<Owned> order = {Contact, Body, World};
  do {
    auto world = std::make_unique<TetskinWorld>();
    const auto body = lying(*world);
    for (const Owned owned : order) {
      if (owned == Contact) body->contact.reset();
      if (owned == Body) body->body.reset();
      if (owned == World) world.reset();
      if (world) step(*world, 3);
      if (body->contact && !body->body) {
        EXPECT_TRUE(body->contact->contacts().empty());
      }
    }
  } while (std::next_permutation(order.begin(), order.end()));
}

// Globals are destroyed from the last to the first.
std::vector<std::unique_ptr<DeformableBody>> bodiesAfterTheWorld;
std::vector<std::unique_ptr<SurfaceContact>> contactsAfterTheWorld;
std::unique_ptr<TetskinWorld> globalWorld;
std::vector<std::unique_ptr<SurfaceContact>> contactsBeforeTheWorld;
std::vector<std::unique_ptr<DeformableBody>> bodiesBeforeTheWorld;

/// All four orders in which a contact, a body and the world can be destroyed at the end of a program.
void fillGlobals() {
  globalWorld = std::make_unique<TetskinWorld>();
  for (int k = 0; k < 4; ++k) {
    TouchingBody body(*globalWorld, ballMesh(12, 0.35), btVector3(btScalar(1.5) * k, btScalar(0.36), 0));
    (k & 1 ? bodiesBeforeTheWorld : bodiesAfterTheWorld).push_back(std::move(body.body));
    (k & 2 ? contactsBeforeTheWorld : contactsAfterTheWorld).push_back(std::move(body.contact));
  }
  step(*globalWorld, 10);
}

TEST(ContactLifetimesDeathTest, GlobalsGoInAnyOrderAtTheEndOfTheProgram) {
  // This runs in a separate process, which ends like any other: static objects are destroyed.
  const auto run = [] {
    fillGlobals();
    for (const auto* contacts : {&contactsBeforeTheWorld, &contactsAfterTheWorld}) {
      for (const auto& contact : *contacts) {
        if (contact->contacts().empty()) std::exit(1);
      }
    }
    std::exit(0);
  };
  EXPECT_EXIT(run(), testing::ExitedWithCode(0), "");
}

/// Moves a body to another world, where no forces act on it and it stays where it is.
void move(btSoftBody& body, EmptyWorld& from, EmptyWorld& to) {
  from.deformable().removeSoftBody(&body);
  body.m_worldInfo = &to.deformable().getWorldInfo();
  to.deformable().addSoftBody(&body);
  for (int n = 0; n < body.m_nodes.size(); ++n) body.m_nodes[n].m_v.setZero();
}

TEST(ContactLifetimes, ABodyTakenToAnotherWorldIsMetByItsNodesThereAndByItsSurfaceOnceItIsBack) {
  TetskinWorld first, second;
  const auto body = lying(first);
  btSoftBody& soft = body->body->body();
  const TouchingBody other(second, ballMesh(12, 0.35), btVector3(3, btScalar(0.36), 0));
  const std::vector<btVector3> lyingNodes = nodesOf(soft);
  move(soft, first, second);
  step(second, 10);
  EXPECT_GT(soft.m_nodeRigidContacts.size(), 0);
  EXPECT_TRUE(body->contact->contacts().empty());
  EXPECT_FALSE(other.contact->contacts().empty());
  move(soft, second, first);
  // Contact by nodes had lifted the body off the floor.
  for (int n = 0; n < soft.m_nodes.size(); ++n) soft.m_nodes[n].m_x = lyingNodes[static_cast<std::size_t>(n)];
  step(first, 1);
  EXPECT_FALSE(body->contact->contacts().empty());
}

TEST(ContactLifetimes, ABodyThatReturnsIsMetByItsSurfaceInEitherWorld) {
  TetskinWorld first, second;
  const auto lies = lying(first);
  const double lay = lies->height();
  for (TetskinWorld* world : {&first, &second, &first}) {
    lies->body->removeFromWorld();
    ASSERT_TRUE(lies->body->addToWorld(world->deformable()).ok());
    step(*world, 30);
    EXPECT_FALSE(lies->contact->contacts().empty());
    EXPECT_NEAR(lies->height(), lay, 0.02);
  }
}

TEST(ContactLifetimes, ContactThatWasLeftBehindByItsWorldsDispatcherStartsAnewInAnother) {
  auto first = std::make_unique<TetskinWorld>();
  TetskinWorld second;
  const auto body = lying(*first);
  move(body->body->body(), *first, second);
  first.reset();
  body->contact.reset();
  auto made = SurfaceContact::add(second.deformable(), body->body->body(), *body->binding, body->mesh);
  ASSERT_TRUE(made.ok()) << made.status().message;
  step(second, 10);
  EXPECT_FALSE(made.value()->contacts().empty());
  // The body's original world is gone and cannot take it back: the code that moved it removes it, and its owner frees
  // it.
  second.deformable().removeSoftBody(&body->body->body());
}

TEST(ContactLifetimes, ObstaclesComeAndGoInTouch) {
  TetskinWorld world;
  const auto body = std::make_unique<TouchingBody>(world, ballMesh(12, 0.35), btVector3(0, btScalar(2.5), 0));
  for (int k = 0; k < 5; ++k) {
    const Obstacle shelf(world, std::make_unique<btBoxShape>(btVector3(1, btScalar(0.1), 1)),
                         placeAt(btVector3(0, btScalar(body->height()) - btScalar(0.11), 0)));
    step(world, 10);
    EXPECT_FALSE(body->contact->contacts().empty()) << k;
  }
  step(world, 60);
  EXPECT_LT(body->height(), 2.0);
}

TEST(ContactLifetimes, NoObstacleIsToldOfThatHasLeftTheWorld) {
  TetskinWorld world;
  const auto shelfAt = [&](btScalar x) {
    return std::make_unique<Obstacle>(world, std::make_unique<btBoxShape>(btVector3(1, btScalar(0.5), 1)),
                                      placeAt(btVector3(x, 4, 0)));
  };
  auto left = shelfAt(-1), right = shelfAt(1);
  TouchingBody body(world, boxMesh(Eigen::Vector3d(0.35, 0.35, 0.35)), btVector3(0, btScalar(4.86), 0));
  const auto touches = [&](const btCollisionObject* object) {
    const auto all = body.contact->contacts();
    return std::any_of(all.begin(), all.end(), [&](const SurfaceContactPoint& at) { return at.object == object; });
  };
  step(world, 30);
  const btCollisionObject *gone = &left->body(), *stays = &right->body();
  ASSERT_TRUE(touches(gone));
  ASSERT_TRUE(touches(stays));
  left.reset();
  EXPECT_FALSE(touches(gone));
  EXPECT_TRUE(touches(stays));
  step(world, 1);
  EXPECT_FALSE(touches(gone));
}

/// An application's own algorithm for a pair, which is Bullet's, and counted.
struct CountedAlgorithm : btCollisionAlgorithmCreateFunc {
  explicit CountedAlgorithm(btCollisionAlgorithmCreateFunc& ofBullet) : bullets(ofBullet) {}
  btCollisionAlgorithm* CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                 const btCollisionObjectWrapper* first,
                                                 const btCollisionObjectWrapper* second) override {
    ++count;
    return bullets.CreateCollisionAlgorithm(info, first, second);
  }
  btCollisionAlgorithmCreateFunc& bullets;
  int count = 0;
};

TEST(ContactLifetimes, AlgorithmsOfTheApplicationServeBodiesWithoutSurfaceContact) {
  TetskinWorld world;
  const int soft = SOFTBODY_SHAPE_PROXYTYPE, box = BOX_SHAPE_PROXYTYPE;
  CountedAlgorithm first(*world.configuration.getCollisionAlgorithmCreateFunc(soft, box)),
      second(*world.configuration.getCollisionAlgorithmCreateFunc(box, soft));
  world.dispatcher.registerCollisionCreateFunc(soft, box, &first);
  world.dispatcher.registerCollisionCreateFunc(box, soft, &second);
  const auto touching = lying(world), another = lying(world);
  EXPECT_EQ(first.count + second.count, 0);
  TetMesh cage = shifted(looseCage(), Eigen::Vector3d(3, 0.53, 0));
  const auto plain = added(world, cage);
  step(world, 60);
  EXPECT_EQ(first.count + second.count, 1);
  EXPECT_GT(lowest(plain->body()), -0.01);
  // Without its contacts, a body is like any other: at once, by the algorithm of its pair, and with each new pair.
  touching->contact.reset();
  step(world, 10);
  EXPECT_EQ(first.count + second.count, 2);
}

/// A dispatcher of the application, derived from Bullet's interface alone.
struct OtherDispatcher : btDispatcher {
  btCollisionAlgorithm* findAlgorithm(const btCollisionObjectWrapper*, const btCollisionObjectWrapper*,
                                      btPersistentManifold*, ebtDispatcherQueryType) override {
    return nullptr;
  }
  btPersistentManifold* getNewManifold(const btCollisionObject*, const btCollisionObject*) override { return nullptr; }
  void releaseManifold(btPersistentManifold*) override {}
  void clearManifold(btPersistentManifold*) override {}
  bool needsCollision(const btCollisionObject*, const btCollisionObject*) override { return false; }
  bool needsResponse(const btCollisionObject*, const btCollisionObject*) override { return false; }
  void dispatchAllCollisionPairs(btOverlappingPairCache*, const btDispatcherInfo&, btDispatcher*) override {}
  int getNumManifolds() const override { return 0; }
  btPersistentManifold* getManifoldByIndexInternal(int) override { return nullptr; }
  btPersistentManifold** getInternalManifoldPointer() override { return nullptr; }
  btPoolAllocator* getInternalManifoldPool() override { return nullptr; }
  const btPoolAllocator* getInternalManifoldPool() const override { return nullptr; }
  void* allocateCollisionAlgorithm(int) override { return nullptr; }
  void freeCollisionAlgorithm(void*) override {}
};

TEST(ContactLifetimes, NeedsADispatcherThatAlgorithmsCanBeRegisteredWith) {
  btSoftBodyRigidBodyCollisionConfiguration configuration;
  OtherDispatcher dispatcher;
  btDbvtBroadphase broadphase;
  DeformableSolver bodySolver;
  btDeformableMultiBodyConstraintSolver solver;
  solver.setDeformableSolver(&bodySolver);
  btDeformableMultiBodyDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration, &bodySolver);
  const TriangleMesh mesh = ballMesh(6, 0.35);
  const TetMesh cage = looseCage();
  const auto body = DeformableBody::add(world, cage).value();
  const auto made = SurfaceContact::add(world, body->body(), *SoftBodyBinding::create(cage, mesh).value(), mesh);
  EXPECT_EQ(made.status().code, StatusCode::InvalidOption);
}

}  // namespace
}  // namespace tetskin::test
