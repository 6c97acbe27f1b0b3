// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Wherever Bullet calls the application, it may add and remove whatever it likes, except where Bullet itself goes
// through what would change: see the last test. In a tick callback after the detection of contacts, Bullet's own code
// would read objects that are gone, so that a sanitizer alone, or a memory checker, sees some of these faults.
#include "crowded_world.h"

#include <tetskin/threads/thread_pool.h>

#include <BulletDynamics/Dynamics/btActionInterface.h>

#include <iterator>

namespace tetskin::test {
namespace {

constexpr btScalar kStep = btScalar(1) / 240;
constexpr int kFramesBefore = 8, kStepsPerFrame = 2;
constexpr btScalar kWeight = 10;  // of a toy: one kilogram

enum class Place {
  BetweenFrames,
  BeforeStep,   ///< tick callback before a step
  WithinStep,   ///< tick callback after a step, which a deformable world calls before the solve
  BeforeSolve,  ///< solver callback, called twice
  AfterSolve,
  Action,
  ReadMotion,   ///< motion state of a kinematic body
  WriteMotion,  ///< motion state of a dynamic body
};
constexpr const char* kPlaces[] = {"between frames",  "before a step", "within a step", "before the solve",
                                   "after the solve", "action",        "motion read",   "motion written"};

/// Calls back once at a place, when it is armed.
struct Hooks : btActionInterface, btMotionState {
  Hooks(EmptyWorld& ofWorld, Place ofPlace) : world(ofWorld.deformable()), place(ofPlace) {
    world.setWorldUserInfo(this);
    const auto tick = [](btDynamicsWorld* w, btScalar) { hooksOf(*w).call(hooksOf(*w).place); };
    if (place == Place::BeforeStep || place == Place::WithinStep) {
      world.setInternalTickCallback(tick, this, place == Place::BeforeStep);
    }
    world.setSolverCallback([](btScalar, btDeformableMultiBodyDynamicsWorld* w) {
      Hooks& hooks = hooksOf(*w);
      hooks.solved = !hooks.solved;
      hooks.call(hooks.solved ? Place::BeforeSolve : Place::AfterSolve);
    });
    world.addAction(this);
    if (place != Place::ReadMotion && place != Place::WriteMotion) return;
    const btScalar mass = place == Place::WriteMotion ? btScalar(1) : btScalar(0);
    moved = std::make_unique<btRigidBody>(mass, this, &shape, btVector3(1, 1, 1));
    if (mass == 0) moved->setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
    moved->setActivationState(DISABLE_DEACTIVATION);
    world.addRigidBody(moved.get());
  }
  ~Hooks() override {
    world.removeAction(this);
    if (moved) world.removeRigidBody(moved.get());
  }
  static Hooks& hooksOf(btDynamicsWorld& w) { return *static_cast<Hooks*>(w.getWorldUserInfo()); }
  void call(Place at) {
    if (at != place || !armed) return;
    const std::function<void()> now = std::move(armed);
    armed = nullptr;
    now();
  }

  void updateAction(btCollisionWorld*, btScalar) override { call(Place::Action); }
  void debugDraw(btIDebugDraw*) override {}
  void getWorldTransform(btTransform& to) const override {
    to = btTransform(btMatrix3x3::getIdentity(), btVector3(0, 50, 0));
    const_cast<Hooks*>(this)->call(Place::ReadMotion);
  }
  void setWorldTransform(const btTransform&) override { call(Place::WriteMotion); }

