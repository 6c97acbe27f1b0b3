// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Which side of terrain and of mirrored meshes is outside: tested by the distances that a probe reports, and by what
// falls on it.
#include "contact_test.h"

#include <BulletCollision/CollisionShapes/btHeightfieldTerrainShape.h>
#include <BulletCollision/CollisionShapes/btScaledBvhTriangleMeshShape.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>
#include <tetskin/contact/soft_contacts.h>
#include <tetskin/solver/src/search/mesh_probe.h>

#include <utility>

namespace tetskin::test {

using namespace bullet_detail;

namespace {

constexpr int kSide = 12;  // samples along a side of the terrain
const char* const kAxes = "XYZ";

/// All the ways in which Bullet divides the squares of terrain into triangles.
enum class Cut { Plain, QuadEdgesFlipped, Diamonds, Zigzag };
constexpr Cut kCuts[] = {Cut::Plain, Cut::QuadEdgesFlipped, Cut::Diamonds, Cut::Zigzag};

std::vector<btScalar> hills() {
  std::vector<btScalar> heights;
  for (int k = 0; k < kSide * kSide; ++k) heights.push_back(btScalar(0.3) * std::sin(btScalar(1.7) * k));
  return heights;
}

std::unique_ptr<btHeightfieldTerrainShape> terrain(const std::vector<btScalar>& heights, int upAxis, Cut cut,
                                                   bool windingFlipped) {
  auto field = std::make_unique<btHeightfieldTerrainShape>(kSide, kSide, static_cast<const void*>(heights.data()), 1,
                                                           -1, 1, upAxis, PHY_FLOAT, cut == Cut::QuadEdgesFlipped);
  field->setUseDiamondSubdivision(cut == Cut::Diamonds);
  field->setUseZigzagSubdivision(cut == Cut::Zigzag);
  field->setFlipTriangleWinding(windingFlipped);
  return field;
}

void forAllTerrain(const std::function<void(int upAxis, Cut cut, bool windingFlipped)>& visit) {
  for (int upAxis = 0; upAxis < 3; ++upAxis) {
    for (const Cut cut : kCuts) {
      for (const bool windingFlipped : {false, true}) {
        SCOPED_TRACE(std::string(1, kAxes[upAxis]) + " up, cut " + std::to_string(static_cast<int>(cut)) +
                     (windingFlipped ? ", winding flipped" : ""));
        visit(upAxis, cut, windingFlipped);
      }
    }
  }
}

/// The height of a point above the triangle that is over or under it.
class HeightOver : public btTriangleCallback {
 public:
  HeightOver(const btVector3& point, int upAxis) : point_(point), up_(upAxis) {}
  void processTriangle(btVector3* corners, int, int) override {
    const int a = (up_ + 1) % 3, b = (up_ + 2) % 3;
    const auto area = [&](const btVector3& p, const btVector3& q, const btVector3& r) {
      return (q[a] - p[a]) * (r[b] - p[b]) - (q[b] - p[b]) * (r[a] - p[a]);
    };
    const btScalar whole = area(corners[0], corners[1], corners[2]);
    btScalar under = 0;
    for (int k = 0; k < 3; ++k) {
      const btScalar weight = area(point_, corners[(k + 1) % 3], corners[(k + 2) % 3]) / whole;
      if (weight < 0) return;
      under += weight * corners[k][up_];
    }
    height = point_[up_] - under;
  }

  btScalar height = 0;

