// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Contacts that an application filters out do not happen: by the surface, by nodes, and among soft bodies; and a filter
// that changes while a body rests on something takes effect in the next step.
#include "contact_test.h"
#include "soft_fixtures.h"

#include <ostream>
#include <tuple>
#include <utility>

namespace tetskin::test {
namespace {

enum class By { Nodes, Surface };

std::ostream& operator<<(std::ostream& out, By by) {
  return out << (by == By::Nodes ? "Nodes" : "Surface");
}

/// A body on a platform high above the floor.
struct OnAPlatform {
  explicit OnAPlatform(By by)
      : platform(world, std::make_unique<btBoxShape>(btVector3(2, 1, 2)), placeAt(btVector3(0, 4, 0))),
        body(world, ballMesh(12, 0.35), btVector3(0, by == By::Nodes ? btScalar(5.55) : btScalar(5.38), 0)) {
    if (by == By::Nodes) body.contact.reset();
  }
  btSoftBody& soft() { return body.body->body(); }
  btBroadphaseProxy& proxy() { return *soft().getBroadphaseHandle(); }
  btRigidBody& rigid() { return platform.body(); }
  /// Whether the platform still supports the body after this many frames.
  bool isPinned(int frames) {
    step(world, frames);
    return body.height() > 4.9;
  }

  TetskinWorld world;
  Obstacle platform;
  TouchingBody body;
};

/// A filter that lets no pair pass while it is `closed`.
struct Gate : btOverlapFilterCallback {
  bool needBroadphaseCollision(btBroadphaseProxy*, btBroadphaseProxy*) const override { return !closed; }
  bool closed = false;
};

using Change = std::function<void(OnAPlatform&, bool forbid)>;

struct Filter {
  const char* name;
  Change change;
};

std::ostream& operator<<(std::ostream& out, const Filter& filter) {
  return out << filter.name;
}

void setFlag(btCollisionObject& object, bool forbid) {
  constexpr int kFlag = btCollisionObject::CF_NO_CONTACT_RESPONSE;
  object.setCollisionFlags(forbid ? object.getCollisionFlags() | kFlag : object.getCollisionFlags() & ~kFlag);
}

const Filter kFilters[] = {
    {"MaskOfTheBody", [](OnAPlatform& in, bool forbid) { in.proxy().m_collisionFilterMask = forbid ? 0 : -1; }},
    {"GroupOfTheBody", [](OnAPlatform& in, bool forbid) { in.proxy().m_collisionFilterGroup = forbid ? 0 : 1; }},
    {"MaskOfTheRigidBody",
     [](OnAPlatform& in, bool forbid) {
       in.rigid().getBroadphaseHandle()->m_collisionFilterMask = forbid ? ~btBroadphaseProxy::DefaultFilter : -1;
     }},
    {"IgnoredByTheBody", [](OnAPlatform& in, bool forbid) { in.soft().setIgnoreCollisionCheck(&in.rigid(), forbid); }},
    {"IgnoredByTheRigidBody",
     [](OnAPlatform& in, bool forbid) { in.rigid().setIgnoreCollisionCheck(&in.soft(), forbid); }},
    {"ResponseOfTheBody", [](OnAPlatform& in, bool forbid) { setFlag(in.soft(), forbid); }},
    {"ResponseOfTheRigidBody", [](OnAPlatform& in, bool forbid) { setFlag(in.rigid(), forbid); }},
    {"CollisionsOfTheBody",
     [](OnAPlatform& in, bool forbid) {
       constexpr int kNodes = btSoftBody::fCollision::SDF_RD | btSoftBody::fCollision::SDF_RDN;
       in.soft().m_cfg.collisions = forbid ? 0 : kNodes;
     }},
};

class ContactFilters : public testing::TestWithParam<std::tuple<By, Filter>> {
 protected:
  By by() const { return std::get<0>(GetParam()); }
  void set(OnAPlatform& scene, bool forbid) const { std::get<1>(GetParam()).change(scene, forbid); }
};

TEST_P(ContactFilters, ForbidWhatBegins) {
  OnAPlatform scene(by());
  set(scene, true);
  EXPECT_FALSE(scene.isPinned(60));
}

TEST_P(ContactFilters, CountFromTheNextStep) {
  OnAPlatform scene(by());
  ASSERT_TRUE(scene.isPinned(60));
  set(scene, true);
  EXPECT_TRUE(scene.isPinned(1));
  set(scene, false);
  ASSERT_TRUE(scene.isPinned(60)) << "forbidden for a frame";
  set(scene, true);
  EXPECT_FALSE(scene.isPinned(40));
}

TEST_P(ContactFilters, WakeWhatLiesThere) {
  OnAPlatform scene(by());
  ASSERT_TRUE(scene.isPinned(60));
  scene.soft().forceActivationState(ISLAND_SLEEPING);
  ASSERT_TRUE(scene.isPinned(60));
  ASSERT_FALSE(scene.soft().isActive());
  set(scene, true);
  EXPECT_FALSE(scene.isPinned(40));
}

INSTANTIATE_TEST_SUITE_P(Of, ContactFilters,
                         testing::Combine(testing::Values(By::Nodes, By::Surface), testing::ValuesIn(kFilters)),
                         [](const auto& param) {
                           const std::string by = std::get<0>(param.param) == By::Nodes ? "ByNodes" : "BySurface";
                           return std::get<1>(param.param).name + by;
                         });

TEST(ContactFiltersOfAWorld, AskTheWorldsCallback) {
  for (const By by : {By::Nodes, By::Surface}) {
    Gate gate;
    OnAPlatform scene(by);
    scene.world.deformable().getPairCache()->setOverlapFilterCallback(&gate);
    ASSERT_TRUE(scene.isPinned(60)) << by;
    gate.closed = true;
    EXPECT_FALSE(scene.isPinned(40)) << by;
    scene.world.deformable().getPairCache()->setOverlapFilterCallback(nullptr);
  }
}

/// Bullet does not keep a pair that was refused when the boxes began to overlap.
TEST(ContactFiltersOfAWorld, AllowARefusedPairAfterARefresh) {
  for (const By by : {By::Nodes, By::Surface}) {
    OnAPlatform scene(by);
    scene.proxy().m_collisionFilterMask = 0;
    scene.world.deformable().refreshBroadphaseProxy(&scene.soft());
    step(scene.world, 2);
    scene.proxy().m_collisionFilterMask = -1;
    scene.world.deformable().refreshBroadphaseProxy(&scene.soft());
    EXPECT_TRUE(scene.isPinned(60)) << by;
  }
}

/// One ball that lies on another, which is pinned.
struct OnABall {
  OnABall()
      : lower(added(*world, ball().at({0, 5, 0}))),
        upper(added(*world, ball().at({0, 5.85, 0}))),
        contacts(contactsIn(*world)) {
    for (int n = 0; n < lower->body().m_nodes.size(); ++n) lower->body().setMass(n, 0);
    EXPECT_TRUE(contacts->add(lower->body(), ball().shape).ok());
    EXPECT_TRUE(contacts->add(upper->body(), ball().shape).ok());
  }
  bool isPinned(int frames) {
    step(*world, frames);
    return centreOf(upper->body()).y() > 6;
  }

