// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "contact_test.h"

#include <tetskin/contact/src/rigid/surface_patches.h>
#include <tetskin/core/src/base/mesh/tet_geometry.h>
#include <tetskin/solver/src/search/mesh_probe.h>
#include <tetskin/solver/src/search/point_collider.h>

namespace tetskin::test {

using namespace bullet_detail;
using namespace contact_detail;

namespace {

constexpr btScalar kSampleMargin = btScalar(0.002), kSampleSlack = btScalar(0.005);
/// Depth that samples may miss over something flat: far below the margin.
constexpr btScalar kLeftOut = btScalar(0.0003);

/// Counts the questions.
class AskedProbe : public ShapeProbe {
 public:
  explicit AskedProbe(ShapeProbe& probe) : probe_(probe) {}
  bool isKnownByItsBox() const override { return probe_.isKnownByItsBox(); }
  bool isHalfSpace(const Ball& ball) const override { return probe_.isHalfSpace(ball); }
  bool enter(const Ball& ball, btScalar reach) override { return ++balls, probe_.enter(ball, reach); }
  bool narrow(const CarrierPaths& carriers, const Ball& ball, btScalar reach) override {
    return ++balls, probe_.narrow(carriers, ball, reach);
  }
  ShapeBound bound() const override { return probe_.bound(); }
  ShapeDistance at(const btVector3& point) const override { return ++points, probe_.at(point); }

  int balls = 0;
  mutable int points = 0;

 private:
  ShapeProbe& probe_;
};

/// The box of twelve triangles in nodes that may move.
class TriangleSamples : public ::testing::Test {
 protected:
  TriangleSamples() {
    for (const Eigen::Vector3d& p : cage_.nodes) nodes_.push_back({toBullet(p), toBullet(p)});
  }

  PointCollider searchWith(double spacing) const { return searchWith(mesh_, spacing); }
  PointCollider searchWith(const TriangleMesh& mesh, double spacing) const {
    return {makeContactPatches(embed(cage_, mesh).value(), mesh, divisionsFor(mesh, spacing)), kSampleSlack};
  }
  /// Each node moves by another random way.
  void deform(std::mt19937& random, btScalar size, btScalar speed) {
    const auto part = [&] { return btScalar(random()) / btScalar(0x80000000u) - 1; };
    for (std::size_t n = 0; n < nodes_.size(); ++n) {
      const btVector3 offset(part(), part(), part()), velocity(part(), part(), part());
      nodes_[n].now = toBullet(cage_.nodes[n]) + size * offset;
      nodes_[n].predicted = nodes_[n].now + speed * velocity;
    }
  }
  NodePath pathOf(const ContactPatches& patches, const ContactPatch& patch, std::uint32_t point) const {
    std::array<btScalar, kMaxCarriers> weights{};
    patches.weightsOf(patch, point, weights.data());
    NodePath path{btVector3(0, 0, 0), btVector3(0, 0, 0)};
    for (std::uint32_t n = 0; n < patch.nodeCount; ++n) {
      const NodePath& node = nodes_[static_cast<std::size_t>(patches.nodes[patch.firstNode + n])];
      path.now += weights[n] * node.now;
      path.predicted += weights[n] * node.predicted;
    }
    return path;
  }
  /// The least distance of any vertex or sample, now and at the end of the step, minus the margin.
  template <class DistanceOf>
  btScalar deepestOfAll(const ContactPatches& patches, const DistanceOf& distanceOf) const {
    btScalar deepest = BT_LARGE_FLOAT;
    for (const ContactPatch& patch : patches.patches) {
      for (std::uint32_t p = 0; p < patch.numberCount(); ++p) {
        if (patch.isTriangle() && p / (patch.divisions + 1) + p % (patch.divisions + 1) > patch.divisions) continue;
        const NodePath path = pathOf(patches, patch, p);
        deepest = std::min({deepest, distanceOf(path.now) - kSampleMargin, distanceOf(path.predicted) - kSampleMargin});
      }
    }
    return deepest;
  }

