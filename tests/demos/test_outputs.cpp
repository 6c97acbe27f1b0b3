// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The files that the programs write, and that they overwrite no other: files are identified by the file itself, not by
// name.

#include <filesystem>

#include "drop_run.h"

namespace tetskin::test {
namespace {

namespace fs = std::filesystem;

using Arguments = std::vector<std::string>;

class Outputs : public testing::Test {
 protected:
  Outputs() {
    folder.write("box.obj", boxObj());
    folder.write("cube.vtk", cubeVtk());
  }
  ~Outputs() override { EXPECT_EQ(folder.read("box.obj"), boxObj()) << "what was read is as it was"; }

  CommandResult cage(Arguments more) const {
    more.insert(more.begin(), {"--mesh", "box.obj", "--tets", "60", "--quiet"});
    return folder.run(TETSKIN_CAGE, more);
  }
  CommandResult deform(Arguments more) const {
    more.insert(more.begin(), {"--mesh", "box.obj", "--cage", "cube.vtk", "--deformed", "cube.vtk", "--quiet"});
    return folder.run(TETSKIN_DEFORM, more);
  }
  CommandResult drop(Arguments more) const {
    more.insert(more.begin(), {"--tets", "60", "--frames", "2", "--quiet"});
    return folder.run(TETSKIN_DROP, more);
  }

