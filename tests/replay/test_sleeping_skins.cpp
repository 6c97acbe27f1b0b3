// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A skin is where its body is, whenever it is updated, although it skips sleeping bodies. Each test compares it with a
// second skin of the body that skips nothing.
#include "bullet/skin_test.h"
#include "solver/deformable_test.h"

#include <tetskin/bullet/soft_body_skin.h>
#include <tetskin/replay/snapshot.h>

namespace tetskin::test {
namespace {

/// A bar along z, held at its lower end. Each of the worlds reports in its own way, or not at all, that it moves nodes.
TetMesh bar() {
  return lifted(latticeCage(2, 2, 6, 0.25), 5.0);
}
/// The first nodes in memory are pinned: a look at a few nodes close together sees these alone.
SoftBodyOptions held() {
  SoftBodyOptions options;
  options.pinned = [](const Eigen::Vector3d& p) { return p.z() < 0.4; };
  return options;
}

class HeldBar {
 public:
  virtual ~HeldBar() = default;
  virtual btDiscreteDynamicsWorld& world() = 0;
  virtual btSoftBody& body() = 0;
  /// Null where worlds cannot be saved.
  virtual btDeformableMultiBodyDynamicsWorld* saved() { return nullptr; }
  /// True if steps record what they move, and single nodes moved by hand are noticed in the next step.
  virtual bool counts() const { return false; }

  void step(int frames) {
    for (int f = 0; f < frames; ++f) world().stepSimulation(btScalar(1) / 60, 4, btScalar(1) / 240);
  }
};

/// In a world of the library's solver.
class CountingBar : public HeldBar {
 public:
  CountingBar() : body_(added(world_, bar(), held())) {}
  btDiscreteDynamicsWorld& world() override { return *world_.world; }
  btSoftBody& body() override { return body_->body(); }
  btDeformableMultiBodyDynamicsWorld* saved() override { return &world_.deformable(); }
  bool counts() const override { return true; }
  DeformableBody& deformable() { return *body_; }

 private:
  TetskinWorld world_;
  std::unique_ptr<DeformableBody> body_;
};

/// In a world of the library's solver, whose settings are such that Bullet's own code solves.
class BulletSolvedBar : public HeldBar {
 public:
  BulletSolvedBar() {
    SoftBodyOptions options = held();
    options.forceModel = ForceModel::NeoHookean;
    body_ = added(world_, bar(), options);
    world_.deformable().setImplicit(true);
  }
  btDiscreteDynamicsWorld& world() override { return *world_.world; }
  btSoftBody& body() override { return body_->body(); }
  btDeformableMultiBodyDynamicsWorld* saved() override { return &world_.deformable(); }

 private:
  TetskinWorld world_;
  std::unique_ptr<DeformableBody> body_;
};

/// In Bullet's deformable world.
class DeformableBar : public HeldBar {
 public:
  DeformableBar() {
    for (int n = 0; n < body().m_nodes.size(); ++n) {
      if (body().m_nodes[n].m_x.z() < btScalar(0.4)) body().setMass(n, 0);
    }
  }
  btDiscreteDynamicsWorld& world() override { return *world_.world; }
  btSoftBody& body() override { return world_.body(); }

 private:
  DeformableWorld world_{bar()};
};

/// In Bullet's classic world.
class ClassicBar : public HeldBar {
 public:
  btDiscreteDynamicsWorld& world() override { return *world_.world; }
  btSoftBody& body() override { return world_.body(); }

 private:
  RigidWorld world_{bar(), held()};
};

/// A body not made by the library, in Bullet's classic world.
class PlainBar : public HeldBar {
 public:
  PlainBar() {
    const TetMesh cage = bar();
    std::vector<btVector3> nodes;
    for (const Eigen::Vector3d& p : cage.nodes) nodes.push_back(toBullet(p));
    auto& classic = static_cast<btSoftRigidDynamicsWorld&>(world());
    body_ =
        std::make_unique<btSoftBody>(&classic.getWorldInfo(), static_cast<int>(nodes.size()), nodes.data(), nullptr);
    for (const Tet& t : cage.tets) {
      for (std::size_t a = 0; a < 4; ++a) {
        for (std::size_t b = 0; b < a; ++b) body_->appendLink(t[a], t[b], nullptr, true);
      }
    }
    for (int n = 0; n < body_->m_nodes.size(); ++n) {
      body_->setMass(n, body_->m_nodes[n].m_x.z() < btScalar(0.4) ? 0 : btScalar(0.01));
    }
    classic.addSoftBody(body_.get());
  }
  ~PlainBar() override { static_cast<btSoftRigidDynamicsWorld&>(world()).removeSoftBody(body_.get()); }
  btDiscreteDynamicsWorld& world() override { return *world_.world; }
  btSoftBody& body() override { return *body_; }

