// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <gtest/gtest.h>
#include <tetskin/bullet/deformable_body.h>
#include <tetskin/bullet/recorder.h>
#include <tetskin/bullet/src/build/recorded_world.h>
#include <tetskin/contact/soft_contacts.h>
#include <tetskin/contact/surface_contact.h>
#include <tetskin/touch/surface_joint.h>

#include <btBulletDynamicsCommon.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <initializer_list>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "replay/replay_models.h"
#include "replay/replay_scenes.h"

namespace tetskin::test {
namespace {

constexpr btScalar kRunFrame = btScalar(1) / 60;

/// A file that is removed with this object.
struct RunFile {
  explicit RunFile(const std::string& name)
      : path(testing::TempDir() + name + std::to_string(std::random_device()()) + ".run") {}
  ~RunFile() { std::filesystem::remove(path); }
  std::string path;
};

using World = btDeformableMultiBodyDynamicsWorld;

/// Records so many frames of a world, and returns the hash of each. act(frame) comes before each.
std::vector<std::uint64_t> recordWorld(World& world, const std::string& path, int frames,
                                       const std::function<void(int)>& act = {}) {
  RecorderOptions options;
  options.snapshotEvery = 25;
  const auto recorder = Recorder::start(world, path, options).value();
  std::vector<std::uint64_t> hashes;
  for (int frame = 0; frame < frames; ++frame) {
    if (act) act(frame);
    recorder->step(kRunFrame, 4, kRunFrame / 4);
    hashes.push_back(stateHash(world));
  }
  EXPECT_TRUE(recorder->status().ok()) << recorder->status().message;
  return hashes;
}

Result<std::unique_ptr<Replay>> openBuilt(const std::string& path) {
  return Replay::open(path, {builderOfSoftContacts(), builderOfJoints()});
}

/// The world that is built from the file moves as the recorded one did, to the last bit.
void expectBuiltRunIs(const std::string& path, const std::vector<std::uint64_t>& hashes) {
  const auto replay = openBuilt(path);
  ASSERT_TRUE(replay.ok()) << replay.status().message;
  for (std::size_t k = 0; k < hashes.size(); ++k) {
    ASSERT_TRUE(replay.value()->step()) << k << " " << replay.value()->status().message
                                        << replay.value()->report().object;
    ASSERT_EQ(stateHash(replay.value()->world()), hashes[k]) << k;
  }
  EXPECT_FALSE(replay.value()->step());
  EXPECT_TRUE(replay.value()->status().ok()) << replay.value()->status().message;
  EXPECT_FALSE(replay.value()->report().differs) << replay.value()->report().object;
}

class BuiltScenes : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Of, BuiltScenes, testing::Values("drop", "drag", "twist", "pit"));

TEST_P(BuiltScenes, ArePlayedByTheirFileAlone) {
  const RunFile file(GetParam());
  std::vector<std::uint64_t> hashes;
  {
    const auto scene = ReplayScene::create(GetParam());
    hashes = recordWorld(scene->world(), file.path, 60, [&](int frame) { scene->act(frame); });
  }
  expectBuiltRunIs(file.path, hashes);
}

TEST(RecordedWorld, OfAHeapIsPlayedByItsFileAlone) {
  const RunFile file("heap");
  std::vector<std::uint64_t> hashes;
  {
    const auto scene = ReplayScene::create("heap");
    hashes = recordWorld(scene->world(), file.path, 20, [&](int frame) { scene->act(frame); });
  }
  expectBuiltRunIs(file.path, hashes);
  // 26 bodies of three models.
  EXPECT_LT(std::filesystem::file_size(file.path), 12u * 1000u * 1000u);
}

/// Shapes of all kinds that a file can hold, falling onto a plane, with joints of all kinds between some of them.
class ShapeZoo {
 public:
  ShapeZoo() {
    add(new btStaticPlaneShape(btVector3(btScalar(0.1), 1, btScalar(0.05)), -1), 0);
    const btScalar half = btScalar(0.4);
    auto* box = new btBoxShape(btVector3(half, btScalar(0.3), btScalar(0.2)));
    box->setMargin(btScalar(0.03));
    add(box, 1);
    add(new btSphereShape(btScalar(0.3)), 1);
    add(new btCapsuleShape(btScalar(0.2), half), 1);
    add(new btCapsuleShapeX(btScalar(0.2), half), 1);
    add(new btCapsuleShapeZ(btScalar(0.2), half), 1);
    add(new btCylinderShape(btVector3(half, btScalar(0.2), half)), 1);
    add(new btCylinderShapeX(btVector3(btScalar(0.2), half, half)), 1);
    add(new btCylinderShapeZ(btVector3(half, half, btScalar(0.2))), 1);
    add(new btConeShape(btScalar(0.3), half), 1);
    add(new btConeShapeX(btScalar(0.3), half), 1);
    add(new btConeShapeZ(btScalar(0.3), half), 1);
    auto* hull = new btConvexHullShape;
    for (int k = 0; k < 12; ++k)
      hull->addPoint(btVector3(btScalar(k % 3) / 3, btScalar(k % 4) / 4, btScalar(k % 5) / 5));
    hull->setLocalScaling(btVector3(1, btScalar(1.3), 1));
    add(hull, 1);
    auto* compound = new btCompoundShape;
    compound->addChildShape(at(0, 0, 0), shapes[1].get());
    compound->addChildShape(at(1, 0, 0), shapes[2].get());
    compound->setLocalScaling(btVector3(btScalar(0.7), btScalar(0.7), btScalar(0.7)));
    add(compound, 1);
    addMesh();
    add(shapes[2].get(), 1, false);  // shared with another body
    addJoints();
  }
  ~ShapeZoo() {
    for (const auto& joint : joints) world.removeConstraint(joint.get());
    for (const auto& body : bodies) world.removeRigidBody(body.get());
  }

