// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/contact/src/soft/pair_candidates.h>

#include <set>

#include "soft_fixtures.h"

namespace tetskin::test {
namespace {

using namespace contact_detail;

constexpr btScalar kCandidateStep = btScalar(0.004);
/// Runs of samples, with tets.
using RunTets = std::set<std::pair<int, int>>;

bool holdsAll(const RunTets& all, const RunTets& some) {
  return std::includes(all.begin(), all.end(), some.begin(), some.end());
}

/// Balls with few samples: all pairs are tested in each step.
class SoftCandidates : public StillBalls {
 protected:
  std::unique_ptr<ContactBody> includeCoarse(const Eigen::Vector3d& offset) {
    static const std::shared_ptr<const ContactShape> shape = ball().makeShape({400, 24});
    return include(offset, 1.0, shape);
  }
  /// Moves each node of a body, and reads the body.
  void move(ContactBody& body, const std::function<btVector3(const btVector3&)>& to) {
    for (int n = 0; n < body.body->m_nodes.size(); ++n) body.body->m_nodes[n].m_x = to(body.body->m_nodes[n].m_x);
    body.read();
  }
};

/// Runs and tets such that a sample of the run is in the filled part of the tet, by testing all pairs.
RunTets metByBruteForce(const ContactBody& first, const ContactBody& second) {
  RunTets met;
  const ShapeData &of = first.data(), &in = second.data();
  for (std::size_t t = 0; t < in.tets.size(); ++t) {
    TetCorners corners;
    for (std::size_t k = 0; k < 4; ++k) corners[k] = toEigen(second.positions[in.tets[t][k]]);
    if (!(in.filled[t].left > 0) || isFlat(corners)) continue;
    const BarycentricMap map(corners);
    const btScalar* least = in.filled[t].minimum;
    for (std::size_t r = 0; r < of.runs.size(); ++r) {
      for (int s = of.runs[r].first; s < of.runs[r].last; ++s) {
        const btVector3 p = of.samples[s].position([&](int node) { return first.positions[node]; });
        const Eigen::Vector4d inside = map(toEigen(p)) - Eigen::Vector4d(least[0], least[1], least[2], least[3]);
        if (inside.minCoeff() > 1e-4) met.emplace(r, t);
      }
    }
  }
  return met;
}

/// The runs and tets that are tested if each test finds this clearance.
RunTets visited(PairCandidates& candidates, const ContactBody& first, ContactBody& second,
                const Clearance& found = {0, 0}) {
  second.place();
  RunTets tested;
  int run = -1;
  const auto begin = [&](const VisitedRun& next) {
    EXPECT_LT(run, next.run);
    run = next.run;
    return first.runBox(run);
  };
  const auto test = [&](int tet) {
    EXPECT_TRUE(tested.emplace(run, tet).second) << "twice";
    return found;
  };
  candidates.visit(second, begin, test, [] {});
  return tested;
}

TEST_F(SoftCandidates, HoldAllThatTestingAllPairsFindsWhileBodiesMove) {
  auto first = includeCoarse({0, 0, 0}), second = includeCoarse({0.8, 0.2, 0.1});
  PairCandidates candidates;
  std::mt19937 random(4);
  std::size_t found = 0;
  int oldest = 0, renewed = 0;
  for (int step = 0; step < 60; ++step) {
    const btQuaternion turn(btVector3(1, 2, 0).normalized(), btScalar(0.02));
    const btVector3 shift = btVector3(step < 30 ? btScalar(-0.01) : btScalar(0.006), 0, 0) * btScalar(step % 3);
    move(*first, [&](const btVector3& x) { return quatRotate(turn, x); });
    move(*second, [&](const btVector3& x) {
      return quatRotate(turn, x + shift + btVector3(0, btScalar(random() % 100) * btScalar(1e-5), 0));
    });
    candidates.update(*first, *second, kCandidateStep);
    const RunTets met = metByBruteForce(*first, *second), tested = visited(candidates, *first, *second);
    ASSERT_TRUE(holdsAll(tested, met)) << step;
    for (const auto& [run, tet] : tested) {
      ContactBox around;
      for (const int n : second->data().tets[tet]) around.extend(second->positions[n]);
      EXPECT_TRUE(first->runBox(run).collides(around.grownBy(btScalar(0.02))));
    }
    found += met.size();
    oldest = std::max(oldest, candidates.age());
    renewed += candidates.age() == 0 ? 1 : 0;
  }
  EXPECT_GT(found, 500U);
  EXPECT_GT(oldest, 2);
  EXPECT_GT(renewed, 2);
}

TEST_F(SoftCandidates, AreNotTestedAgainUntilTheyHaveMovedByTheirClearance) {
  const btScalar apart = btScalar(0.0004);
  for (const bool within : {false, true}) {
    auto first = includeCoarse({0, 0, 0}), second = includeCoarse({0.6, 0.2, 0.1});
    const btScalar touching =
        kNearCubes * second->data().grid.spacing();  // is subtracted from the distance of what stands
    const Clearance clear = within ? Clearance{kForever, kApproach * btScalar(2.5) * apart + touching}
                                   : Clearance{btScalar(2.5) * apart, kForever};
    PairCandidates candidates;
    candidates.update(*first, *second, kCandidateStep);
    const RunTets begun = visited(candidates, *first, *second, clear);
    ASSERT_GT(begun.size(), 20U);
    for (int step = 1; step <= 3; ++step) {
      first->read();
      move(*second, [&](const btVector3& x) { return x - btVector3(apart, 0, 0); });
      candidates.update(*first, *second, kCandidateStep);
      ASSERT_EQ(candidates.age(), step);
      std::size_t again = 0;
      for (const auto& tested : visited(candidates, *first, *second, clear)) again += begun.count(tested);
      // Meanwhile, some have left each other.
      if (step < 3) {
        EXPECT_EQ(again, 0U);
      } else {
        EXPECT_GT(again, begun.size() * 19 / 20);
      }
    }
  }
}

/// A ball that is folded in the middle.
TEST_F(SoftCandidates, OfABodyWithItselfAreThoseThatAreFarApartAtRest) {
  auto body = includeCoarse({0, 0, 0});
  move(*body, [&](const btVector3& x) { return btVector3(btFabs(x.x() - btScalar(0.47)), x.y(), x.z()); });
  PairCandidates candidates;
  candidates.update(*body, *body, kCandidateStep);
  const ShapeData& data = body->data();
  const auto isFar = [&](const std::pair<int, int>& at) {
    const btVector3 apart = data.centroids[data.runs[at.first].tet] - data.centroids[at.second];
    return apart.length() >= 2 * data.edge;
  };
  const RunTets tested = visited(candidates, *body, *body);
  EXPECT_TRUE(std::all_of(tested.begin(), tested.end(), isFar));
  std::size_t far = 0;
  for (const auto& met : metByBruteForce(*body, *body)) {
    if (!isFar(met)) continue;
    EXPECT_EQ(tested.count(met), 1U);
    ++far;
  }
  EXPECT_GT(far, 50U);
}

TEST_F(SoftCandidates, HoldWhileBodiesMoveTogether) {
  auto first = include(Eigen::Vector3d(0, 0, 0)), second = include(Eigen::Vector3d(0.5, 0.5, 0.1));
  const btScalar dt = btScalar(0.004);
  PairCandidates candidates;
  candidates.update(*first, *second, dt);
  EXPECT_EQ(candidates.age(), 0);
  for (const auto& body : bodies_) body->translate(btVector3(5, 0, 0));
  for (ContactBody* body : {first.get(), second.get()}) body->read();
  candidates.update(*first, *second, dt);
  EXPECT_EQ(candidates.age(), 1) << "both have moved by as much";
  candidates.update(*first, *second, dt);
  EXPECT_EQ(candidates.age(), 1) << "nothing has been read since";
  bodies_[1]->m_nodes[7].m_x += btVector3(0, btScalar(0.2), 0);
  second->read();
  candidates.update(*first, *second, dt);
  EXPECT_EQ(candidates.age(), 0) << "a node has gone farther than the slack";
}

TEST_F(SoftCandidates, AreMissingOfBodiesApart) {
  auto first = include(Eigen::Vector3d(0, 0, 0)), second = include(Eigen::Vector3d(3, 0, 0));
  PairCandidates candidates;
  candidates.update(*first, *second, btScalar(0.004));
  EXPECT_TRUE(candidates.empty());
}

/// Runs and tets whose boxes are not farther apart than this.
RunTets nearerThan(btScalar reach, const ContactBody& first, const ContactBody& second) {
  RunTets near;
  const ShapeData& of = second.data();
  for (int r = 0; r < static_cast<int>(first.data().runs.size()); ++r) {
    const FourBoxes box(first.runBox(r));
    for (std::size_t g = 0; g < of.groups.size(); ++g) {
      const Four gaps = gapsBetween(box, second.groupBoxes[g]);
      for (int k = 0; k < kLanes; ++k) {
        if (of.groups[g][k] >= 0 && gaps[k] <= reach) near.emplace(r, of.groups[g][k]);
      }
    }
  }
  return near;
}

/// How long they last at the most, and how often they do not.
struct Lasting {
  int longest = 0, ended = 0;
};

TEST_F(SoftCandidates, LastAsLongAsNothingElseIsMet) {
  const auto lasting = [&](double apart, const btVector3& approach, btScalar angle) {
    auto first = includeCoarse({0, 0, 0}), second = includeCoarse({apart, 0.2, 0.1});
    const btQuaternion turn(btVector3(1, 2, 0).normalized(), angle);
    CandidateValidity validity;
    RunTets near;
    Lasting found;
    for (int step = 0; step < 60; ++step) {
      if (step == 0 || !validity.lasts(*first, *second)) {
        found.ended += step > 0 ? 1 : 0;
        first->fit();
        second->fit();
        validity.begin(*first, *second);
        near = nearerThan(validity.slack(), *first, *second);
      }
      found.longest = std::max(found.longest, validity.age());
      EXPECT_TRUE(holdsAll(near, metByBruteForce(*first, *second))) << step;
      move(*first, [&](const btVector3& x) { return quatRotate(turn, x); });
      move(*second, [&](const btVector3& x) { return quatRotate(turn, x + approach * (1 + x.y())); });
    }
    return found;
  };
  const Lasting tumbling = lasting(0.8, btVector3(btScalar(-0.001), 0, 0), btScalar(0.03));
  EXPECT_GT(tumbling.longest, 5);
  EXPECT_GT(tumbling.ended, 0);
  const Lasting flying = lasting(2.5, btVector3(btScalar(-0.03), 0, 0), 0);
  EXPECT_GT(flying.longest, 15) << "while it is far away";
  EXPECT_GT(flying.ended, 2);
}

}  // namespace
}  // namespace tetskin::test