 private:
  RigidWorld world_{smallCageAbove(20.0)};
  std::unique_ptr<btSoftBody> body_;
};

template <class Bar>
std::unique_ptr<HeldBar> make() {
  return std::make_unique<Bar>();
}
using Maker = std::unique_ptr<HeldBar> (*)();

class SleepingSkin : public testing::TestWithParam<Maker> {
 protected:
  SleepingSkin() : scene(GetParam()()) {
    const TetMesh cage = bar();
    const TriangleMesh mesh = sphere(8, 0.3, boundingBox(cage.nodes).center());
    EXPECT_TRUE(skin.bind(scene->body(), cage, mesh).ok());
    EXPECT_TRUE(second.bind(scene->body(), skin.binding()).ok());
    atRest = surfaceOf(skin);
  }

  btSoftBody& body() { return scene->body(); }
  void sleep() { body().forceActivationState(ISLAND_SLEEPING); }
  void wake() {
    body().forceActivationState(ACTIVE_TAG);
    body().setDeactivationTime(0);
  }
  /// The surface where the body is now.
  Surface now() {
    second.markMoved();
    EXPECT_EQ(second.update(), StatusCode::Ok);
    return surfaceOf(second);
  }
  /// Checks that an update shows the body, and that another one skips it.
  void expectShownAndSkipped() {
    ASSERT_FALSE(body().isActive());
    EXPECT_EQ(skin.update(), StatusCode::Ok);
    EXPECT_EQ(surfaceOf(skin), now());
    EXPECT_EQ(skin.update(), StatusCode::Asleep);
  }
  /// The bar sinks by its weight for some frames, and sleeps where it is then.
  void fallAsleep() {
    scene->step(12);
    sleep();
  }