  std::unique_ptr<TetskinWorld> world = worldWith(btVector3(0, -10, 0));
  std::unique_ptr<DeformableBody> lower, upper;
  std::unique_ptr<SoftContacts> contacts;
};

using SoftChange = std::function<void(btSoftBody& body, const btSoftBody& other, bool forbid)>;

const std::pair<const char*, SoftChange> kSoftFilters[] = {
    {"Mask", [](btSoftBody& body, const btSoftBody&,
                bool forbid) { body.getBroadphaseHandle()->m_collisionFilterMask = forbid ? 0 : -1; }},
    {"Group", [](btSoftBody& body, const btSoftBody&,
                 bool forbid) { body.getBroadphaseHandle()->m_collisionFilterGroup = forbid ? 0 : 1; }},
    {"Ignored",
     [](btSoftBody& body, const btSoftBody& other, bool forbid) { body.setIgnoreCollisionCheck(&other, forbid); }},
    {"Response", [](btSoftBody& body, const btSoftBody&, bool forbid) { setFlag(body, forbid); }},
    {"Collisions",
     [](btSoftBody& body, const btSoftBody&, bool forbid) {
       constexpr int kNodes = btSoftBody::fCollision::SDF_RD | btSoftBody::fCollision::SDF_RDN;
       body.m_cfg.collisions = forbid ? 0 : kNodes;
     }},
};

TEST(ContactFiltersAmongSoftBodies, CountFromTheNextStep) {
  for (const auto& [name, change] : kSoftFilters) {
    for (const bool ofUpper : {false, true}) {
      OnABall scene;
      btSoftBody& own = (ofUpper ? scene.upper : scene.lower)->body();
      const btSoftBody& other = (ofUpper ? scene.lower : scene.upper)->body();
      ASSERT_TRUE(scene.isPinned(30)) << name;
      change(own, other, true);
      EXPECT_TRUE(scene.isPinned(1)) << name;
      EXPECT_TRUE(scene.contacts->contacts().empty()) << name;
      change(own, other, false);
      ASSERT_TRUE(scene.isPinned(30)) << name << ": forbidden for a frame";
      EXPECT_FALSE(scene.contacts->contacts().empty()) << name;
      for (DeformableBody* body : {scene.lower.get(), scene.upper.get()}) {
        body->body().forceActivationState(ISLAND_SLEEPING);
      }
      ASSERT_TRUE(scene.isPinned(10)) << name;
      ASSERT_FALSE(scene.upper->body().isActive()) << name;
      change(own, other, true);
      EXPECT_FALSE(scene.isPinned(30)) << name;
    }
  }
}

TEST(ContactFiltersAmongSoftBodies, AskTheWorldsCallback) {
  Gate gate;
  OnABall scene;
  scene.world->deformable().getPairCache()->setOverlapFilterCallback(&gate);
  ASSERT_TRUE(scene.isPinned(30));
  gate.closed = true;
  EXPECT_FALSE(scene.isPinned(30));
  scene.world->deformable().getPairCache()->setOverlapFilterCallback(nullptr);
}

}  // namespace
}  // namespace tetskin::test
