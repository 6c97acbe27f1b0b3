// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The folder of frames: its contents, its size, and what is announced before it is written.
#include <tetskin/io/files.h>

#include <filesystem>

#include "drop_run.h"

namespace tetskin::test {
namespace {

class DropFrames : public DropRun {};

TEST_F(DropFrames, LeavesNoFrameOfALongerRunAndEveryFileThatIsNotItsOwn) {
  folder.write("box.obj", boxObj());
  const auto run = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"--mesh", "box.obj", "--tets", "60", "--out", "o", "--quiet", "--frames"});
    return drop(more);
  };
  ASSERT_EQ(run({"8", "--write-cage"}).status, 0);
  const std::vector<std::string> others = {"o/cage_0100.vtk", "o/cage_old.vtk", "o/frames.obj", "o/notes.txt"};
  for (const std::string& name : others) folder.write(name, "mine");
  folder.write("kept.obj", "mine");
  folder.write("o/.tetskin_frames", folder.read("o/.tetskin_frames") + "../kept.obj\nnotes.txt\ncage_old.vtk\n\n.\n");
  folder.write("o/frame_0100.obj", "mine");
  expectRefused(run({"5", "--every", "2"}), "frame_0100.obj");
  EXPECT_EQ(folder.read("o/frame_0100.obj"), "mine");
  EXPECT_TRUE(folder.exists("o/frame_0007.obj")) << "what is refused replaces nothing";
  std::filesystem::remove(folder.path("o/frame_0100.obj"));

  EXPECT_EQ(run({"3", "--json", "no/where.json"}).status, 2);
  EXPECT_TRUE(folder.exists("o/frame_0007.obj")) << "what does not run replaces nothing";
  ASSERT_EQ(run({"5", "--every", "2"}).status, 0);
  for (const char* name : {"o/frame_0000.obj", "o/frame_0002.obj", "o/frame_0004.obj"}) {
    EXPECT_TRUE(folder.exists(name)) << name;
  }
  EXPECT_EQ(folder.count("o", ".obj"), 3u + 1u + 1u) << "ours, the one that is not, and the obstacles";
  EXPECT_EQ(folder.count("o", ".vtk"), 2u);
  for (const std::string& name : others) EXPECT_EQ(folder.read(name), "mine") << name;
  EXPECT_EQ(folder.read("kept.obj"), "mine");
}

TEST_F(DropFrames, SaysHowMuchItWritesBeforeItDoes) {
  folder.write("box.obj", boxObj());
  const CommandResult result =
      drop({"--mesh", "box.obj", "--tets", "3000", "--frames", "60", "--every", "30", "--write-cage", "--out", "o"});
  ASSERT_EQ(result.status, 0) << result.err;
  const std::string announced = "writing 2 frames and animation.glb, about ";
  const std::size_t index = result.out.find(announced);
  ASSERT_NE(index, std::string::npos) << result.out;
  EXPECT_LT(index, result.out.find("simulating"));
  const double written =
      static_cast<double>(folder.read("o/frame_0000.obj").size() + folder.read("o/cage_0000.vtk").size() +
                          folder.read("o/frame_0030.obj").size() + folder.read("o/cage_0030.vtk").size() +
                          folder.read("o/animation.glb").size());
  EXPECT_NEAR(std::stod(result.out.substr(index + announced.size())), 1e-3 * written, 1.0 + 0.1e-3 * written)
      << result.out;
  EXPECT_NE(result.out.find("kB, to o\n"), std::string::npos) << result.out;
}

TEST_F(DropFrames, RefusesMoreThanTheDiskHasRoomFor) {
  const CommandResult result = drop({"--tets", "60", "--triangles", "300000", "--frames", "1000000", "--out", "o"});
  expectRefused(result, "--every");
  EXPECT_NE(result.err.find("o: 1000000 frames take about "), std::string::npos) << result.err;
  EXPECT_EQ(result.out, "") << "no cage is built for it";
  EXPECT_FALSE(folder.exists("o"));
}

TEST_F(DropFrames, ColoursItsOwnModelsAndLeavesOthersTheirMaterials) {
  ASSERT_EQ(drop({"--tets", "60", "--triangles", "3000", "--frames", "1", "--out", "o"}).status, 0);
  EXPECT_EQ(folder.read("o/frame_0000.obj").rfind("mtllib tetskin_frames.mtl\nv ", 0), 0u);
  const std::string library = folder.read("o/tetskin_frames.mtl");
  for (const char* name : {"newmtl scales\n", "newmtl horn\n", "newmtl ivory\n", "newmtl eye\n", "newmtl pupil\n"}) {
    EXPECT_NE(library.find(name), std::string::npos) << name;
  }
  EXPECT_EQ(folder.read("o/frame_0000.mtl"), library) << "f3d looks for the frame's name";
  EXPECT_NE(folder.read("o/obstacles.mtl").find("newmtl ramp\n"), std::string::npos);
  EXPECT_EQ(loadMesh(folder.path("o/frame_0000.obj")).value().groups.front().material, "horn");

  folder.write("box.obj", boxObj());
  ASSERT_EQ(drop({"--mesh", "box.obj", "--tets", "60", "--frames", "1", "--out", "o"}).status, 0);
  EXPECT_EQ(folder.read("o/frame_0000.obj").rfind("# a box\nmtllib box.mtl\n", 0), 0u);
  EXPECT_FALSE(folder.exists("o/tetskin_frames.mtl")) << "of the run before";
  EXPECT_FALSE(folder.exists("o/frame_0000.mtl"));
}

}  // namespace
}  // namespace tetskin::test
