// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/contact/src/soft/body_pairs.h>
#include <tetskin/contact/src/soft/pair_search.h>

#include <set>

#include "soft_fixtures.h"

namespace tetskin::test {
namespace {

using namespace contact_detail;

class SoftSearch : public StillBalls {};

/// In cubes of the grid: the relative motion up to which touches are followed instead of searched for.
constexpr btScalar kFollowedMotion = btScalar(0.05);
/// How much their distances may differ, in cubes: they approach by that motion, as does a surface that curves.
constexpr btScalar kFollowedError = 2 * kFollowedMotion;
/// In cubes: how much the distance of a followed touch may differ from the one found for the same sample.
constexpr btScalar kPlaneError = btScalar(0.3) * kFollowedMotion;
/// In cubes: the depth from which on a sample touches whatever the normals are.
constexpr btScalar kPiercingDepth = btScalar(0.2);

/// A search from step to step, compared with one that has no candidates and thus follows no touches.
class FollowingSearch {
 public:
  struct Found {
    std::size_t wanted = 0;          ///< number of touches that the search from nothing has found, in all steps
    int searched = 0, followed = 0;  ///< numbers of steps
  };

  void find(ContactBody& first, ContactBody& second, btScalar dt) {
    PairMemory fromNothing = memory_;
    fromNothing.candidates = {};
    fromNothing.motion = {};
    wanted_.clear();
    search_.find(first, second, dt, btVector3(0, 0, 0), 0, fromNothing, wanted_);
    search_.find(first, second, dt, btVector3(0, 0, 0), 0, memory_, touches_);
    found_.wanted += wanted_.size();
    // Since a search in this step, nothing can have moved.
    const bool searched = memory_.motion.sinceSearch() == 0;
    ++(searched ? found_.searched : found_.followed);
    searched ? expectSame() : expectNearlySame(first, second.data().grid.spacing());
  }
  const Found& found() const { return found_; }
  int age() const { return memory_.candidates.age(); }

 private:
  void expectSame() const {
    ASSERT_EQ(touches_.size(), wanted_.size());
    for (std::size_t k = 0; k < touches_.size(); ++k) {
      EXPECT_EQ(touches_[k].sample, wanted_[k].sample);
      EXPECT_EQ(touches_[k].distance, wanted_[k].distance);
    }
  }
  /// New touches are found later, when they are at most this deep.
  void expectNearlySame(const ContactBody& first, btScalar cube) const {
    const btScalar tolerance = kFollowedError * cube;
    const std::vector<int>& nodes = first.data().sampleNodes;
    for (const Touch& known : wanted_) {
      if (known.distance > -tolerance - (known.pierces ? kPiercingDepth * cube : btScalar(0))) continue;
      const int node = nodes[static_cast<std::size_t>(known.sample)];
      EXPECT_TRUE(std::any_of(touches_.begin(), touches_.end(), [&](const Touch& touch) {
        return nodes[static_cast<std::size_t>(touch.sample)] == node &&
               btFabs(touch.distance - known.distance) < tolerance;
      })) << node;
    }
    for (const Touch& touch : touches_) {
      for (const Touch& known : wanted_) {
        if (known.sample != touch.sample || known.tet != touch.tet) continue;
        // The plane that stands for the surface differs from it by less than the motion.
        EXPECT_NEAR(touch.distance, known.distance, kPlaneError * cube);
        EXPECT_GT(touch.normal.dot(known.normal), 0.98);
        EXPECT_LT((touch.point - known.point).length(), 1e-5);
      }
    }
  }

