// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The output formats of a run: --format.

#include <cstring>
#include <filesystem>

#include "deform_run.h"
#include "drop_run.h"

namespace tetskin::test {
namespace {

namespace fs = std::filesystem;

using Arguments = std::vector<std::string>;

class DropFormats : public DropRun {
 protected:
  DropFormats() { folder.write("box.obj", boxObj()); }

  CommandResult run(const Arguments& more) const {
    Arguments arguments = {"--mesh", "box.obj", "--tets", "60", "--frames", "9", "--out", "o", "--no-view", "--quiet"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return drop(arguments);
  }
  /// The names of the files in the folder of the run, apart from the list of frames.
  std::set<std::string> files() const {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder.path("o"))) names.insert(entry.path().filename().string());
    names.erase(".tetskin_frames");
    return names;
  }
};

/// The numbers of vertices and of frames in a point cache, and the coordinates of a frame.
struct PointCache {
  explicit PointCache(const std::string& bytes) : text(bytes) {}
  std::int32_t vertices() const { return at<std::int32_t>(16); }
  std::int32_t frames() const { return at<std::int32_t>(28); }
  float step() const { return at<float>(24); }
  template <class Number>
  Number at(std::size_t offset) const {
    Number number{};
    EXPECT_LE(offset + sizeof number, text.size());
    std::memcpy(&number, text.data() + offset, sizeof number);
    return number;
  }
  /// Expects a frame to be that of an OBJ file.
  void expectFrame(std::size_t frame, const std::vector<std::array<double, 3>>& expected) const {
    ASSERT_EQ(expected.size(), static_cast<std::size_t>(vertices()));
    for (std::size_t i = 0; i < 3 * expected.size(); ++i) {
      const auto number = at<float>(32 + 12 * frame * expected.size() + 4 * i);
      EXPECT_EQ(number, static_cast<float>(expected[i / 3][i % 3]));
    }
  }
  std::string text;
};

TEST_F(DropFormats, WritesWhatIsRequestedAndRemovesWhatARunBeforeWrote) {
  ASSERT_EQ(run({"--every", "4"}).status, 0);
  EXPECT_EQ(files(), (std::set<std::string>{"animation.glb", "frame_0000.obj", "frame_0004.obj", "frame_0008.obj",
                                            "obstacles.mtl", "obstacles.obj", "summary.json"}))
      << "by default";
  ASSERT_EQ(run({"--format", "glb"}).status, 0);
  EXPECT_EQ(files(), (std::set<std::string>{"animation.glb", "obstacles.mtl", "obstacles.obj", "summary.json"}));
  EXPECT_EQ(folder.read("o/animation.glb").substr(0, 4), "glTF");
  ASSERT_EQ(run({"--format", "pc2"}).status, 0);
  EXPECT_EQ(files(), (std::set<std::string>{"animation.obj", "animation.pc2", "obstacles.mtl", "obstacles.obj",
                                            "summary.json"}));
  ASSERT_EQ(run({"--format", "obj", "--normals", "transformed"}).status, 0);
  EXPECT_NE(folder.read("o/frame_0008.obj").find("\nvn "), std::string::npos);
  EXPECT_EQ(folder.count("o", ".obj"), 9u + 1u);
  EXPECT_EQ(folder.count("o", ".pc2") + folder.count("o", ".glb"), 0u);
}

TEST_F(DropFormats, APointCacheHasThePositionsOfTheObjFrames) {
  ASSERT_EQ(run({"--format", "obj,pc2", "--every", "4", "--interpolation", "quadratic"}).status, 0);
  const PointCache cache(folder.read("o/animation.pc2"));
  EXPECT_EQ(cache.vertices(), 8);
  ASSERT_EQ(cache.frames(), 3);
  EXPECT_EQ(cache.at<float>(20), 0.0f) << "the first frame";
  EXPECT_EQ(cache.step(), 4.0f);
  EXPECT_EQ(cache.text.size(), 32u + 3u * 8u * 12u);
  cache.expectFrame(0, test::objPositions(folder.read("o/frame_0000.obj")));
  cache.expectFrame(2, test::objPositions(folder.read("o/frame_0008.obj")));
  EXPECT_EQ(folder.read("o/animation.obj"), folder.read("o/frame_0000.obj"));
}

TEST_F(DropFormats, AGlbIsAHundredthOfAnObjSequence) {
  ASSERT_EQ(drop({"--triangles", "20000", "--tets", "300", "--frames", "120", "--no-view", "--quiet", "--contact",
                  "cage", "--every", "119", "--out", "o"})
                .status,
            0);
  const double obj = 120.0 * static_cast<double>(fs::file_size(folder.path("o/frame_0000.obj")));
  EXPECT_LT(100.0 * static_cast<double>(fs::file_size(folder.path("o/animation.glb"))), 1.2 * obj);
}

TEST_F(DropFormats, AFileOfSomebodyElseIsNotReplaced) {
  fs::create_directory(folder.path("o"));
  folder.write("o/animation.glb", "mine");
  expectRefused(run({}), "o: animation.glb was not written by an earlier tetskin run");
  EXPECT_EQ(folder.read("o/animation.glb"), "mine");
  EXPECT_EQ(run({"--format", "obj"}).status, 0) << "it is in nobody's way";
  EXPECT_EQ(folder.read("o/animation.glb"), "mine");
  expectRefused(run({"--json", "o/animation.pc2"}), "--json o/animation.pc2");
}

TEST_F(DropFormats, ARunThatIsKilledWhileItWritesLeavesNoHalfFile) {
  for (const std::string format : {"glb", "pc2"}) {
    const std::string command = "ulimit -f 20; " TETSKIN_DROP
                                " --triangles 3000 --tets 60 --frames 30 --no-view "
                                "--quiet --out killed --format " +
                                format;  // killed by the signal of the limit
    EXPECT_NE(folder.run("sh", {"-c", command}).status, 0);
    EXPECT_FALSE(folder.exists("killed/animation." + format));
    const std::string full = "trap '' XFSZ; " + command;  // the limit as a full disk
    const CommandResult result = folder.run("sh", {"-c", full});
    EXPECT_EQ(result.status, 2) << result.err;
    EXPECT_NE(result.err.find("cannot be written"), std::string::npos) << result.err;
    EXPECT_FALSE(folder.exists("killed/animation." + format));
  }
}

class DeformSequence : public DeformRun {};

TEST_F(DeformSequence, BecomesOneFile) {
  makeModel(3000, 300);
  for (const int frame : {0, 1, 2}) {
    writeDeformed([&](const Eigen::Vector3d& p) -> Eigen::Vector3d { return p + 0.1 * frame * p.y() * p; },
                  "cage_" + std::to_string(frame) + ".vtk");
  }
  const auto sequence = [&](const char* output) {
    return folder.run(TETSKIN_DEFORM, {"--mesh", "m.obj", "--cage", "rest.vtk", "--deformed", "cage_0.vtk",
                                       "cage_1.vtk", "cage_2.vtk", "-o", output, "--json", "s.json"});
  };
  ASSERT_EQ(sequence("all.pc2").status, 0);
  const PointCache cache(folder.read("all.pc2"));
  EXPECT_EQ(cache.frames(), 3);
  ASSERT_EQ(deform({"--deformed", "cage_2.vtk"}).status, 0);
  cache.expectFrame(2, test::objPositions(folder.read("o.obj")));
  ASSERT_EQ(sequence("all.glb").status, 0);
  EXPECT_EQ(folder.read("all.glb").substr(0, 4), "glTF");
  EXPECT_EQ(folder.json("s.json")["frames"], 3);

  fs::remove(folder.path("o.obj"));
  test::expectRefused(sequence("o.obj"), "an OBJ file holds one frame, and --deformed names 3");
  folder.write("cage_1.vtk", "damaged");
  const std::string before = folder.read("all.pc2");
  test::expectRefused(sequence("all.pc2"), "cage_1.vtk");
  EXPECT_EQ(folder.read("all.pc2"), before);
  test::expectRefused(sequence("cage_2.vtk"), "unsupported output format; use .obj, .glb or .pc2");
}

}  // namespace
}  // namespace tetskin::test
