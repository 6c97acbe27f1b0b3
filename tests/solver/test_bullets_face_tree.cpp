// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Bullet's own trees of a soft body's faces. The table in tests/BULLET_DEFECTS.md names this test.
#include "deformable_test.h"

#include <chrono>
#include <cstdlib>
#include <thread>

namespace tetskin::test {
namespace {

TEST(BulletsFaceTreeDeathTest, NeverEndsForABodyOfTwoParts) {
  EXPECT_EXIT(
      {
        btSoftBodyWorldInfo info;
        const std::unique_ptr<btSoftBody> body(createSoftBody(twoComponents(test::singleTet()), info).value());
        std::thread([] {
          std::this_thread::sleep_for(std::chrono::seconds(1));  // ample for eight faces
          std::_Exit(3);
        }).detach();
        body->initializeFaceTree();
      },
      testing::ExitedWithCode(3), "");
}

}  // namespace
}  // namespace tetskin::test