 private:
  btVector3 point_;
  int up_;
};

ShapeDistance asked(MeshProbe& probe, const btVector3& point, btScalar reach) {
  const NodePath path{point, point};
  if (!probe.enter({point, btScalar(0.1)}, reach) || !probe.narrow({&path, 1, 1}, {point, btScalar(0.01)}, reach)) {
    return {};
  }
  return probe.at(point);
}

TEST(OutwardSides, OfTerrainAreThoseOfItsUpAxisHoweverItIsCutAndWound) {
  const std::vector<btScalar> heights = hills();
  forAllTerrain([&](int upAxis, Cut cut, bool windingFlipped) {
    const auto field = terrain(heights, upAxis, cut, windingFlipped);
    field->setLocalScaling(btVector3(btScalar(0.7), btScalar(1.2), btScalar(0.9)));
    MeshProbe probe;
    probe.take(*field, btScalar(0.3));
    int above = 0, below = 0;
    for (btVector3 point : pointsWithin(2, 200)) {
      point[upAxis] *= btScalar(0.3);
      HeightOver over(point, upAxis);
      field->processAllTriangles(&over, btVector3(-9, -9, -9), btVector3(9, 9, 9));
      const ShapeDistance found = asked(probe, point, btScalar(0.25));
      if (found.distance >= btScalar(0.25) || btFabs(over.height) < btScalar(1e-3)) continue;
      ++(over.height > 0 ? above : below);
      ASSERT_EQ(found.distance > 0, over.height > 0);
      ASSERT_GT(found.normal[upAxis], 0);
    }
    EXPECT_GT(above, 30);
    EXPECT_GT(below, 30);
  });
}

/// A ball of triangles that face outwards.
std::unique_ptr<btTriangleMesh> bulletsBall(int rings, double radius) {
  const TriangleMesh ball = ballMesh(rings, radius);
  auto mesh = std::make_unique<btTriangleMesh>();
  for (const auto& t : ball.triangles) {
    mesh->addTriangle(toBullet(ball.positions[t[0]]), toBullet(ball.positions[t[1]]), toBullet(ball.positions[t[2]]));
  }
  return mesh;
}

/// The eight ways to mirror a shape.
std::vector<btVector3> mirrors() {
  std::vector<btVector3> all;
  for (int k = 0; k < 8; ++k) all.emplace_back(k & 1 ? -1 : 1, k & 2 ? -1 : 1, k & 4 ? -1 : 1);
  return all;
}

void expectOutwards(const btConcaveShape& ball, btScalar radius) {
  MeshProbe probe;
  probe.take(ball, btScalar(0.2));
  for (const btVector3& towards : pointsWithin(1, 30)) {
    const btVector3 direction = towards.normalized();
    const ShapeDistance outside = asked(probe, (radius + btScalar(0.1)) * direction, btScalar(0.2));
    const ShapeDistance inside = asked(probe, (radius - btScalar(0.1)) * direction, btScalar(0.2));
    EXPECT_NEAR(outside.distance, 0.1, 0.03);
    EXPECT_NEAR(inside.distance, -0.1, 0.03);
    EXPECT_GT(outside.normal.dot(direction), 0.9);
  }
}

TEST(OutwardSides, OfMeshesAreMirroredWithThem) {
  for (const btVector3& mirror : mirrors()) {
    SCOPED_TRACE(testing::Message() << mirror.x() << ' ' << mirror.y() << ' ' << mirror.z());
    const auto own = bulletsBall(12, 1), lent = bulletsBall(12, 1), packed = bulletsBall(12, 1);
    btBvhTriangleMeshShape scaledItself(own.get(), true);
    scaledItself.setLocalScaling(mirror);
    expectOutwards(scaledItself, 1);
    btBvhTriangleMeshShape child(lent.get(), true);
    btScaledBvhTriangleMeshShape scaled(&child, btScalar(0.8) * mirror);
    expectOutwards(scaled, btScalar(0.8));
    // A mirrored shape contains a child that is itself mirrored.
    child.setLocalScaling(btVector3(1, -1, 1));
    expectOutwards(scaled, btScalar(0.8));
    btGImpactMeshShape pieces(packed.get());
    pieces.setLocalScaling(mirror);
    pieces.updateBound();
    expectOutwards(pieces, 1);
  }
}

/// Something flat, at least 4 above the floor of the world, on which a body falls.
struct Landing {
  std::function<std::unique_ptr<btConcaveShape>()> make;
  int upAxis = 1;
};

/// The height at which the body's lowest point comes to rest above the plane through the shape's origin; by nodes, or
/// by the body's surface.
double restsAbove(const Landing& landing, bool bySurface) {
  TetskinWorld world;
  btVector3 up(0, 0, 0);
  up[landing.upAxis] = 1;
  world.deformable().setGravity(btScalar(-10) * up);
  const btVector3 position(0, 30, 0);
  Obstacle obstacle(world, landing.make(), placeAt(position));
  TouchingBody body(world, ballMesh(16, 0.35), position + btScalar(0.55) * up);
  if (!bySurface) body.contact.reset();
  step(world, 45);
  if (bySurface) return body.gap([&](const Eigen::Vector3d& p) { return (p - toEigen(position)).dot(toEigen(up)); });
  double minimum = HUGE_VAL;
  const btSoftBody& soft = body.body->body();
  for (int n = 0; n < soft.m_nodes.size(); ++n) {
    minimum = std::min<double>(minimum, (soft.m_nodes[n].m_x - position).dot(up));
  }
  return minimum;
}

void expectPinned(const Landing& landing) {
  EXPECT_NEAR(restsAbove(landing, true), 0.002, 0.01);
  const double byNodes = restsAbove(landing, false);
  EXPECT_GT(byNodes, 0);
  EXPECT_LT(byNodes, 0.1);  // the margins of both in Bullet
}

TEST(OutwardSides, TerrainOfAnyUpAxisHoldsWhatFallsOnIt) {
  const std::vector<btScalar> flat(kSide * kSide, btScalar(0));
  for (int upAxis = 0; upAxis < 3; ++upAxis) {
    for (const bool windingFlipped : {false, true}) {
      SCOPED_TRACE(std::string(1, kAxes[upAxis]) + (windingFlipped ? " up, winding flipped" : " up"));
      expectPinned({[&] { return terrain(flat, upAxis, Cut::Diamonds, windingFlipped); }, upAxis});
    }
  }
}

TEST(OutwardSides, MirroredMeshesHoldWhatFallsOnThem) {
  // A slab, because it has an outside above and below; its top is at 0.
  const auto mesh = std::make_unique<btTriangleMesh>();
  const TriangleMesh slab = boxMesh(Eigen::Vector3d(3, 1, 3));
  for (const auto& t : slab.triangles) {
    const auto at = [&](int k) { return toBullet(slab.positions[t[k]]) - btVector3(0, 1, 0); };
    mesh->addTriangle(at(0), at(1), at(2));
  }
  btBvhTriangleMeshShape child(mesh.get(), true);
  for (const btVector3& mirror : {btVector3(-1, 1, 1), btVector3(1, 1, -1), btVector3(-1, 1, -1)}) {
    SCOPED_TRACE(testing::Message() << mirror.x() << ' ' << mirror.z());
    expectPinned({[&] { return std::make_unique<btScaledBvhTriangleMeshShape>(&child, mirror); }});
    const auto own = std::make_unique<btTriangleMesh>(*mesh);
    expectPinned({[&] {
      auto shape = std::make_unique<btBvhTriangleMeshShape>(own.get(), true);
      shape->setLocalScaling(mirror);
      return shape;
    }});
  }
}

/// The heights of the lowest and the highest point of an egg that has landed on the floor.
std::pair<double, double> restOf(const TriangleMesh& mesh, TetMesh cage) {
  TetskinWorld world;
  const auto binding = SoftBodyBinding::create(cage, mesh).value();
  for (Eigen::Vector3d& p : cage.nodes) p.y() += 0.4;
  const auto body = added(world, cage);
  const auto contact = SurfaceContact::add(world.deformable(), body->body(), *binding, mesh).value();
  SoftBodySkin skin;
  EXPECT_TRUE(skin.bind(body->body(), binding).ok());
  step(world, 90);
  EXPECT_EQ(skin.update(), StatusCode::Ok);
  return {static_cast<double>(skin.bounds().min().y()), static_cast<double>(skin.bounds().max().y())};
}

/// A negative scale mirrors points, and does not change the winding of triangles.
TEST(OutwardSides, OfMirroredBodiesAreMetAsTheOriginalsOrRefused) {
  TriangleMesh egg = ballMesh(12, 0.35);
  for (Eigen::Vector3d& p : egg.positions) p = Eigen::Vector3d(p.x() > 0 ? 1.2 * p.x() : p.x(), 0.8 * p.y(), p.z());
  TetMesh cage = looseCage();
  const auto [low, high] = restOf(egg, cage);
  for (auto* points : {&egg.positions, &cage.nodes}) {
    for (Eigen::Vector3d& p : *points) p.x() = -p.x();
  }
  (void)repairTetMesh(cage);
  TriangleMesh turned = egg;
  for (auto& t : turned.triangles) std::swap(t[1], t[2]);
  for (const TriangleMesh* mesh : {&turned, &egg}) {
    const auto [mirroredLow, mirroredHigh] = restOf(*mesh, cage);
    EXPECT_NEAR(mirroredLow, low, 1e-4);
    EXPECT_NEAR(mirroredHigh, high, 1e-4);
  }
  EXPECT_TRUE(ContactShape::create(cage, turned, {500, 24}).ok());
  const Status inwards = ContactShape::create(cage, egg).status();
  EXPECT_EQ(inwards.code, StatusCode::Degenerate);
  EXPECT_NE(inwards.message.find("face inwards"), std::string::npos) << inwards.message;
}

}  // namespace
}  // namespace tetskin::test
