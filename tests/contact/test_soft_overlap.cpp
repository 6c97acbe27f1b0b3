// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors

#include "soft_fixtures.h"

namespace tetskin::test {
namespace {

using Eigen::Vector3d;

/// Three balls at the same position, or nearly so, or half inside each other.
TEST(SoftOverlap, BodiesThatOverlapLeaveEachOtherSlowly) {
  for (const double offset : {0.0, 0.05, 0.4}) {
    const auto world = worldWith(btVector3(0, 0, 0));
    const auto contacts = contactsIn(*world);
    std::vector<std::unique_ptr<DeformableBody>> balls;
    for (int k = 0; k < 3; ++k) {
      balls.push_back(addBall(*world, Vector3d(offset * k, 2.0 + 0.3 * offset * k, 0)));
      ASSERT_TRUE(contacts->add(balls.back()->body(), ball().shape).ok());
    }
    double fastest = 0.0;
    for (int frame = 0; frame < 90; ++frame) {
      step(*world, 1);
      fastest = std::max(fastest, fastestNode(balls));
    }
    EXPECT_LT(fastest, 2.0 * 2.0 * Ball::kRadius) << offset;
    for (std::size_t a = 0; a < 3; ++a) {
      EXPECT_EQ(contacts->status(balls[a]->body()), StatusCode::Ok);
      for (std::size_t b = 0; b < a; ++b) {
        const auto apart = static_cast<double>((centreOf(balls[a]->body()) - centreOf(balls[b]->body())).length());
        EXPECT_GT(apart, 1.95 * Ball::kRadius) << offset;
      }
    }
  }
}

/// A ball inside another one of twice its size: there is no way out, and neither of them moves.
TEST(SoftOverlap, WhatLiesWithinAnotherSaysSoAndIsLeftInPeace) {
  const auto world = worldWith(btVector3(0, 0, 0));
  TetMesh cage = ball().cage;
  TriangleMesh mesh = ball().mesh;
  const auto larger = [](const Vector3d& p) -> Vector3d {
    return Vector3d(0.5, 0.5, 0.5) + 2.0 * (p - Vector3d(0.5, 0.5, 0.5));
  };
  for (Vector3d& p : cage.nodes) p = larger(p);
  for (Vector3d& p : mesh.positions) p = larger(p);
  const auto shape = ContactShape::create(cage, mesh).value();
  for (Vector3d& p : cage.nodes) p.y() += 2.0;
  std::vector<std::unique_ptr<DeformableBody>> balls;
  balls.push_back(added(*world, cage, {}));
  balls.push_back(addBall(*world, Vector3d(0.1, 2.05, 0)));
  const auto contacts = contactsIn(*world);
  ASSERT_TRUE(contacts->add(balls[0]->body(), shape).ok());
  ASSERT_TRUE(contacts->add(balls[1]->body(), ball().shape).ok());
  step(*world, 20);
  EXPECT_EQ(contacts->status(balls[0]->body()), StatusCode::Ok);
  EXPECT_EQ(contacts->status(balls[1]->body()), StatusCode::Enclosed);
  EXPECT_LT(fastestNode(balls), 1e-3);
  balls[1]->body().m_cfg.collisions = 0;
  step(*world, 1);
  EXPECT_EQ(contacts->status(balls[1]->body()), StatusCode::Ok) << "it meets none of them";
}

}  // namespace
}  // namespace tetskin::test
