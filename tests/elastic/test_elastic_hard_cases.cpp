// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/elastic/elastic_body.h>

#include <limits>

#include "elastic_motion.h"
#include "support/odd_meshes.h"
#include "support/shuffled_threads.h"

namespace tetskin::test {
namespace {

template <class S>
class ElasticHardCasesOf : public WithScalar<S> {};
TYPED_TEST_SUITE(ElasticHardCasesOf, Scalars);

Cage quadratic(const TetMesh& mesh) {
  return refineQuadratic(mesh).value();
}

/// Ways to damage a body, from which it must recover.
struct Damaged {
  const char* name;
  std::function<Vector3d(const Vector3d&)> position;
};

TYPED_TEST(ElasticHardCasesOf, ComesBackFromBeingFlatCollapsedOrInsideOut) {
  const std::vector<Damaged> damaged{
      {"flat", [](const Vector3d& p) { return Vector3d(p.x(), p.y(), 0.3); }},
      {"thread", [](const Vector3d& p) { return Vector3d(p.x(), 0.0, 0.3); }},
      {"collapsed", [](const Vector3d&) { return Vector3d(0.1, 0.2, 0.3); }},
      {"mirrored", [](const Vector3d& p) { return Vector3d(p.x(), p.y(), -p.z()); }},
      {"inverted", [](const Vector3d& p) { return Vector3d(-p); }},
  };
  ElasticOptions options = soft();
  options.stiffnessDamping = 0.01;
  for (const Cage& of : {Cage(singleTet()), Cage(latticeCage(2, 1, 1)), Cage(jittered(latticeCage(3, 2, 2), 0.1, 3)),
                         quadratic(singleTet()), quadratic(jittered(latticeCage(2, 1, 1), 0.1, 3))}) {
    const TetMesh& cage = of.mesh;
    onEachInstructionSet([&] {
      for (const Damaged& direction : damaged) {
        ElasticBody<TypeParam> body = made<TypeParam>(of, options);
        Points nodes;
        for (const Vector3d& p : cage.nodes) nodes.push_back(direction.position(p));
        fill(body.positions(), nodes);
        int steps = 0;
        while (steps < 400 && !(smallestVolume(cage, pointsOf(body.positions())) > 0.9)) {
          body.step(1.0 / 60.0);
          ++steps;
        }
        EXPECT_LT(steps, 400) << direction.name << " of " << cage.tetCount() << " tets";
      }
    });
  }
}

TYPED_TEST(ElasticHardCasesOf, ComesBackFromAWildMess) {
  ElasticOptions options = soft();
  options.stiffnessDamping = 0.01;
  for (const Cage& of : {Cage(latticeCage(3, 2, 2)), quadratic(latticeCage(2, 1, 1))}) {
    const TetMesh& cage = of.mesh;
    onEachInstructionSet([&] {
      ElasticBody<TypeParam> body = made<TypeParam>(of, options);
      fill(body.positions(), scattered(cage.nodes, 1.0, 14));
      ASSERT_LT(smallestVolume(cage, pointsOf(body.positions())), -0.5);
      for (int k = 0; k < 300; ++k) body.step(1.0 / 60.0);
      EXPECT_GT(smallestVolume(cage, pointsOf(body.positions())), 0.95);
    });
  }
}

TYPED_TEST(ElasticHardCasesOf, HoldsTogetherWhenVeryStiffAndThrownHard) {
  ElasticOptions options = soft();
  options.youngsModulus = 1e9;
  options.density = 1.0;
  for (const Cage& of :
       {Cage(jittered(latticeCage(3, 2, 1), 0.1, 3)), quadratic(jittered(latticeCage(2, 1, 1), 0.1, 3))}) {
    const TetMesh& cage = of.mesh;
    onEachInstructionSet([&] {
      ElasticBody<TypeParam> body = made<TypeParam>(of, options);
      fill(body.velocities(), scattered(Points(cage.nodeCount(), Vector3d(500, -300, 800)), 50.0, 15));
      for (int k = 0; k < 300; ++k) {
        EXPECT_LE(body.step(1.0 / 60.0, {0, 0, -9.8}), options.maxIterations);
        ASSERT_LT(fastest(body), 1200.0) << k;
      }
      EXPECT_NEAR(smallestVolume(cage, pointsOf(body.positions())), 1.0, 0.2) << "turning makes it a little larger";
    });
  }
}

TYPED_TEST(ElasticHardCasesOf, ComesToRestWhenVeryStiffAndStruckHardWhereItIsHeld) {
  const TetMesh cage = latticeCage(3, 2, 1);
  ElasticOptions options = soft();
  options.youngsModulus = 1e9;
  options.density = 1.0;
  onEachInstructionSet([&] {
    ElasticBody<TypeParam> body = made<TypeParam>(cage, options);
    Points velocities = scattered(Points(cage.nodeCount(), Vector3d(500, -300, 800)), 500.0, 15);
    for (std::size_t n = 0; n < cage.nodeCount(); ++n) {
      if (cage.nodes[n].x() == 0.0) velocities[n].setZero();
    }
    fill(body.velocities(), velocities);
    pinTheEnd(body, cage);
    for (int k = 0; k < 60; ++k) {
      body.step(1.0 / 60.0);
      ASSERT_LT(fastest(body), 1500.0) << k;
    }
    EXPECT_LT(fastest(body), 1e-6);
    EXPECT_NEAR(smallestVolume(cage, pointsOf(body.positions())), 1.0, 1e-5);
  });
}

/// A quadratic tet alone has states without stress in which its points are turned by 90 degrees and more from each
/// other.
TYPED_TEST(ElasticHardCasesOf, AQuadraticTetComesBackFromBeingTangled) {
  ElasticOptions options = soft();
  options.stiffnessDamping = 0.01;
  const Cage cage = quadratic(singleTet());
  onEachInstructionSet([&] {
    for (unsigned seed = 1; seed <= 10; ++seed) {
      ElasticBody<TypeParam> body = made<TypeParam>(cage, options);
      fill(body.positions(), scattered(cage.mesh.nodes, 1.0, seed));
      int steps = 0;
      while (steps < 400 && !(smallestVolume(cage.mesh, pointsOf(body.positions())) > 0.9)) {
        body.step(1.0 / 60.0);
        ++steps;
      }
      EXPECT_LT(steps, 400) << seed;
    }
  });
}

/// From so soft that it hangs down to so stiff that it does not move.
TYPED_TEST(ElasticHardCasesOf, QuadraticTetsComeToRestAtAnyStiffness) {
  const Cage cage = quadratic(latticeCage(4, 1, 1, 0.25));
  for (const double poissonRatio : {0.3, 0.45}) {
    for (double youngsModulus = 1e2; youngsModulus < 2e10; youngsModulus *= 10.0) {
      ElasticOptions options = soft();
      options.youngsModulus = youngsModulus;
      options.poissonRatio = poissonRatio;
      options.density = 10.0;
      options.stiffnessDamping = 0.1;
      ElasticBody<TypeParam> body = made<TypeParam>(cage, options);
      pinTheEnd(body, cage.mesh);
      int most = 0;
      for (int k = 0; k < 240; ++k) {
        most = std::max(most, body.step(1.0 / 60.0, {0, 0, -9.8}));
        ASSERT_LT(fastest(body), 50.0) << youngsModulus << " Pa, step " << k;
      }
      EXPECT_LT(most, 100) << youngsModulus;
      EXPECT_LT(fastest(body), youngsModulus < 5e3 ? 3.0 : 0.01) << youngsModulus << " Pa; soft ones still swing";
    }
  }
}

template <class S>
Points swung(const Cage& cage, int steps, ParallelFor* threads = nullptr, double tolerance = 1e-2) {
  ElasticOptions options = soft();
  options.tolerance = tolerance;
  ElasticBody<S> body = made<S>(cage, options);
  pinTheEnd(body, cage.mesh);
  for (int k = 0; k < steps; ++k) body.step(1.0 / 60.0, {0, 2.0, -9.8}, threads);
  Points result = pointsOf(body.positions());
  for (const Vector3d& v : pointsOf(body.velocities())) result.push_back(v);
  return result;
}

TYPED_TEST(ElasticHardCasesOf, HasTheSameBitsAgainAndOnAnyThreads) {
  Cage mixed = quadratic(latticeCage(7, 6, 6, 0.2));
  for (int& number : mixed.quadraticTet) number = number < 500 ? number : -1;
  for (const Cage& cage : {Cage(latticeCage(14, 12, 12, 0.1)), quadratic(latticeCage(7, 6, 6, 0.2)), mixed}) {
    const Points alone = swung<TypeParam>(cage, 4);
    EXPECT_EQ(swung<TypeParam>(cage, 4), alone);
    for (const int count : {1, 2}) {
      ShuffledThreads threads(count);
      EXPECT_EQ(swung<TypeParam>(cage, 4, &threads), alone);
      EXPECT_GT(threads.maxTasks, 8u);
    }
  }
}

TEST(ElasticHardCases, FloatIsNearDouble) {
  for (const Cage& cage : {Cage(latticeCage(6, 2, 2, 0.25)), quadratic(latticeCage(3, 1, 1, 0.5))}) {
    onEachInstructionSet([&] {
      const Points twice = swung<double>(cage, 30, nullptr, 1e-5), single = swung<float>(cage, 30, nullptr, 1e-5);
      double maximum = 0.0, moved = 0.0;
      for (std::size_t n = 0; n < cage.mesh.nodeCount(); ++n) {
        maximum = std::max(maximum, (twice[n] - single[n]).norm());
        moved = std::max(moved, (twice[n] - cage.mesh.nodes[n]).norm());
      }
      ASSERT_GT(moved, 0.3);
      EXPECT_LT(maximum, 3e-6);
    });
  }
}

TYPED_TEST(ElasticHardCasesOf, InstructionSetsMoveItAlike) {
  for (const Cage& cage : {Cage(latticeCage(6, 2, 2, 0.25)), quadratic(latticeCage(3, 1, 1, 0.5))}) {
    Points expected;
    onEachInstructionSet([&] {
      const Points nodes = swung<TypeParam>(cage, 30, nullptr, 1e-5);
      if (expected.empty()) expected = nodes;
      double maximum = 0.0;
      for (std::size_t n = 0; n < nodes.size(); ++n) maximum = std::max(maximum, (nodes[n] - expected[n]).norm());
      EXPECT_LT(maximum, 4e3 * this->kEpsilon);
    });
  }
}

TYPED_TEST(ElasticHardCasesOf, KeepsItsMomentumBesideANodeOfNoTet) {
  TetMesh cage = jittered(latticeCage(3, 2, 1), 0.1, 3);
  cage.nodes.emplace_back(9, 9, 9);
  const std::vector<double> masses = lumped(cage);
  ElasticOptions options = soft();
  options.youngsModulus = 500.0;
  options.density = 1.0;
  ElasticBody<TypeParam> body = made<TypeParam>(cage, options);
  Points velocities = scattered(Points(cage.nodeCount(), Vector3d::Zero()), 1.0, 16);
  velocities.back().setZero();
  fill(body.velocities(), velocities);
  const auto angular = [&] {
    const Points positions = pointsOf(body.positions()), now = pointsOf(body.velocities());
    Vector3d sum = Vector3d::Zero();
    for (std::size_t n = 0; n < now.size(); ++n) sum += masses[n] * positions[n].cross(now[n]);
    return sum;
  };
  const Vector3d start = angular();
  for (int k = 0; k < 600; ++k) body.step(1.0 / 240.0);
  EXPECT_LT((angular() - start).norm(), 100.0 * this->kEpsilon);
}

TYPED_TEST(ElasticHardCasesOf, IsElasticAgainAfterANodeWasNotFinite) {
  const TetMesh cage = latticeCage(2, 1, 1);
  ElasticBody<TypeParam> body = made<TypeParam>(cage, soft());
  body.positions()[3][1] = std::numeric_limits<TypeParam>::quiet_NaN();
  body.step(1.0 / 60.0);
  fill(body.velocities(), Points(cage.nodeCount(), Vector3d::Zero()));
  fill(body.positions(), cage.nodes);
  EXPECT_LT(body.energy(), 1e-6);
  fill(body.positions(), mapped(cage.nodes, Vector3d(1.1, 1.0, 1.0).asDiagonal(), Vector3d::Zero()));
  EXPECT_GT(body.energy(), 1.0);
}

TEST(ElasticHardCases, RefusesWhatIsBeyondTheRangeOfTheScalars) {
  TetMesh cage = latticeCage(1, 1, 1);
  ElasticOptions options = soft();
  options.youngsModulus = 1e30;
  options.stiffnessScale.assign(cage.tetCount(), 1e30);
  EXPECT_EQ(ElasticBody<float>::create(cage, options).status().code, StatusCode::InvalidOption);
  options = soft();
  options.nodeMasses.assign(cage.nodeCount(), 1e-50);
  EXPECT_EQ(ElasticBody<float>::create(cage, options).status().code, StatusCode::InvalidOption);
  for (Vector3d& p : cage.nodes) p *= 1e39;
  EXPECT_FALSE(ElasticBody<float>::create(cage, soft()).ok());
}

}  // namespace
}  // namespace tetskin::test