  DeformableWorld world;
  std::vector<std::unique_ptr<btCollisionShape>> shapes;
  std::vector<std::unique_ptr<btRigidBody>> bodies;
  std::vector<std::unique_ptr<btTypedConstraint>> joints;

 private:
  static btTransform at(btScalar x, btScalar y, btScalar z) {
    return btTransform(btQuaternion(btVector3(0, 0, 1), btScalar(0.1)), btVector3(x, y, z));
  }
  void add(btCollisionShape* shape, btScalar mass, bool owned = true) {
    if (owned) shapes.emplace_back(shape);
    btVector3 inertia(0, 0, 0);
    if (mass > 0) shape->calculateLocalInertia(mass, inertia);
    const auto k = static_cast<btScalar>(bodies.size());
    bodies.push_back(std::make_unique<btRigidBody>(mass, nullptr, shape, inertia));
    if (mass > 0) bodies.back()->setWorldTransform(at(btScalar(0.45) * k, 2 + btScalar(int(k) % 3), 0));
    bodies.back()->setUserIndex(static_cast<int>(100 + bodies.size()));
    world.addRigidBody(bodies.back().get(), 1, bodies.size() == 3 ? 1 : -1);
  }
  void addMesh() {
    for (int i = 0; i < 9; ++i) {
      for (int j = 0; j < 9; ++j)
        vertices.insert(vertices.end(), {btScalar(i), btScalar((i * j) % 3) / 9, btScalar(j - 4)});
    }
    for (int i = 0; i < 8; ++i) {
      for (int j = 0; j < 8; ++j) {
        const auto corner = static_cast<unsigned short>(9 * i + j);
        const auto next = static_cast<unsigned short>(corner + 9);
        for (const int n : {corner + 0, corner + 1, next + 0, corner + 1, next + 1, next + 0}) {
          indices.push_back(static_cast<unsigned short>(n));
        }
      }
    }
    btIndexedMesh part;
    part.m_numTriangles = 128;
    part.m_triangleIndexBase = reinterpret_cast<const unsigned char*>(indices.data());
    part.m_triangleIndexStride = 3 * sizeof(unsigned short);
    part.m_numVertices = 81;
    part.m_vertexBase = reinterpret_cast<const unsigned char*>(vertices.data());
    part.m_vertexStride = 3 * sizeof(btScalar);
    part.m_vertexType = sizeof(btScalar) == 8 ? PHY_DOUBLE : PHY_FLOAT;
    mesh.addIndexedMesh(part, PHY_SHORT);
    add(new btBvhTriangleMeshShape(&mesh, true), 0);
    bodies.back()->setWorldTransform(at(-1, 0, 0));
  }
  void addJoints() {
    const btTransform frame = at(btScalar(0.2), 0, 0);
    const btVector3 pivot(btScalar(0.3), 0, 0), x(1, 0, 0), y(0, 1, 0);
    btRigidBody &a = *bodies[1], &b = *bodies[2], &c = *bodies[3], &d = *bodies[4];
    add(new btPoint2PointConstraint(a, b, pivot, -pivot), true);
    add(new btHingeConstraint(c, frame), false);
    auto* hinge = new btHingeConstraint(c, d, frame, frame);
    hinge->enableAngularMotor(true, 2, btScalar(0.3));
    add(hinge, true);
    add(new btSliderConstraint(*bodies[5], *bodies[6], frame, frame, true), true);
    add(new btConeTwistConstraint(*bodies[6], *bodies[7], frame, frame), false);
    auto* spring = new btGeneric6DofSpringConstraint(*bodies[7], *bodies[8], frame, frame, true);
    spring->enableSpring(0, true);
    spring->setStiffness(0, 30);
    add(spring, true);
    add(new btGeneric6DofConstraint(*bodies[8], *bodies[9], frame, frame, false), true);
    add(new btGeneric6DofSpring2Constraint(*bodies[9], *bodies[10], frame, frame), true);
    add(new btFixedConstraint(*bodies[10], *bodies[11], frame, frame), true);
    add(new btGearConstraint(*bodies[11], *bodies[12], x, y, btScalar(0.5)), false);
    btVector3 anchor(3, 2, 0), first = x, second = y;
    add(new btUniversalConstraint(*bodies[12], *bodies[13], anchor, first, second), true);
  }
  void add(btTypedConstraint* joint, bool disable) {
    joints.emplace_back(joint);
    world.addConstraint(joint, disable);
  }