  CommandFolder folder;
};

TEST_F(Outputs, AreNotWhatIsRead) {
  expectRefused(cage({"-o", "c.vtk", "--json", "box.obj"}), "--json box.obj: would overwrite the input of --mesh");
  expectRefused(deform({"-o", "box.obj"}), "--output box.obj");
  expectRefused(deform({"-o", "now.obj", "--dump-embedding", "cube.vtk"}), "--cage cube.vtk");
  expectRefused(drop({"--mesh", "box.obj", "--view", "box.obj"}), "--view box.obj");
  expectRefused(drop({"--mesh", "box.obj", "--json", "box.obj"}), "--json box.obj");
  EXPECT_EQ(folder.read("cube.vtk"), cubeVtk());
  EXPECT_FALSE(folder.exists("out"));
  EXPECT_FALSE(folder.exists("c.vtk"));
}

TEST_F(Outputs, AreNotWhatIsReadByAnyOtherName) {
  fs::create_symlink(folder.path("box.obj"), folder.path("link.json"));
  fs::create_hard_link(folder.path("box.obj"), folder.path("twin.json"));
  fs::create_directory_symlink(folder.path("."), folder.path("here"));
  for (const std::string name : {"./box.obj", "here/box.obj", "link.json", "twin.json", "here/link.json"}) {
    expectRefused(cage({"-o", "c.vtk", "--json", name}), "--json " + name);
  }
  expectRefused(cage({"-o", "c.vtk", "--json", folder.path("box.obj")}), "would overwrite");
  folder.write("c.json.part", boxObj());  // the name of c.json until it is complete
  expectRefused(folder.run(TETSKIN_CAGE, {"--mesh", "c.json.part", "-o", "c.vtk", "--json", "c.json"}), "c.json.part");
}

TEST_F(Outputs, AreNotTheOtherFileOfAPair) {
  ASSERT_EQ(cage({"-o", "c.ele"}).status, 0);
  const std::string nodes = folder.read("c.node");
  expectRefused(folder.run(TETSKIN_DROP, {"--mesh", "box.obj", "--cage", "c.ele", "--json", "c.node"}), "--cage c.ele");
  expectRefused(cage({"-o", "d.ele", "--json", "d.node"}), "--json d.node");
  EXPECT_EQ(folder.read("c.node"), nodes);
}

TEST_F(Outputs, AreNotTwiceTheSame) {
  expectRefused(cage({"-o", "c.vtk", "--json", "c.vtk"}), "--json c.vtk");
  expectRefused(deform({"-o", "now.obj", "--json", "x", "--dump-embedding", "./x"}), "would overwrite");
  expectRefused(drop({"--view", "x", "--json", "x"}), "would overwrite");
  expectRefused(drop({"--view", "out/drop/summary.json"}), "would overwrite the output of --view");
  expectRefused(drop({"--json", "out/drop/view.html"}), "out/drop/view.html");
  fs::create_symlink("x", folder.path("to_x"));  // points to a file that does not exist yet
  expectRefused(drop({"--view", "x", "--json", "to_x"}), "would overwrite");
  EXPECT_FALSE(folder.exists("out"));
}

TEST_F(Outputs, AreNotFramesOfTheRunNorItsInputAFrameOfTheLast) {
  expectRefused(drop({"--view", "o/frame_0001.obj", "--out", "o"}), "--view o/frame_0001.obj");
  expectRefused(drop({"--json", "o/obstacles.obj", "--out", "o"}), "--json o/obstacles.obj");
  ASSERT_EQ(drop({"--triangles", "3000", "--out", "o", "--no-view"}).status, 0);
  const std::string last = folder.read("o/frame_0001.obj");
  expectRefused(drop({"--mesh", "o/frame_0001.obj", "--out", "o"}), "--mesh o/frame_0001.obj");
  fs::remove(folder.path("o/frame_0001.obj"));
  fs::create_symlink(folder.path("box.obj"), folder.path("o/frame_0001.obj"));
  expectRefused(drop({"--mesh", "box.obj", "--out", "o"}), "--mesh box.obj");
  EXPECT_NE(last, "");
  EXPECT_EQ(drop({"--mesh", "box.obj", "--out", "elsewhere", "--no-view"}).status, 0);
}

TEST_F(Outputs, OfReportsAreNotItsInput) {
  fs::create_directory(folder.path("o"));
  folder.write("o/error_sag.ply", boxObj());
  expectRefused(folder.run(TETSKIN_ERROR_VS_TIME, {"--mesh", "o/error_sag.ply", "--out", "o", "--quick"}), "--mesh");
  expectRefused(folder.run(TETSKIN_ERROR_VS_TIME, {"--view", "o/error_vs_time.json", "--out", "o", "--quick"}),
                "--view");
}

TEST_F(Outputs, AreLookedAtBeforeAnythingIsRead) {
  for (const std::string program : {TETSKIN_CAGE, TETSKIN_DEFORM}) {
    Arguments arguments = {"--mesh", "none.obj", "-o", "now.stl"};
    if (program == TETSKIN_DEFORM) arguments.insert(arguments.end(), {"--cage", "none.vtk", "--deformed", "none.vtk"});
    expectRefused(folder.run(program, arguments), "now.stl: unsupported output format");
    arguments[3] = program == TETSKIN_DEFORM ? "no/where.obj" : "no/where.vtk";
    expectRefused(folder.run(program, arguments), "no/where");
  }
  expectRefused(drop({"--mesh", "none.obj", "--json", "no/where.json"}), "no/where.json");
  expectRefused(drop({"--mesh", "none.obj", "--out", "box.obj/o"}), "box.obj/o: cannot be created");
  EXPECT_EQ(drop({"--mesh", "box.obj", "--out", "o", "--json", "o/s.json", "--no-view"}).status, 0)
      << "made by the run";
}

TEST_F(Outputs, AreNotWaitedForWhereAPipeShouldBeRead) {
  ASSERT_EQ(folder.run("mkfifo", {"pipe.obj"}).status, 0);
  expectRefused(folder.run(TETSKIN_CAGE, {"--mesh", "pipe.obj", "-o", "c.vtk"}), "--mesh pipe.obj: is a pipe");
}

TEST_F(Outputs, MayAllBeADevice) {
  EXPECT_EQ(deform({"-o", "now.obj", "--json", "/dev/null", "--dump-embedding", "/dev/null"}).status, 0);
}

TEST_F(Outputs, OnAFullDeviceAreAnError) {
  const std::string everywhere[] = {TETSKIN_DROP,   TETSKIN_PILE,    TETSKIN_DRAG,         TETSKIN_CAGE,
                                    TETSKIN_DEFORM, TETSKIN_MEASURE, TETSKIN_ERROR_VS_TIME};
  for (const std::string& program : everywhere) {
    for (const char* argument : {"--help", "--version"}) {
      const CommandResult result = folder.run("sh", {"-c", program + " " + argument + " >/dev/full"});
      EXPECT_EQ(result.status, 2) << program;
      EXPECT_NE(result.err.find("standard output cannot be written"), std::string::npos) << result.err;
    }
  }
  const std::string dropping = TETSKIN_DROP " --mesh box.obj --tets 60 --frames 2 --no-view --out o";
  EXPECT_EQ(folder.run("sh", {"-c", dropping + " >/dev/full"}).status, 2);
  EXPECT_EQ(folder.run("sh", {"-c", dropping + " --quiet >/dev/full"}).status, 0) << "nothing is said";
  EXPECT_EQ(drop({"--mesh", "box.obj", "--out", "o", "--json", "/dev/full"}).status, 2);
}

}  // namespace
}  // namespace tetskin::test
