// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "command.h"

namespace tetskin::test {
namespace {

TEST(Clay, KeepsWhatIsPressedIntoIt) {
  const CommandFolder folder;
  const CommandResult result = folder.run(TETSKIN_CLAY, {});
  EXPECT_EQ(result.status, 0) << result.out;
  EXPECT_NE(result.out.find("the clay keeps its shape, the other comes back: yes"), std::string::npos) << result.out;
  EXPECT_TRUE(folder.exists("out/clay/frame_0480.obj"));
}

TEST(MuscleOfAnArm, ObeysTheLawOfTheLever) {
  const CommandFolder folder;
  const CommandResult result = folder.run(TETSKIN_MUSCLE, {});
  EXPECT_EQ(result.status, 0) << result.out;
  EXPECT_NE(result.out.find("the arm obeys the law of the lever: yes"), std::string::npos) << result.out;
  EXPECT_TRUE(folder.exists("out/muscle/frame_0720.obj"));
}

TEST(Inflate, GasLiftsACrate) {
  const CommandFolder folder;
  const CommandResult result = folder.run(TETSKIN_INFLATE, {});
  EXPECT_EQ(result.status, 0) << result.out;
  EXPECT_NE(result.out.find(": yes"), std::string::npos) << result.out;
  EXPECT_TRUE(folder.exists("out/inflate/frame_0300.obj"));
}

}  // namespace
}  // namespace tetskin::test