  std::vector<btScalar> vertices;
  std::vector<unsigned short> indices;
  btTriangleIndexVertexArray mesh;
};

TEST(RecordedWorld, HasShapesAndJointsOfAllKinds) {
  const RunFile file("zoo");
  std::vector<std::uint64_t> hashes;
  {
    ShapeZoo zoo;
    hashes = recordWorld(zoo.world, file.path, 90);
  }
  expectBuiltRunIs(file.path, hashes);
}

/// A ball in a world with a floor, touching at its surface.
struct BallScene {
  explicit BallScene(const Cage& cage, const SoftBodyOptions& options = {}) {
    world.addRigidBody(&floor);
    body = DeformableBody::add(world, cage, options).value();
  }
  ~BallScene() { world.removeRigidBody(&floor); }
  btStaticPlaneShape plane{btVector3(0, 1, 0), btScalar(-0.6)};
  btRigidBody floor{0, nullptr, &plane};
  DeformableWorld world;
  std::unique_ptr<DeformableBody> body;
};

TEST(RecordedWorld, HasBodiesOfAllForceModelsAndKindsOfTets) {
  const ReplayModel ball = ballModel(3, 4);
  const TetMesh coarse = ballModel(1, 2).cage;
  Cage uneven = ball.cage;
  for (std::size_t t = 0; t < uneven.mesh.tetCount(); ++t) uneven.stiffnessFactor.push_back(1.0 + double(t % 5));
  SoftBodyOptions pinned;
  pinned.pinned = [](const Eigen::Vector3d& p) { return p.x() > 0.4; };
  SoftBodyOptions bullets;
  bullets.forceModel = ForceModel::NeoHookean;
  bullets.youngsModulus = 3e3;
  SoftBodyOptions linear = bullets;
  linear.forceModel = ForceModel::LinearElasticity;
  linear.faceTree = false;
  SoftBodyOptions heavy;
  heavy.density = 400;
  heavy.stiffnessDamping = 0.01;
  heavy.solverTolerance = 1e-4;
  const struct {
    const char* name;
    Cage cage;
    SoftBodyOptions options;
    bool scaled;
  } kinds[] = {{"corotated", ball.cage, heavy, false},
               {"uneven", uneven, {}, false},
               {"pinned", uneven, pinned, false},
               {"quadratic", refineQuadratic(coarse).value(), {}, false},
               {"neo-Hookean", uneven, bullets, false},
               {"linear", ball.cage, linear, false},
               {"scaled", uneven, {}, true}};
  for (const auto& kind : kinds) {
    SCOPED_TRACE(kind.name);
    const RunFile file("kind");
    std::vector<std::uint64_t> hashes;
    {
      BallScene scene(kind.cage, kind.options);
      if (kind.scaled) scene.body->body().scale(btVector3(btScalar(1.2), btScalar(0.8), 1));
      hashes = recordWorld(scene.world, file.path, 30);
    }
    expectBuiltRunIs(file.path, hashes);
  }
}

TEST(RecordedWorld, FollowsWhatComesAndGoesInTheMiddleOfARun) {
  const RunFile file("churn");
  const ReplayModel ball = ballModel(3, 4);
  std::vector<std::uint64_t> hashes;
  {
    BallScene scene(ball.cage);
    auto contact = SurfaceContact::add(scene.world, scene.body->body(), *ball.binding, ball.mesh).value();
    auto soft = SoftContacts::add(scene.world).value();
    std::unique_ptr<DeformableBody> second;
    std::unique_ptr<SurfaceSpring> spring;
    std::unique_ptr<SurfaceWeld> weld;
    ReplayModel model = ball;
    btBoxShape box(btVector3(btScalar(0.2), btScalar(0.2), btScalar(0.2)));
    btRigidBody hat(btScalar(0.1), nullptr, &box, btVector3(btScalar(0.01), btScalar(0.01), btScalar(0.01)));
    hat.setWorldTransform(btTransform(btQuaternion::getIdentity(), btVector3(0, 1, 0)));
    SurfaceTree tree = SurfaceTree::create(ball.binding, ball.mesh).value();
    SurfacePoint top = tree.pointAtRest(scene.body->body(), Eigen::Vector3d(0, 1, 0)).value();
    hashes = recordWorld(scene.world, file.path, 70, [&](int frame) {
      if (frame == 10) {
        second = DeformableBody::add(scene.world, movedBy(ball.cage, {0.1, 1.2, 0})).value();
        ASSERT_TRUE(soft->add(scene.body->body(), model.shape(), true).ok());
        ASSERT_TRUE(soft->add(second->body(), model.shape()).ok());
      }
      if (frame == 20) spring = SurfaceSpring::add(scene.world, top).value();
      if (frame > 20 && frame < 35) (void)spring->setTarget(btVector3(btScalar(frame) / 50, 1, 0));
      if (frame == 35) spring.reset();
      if (frame == 36) {
        scene.world.addRigidBody(&hat);
        weld = SurfaceWeld::add(scene.world, top, hat).value();
      }
      if (frame == 45) (void)top.applyForce(btVector3(30, 0, 0), 9);
      if (frame == 55) second.reset();
      if (frame == 60) weld.reset(), scene.world.removeRigidBody(&hat);
    });
  }
  expectBuiltRunIs(file.path, hashes);
}

TEST(RecordedWorld, SaysWhatItCannotBuild) {
  const RunFile file("refused");
  const ReplayModel ball = ballModel(2, 2);
  {
    BallScene scene(ball.cage);
    auto soft = SoftContacts::add(scene.world).value();
    recordWorld(scene.world, file.path, 2);
  }
  const Status missing = Replay::open(file.path, {}).status();
  EXPECT_EQ(missing.code, StatusCode::InvalidOption);
  EXPECT_NE(missing.message.find("soft contacts"), std::string::npos) << missing.message;
  {
    BallScene scene(ball.cage);
    const auto other = createSoftBody(movedBy(ball.cage, {3, 0, 0}), scene.world.getWorldInfo()).value();
    scene.world.addSoftBody(other.get());
    recordWorld(scene.world, file.path, 2);
    EXPECT_TRUE(Replay::open(scene.world, file.path).ok());
    scene.world.removeSoftBody(other.get());
  }
  const Status refused = openBuilt(file.path).status();
  EXPECT_EQ(refused.code, StatusCode::NotSaved);
  EXPECT_NE(refused.message.find("a soft body that no DeformableBody has created"), std::string::npos)
      << refused.message;
  {
    BallScene scene(ball.cage);
    RecorderOptions options;
    options.buildUp = false;
    Recorder::start(scene.world, file.path, options).value()->step(kRunFrame, 4, kRunFrame / 4);
  }
  EXPECT_EQ(openBuilt(file.path).status().code, StatusCode::NotSaved);
}

/// A world that was described, with bytes that can be damaged without a hash that tells of it.
struct Description {
  explicit Description(World& world) : bytes(bullet_detail::describeWorld(world, store).value()) {
    store.read = std::move(store.unsaved);
  }
  bullet_detail::CopyStore store;
  std::vector<unsigned char> bytes;
};

bool isBuiltAndStepped(Description damaged) {
  const auto built =
      bullet_detail::RecordedWorld::build(damaged.bytes, damaged.store, {builderOfSoftContacts(), builderOfJoints()});
  if (!built.ok()) return false;
  built.value()->world().stepSimulation(kRunFrame, 1, kRunFrame);
  return true;
}

TEST(RecordedWorld, ThatIsDamagedIsRefusedOrHarmless) {
  const ReplayModel ball = ballModel(2, 2);
  ReplayModel model = ball;
  BallScene scene(ball.cage);
  const auto contact = SurfaceContact::add(scene.world, scene.body->body(), *ball.binding, ball.mesh).value();
  const auto soft = SoftContacts::add(scene.world).value();
  ASSERT_TRUE(soft->add(scene.body->body(), model.shape(), true).ok());
  SurfaceTree tree = SurfaceTree::create(ball.binding, ball.mesh).value();
  const SurfacePoint top = tree.pointAtRest(scene.body->body(), Eigen::Vector3d(0, 1, 0)).value();
  const auto spring = SurfaceSpring::add(scene.world, top).value();
  const Description whole(scene.world);
  ASSERT_TRUE(isBuiltAndStepped(whole));
  std::mt19937 random(11);
  int refused = 0;
  const auto flip = [&](std::vector<unsigned char>& bytes) {
    bytes[random() % bytes.size()] ^= static_cast<unsigned char>(1 << random() % 8);
  };
  for (int k = 0; k < 400; ++k) {
    Description damaged = whole;
    flip(k % 2 ? damaged.bytes : damaged.store.read[random() % damaged.store.read.size()]);
    refused += !isBuiltAndStepped(std::move(damaged));
  }
  EXPECT_GT(refused, 20);
  for (std::size_t size = 0; size < whole.bytes.size(); size += 1 + size / 50) {
    Description cut = whole;
    cut.bytes.resize(size);
    EXPECT_FALSE(isBuiltAndStepped(std::move(cut))) << size;
  }
}

/// A number that a shape is made with, where it is read, becomes none.
TEST(RecordedWorld, OfAShapeThatIsNotFiniteIsRefused) {
  const btScalar marked = btScalar(0.12345);
  btStaticPlaneShape plane(btVector3(0, 1, 0), marked);
  btConvexHullShape hull;
  for (const btVector3& point : {btVector3(0, 0, 0), btVector3(1, 0, marked), btVector3(0, 1, 0), btVector3(0, 0, 1)}) {
    hull.addPoint(point);
  }
  btSphereShape ball(1), markedBall(marked);
  btCompoundShape compound;
  compound.addChildShape(btTransform(btMatrix3x3::getIdentity(), btVector3(marked, 0, 0)), &ball);
  btEmptyShape nothing;
  nothing.setMargin(marked);
  for (btCollisionShape* shape :
       std::initializer_list<btCollisionShape*>{&plane, &hull, &markedBall, &compound, &nothing}) {
    DeformableWorld world;
    btRigidBody body(0, nullptr, shape);
    world.addRigidBody(&body);
    const Description whole(world);
    ASSERT_TRUE(isBuiltAndStepped(whole)) << shape->getName();
    int places = 0;
    for (std::size_t k = 0; k + sizeof marked <= whole.bytes.size(); ++k) {
      if (std::memcmp(&whole.bytes[k], &marked, sizeof marked) != 0) continue;
      ++places;
      Description damaged = whole;
      const btScalar nan = std::numeric_limits<btScalar>::quiet_NaN();
      std::memcpy(&damaged.bytes[k], &nan, sizeof nan);
      const Status refused = bullet_detail::RecordedWorld::build(damaged.bytes, damaged.store, {}).status();
      EXPECT_NE(refused.message.find("not finite"), std::string::npos) << shape->getName() << ' ' << refused.message;
    }
    EXPECT_GT(places, 0) << shape->getName();
    world.removeRigidBody(&body);
  }
}

}  // namespace
}  // namespace tetskin::test