  PairMemory memory_;
  PairSearch search_;
  std::vector<Touch> touches_, wanted_;
  Found found_;
};

/// Samples of the first body in tets of the second, found by testing all pairs, and only those that are inside by more
/// than `margin`.
std::set<int> insideByBruteForce(const ContactBody& first, const ContactBody& second, double margin) {
  std::set<int> inside;
  const ShapeData &shapeData = first.data(), &in = second.data();
  for (const SampleRun& run : shapeData.runs) {
    for (int s = run.first; s < run.last; ++s) {
      const btVector3 p = shapeData.samples[s].position([&](int node) { return first.positions[node]; });
      for (const Tet& tet : in.tets) {
        TetCorners corners;
        for (int k = 0; k < 4; ++k) corners[k] = toEigen(second.positions[tet[k]]);
        const Eigen::Vector4d w = BarycentricMap(corners)(toEigen(p));
        if (w.minCoeff() < 0.0) continue;
        btVector3 rest(0, 0, 0);
        for (int k = 0; k < 4; ++k) rest += static_cast<btScalar>(w[k]) * in.nodes[tet[k]];
        GridDistance at;
        if (in.grid.at(rest, at) && at.distance < -margin) inside.insert(s);
      }
    }
  }
  return inside;
}

TEST_F(SoftSearch, FindsTheSamplesThatTestingAllPairsFinds) {
  for (const double squeeze : {1.0, 0.6}) {
    auto first = include(Eigen::Vector3d(0, 0, 0)), second = include(Eigen::Vector3d(0.5, 0.55, 0.1), squeeze);
    PairMemory memory;
    PairSearch search;
    std::vector<Touch> touches;
    search.find(*first, *second, btScalar(0.004), btVector3(0, 0, 0), 0, memory, touches);
    const std::set<int> wanted = insideByBruteForce(*first, *second, 1e-4);
    ASSERT_GT(wanted.size(), 10u);
    std::size_t found = 0;
    memory.sides.beginStep();  // the current touches count as those of the previous step
    for (const int s : wanted) found += memory.sides.find(s, btVector3(0, 0, 0), 10) ? 1 : 0;
    EXPECT_EQ(found, wanted.size()) << squeeze;
  }
}

TEST_F(SoftSearch, TellsDepthAndNormalOfTwoBalls) {
  auto first = include(Eigen::Vector3d(0, 0, 0)), second = include(Eigen::Vector3d(0.8, 0, 0));
  PairMemory memory;
  PairSearch search;
  std::vector<Touch> touches;
  search.find(*first, *second, btScalar(0.004), btVector3(0, 0, 0), 0, memory, touches);
  ASSERT_FALSE(touches.empty());
  const auto deep = std::min_element(touches.begin(), touches.end(),
                                     [](const Touch& a, const Touch& b) { return a.distance < b.distance; });
  EXPECT_NEAR(deep->distance, 0.8 - 2 * Ball::kRadius, 0.005);
  EXPECT_LT(deep->normal.x(), -0.97) << "out of the second";
}

/// A ball that sinks into another, turns and is squeezed slightly in each step, so that most candidates are skipped.
TEST_F(SoftSearch, FindsInEachStepWhatASearchFromNothingFinds) {
  auto first = include(Eigen::Vector3d(0, 0, 0)), second = include(Eigen::Vector3d(0.8, 0.2, 0.1));
  FollowingSearch search;
  for (int step = 0; step < 120; ++step) {
    SCOPED_TRACE(step);
    const btQuaternion turn(btVector3(1, 2, 0).normalized(), btScalar(step % 40) * btScalar(2e-4));
    for (int n = 0; n < bodies_[1]->m_nodes.size(); ++n) {
      btVector3& x = bodies_[1]->m_nodes[n].m_x;
      x = quatRotate(turn, x) + btVector3(step < 60 ? btScalar(-0.004) : btScalar(0.002), 0, 0) * btScalar(step % 3);
      x.setY(x.y() * btScalar(0.9995));
    }
    for (ContactBody* body : {first.get(), second.get()}) body->read();
    search.find(*first, *second, step % 7 == 0 ? btScalar(0.04) : btScalar(0.004));
  }
  EXPECT_GT(search.found().wanted, 500u);
  EXPECT_GT(search.found().searched, 60);
}

/// A ball that moves so slowly that it is searched for in few steps.
TEST_F(SoftSearch, FollowsTouchesWhileBodiesHaveHardlyMoved) {
  auto first = include(Eigen::Vector3d(0, 0, 0)), second = include(Eigen::Vector3d(0.75, 0.2, 0.1));
  const btScalar motion = kFollowedMotion * second->data().grid.spacing() / 10;
  FollowingSearch search;
  for (int step = 0; step < 120; ++step) {
    SCOPED_TRACE(step);
    bodies_[1]->translate(btVector3(step < 60 ? -motion : motion, motion * btScalar(step % 2), 0));
    for (ContactBody* body : {first.get(), second.get()}) body->read();
    search.find(*first, *second, btScalar(0.004));
  }
  EXPECT_GT(search.found().wanted, 500u);
  EXPECT_GT(search.found().followed, 60);
  EXPECT_GE(search.found().searched, 120 / 10) << "after as much motion";
}

/// A ball with thorns that are finer than the cubes of its grid and lean over its surface, so that the grid's gradient
/// at their tips may point inwards.
struct ThornyBall {
  TetMesh cage = latticeCage(5, 5, 5, 0.2);
  TriangleMesh mesh = sphere(48, 0.38, Eigen::Vector3d::Constant(0.5));
  std::vector<int> tips;
  std::shared_ptr<const ContactShape> shape;