  std::unique_ptr<HeldBar> scene;
  SoftBodySkin skin, second;
  Surface atRest;
};

TEST_P(SleepingSkin, FollowsABodyThatIsMovedAsAWholeInItsSleep) {
  fallAsleep();
  expectShownAndSkipped();
  const std::function<void()> motions[] = {
      [&] { body().translate(btVector3(1, 0, 0)); },
      [&] { body().rotate(btQuaternion(btVector3(1, 0, 0), btScalar(0.1))); },
      [&] { body().transform(btTransform(btQuaternion(btVector3(0, 1, 0), btScalar(0.1)), btVector3(0, 1, 0))); },
      [&] { body().scale(btVector3(btScalar(1.1), 1, 1)); },
      [&] {
        for (int n = 0; n < body().m_nodes.size(); ++n) body().m_nodes[n].m_x += btVector3(0, 0, 1);
      }};
  for (const auto& move : motions) {
    move();
    expectShownAndSkipped();
  }
}

TEST_P(SleepingSkin, FollowsASingleNodeThatIsMovedInItsBodysSleepAfterAStepOrAWordAtTheLatest) {
  for (int n = 0; n < body().m_nodes.size(); n += 5) {
    fallAsleep();
    (void)skin.update();
    ASSERT_EQ(skin.update(), StatusCode::Asleep);
    body().m_nodes[n].m_x += btVector3(0, btScalar(0.01), 0);
    if (scene->counts()) n % 2 == 0 ? scene->step(1) : skin.markMoved();
    EXPECT_EQ(skin.update(), StatusCode::Ok) << n;
    EXPECT_EQ(surfaceOf(skin), now()) << n;
    wake();
  }
}

TEST_P(SleepingSkin, IsWhereItsBodyIsAfterFramesBetweenSteps) {
  for (int frame = 0; frame < 6; ++frame) {
    scene->step(2);
    skin.recordStep();
    EXPECT_EQ(skin.update(btScalar(0.5)), StatusCode::Ok);
  }
  sleep();
  scene->step(1);
  skin.recordStep();  // the body has fallen asleep in this step
  (void)skin.update(btScalar(0.5));
  scene->step(1);
  skin.recordStep();
  (void)skin.update(btScalar(0.5));
  EXPECT_EQ(surfaceOf(skin), now());
  EXPECT_EQ(skin.update(btScalar(0.5)), StatusCode::Asleep);
  // Woken and asleep again between two recorded steps.
  wake();
  fallAsleep();
  skin.recordStep();
  EXPECT_EQ(skin.update(btScalar(0.5)), StatusCode::Ok);
  EXPECT_EQ(surfaceOf(skin), now());
}

/// Any order of what steps, the application and the skin may do, from the same numbers in every run.
TEST_P(SleepingSkin, IsWhereItsBodyIsAfterAnyOrderOfEvents) {
  std::mt19937 random(7);
  const auto upTo = [&](unsigned count) { return static_cast<int>(random() % count); };
  std::vector<std::vector<unsigned char>> snapshots;
  std::string events;
  int skipped = 0;
  for (int k = 0; k < 2500; ++k) {
    const char event = "ssszzzwhvttrmSRk"[upTo(16)];
    if (events.size() > 60) events.erase(0, 1);
    events += event;
    if (event == 's') scene->step(1);
    if (event == 'z') sleep();
    if (event == 'w') wake();
    if (event == 'h') skin.setVisible(false);
    if (event == 'v') skin.setVisible(true);
    if (event == 't') body().translate(btVector3(0, upTo(2) == 0 ? btScalar(0.01) : btScalar(-0.01), 0));
    if (event == 'r') body().rotate(btQuaternion(btVector3(0, 1, 0), btScalar(0.01)));
    if (event == 'k') skin.recordStep();
    if (event == 'm') {
      body().m_nodes[upTo(static_cast<unsigned>(body().m_nodes.size()))].m_x += btVector3(0, btScalar(1e-4), 0);
      if (scene->counts()) upTo(2) == 0 ? scene->step(1) : skin.markMoved();
    }
    if (event == 'S' && scene->saved()) {
      snapshots.emplace_back(saveSnapshot(*scene->saved(), nullptr, 0).value());
      ASSERT_TRUE(saveSnapshot(*scene->saved(), snapshots.back().data(), snapshots.back().size()).ok());
    }
    if (event == 'R' && !snapshots.empty()) {
      const auto& bytes = snapshots[static_cast<std::size_t>(upTo(static_cast<unsigned>(snapshots.size())))];
      const Status restored = restoreSnapshot(*scene->saved(), bytes.data(), bytes.size());
      // Refused if Bullet searches contacts, and has rebuilt its trees since.
      ASSERT_TRUE(restored.ok() || !scene->counts()) << restored.message << " after " << events;
    }
    if (event == 'k') (void)skin.update(btScalar(0.5));
    if (upTo(2) == 0) continue;
    const StatusCode status = skin.update();
    if (status == StatusCode::Hidden) continue;
    ASSERT_TRUE(status == StatusCode::Ok || status == StatusCode::Asleep) << toString(status) << " after " << events;
    ASSERT_EQ(surfaceOf(skin), now()) << toString(status) << " after " << events;
    if (!body().isActive()) {
      ASSERT_EQ(skin.update(), StatusCode::Asleep) << "after " << events;
    }
    skipped += status == StatusCode::Asleep;
  }
  EXPECT_GT(skipped, 50);
}

INSTANTIATE_TEST_SUITE_P(Worlds, SleepingSkin,
                         testing::Values(&make<CountingBar>, &make<BulletSolvedBar>, &make<DeformableBar>,
                                         &make<ClassicBar>, &make<PlainBar>));

/// The data that a skin reads from a body whose world counts the moves of its nodes.
class SkinOfACountedBody : public testing::Test {
 protected:
  SkinOfACountedBody() {
    scene.step(1);
    scene.body().forceActivationState(ISLAND_SLEEPING);
    const TetMesh cage = bar();
    EXPECT_TRUE(skin.bind(scene.body(), cage, sphere(8, 0.3, boundingBox(cage.nodes).center())).ok());
  }
  /// The nodes that can move unnoticed, found by trying.
  std::vector<int> nodesNotLookedAt() {
    std::vector<int> unseen;
    for (int n = 0; n < scene.body().m_nodes.size(); ++n) {
      btVector3& x = scene.body().m_nodes[n].m_x;
      const btVector3 here = x;
      x += btVector3(0, 1, 0);
      if (skin.update() == StatusCode::Asleep) unseen.push_back(n);
      x = here;
      (void)skin.update();
    }
    return unseen;
  }
  /// Moves all nodes without a word.
  template <class Motion>
  void moveAll(Motion&& motion) {
    for (int n = 0; n < scene.body().m_nodes.size(); ++n) {
      btVector3& x = scene.body().m_nodes[n].m_x;
      x = motion(x);
    }
  }

