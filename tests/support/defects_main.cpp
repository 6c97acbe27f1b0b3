// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Runs tests of Bullet's own defects, tests/BULLET_DEFECTS.md, if Bullet is the version in which they were seen. With
// another one the program has no tests: neither for ctest, which asks the program for them, nor when run directly.
#include <LinearMath/btScalar.h>
#include <gtest/gtest.h>

#include <cstdio>

namespace {

constexpr int kSeenWith = 324;

}  // namespace

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  if (BT_BULLET_VERSION != kSeenWith) {
    std::fprintf(stderr, "Bullet %d: no tests of the defects of Bullet %d\n", BT_BULLET_VERSION, kSeenWith);
    testing::GTEST_FLAG(filter) = "-*";
  }
  return RUN_ALL_TESTS();
}