  ThornyBall() {
    for (int v = 150; v + 150 < static_cast<int>(mesh.vertexCount()); v += 101) {
      tips.push_back(v);
      const Eigen::Vector3d out = outwards(v);
      mesh.positions[v] += 0.02 * out + 0.12 * out.unitOrthogonal();
    }
    ContactShapeOptions options;
    options.gridResolution = 48;
    shape = ContactShape::create(cage, mesh, options).value();
  }
  Eigen::Vector3d outwards(int v) const { return (mesh.positions[v] - Eigen::Vector3d::Constant(0.5)).normalized(); }
};

TEST_F(SoftSearch, ATipFinerThanTheGridTouchesWhatItEnters) {
  const ThornyBall thorny;
  const auto body = createSoftBody(thorny.cage, info_).value();
  ContactBody first(*body, thorny.shape, false, 0);
  first.read();
  const double depth = 0.01;
  for (const int tip : thorny.tips) {
    const btVector3 at = toBullet(thorny.mesh.positions[tip]);
    const Eigen::Vector3d out = thorny.outwards(tip);
    auto second = include(thorny.mesh.positions[tip] + (Ball::kRadius - depth) * out - Eigen::Vector3d::Constant(0.5));
    PairMemory memory;
    PairSearch search;
    std::vector<Touch> touches;
    search.find(first, *second, btScalar(0.004), btVector3(0, 0, 0), 0, memory, touches);
    const auto found = std::find_if(touches.begin(), touches.end(),
                                    [&](const Touch& t) { return (t.point - at).length() < btScalar(1e-5); });
    ASSERT_NE(found, touches.end()) << "vertex " << tip;
    EXPECT_NEAR(found->distance, -depth, 0.25 * second->data().grid.spacing());
    EXPECT_LT(found->normal.dot(toBullet(out)), -0.95);
  }
}

/// The sample by which a node touched stays a contact next to another that has become deeper, unless they are close.
TEST_F(SoftSearch, ANodeKeepsTheSampleItTouchedWithBesideADeeperOne) {
  auto first = include(Eigen::Vector3d(0, 0, 0)), second = include(Eigen::Vector3d(0.78, 0, 0));
  const auto pairsIn = [&](const std::vector<Touch>& touches, const std::vector<Touch>& before) {
    int pairs = 0;
    for (std::size_t a = 0; a < touches.size(); ++a) {
      for (std::size_t b = 0; b < a; ++b) {
        const std::vector<int>& nodes = first->data().sampleNodes;
        if (nodes[touches[a].sample] != nodes[touches[b].sample]) continue;
        if (touches[a].normal.dot(touches[b].normal) < btScalar(0.9)) continue;
        EXPECT_GT((touches[a].point - touches[b].point).length(), 0.1 * first->data().edge);
        EXPECT_TRUE(std::any_of(before.begin(), before.end(), [&](const Touch& touch) {
          return touch.sample == touches[a].sample || touch.sample == touches[b].sample;
        }));
        ++pairs;
      }
    }
    return pairs;
  };
  PairMemory memory;
  PairSearch search;
  std::vector<Touch> before, touches, fromNothing;
  const btVector3 none(0, 0, 0);
  search.find(*first, *second, btScalar(0.004), none, 0, memory, before);
  EXPECT_EQ(pairsIn(before, {}), 0);
  bodies_[1]->translate(btVector3(0, btScalar(0.15), 0));
  for (ContactBody* body : {first.get(), second.get()}) body->read();
  PairMemory empty;
  search.find(*first, *second, btScalar(0.004), none, 0, memory, touches);
  search.find(*first, *second, btScalar(0.004), none, 0, empty, fromNothing);
  EXPECT_GT(pairsIn(touches, before), 0);
  EXPECT_EQ(pairsIn(fromNothing, {}), 0);
}

TEST_F(SoftSearch, ANodeTouchesByAnotherSampleOnlyWhereThatIsDeeperByATenthOfACube) {
  auto first = include(Eigen::Vector3d(0, 0, 0)), second = include(Eigen::Vector3d(0.78, 0, 0));
  PairSearch search;
  const btVector3 none(0, 0, 0), way(0, btScalar(0.01), 0);
  PairMemory memory;
  std::vector<Touch> touches;
  int kept = 0;
  for (int step = 0; step < 20; ++step) {
    std::vector<Touch> fromNothing;
    PairMemory empty;
    search.find(*first, *second, btScalar(0.004), none, 0, memory, touches);
    search.find(*first, *second, btScalar(0.004), none, 0, empty, fromNothing);
    const std::vector<int>& nodes = first->data().sampleNodes;
    for (const Touch& deeper : fromNothing) {
      const auto is = [&](const Touch& t) { return t.sample == deeper.sample; };
      if (std::any_of(touches.begin(), touches.end(), is)) continue;
      ++kept;
      EXPECT_TRUE(std::any_of(touches.begin(), touches.end(), [&](const Touch& t) {
        return nodes[t.sample] == nodes[deeper.sample] &&
               t.distance - deeper.distance < btScalar(0.1) * second->data().grid.spacing();
      }));
    }
    bodies_[1]->translate(way);
    for (ContactBody* body : {first.get(), second.get()}) body->read();
  }
  EXPECT_GT(kept, 0);
}

TEST(BodyPairs, AreThoseThatTestingAllBoxesFinds) {
  std::mt19937 random(3);
  for (const btVector3& spread : {btVector3(9, 1, 1), btVector3(1, 1, 9), btVector3(3, 3, 3), btVector3(0, 0, 0)}) {
    std::vector<ContactBox> boxes(60);
    for (ContactBox& box : boxes) {
      btVector3 low, size;
      for (int k = 0; k < 3; ++k) {
        low[k] = spread[k] * static_cast<btScalar>(random() % 1000) / 1000;
        size[k] = static_cast<btScalar>(random() % 1000) / 1000;
      }
      box.extend(low);
      box.extend(low + size);
    }
    std::vector<std::pair<std::size_t, std::size_t>> all;
    for (std::size_t a = 0; a < boxes.size(); ++a) {
      for (std::size_t b = a; b < boxes.size(); ++b) {
        if (boxes[a].collides(boxes[b])) all.emplace_back(a, b);
      }
    }
    EXPECT_EQ(overlappingBoxPairs(boxes), all);
  }
  EXPECT_TRUE(overlappingBoxPairs({}).empty());
}

}  // namespace
}  // namespace tetskin::test