  btDeformableMultiBodyDynamicsWorld& world;
  Place place;
  std::function<void()> armed;
  bool solved = false;
  btSphereShape shape{btScalar(0.1)};
  std::unique_ptr<btRigidBody> moved;
};

struct Way {
  const char* name;
  void (*change)(CrowdedWorld&);
};
/// One after the other in one world: another change restores what one has removed.
const Way kWays[] = {
    {"soft body removed", [](CrowdedWorld& of) { of.upper.reset(); }},
    {"soft body added", [](CrowdedWorld& of) { of.addUpper(); }},
    {"soft body replaced", [](CrowdedWorld& of) { of.upper.reset(), of.addUpper(); }},
    {"lower body removed", [](CrowdedWorld& of) { of.lower.reset(); }},
    {"lower body added", [](CrowdedWorld& of) { of.addLower(); }},
    {"lower body replaced", [](CrowdedWorld& of) { of.lower.reset(), of.addLower(); }},
    {"all that the lower body touches removed", [](CrowdedWorld& of) { of.upper.reset(), of.shelf.reset(); }},
    {"all that the lower body touches added", [](CrowdedWorld& of) { of.addUpper(), of.addShelf(); }},
    {"Bullet's body removed", [](CrowdedWorld& of) { of.bullets.reset(); }},
    {"Bullet's body added", [](CrowdedWorld& of) { of.addBullets(); }},
    {"Bullet's body replaced", [](CrowdedWorld& of) { of.bullets.reset(), of.addBullets(); }},
    {"surface contact removed", [](CrowdedWorld& of) { of.lower->contact.reset(); }},
    {"surface contact added", [](CrowdedWorld& of) { of.lower->touch(of.world); }},
    {"surface contact replaced", [](CrowdedWorld& of) { of.lower->touch(of.world), of.under->touch(of.world); }},
    {"soft contacts removed", [](CrowdedWorld& of) { of.contacts.reset(); }},
    {"soft contacts added", [](CrowdedWorld& of) { of.addSoftContacts(); }},
    {"soft contacts replaced", [](CrowdedWorld& of) { of.contacts.reset(), of.addSoftContacts(); }},
    {"body out of soft contacts", [](CrowdedWorld& of) { of.contacts->remove(of.upper->soft()); }},
    {"body into soft contacts",
     [](CrowdedWorld& of) { EXPECT_TRUE(of.contacts->add(of.upper->soft(), toyModel().shape).ok()); }},
    {"joints removed", [](CrowdedWorld& of) { of.removeJoints(); }},
    {"joints added", [](CrowdedWorld& of) { of.addJoints(); }},
    {"joints replaced", [](CrowdedWorld& of) { of.removeJoints(), of.addJoints(); }},
    {"joints released", [](CrowdedWorld& of) { of.spring->release(), of.weld->release(); }},
    {"joints added", [](CrowdedWorld& of) { of.removeJoints(), of.addJoints(); }},
    {"record removed", [](CrowdedWorld& of) { of.record.reset(); }},
    {"record added", [](CrowdedWorld& of) { of.addRecord(); }},
    {"rigid body removed", [](CrowdedWorld& of) { of.box.reset(); }},
    {"rigid body added", [](CrowdedWorld& of) { of.addBox(); }},
    {"rigid body replaced", [](CrowdedWorld& of) { of.box.reset(), of.addBox(); }},
    {"static body removed", [](CrowdedWorld& of) { of.shelf.reset(); }},
    {"static body added", [](CrowdedWorld& of) { of.addShelf(); }},
    {"multibody removed", [](CrowdedWorld& of) { of.base.reset(); }},
    {"multibody added", [](CrowdedWorld& of) { of.addBase(); }},
    {"multibody replaced", [](CrowdedWorld& of) { of.base.reset(), of.addBase(); }},
    {"body with joints removed", [](CrowdedWorld& of) { of.held.reset(); }},
    {"all but the bystander removed",
     [](CrowdedWorld& of) {
       for (auto* toy : {&of.upper, &of.carrier, &of.bullets, &of.lower, &of.under}) toy->reset();
       of.removeJoints();
       of.box.reset();
       of.base.reset();
       of.shelf.reset();
       of.contacts.reset();
     }},
};

/// Conditions for each body, whatever has changed near it: bodies that appear where others have sunk a little are
/// pushed apart at most as fast as bodies fall.
void checkBodies(CrowdedWorld& of) {
  for (Toy* toy : {of.bystander.get(), of.lower.get(), of.upper.get(), of.bullets.get(), of.under.get(), of.held.get(),
                   of.carrier.get()}) {
    if (!toy) continue;
    EXPECT_TRUE(isFinite(toy->soft()));
    EXPECT_GT(lowest(toy->soft()), -0.15);
    EXPECT_LT(rmsSpeed(toy->soft()), 2.0);
    EXPECT_EQ(toy->skin.update(), StatusCode::Ok);
  }
}

/// The bystander's state in each frame: a node, and the force on the body.
using Course = std::vector<std::array<btVector3, 2>>;

/// changing  false: nothing is changed
Course runWith(Place place, bool changing, ParallelFor* threads) {
  CrowdedWorld of(threads);
  Hooks hooks(of.world, place);
  Course course;
  const auto frame = [&] {
    hooks.call(Place::BetweenFrames);
    of.world.deformable().stepSimulation(kStepsPerFrame * kStep, kStepsPerFrame, kStep);
    EXPECT_FALSE(hooks.armed);
    checkBodies(of);
    // A record that is added within a frame knows only of the steps that are left of it.
    const btVector3 force = of.record ? of.record->forcesOn(of.bystander->soft()).total().force : btVector3(0, 0, 0);
    course.push_back({of.bystander->soft().m_nodes[0].m_x, force});
  };
  for (int f = 0; f < kFramesBefore; ++f) frame();
  for (const Way& way : kWays) {
    SCOPED_TRACE(std::string(way.name) + ", " + kPlaces[static_cast<int>(place)]);
    if (changing) hooks.armed = [&] { way.change(of); };
    frame();
    frame();
  }
  return course;
}

class ChangesWithinSteps : public testing::TestWithParam<int> {};

TEST_P(ChangesWithinSteps, LeaveTheRestOfTheStepAsItIs) {
  const auto place = static_cast<Place>(GetParam());
  ThreadPool pool(2);
  static const Course undisturbed = runWith(Place::BetweenFrames, false, nullptr);
  const Course course = runWith(place, true, GetParam() % 2 == 0 ? nullptr : &pool);
  ASSERT_EQ(course.size(), undisturbed.size());
  for (std::size_t f = 0; f < course.size(); ++f) {
    EXPECT_EQ(course[f][0], undisturbed[f][0]) << f;
    if (course[f][1].isZero()) continue;  // without a record
    EXPECT_NEAR(course[f][1].y(), undisturbed[f][1].y(), 1e-3 * kWeight) << f;
  }
  EXPECT_NEAR(undisturbed.back()[1].y(), kWeight, 0.1 * kWeight);
}

INSTANTIATE_TEST_SUITE_P(Everywhere, ChangesWithinSteps, testing::Range(0, static_cast<int>(std::size(kPlaces))));

/// Bullet's btOverlapFilterCallback, which adds a body when asked.
struct AddingFilter : btOverlapFilterCallback {
  bool needBroadphaseCollision(btBroadphaseProxy* first, btBroadphaseProxy* second) const override {
    if (change) change();
    return (first->m_collisionFilterGroup & second->m_collisionFilterMask) != 0;
  }
  std::function<void()> change;
};

#ifndef NDEBUG  // an assertion of debug builds, which the sanitized configuration is
TEST(ChangesWithinStepsDeathTest, AreRefusedWhereBulletDetectsContacts) {
  tetskin::DeformableWorld world;
  btSphereShape shape(1);
  btRigidBody first(1, nullptr, &shape, btVector3(1, 1, 1)), second(1, nullptr, &shape, btVector3(1, 1, 1));
  world.addRigidBody(&first);
  world.addRigidBody(&second);
  AddingFilter filter;
  filter.change = [&] { world.removeRigidBody(&second); };
  world.getPairCache()->setOverlapFilterCallback(&filter);
  const auto near = [](btBroadphasePair&, btCollisionDispatcher& dispatcher, const btDispatcherInfo&) {
    static_cast<void>(dispatcher);
  };
  world.dispatcher().setNearCallback(near);
  EXPECT_DEATH(world.stepSimulation(kStep, 1, kStep), "filter, near or contact callback");
  filter.change = nullptr;
  world.removeRigidBody(&first);
  world.removeRigidBody(&second);
}
#endif

}  // namespace
}  // namespace tetskin::test
