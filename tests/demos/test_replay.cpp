// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Runs that the demos record, play again and check.
#include <tetskin/replay/recorder.h>
#include <tetskin/solver/deformable_world.h>

#include "command.h"

namespace tetskin::test {
namespace {

const std::vector<std::string> kShort = {"--frames", "12", "--every", "100", "--quiet"};

std::vector<std::string> with(std::vector<std::string> arguments, const std::vector<std::string>& more) {
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

struct Demo {
  const char* name;
  const char* program;
  std::vector<std::string> arguments;
};

const std::vector<Demo>& demos() {
  static const std::vector<Demo> all = {{"drop", TETSKIN_DROP, {"--tets", "300", "--triangles", "2000", "--no-view"}},
                                        {"pile", TETSKIN_PILE, {"--bodies", "3", "--tets", "200"}},
                                        {"drag", TETSKIN_DRAG, {"--tets", "300"}}};
  return all;
}

TEST(CheckDeterminism, FindsEachStepTheSameWhenItIsMadeAgain) {
  for (const Demo& demo : demos()) {
    const CommandFolder folder;
    const CommandResult result = folder.run(demo.program, with(with(demo.arguments, kShort), {"--check-determinism"}));
    EXPECT_EQ(result.status, 0) << demo.name << result.err << result.out;
    EXPECT_NE(result.out.find("44 steps, each made again from a snapshot: equal to the last bit"), std::string::npos)
        << demo.name << result.out;
  }
}

TEST(ReplayCommand, PlaysWhatEachDemoHasRecorded) {
  for (const Demo& demo : demos()) {
    const CommandFolder folder;
    const CommandResult recorded =
        folder.run(demo.program, with(with(demo.arguments, kShort), {"--record", "run.replay"}));
    EXPECT_EQ(recorded.status, 0) << demo.name << recorded.err << recorded.out;
    const CommandResult played = folder.run(TETSKIN_REPLAY, {"run.replay"});
    EXPECT_EQ(played.status, 0) << demo.name << played.err << played.out;
    EXPECT_NE(played.out.find("44 steps are as recorded, to the last bit"), std::string::npos) << played.out;
  }
}

TEST(ReplayCommand, TellsHowToPlayARunOfAnotherProgram) {
  const CommandFolder folder;
  DeformableWorld world;
  ASSERT_EQ(Recorder::start(world, folder.path("app.replay")).value()->step(btScalar(1) / 60), 1);
  expectRefused(folder.run(TETSKIN_REPLAY, {"app.replay"}), "build its world as that program does");
}

TEST(ReplayCommand, OfAnotherModelIsRefused) {
  const CommandFolder folder;
  const Demo& drop = demos().front();
  folder.run(drop.program, with(with(drop.arguments, kShort), {"--record", "run.replay"}));
  expectRefused(
      folder.run(drop.program, {"--tets", "400", "--frames", "5", "--no-view", "--quiet", "--replay", "run.replay"}),
      "the snapshot is of another world");
}

TEST(RunsInFiles, NeedAWorldThatCanBeSavedAndOneWish) {
  const CommandFolder folder;
  expectRefused(folder.run(TETSKIN_DROP, {"--elasticity", "bullet", "--frames", "3", "--tets", "200", "--quiet",
                                          "--no-view", "--check-determinism"}),
                "DeformableSolver");
  expectRefused(folder.run(TETSKIN_DROP, {"--frames", "3", "--tets", "200", "--quiet", "--no-view",
                                          "--check-determinism", "--record", "a.replay"}),
                "choose one of");
}

}  // namespace
}  // namespace tetskin::test
