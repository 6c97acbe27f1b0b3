// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The simultaneous actions that plugin/docs/many_bodies.md allows, tested under the thread sanitizer and for the same
// bits as with one thread. Bullet itself is not instrumented: only the library is checked.
#include "contact/contact_test.h"

#include <tetskin/contact/soft_contacts.h>
#include <tetskin/threads/thread_pool.h>
#include <tetskin/touch/surface_point.h>

#include <atomic>
#include <thread>

namespace tetskin::test {
namespace {

/// Data that bodies of one model share: all threads read it, none writes it.
struct SharedModel {
  TetMesh cage = looseCage();
  TriangleMesh mesh = ballMesh(16, 0.35);
  std::shared_ptr<const SoftBodyBinding> binding = SoftBodyBinding::create(cage, mesh, withNormals()).value();
  std::shared_ptr<const ContactShape> shape = ContactShape::create(cage, mesh, coarse()).value();

  static BindingOptions withNormals() {
    BindingOptions options;
    options.normals = Normals::Recomputed;
    return options;
  }
  static ContactShapeOptions coarse() {
    ContactShapeOptions options;
    options.sampleCount = 500;
    options.gridResolution = 16;
    return options;
  }
};

const SharedModel& model() {
  static const SharedModel made;
  return made;
}

/// Two bodies of the model that fall onto each other and the floor.
class Pair {
 public:
  Pair() {
    contacts_ = SoftContacts::add(world.deformable()).value();
    for (int k = 0; k < 2; ++k) {
      TetMesh cage = shifted(model().cage, Eigen::Vector3d(0.1 * k, 0.37 + 0.72 * k, 0));
      bodies.push_back(added(world, cage));
      touching_.push_back(
          SurfaceContact::add(world.deformable(), bodies[k]->body(), *model().binding, model().mesh).value());
      EXPECT_TRUE(contacts_->add(bodies[k]->body(), model().shape).ok());
      skins.push_back(std::make_unique<SoftBodySkin>());
      EXPECT_TRUE(skins[k]->bind(bodies[k]->body(), model().binding).ok());
    }
  }

  void run(int frames) {
    for (int f = 0; f < frames; ++f) {
      step(world, 1);
      for (const auto& skin : skins) EXPECT_EQ(skin->update(), StatusCode::Ok);
      contactsSeen += contacts_->contacts().size() + touching_[0]->contacts().size();
    }
  }
  std::vector<btScalar> drawn() const {
    std::vector<btScalar> all;
    for (const auto& skin : skins) {
      for (std::size_t v = 0; v < skin->positions().size(); ++v) {
        for (int k = 0; k < 3; ++k) all.push_back(skin->positions()[v][k] + skin->normals()[v][k]);
      }
    }
    return all;
  }

  TetskinWorld world;
  std::vector<std::unique_ptr<DeformableBody>> bodies;
  std::vector<std::unique_ptr<SoftBodySkin>> skins;
  std::size_t contactsSeen = 0;

 private:
  std::unique_ptr<SoftContacts> contacts_;
  std::vector<std::unique_ptr<SurfaceContact>> touching_;
};

/// Runs each task in a separate thread.
void inThreads(int count, const std::function<void(int)>& task) {
  std::vector<std::thread> threads;
  for (int k = 0; k < count; ++k) threads.emplace_back(task, k);
  for (std::thread& thread : threads) thread.join();
}

TEST(WorldsInThreads, EachInOneHaveTheBitsOfOneAlone) {
  Pair alone;
  alone.run(12);
  EXPECT_GT(alone.contactsSeen, 0u);
  std::vector<std::vector<btScalar>> drawn(3);
  inThreads(3, [&](int k) {
    Pair own;  // created, stepped and destroyed in this thread
    own.run(12);
    drawn[static_cast<std::size_t>(k)] = own.drawn();
  });
  for (const auto& values : drawn) EXPECT_EQ(values, alone.drawn());
}

TEST(WorldsInThreads, SolveWithAPoolForTheBitsOfOneThread) {
  ThreadPool pool(3);
  Pair alone, shared;
  shared.world.bodySolver().setThreads(&pool);
  alone.run(12);
  shared.run(12);
  EXPECT_EQ(alone.drawn(), shared.drawn());
  shared.world.bodySolver().setThreads(nullptr);
}

/// A renderer has the surface as of the last update, until the next update.
TEST(WorldsInThreads, StepsGoOnWhileAnotherThreadDraws) {
  Pair pair;
  pair.run(1);
  const std::vector<btScalar> before = pair.drawn();
  std::atomic<bool> done{false};
  std::thread renderer([&] {
    do EXPECT_EQ(pair.drawn(), before);
    while (!done);
  });
  step(pair.world, 5);  // without an update of the skin
  done = true;
  renderer.join();
  for (const auto& skin : pair.skins) EXPECT_EQ(skin->update(), StatusCode::Ok);
  EXPECT_NE(pair.drawn(), before);
}

TEST(WorldsInThreads, SkinsOfOneWorldAreUpdatedEachByAThread) {
  Pair alone, spread;
  alone.run(5);
  for (int f = 0; f < 5; ++f) {
    step(spread.world, 1);
    inThreads(2, [&](int k) { EXPECT_EQ(spread.skins[static_cast<std::size_t>(k)]->update(), StatusCode::Ok); });
  }
  EXPECT_EQ(spread.drawn(), alone.drawn());
}

TEST(WorldsInThreads, RaysAreCastByEachThreadWithATreeOfItsOwn) {
  Pair pair;
  pair.run(3);
  std::vector<btScalar> distances(3);
  inThreads(3, [&](int k) {
    const SurfaceTree tree = SurfaceTree::create(model().binding, model().mesh).value();
    const SurfaceHit hit = tree.raycast(*pair.skins[0], btVector3(0, 5, 0), btVector3(0, -5, 0));
    EXPECT_TRUE(hit);
    EXPECT_TRUE(tree.pointAt(pair.bodies[0]->body(), hit).ok());
    distances[static_cast<std::size_t>(k)] = hit.distance;
  });
  EXPECT_EQ(distances[1], distances[0]);
  EXPECT_EQ(distances[2], distances[0]);
}

TEST(WorldsInThreads, ModelsAreMadeWhileAWorldSteps) {
  Pair alone, stepped;
  alone.run(5);
  std::unique_ptr<SharedModel> made;
  std::thread loader([&] { made = std::make_unique<SharedModel>(); });
  stepped.run(5);
  loader.join();
  EXPECT_EQ(stepped.drawn(), alone.drawn());
  EXPECT_EQ(made->shape->sampleCount(), model().shape->sampleCount());
}

}  // namespace
}  // namespace tetskin::test