  TetMesh cage_ = looseCage();
  TriangleMesh mesh_ = boxMesh(Eigen::Vector3d(0.35, 0.3, 0.35));
  std::vector<NodePath> nodes_;
};

btScalar deepest(const PointContacts& touches) {
  btScalar least = BT_LARGE_FLOAT;
  for (const PointContact& touch : touches) least = std::min({least, touch.distance, touch.predicted});
  return least;
}

TEST_F(TriangleSamples, TouchAsDeepAsALookAtEachOfThemFinds) {
  const btSphereShape ball(btScalar(0.15));
  const btBoxShape box(btVector3(btScalar(0.2), btScalar(0.1), btScalar(0.15)));
  const btCapsuleShapeZ pole(btScalar(0.03), 2);
  PointCollider search = searchWith(0.02);
  std::mt19937 random(3);
  int touching = 0;
  for (int k = 0; k < 150; ++k) {
    const btScalar speed = btScalar(0.002) * static_cast<btScalar>(k / 3 % 2);
    deform(random, btScalar(0.03), speed);
    const btCollisionShape* shapes[] = {&ball, &box, &pole};
    const btCollisionShape& shape = *shapes[k % 3];
    const ExactShape exact = *ExactShape::exactShape(shape);
    ExactProbe probe;
    probe.take(exact);
    const auto part = [&] { return btScalar(random()) / btScalar(0x80000000u) - 1; };
    const btTransform at =
        placeAt(btVector3(part() / 2, part() / 2, part() / 2), btQuaternion(part(), part(), part(), 1).normalized());
    search.begin(nodes_, kSampleMargin, 0);
    ShapeMemory memory;
    btVector3 low, high;
    shape.getAabb(at, low, high);
    WorldBox around;
    around.extend(low.m_floats, high.m_floats);
    const PointContacts touches = search.find(probe, {at, at}, memory, &around);
    const btScalar all =
        deepestOfAll(search.patches(), [&](const btVector3& p) { return exact.distance(at.inverse() * p).distance; });
    for (const PointContact& touch : touches) {
      const auto& patches = search.patches().patches;
      const ContactPatch& patch = *std::find_if(patches.begin(), patches.end(), [&](const ContactPatch& of) {
        return touch.point - of.firstPoint < of.numberCount();
      });
      const NodePath path = pathOf(search.patches(), patch, touch.point - patch.firstPoint);
      EXPECT_LT((touch.position - path.now).length(), 1e-5);
    }
    if (all >= 0) continue;
    ++touching;
    if (all < -kLeftOut) {
      ASSERT_FALSE(touches.empty()) << k;
    }
    // Among moving points, the one that will be deepest is taken.
    if (!touches.empty()) {
      EXPECT_LT(deepest(touches), all + kLeftOut + speed) << k;
    }
  }
  EXPECT_GT(touching, 50);
}

TEST_F(TriangleSamples, TouchTrianglesAsDeepAsALookAtEachOfThemFinds) {
  btTriangleMesh hills;
  const auto corner = [](int i, int j) {
    const double x = 0.05 * i, z = 0.05 * j;
    return btVector3(btScalar(x), btScalar(i < 0 ? 0.02 * std::sin(9 * x) * std::cos(7 * z) : 0.0), btScalar(z));
  };
  for (int i = -16; i < 16; ++i) {
    for (int j = -16; j < 16; ++j) {
      hills.addTriangle(corner(i, j), corner(i, j + 1), corner(i + 1, j));
      hills.addTriangle(corner(i + 1, j), corner(i, j + 1), corner(i + 1, j + 1));
    }
  }
  btBvhTriangleMeshShape shape(&hills, true);
  MeshProbe probe, whole;
  probe.take(shape, btScalar(0.03));
  whole.take(shape, btScalar(0.03));
  PointCollider search = searchWith(0.03);
  std::mt19937 random(4);
  int touching = 0;
  for (int k = 0; k < 8; ++k) {
    deform(random, btScalar(0.01), btScalar(0.001));
    const btTransform at = placeAt(btVector3(0, btScalar(-0.3 - 0.005 * (k % 3)), 0));
    search.begin(nodes_, kSampleMargin, 0);
    ShapeMemory memory;
    const btScalar found = deepest(search.find(probe, {at, at}, memory));
    const btScalar all = deepestOfAll(search.patches(), [&](const btVector3& p) {
      const btVector3 local = at.inverse() * p;
      if (!whole.enter({local, btScalar(1e-4)}, btScalar(0.01))) return BT_LARGE_FLOAT;
      return whole.at(local).distance;
    });
    if (all >= 0) continue;
    ++touching;
    EXPECT_LT(found, all + kLeftOut) << k;
  }
  EXPECT_GT(touching, 4);
}

/// How often the search asks for the distance of a point, and for objects near a ball.
struct Questions {
  int points = 0, balls = 0;
  std::size_t touches = 0;
};

TEST_F(TriangleSamples, OverAFloorAreNotLookedAt) {
  const btBoxShape ground(btVector3(2, 1, 2));
  btTriangleMesh squares;
  for (int i = -8; i < 8; ++i) {
    for (int j = -8; j < 8; ++j) {
      const btVector3 a(btScalar(0.1 * i), 0, btScalar(0.1 * j)), u(btScalar(0.1), 0, 0), v(0, 0, btScalar(0.1));
      squares.addTriangle(a, a + v, a + u);
      squares.addTriangle(a + u, a + v, a + u + v);
    }
  }
  btBvhTriangleMeshShape flat(&squares, true);
  ExactProbe box;
  box.take(*ExactShape::exactShape(ground));
  MeshProbe mesh;
  mesh.take(flat, btScalar(0.03));
  const auto ask = [&](ShapeProbe& probe, double spacing, const btVector3& at) {
    PointCollider search = searchWith(spacing);
    AskedProbe counting(probe);
    ShapeMemory memory;
    search.begin(nodes_, kSampleMargin, 0);
    Questions asked;
    asked.touches = search.find(counting, {placeAt(at), placeAt(at)}, memory).size();
    asked.points = counting.points;
    asked.balls = counting.balls;
    return asked;
  };
  const btScalar touching = btScalar(-0.3 + 0.001);
  for (const bool asMesh : {false, true}) {
    ShapeProbe& probe = asMesh ? static_cast<ShapeProbe&>(mesh) : box;
    const btVector3 at(0, asMesh ? touching : touching - 1, 0);
    const Questions without = ask(probe, SurfaceContactOptions::kNoSamples, at), with = ask(probe, 0.005, at);
    EXPECT_EQ(without.touches, 4U);
    EXPECT_EQ(with.touches, 4U);
    EXPECT_LT(with.points, without.points + 80);
    EXPECT_LT(with.balls, without.balls + 80);
  }
}

TEST_F(TriangleSamples, OverAPlaneTakeNoMoreThanNone) {
  const btStaticPlaneShape plane(btVector3(0, 1, 0), 1);
  const btBoxShape box(btVector3(3, 1, 3));
  const auto ask = [&](const btCollisionShape& ground, double spacing) {
    ExactProbe probe;
    probe.take(*ExactShape::exactShape(ground));
    AskedProbe counting(probe);
    PointCollider search = searchWith(spacing);
    ShapeMemory memory;
    const btTransform at = placeAt(btVector3(0, btScalar(-1.3 + 0.001), 0));
    search.begin(nodes_, kSampleMargin, 0);
    EXPECT_EQ(search.find(counting, {at, at}, memory).size(), 4U);
    return counting.points + counting.balls;
  };
  for (const btCollisionShape* ground :
       {static_cast<const btCollisionShape*>(&plane), static_cast<const btCollisionShape*>(&box)}) {
    EXPECT_LE(ask(*ground, 0.005), ask(*ground, SurfaceContactOptions::kNoSamples) + 2) << "other clusters";
  }
}

/// A small box on a large face: samples touch.
TEST_F(TriangleSamples, OfWhatLiesAreLookedAtWhereTheyTouchAlone) {
  const btBoxShape box(btVector3(btScalar(0.1), btScalar(0.1), btScalar(0.12)));
  ExactProbe probe;
  probe.take(*ExactShape::exactShape(box));
  PointCollider search = searchWith(0.02);
  ShapeMemory memory;
  int asked = 0;
  const auto touchesAt = [&](btScalar x, btScalar height) {
    AskedProbe counting(probe);
    const btTransform at = placeAt(btVector3(x, btScalar(0.4) + height, btScalar(0.02)));
    search.begin(nodes_, kSampleMargin, 0);
    std::set<std::uint32_t> points;
    for (const PointContact& touch : search.find(counting, {at, at}, memory)) points.insert(touch.point);
    asked = counting.points + counting.balls;
    return points;
  };
  const btScalar gap = kSampleMargin / 2, little = btScalar(0.001) * kSampleSlack;
  const std::set<std::uint32_t> first = touchesAt(0, gap);
  const int searched = asked;
  EXPECT_GE(first.size(), 4U);
  EXPECT_EQ(touchesAt(little, gap), first);
  EXPECT_LT(asked, 4 * static_cast<int>(first.size()) + 20) << "it has hardly moved";
  EXPECT_LT(3 * asked, searched);
  EXPECT_FALSE(touchesAt(btScalar(0.05), gap).empty());
  EXPECT_GT(2 * asked, searched) << "it has moved";
  // Put away and back where it was: what touched there is not known from the step before.
  (void)touchesAt(0, gap);
  EXPECT_TRUE(touchesAt(0, 1).empty());
  EXPECT_EQ(touchesAt(0, gap).size(), first.size());
}

/// A box on a face of coarse triangles: its corners and edges lie within triangles.
TEST_F(TriangleSamples, HoldAFaceByHardlyMorePointsThanNodes) {
  TriangleMesh mesh;
  constexpr int kCells = 6;
  for (int i = 0; i <= kCells; ++i) {
    for (int j = 0; j <= kCells; ++j) mesh.positions.emplace_back(0.1 * i - 0.29, 0.3, 0.1 * j - 0.32);
  }
  for (int i = 0; i < kCells; ++i) {
    for (int j = 0; j < kCells; ++j) {
      const int a = i * (kCells + 1) + j, b = a + kCells + 1;
      mesh.triangles.push_back({a, a + 1, b});
      mesh.triangles.push_back({b, a + 1, b + 1});
    }
  }
  const btVector3 half(btScalar(0.14), btScalar(0.1), btScalar(0.17));
  const btBoxShape box(half);
  ExactProbe probe;
  probe.take(*ExactShape::exactShape(box));
  const auto touchesOf = [&](double spacing, btScalar speed) {
    PointCollider search = searchWith(mesh, spacing);
    ShapeMemory memory;
    const btTransform at = placeAt(btVector3(0, btScalar(0.4) + kSampleMargin - btScalar(0.01) * kSampleSlack, 0));
    const btTransform later = placeAt(at.getOrigin() - btVector3(0, speed, 0));
    search.begin(nodes_, kSampleMargin, 0);
    PointContacts touches = search.find(probe, {at, later}, memory);
    std::set<int> nodes;
    for (const PointContact& touch : touches)
      nodes.insert(touch.at.nodes.begin(), touch.at.nodes.begin() + touch.at.count);
    return std::make_pair(touches, nodes.size());
  };
  const std::size_t vertices = touchesOf(SurfaceContactOptions::kNoSamples, 0).first.size();
  for (const double spacing : {0.025, 0.0125, 0.00625}) {
    const auto [touches, nodes] = touchesOf(spacing, 0);
    EXPECT_LE(touches.size(), vertices + nodes + 8) << spacing;
    for (const int x : {-1, 1}) {  // a point near each corner: without it, the box would tip over inwards of there
      for (const int z : {-1, 1}) {
        const btVector3 corner = half * btVector3(btScalar(x), 0, btScalar(z)) + btVector3(0, btScalar(0.3), 0);
        btScalar nearest = 1;
        for (const PointContact& touch : touches) nearest = std::min(nearest, (touch.position - corner).length());
        EXPECT_LT(nearest, std::max(2 * spacing, 0.02)) << x << " " << z << " " << spacing;
      }
    }
    EXPECT_GT(touchesOf(spacing, kSampleSlack).first.size(), 2 * touches.size()) << "what falls needs them all";
  }
}

/// Followed in many small steps, it touches where a search from the beginning would find it.
TEST_F(TriangleSamples, OfWhatCreepsTouchAsDeepAsALookAtEachOfThemFinds) {
  const btBoxShape box(btVector3(btScalar(0.1), btScalar(0.1), btScalar(0.12)));
  const ExactShape exact = *ExactShape::exactShape(box);
  ExactProbe probe;
  probe.take(exact);
  PointCollider search = searchWith(0.02);
  ShapeMemory memory;
  for (int step = 0; step < 300; ++step) {
    const btScalar far = btScalar(3e-4) * kSampleSlack * static_cast<btScalar>(step);
    btTransform at = placeAt(btVector3(far, btScalar(0.4) + kSampleMargin / 2 - far / 8, 0));
    at.setRotation(btQuaternion(btVector3(1, 0, 0), far));
    search.begin(nodes_, kSampleMargin, 0);
    const btScalar found = deepest(search.find(probe, {at, at}, memory));
    const btTransform inverse = at.inverse();
    const btScalar all =
        deepestOfAll(search.patches(), [&](const btVector3& p) { return exact.distance(inverse * p).distance; });
    ASSERT_NEAR(found, all, btScalar(0.004) * kSampleSlack) << step;
  }
}

TEST_F(TriangleSamples, FarFromASmallShapeAreNotLookedAt) {
  // A square of more and more triangles of one size.
  const auto ask = [&](int cells) {
    TriangleMesh mesh;
    for (int i = 0; i <= cells; ++i) {
      for (int j = 0; j <= cells; ++j) {
        mesh.positions.emplace_back(0.025 * (i - cells / 2), 0.3, 0.025 * (j - cells / 2));
      }
    }
    for (int i = 0; i < cells; ++i) {
      for (int j = 0; j < cells; ++j) {
        const int a = i * (cells + 1) + j, b = a + cells + 1;
        mesh.triangles.push_back({a, a + 1, b});
        mesh.triangles.push_back({b, a + 1, b + 1});
      }
    }
    PointCollider search = searchWith(mesh, 0.01);
    const btSphereShape ball(btScalar(0.02));
    ExactProbe probe;
    probe.take(*ExactShape::exactShape(ball));
    AskedProbe counting(probe);
    const btTransform at = placeAt(btVector3(btScalar(0.013), btScalar(0.321), btScalar(0.017)));
    btVector3 low, high;
    ball.getAabb(at, low, high);
    WorldBox around;
    around.extend(low.m_floats, high.m_floats);
    ShapeMemory memory;
    search.begin(nodes_, kSampleMargin, 0);
    EXPECT_FALSE(search.find(counting, {at, at}, memory, &around).empty());
    return counting.points + counting.balls;
  };
  const int few = ask(8);
  EXPECT_LT(few, 500);
  EXPECT_LT(ask(36), 2 * few);
}

TEST_F(TriangleSamples, OfLargeTrianglesAreLookedAtNearAShapeAlone) {
  const btSphereShape ball(btScalar(0.02));
  ExactProbe probe;
  probe.take(*ExactShape::exactShape(ball));
  const btTransform at = placeAt(btVector3(btScalar(0.013), btScalar(0.321), btScalar(0.017)));
  PointCollider search = searchWith(0.005);
  AskedProbe counting(probe);
  ShapeMemory memory;
  search.begin(nodes_, kSampleMargin, 0);
  EXPECT_FALSE(search.find(counting, {at, at}, memory).empty());
  EXPECT_GT(search.patches().pointCount, 50000U);
  EXPECT_LT(counting.points + counting.balls, 500);
}

TEST_F(TriangleSamples, ByDefaultFollowTheTetsInAllSizes) {
  for (const double size : {0.01, 1.0, 100.0}) {
    TetMesh cage = cage_;
    TriangleMesh coarse = mesh_, fine = ballMesh(24, 0.35);
    for (auto* points : {&cage.nodes, &coarse.positions, &fine.positions}) {
      for (Eigen::Vector3d& p : *points) p *= size;
    }
    std::vector<btScalar> rest;
    for (const Eigen::Vector3d& p : cage.nodes) {
      for (const double x : {p.x(), p.y(), p.z(), 0.0}) rest.push_back(static_cast<btScalar>(x));
    }
    const Divisions large = defaultDivisions(embed(cage, coarse).value(), coarse, rest);
    for (std::size_t t = 0; t < large.size(); ++t) {
      const TriangleCorners corners = cornersOf(coarse, coarse.triangles[t]);
      const double longest = std::max(
          {(corners[0] - corners[1]).norm(), (corners[1] - corners[2]).norm(), (corners[2] - corners[0]).norm()});
      EXPECT_LE(longest / large[t], 0.125 * meanEdge(cage) * 1.0001);
      EXPECT_GT(longest / large[t], 0.06 * meanEdge(cage));
    }
    EXPECT_EQ(countOfSamples(defaultDivisions(embed(cage, fine).value(), fine, rest)), 0.0);
  }
}

/// A box of twelve triangles, held at its nodes below, and a ball that falls on it, between the mesh's vertices.
/// Returns the ball's height above where it just touches the box.
btScalar heightOfBallOnBox(double diameterInEdges, const SurfaceContactOptions& options) {
  TetskinWorld world;
  SoftBodyOptions material;
  material.youngsModulus = 3e5;
  material.pinned = [](const Eigen::Vector3d& p) { return p.y() < 1.9; };
  TouchingBody body(world, boxMesh(Eigen::Vector3d(0.35, 0.3, 0.35)), btVector3(0, 2, 0), options, material);
  const auto radius = static_cast<btScalar>(0.5 * diameterInEdges * meanEdge(looseCage()));
  Obstacle ball(world, std::make_unique<btSphereShape>(radius),
                placeAt(btVector3(btScalar(0.11), btScalar(2.31) + radius, btScalar(0.05))), btScalar(0.01));
  step(world, 40);
  return ball.body().getWorldTransform().getOrigin().y() - radius - btScalar(2.3);
}

TEST(SurfaceContact, StopsWhatIsHalfATetLarge) {
  EXPECT_NEAR(heightOfBallOnBox(0.5, {}), 0.0, 0.01);
  EXPECT_NEAR(heightOfBallOnBox(2.0, {}), 0.0, 0.01);
}

TEST(SurfaceContact, WithoutSamplesLetsThingsPassBetweenVertices) {
  SurfaceContactOptions none;
  none.sampleSpacing = SurfaceContactOptions::kNoSamples;
  EXPECT_LT(heightOfBallOnBox(2.0, none), -0.3);
}

TEST(SurfaceContact, OfACoarseBoxOnAFloorIsThatOfItsCorners) {
  TetskinWorld world;
  TouchingBody body(world, boxMesh(Eigen::Vector3d(0.35, 0.1, 0.35)), btVector3(0, btScalar(0.11), 0));
  EXPECT_GT(body.contact->sampleCount(), 500U);
  step(world, 120);
  ASSERT_EQ(body.contact->contacts().size(), 4U);
  btScalar sum = 0;
  for (const SurfaceContactPoint& at : body.contact->contacts()) sum += at.impulse.y();
  EXPECT_NEAR(sum, 10.0 / 240, 1e-3 * 10.0 / 240);
  EXPECT_NEAR(body.height(), 0.0, 0.002);
}

}  // namespace
}  // namespace tetskin::test