  CountingBar scene;
  SoftBodySkin skin;
};

TEST_F(SkinOfACountedBody, IsSkippedUntilSingleNodesAreMarked) {
  const std::vector<int> unseen = nodesNotLookedAt();
  ASSERT_EQ(static_cast<int>(unseen.size()), scene.body().m_nodes.size() - 4);
  const Surface before = surfaceOf(skin);
  for (const int n : unseen) scene.body().m_nodes[n].m_x += btVector3(0, 1, 0);
  EXPECT_EQ(skin.update(), StatusCode::Asleep);
  EXPECT_EQ(surfaceOf(skin), before);
  skin.markMoved();
  EXPECT_EQ(skin.update(), StatusCode::Ok);
  EXPECT_NE(surfaceOf(skin), before);
  EXPECT_EQ(skin.update(), StatusCode::Asleep);
}

TEST_F(SkinOfACountedBody, FollowsAPinnedNodeThatIsLedBetweenSteps) {
  for (int n = 0; n < scene.body().m_nodes.size(); ++n) {
    if (!scene.deformable().isPinned(n)) continue;
    ASSERT_TRUE(scene.deformable().setPinnedPosition(n, scene.body().m_nodes[n].m_x + btVector3(0, 1, 0)).ok());
    scene.body().forceActivationState(ISLAND_SLEEPING);
    EXPECT_EQ(skin.update(), StatusCode::Ok) << n;
    EXPECT_EQ(skin.update(), StatusCode::Asleep);
  }
}

TEST_F(SkinOfACountedBody, IsSeenToMoveInEveryAffineWay) {
  const std::vector<int> unseen = nodesNotLookedAt();
  std::vector<btVector3> lookedAt;
  for (int n = 0; n < scene.body().m_nodes.size(); ++n) {
    if (std::find(unseen.begin(), unseen.end(), n) == unseen.end()) lookedAt.push_back(scene.body().m_nodes[n].m_x);
  }
  ASSERT_EQ(lookedAt.size(), 4u);
  // The tet turns about each of its edges, whose ends stay where they are, and is then stretched along each axis.
  for (std::size_t a = 0; a < 4; ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      const btMatrix3x3 turn(btQuaternion((lookedAt[a] - lookedAt[b]).normalized(), btScalar(0.3)));
      moveAll([&](const btVector3& x) { return lookedAt[a] + turn * (x - lookedAt[a]); });
      EXPECT_EQ(skin.update(), StatusCode::Ok) << a << ", " << b;
      EXPECT_EQ(skin.update(), StatusCode::Asleep);
      moveAll([&](const btVector3& x) { return lookedAt[a] + turn.transpose() * (x - lookedAt[a]); });
      (void)skin.update();
    }
  }
  for (int axis = 0; axis < 3; ++axis) {
    btVector3 stretch(1, 1, 1);
    stretch[axis] = btScalar(1.5);
    moveAll([&](const btVector3& x) { return x * stretch; });
    EXPECT_EQ(skin.update(), StatusCode::Ok) << axis;
    EXPECT_EQ(skin.update(), StatusCode::Asleep);
  }
}

TEST_F(SkinOfACountedBody, IsWhereItsBodyIsThoughThatHasBeenInAnotherWorldMeanwhile) {
  EXPECT_EQ(skin.update(), StatusCode::Asleep);
  const Surface before = surfaceOf(skin);
  btSoftBody& body = scene.body();
  EmptyWorld bullets;
  // Bullet moves a body in the tree of the world that m_worldInfo names.
  btSoftBodyWorldInfo* const info = body.m_worldInfo;
  scene.saved()->removeSoftBody(&body);
  body.m_worldInfo = &bullets.deformable().getWorldInfo();
  bullets.deformable().addSoftBody(&body);
  btDeformableGravityForce gravity(btVector3(0, -10, 0));
  bullets.deformable().addForce(&body, &gravity);
  body.forceActivationState(ACTIVE_TAG);
  step(bullets, 5);
  bullets.deformable().removeSoftBody(&body);
  body.m_worldInfo = info;
  scene.saved()->addSoftBody(&body);
  body.forceActivationState(ISLAND_SLEEPING);
  EXPECT_EQ(skin.update(), StatusCode::Ok);
  EXPECT_NE(surfaceOf(skin), before);
  EXPECT_EQ(skin.update(), StatusCode::Asleep);
  scene.step(1);
  (void)skin.update();  // counted again
  EXPECT_EQ(skin.update(), StatusCode::Asleep);
}

}  // namespace
}  // namespace tetskin::test
