// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <gtest/gtest.h>
#include <tetskin/core/mesh_skin.h>
#include <tetskin/io/mesh_loader.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "command.h"

namespace tetskin {
namespace {

using test::CommandFolder;
using test::CommandResult;

/// A box as an OBJ with quads, texture coordinates, groups and a comment, around the origin.
std::string boxObj(double half = 0.4, const char* firstX = nullptr) {
  std::string text = "# a box\nmtllib box.mtl\n";
  for (int k = 0; k < 8; ++k) {
    const std::string x = k == 0 && firstX ? firstX : std::to_string(k & 1 ? half : -half);
    text += "v " + x + " " + std::to_string(k & 2 ? half : -half) + " " + std::to_string(k & 4 ? half : -half) + "\n";
  }
  text += "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\ng sides\nusemtl red\nf 1/1 3/2 4/3 2/4\nf 5/1 6/2 8/3 7/4\n";
  text += "f 1/1 2/2 6/3 5/4\nf 3/1 7/2 8/3 4/4\ng caps\nusemtl blue\nf 1/1 5/2 7/3 3/4\nf 2/1 4/2 8/3 6/4\n";
  return text;
}

/// One cube of edge 1 around the origin as six tets.
std::string cubeVtk() {
  std::string text = "# vtk DataFile Version 2.0\ncube\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 8 double\n";
  for (int k = 0; k < 8; ++k) {
    text += std::string(k & 1 ? "0.5 " : "-0.5 ") + (k & 2 ? "0.5 " : "-0.5 ") + (k & 4 ? "0.5\n" : "-0.5\n");
  }
  text += "CELLS 6 30\n4 0 1 3 7\n4 0 3 2 7\n4 0 2 6 7\n4 0 6 4 7\n4 0 4 5 7\n4 0 5 1 7\nCELL_TYPES 6\n";
  return text + "10\n10\n10\n10\n10\n10\n";
}

class Drop : public testing::Test {
 protected:
  CommandResult drop(std::vector<std::string> arguments) const { return folder.run(TETSKIN_DROP, arguments); }

  /// Exit status 2, one line on standard error that mentions the words, nothing written.
  void expectRefused(const std::vector<std::string>& arguments, const std::vector<std::string>& words) const {
    const CommandResult result = drop(arguments);
    for (const std::string& word : words) test::expectRefused(result, word);
    EXPECT_FALSE(folder.exists("out"));
  }

  CommandFolder folder;
};

/// How far a frame is from the best rigid image of the first, RMS, over the first one's largest side.
double deformation(const std::vector<std::array<double, 3>>& rest, const std::vector<std::array<double, 3>>& now) {
  Eigen::Matrix3Xd a(3, rest.size()), b(3, now.size());
  for (std::size_t v = 0; v < rest.size(); ++v) {
    a.col(v) = Eigen::Vector3d(rest[v].data());
    b.col(v) = Eigen::Vector3d(now[v].data());
  }
  const Eigen::Matrix4d motion = Eigen::umeyama(a, b, false);
  const Eigen::Matrix3Xd moved = (motion.topLeftCorner<3, 3>() * a).colwise() + motion.topRightCorner<3, 1>();
  const double size = (a.rowwise().maxCoeff() - a.rowwise().minCoeff()).maxCoeff();
  return std::sqrt((moved - b).colwise().squaredNorm().mean()) / size;
}

TEST_F(Drop, SerpentFallsDeformsStaysAboveTheFloorAndRests) {
  const CommandResult result = drop({"--triangles", "8000", "--tets", "1000", "--every", "30"});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto json = folder.json("out/drop/summary.json");
  EXPECT_EQ(json["frames"], 240);
  EXPECT_EQ(json["inside"].get<int>() + json["outside"].get<int>(), json["vertices"].get<int>());
  EXPECT_EQ(json["unbound"], 0);
  EXPECT_TRUE(json["finite"]);
  EXPECT_LT(json["extent_max"], 2.0);
  EXPECT_LT(json["rest_speed"], 0.05);
  EXPECT_LT(json["rest_error_max"], 1e-6);

  const auto first = test::objPositions(folder.read("out/drop/frame_0000.obj"));
  const auto impact = test::objPositions(folder.read("out/drop/frame_0030.obj"));
  const auto last = test::objPositions(folder.read("out/drop/frame_0210.obj"));
  ASSERT_EQ(first.size(), json["vertices"].get<std::size_t>());
  double fall = 0.0, low = HUGE_VAL;
  for (std::size_t v = 0; v < first.size(); ++v) {
    fall += (first[v][1] - last[v][1]) / static_cast<double>(first.size());
    low = std::min(low, last[v][1]);
  }
  EXPECT_GT(fall, 0.3);
  EXPECT_GT(deformation(first, impact), 0.01);
  EXPECT_GE(low, json["floor_y"].get<double>() - json["margin"].get<double>() - 0.01 * 2.0);
  EXPECT_NE(result.out.find("attach"), std::string::npos);
}

TEST_F(Drop, KeepsTheInputsFacesTextureCoordinatesGroupsAndOrder) {
  folder.write("box.obj", boxObj());
  folder.write("cube.vtk", cubeVtk());
  ASSERT_EQ(drop({"--mesh", "box.obj", "--cage", "cube.vtk", "--frames", "3", "--out", "o"}).status, 0);
  const auto withoutPositions = [](const std::string& text) {
    std::string kept;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) kept += line.rfind("v ", 0) == 0 ? "v\n" : line + "\n";
    return kept;
  };
  EXPECT_EQ(withoutPositions(folder.read("o/frame_0002.obj")), withoutPositions(boxObj()));
  const auto in = test::objPositions(boxObj()), out = test::objPositions(folder.read("o/frame_0000.obj"));
  for (std::size_t v = 0; v < in.size(); ++v) {
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(in[v][k], out[v][k], 1e-6);
  }
}

TEST_F(Drop, WritesCurrentUnitNormalsIfAskedFor) {
  folder.write("box.obj", boxObj());
  for (const std::string normals : {"transformed", "recomputed"}) {
    ASSERT_EQ(drop({"--mesh", "box.obj", "--tets", "60", "--frames", "30", "--every", "29", "--interpolation",
                    "quadratic", "--normals", normals, "--out", normals})
                  .status,
              0);
    const TriangleMesh first = loadMesh(folder.path(normals + "/frame_0000.obj")).value();
    const TriangleMesh last = loadMesh(folder.path(normals + "/frame_0029.obj")).value();
    ASSERT_EQ(first.normals.size(), 8u);
    ASSERT_EQ(last.normals.size(), 8u);
    EXPECT_EQ(last.texcoords.size(), first.texcoords.size());
    const std::vector<Eigen::Vector3d> expected = restNormals(first);
    for (int v = 0; v < 8; ++v) {
      EXPECT_LT((first.normals[v].cast<double>() - expected[v]).norm(), 1e-5);
      EXPECT_NEAR(last.normals[v].norm(), 1.0, 1e-5);
    }
  }
}

TEST_F(Drop, QuadraticSurfaceFollowsTheSameCage) {
  for (const std::string kind : {"linear", "quadratic"}) {
    ASSERT_EQ(drop({"--triangles", "4000", "--tets", "300", "--frames", "40", "--every", "39", "--interpolation", kind,
                    "--write-cage", "--out", kind})
                  .status,
              0);
  }
  EXPECT_EQ(folder.read("linear/cage_0039.vtk"), folder.read("quadratic/cage_0039.vtk"));
  const auto linear = test::objPositions(folder.read("linear/frame_0039.obj"));
  const auto quadratic = test::objPositions(folder.read("quadratic/frame_0039.obj"));
  double farthest = 0.0;
  for (std::size_t v = 0; v < linear.size(); ++v) {
    farthest =
        std::max(farthest, (Eigen::Vector3d(linear[v].data()) - Eigen::Vector3d(quadratic[v].data())).norm() / 2.0);
  }
  EXPECT_GT(farthest, 1e-4);
  EXPECT_LT(farthest, 0.1);
}

TEST_F(Drop, TouchesTheFloorAsDrawnOrByItsCage) {
  double above[2] = {};
  for (const bool surface : {true, false}) {
    const std::string out = surface ? "surface" : "cage";
    const CommandResult result = drop({"--tets", "300", "--triangles", "8000", "--frames", "180", "--every", "180",
                                       "--out", folder.path(out), "--contact", out});
    ASSERT_EQ(result.status, 0) << result.err;
    const auto json = folder.json(out + "/summary.json");
    EXPECT_EQ(json["contact"], out);
    above[surface] = json["lowest_y"].get<double>() - json["floor_y"].get<double>();
  }
  EXPECT_NEAR(above[1], 0.0, 0.01);  // of a model of size 2
  EXPECT_GT(above[0], 0.02);
}

TEST_F(Drop, AReducedBodyFallsStaysAboveTheFloorAndRests) {
  const CommandResult result = drop({"--body", "reduced", "--modes", "8", "--fine-tets", "8000", "--tets", "300",
                                     "--triangles", "6000", "--frames", "240", "--every", "100", "--out", "out"});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto summary = folder.json("out/summary.json");
  EXPECT_EQ(summary.at("body"), "reduced");
  EXPECT_EQ(summary.at("modes"), 8);
  EXPECT_EQ(summary.at("contact"), "cage");
  EXPECT_EQ(summary.at("finite"), true);
  EXPECT_EQ(summary.at("above_floor"), true);
  EXPECT_LT(summary.at("extent_max").get<double>(), 2.0);
  EXPECT_LT(summary.at("rest_speed").get<double>(), 0.2);
  EXPECT_NE(result.out.find("reduced, 8 modes"), std::string::npos) << result.out;
}

TEST_F(Drop, WritesEveryKthFrameAndTheCageBesideIt) {
  folder.write("box.obj", boxObj());
  ASSERT_EQ(
      drop({"--mesh", "box.obj", "--tets", "60", "--frames", "9", "--every", "4", "--write-cage", "--out", "o"}).status,
      0);
  for (const char* name : {"o/frame_0000.obj", "o/frame_0004.obj", "o/frame_0008.obj", "o/cage_0000.vtk",
                           "o/cage_0008.vtk", "o/obstacles.obj"}) {
    EXPECT_TRUE(folder.exists(name)) << name;
  }
  EXPECT_EQ(folder.count("o", ".vtk"), 3u);
  EXPECT_EQ(folder.json("o/summary.json")["frames_written"], 3);
}

TEST_F(Drop, LeavesNoFrameOfALongerRunAndEveryFileThatIsNotItsOwn) {
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
  test::expectRefused(run({"5", "--every", "2"}), "frame_0100.obj");
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

TEST_F(Drop, SaysHowMuchItWritesBeforeItDoes) {
  folder.write("box.obj", boxObj());
  const CommandResult result =
      drop({"--mesh", "box.obj", "--tets", "3000", "--frames", "60", "--every", "30", "--write-cage", "--out", "o"});
  ASSERT_EQ(result.status, 0) << result.err;
  const std::size_t place = result.out.find("writing 2 frames, about ");
  ASSERT_NE(place, std::string::npos) << result.out;
  EXPECT_LT(place, result.out.find("simulating"));
  const double written =
      static_cast<double>(folder.read("o/frame_0000.obj").size() + folder.read("o/cage_0000.vtk").size() +
                          folder.read("o/frame_0030.obj").size() + folder.read("o/cage_0030.vtk").size());
  EXPECT_NEAR(std::stod(result.out.substr(place + 24)), 1e-3 * written, 1.0 + 0.1e-3 * written) << result.out;
  EXPECT_NE(result.out.find("kB, to o\n"), std::string::npos) << result.out;
}

TEST_F(Drop, SpeaksOfOneFrameAndOfFewBytesAsTheyAre) {
  folder.write("box.obj", boxObj());
  const CommandResult result = drop({"--mesh", "box.obj", "--tets", "60", "--frames", "1", "--out", "o"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("writing 1 frame, about "), std::string::npos) << result.out;
  EXPECT_NE(result.out.find(" kB, to o\n"), std::string::npos) << result.out;
}

TEST_F(Drop, TellsThatACageIsBuiltBeforeAllElse) {
  folder.write("box.obj", boxObj());
  const auto run = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"--mesh", "box.obj", "--frames", "1", "--out", "o"});
    return drop(more).out;
  };
  EXPECT_EQ(run({"--tets", "60"}).find("building a cage of 60 tets\n"), 0u);
  EXPECT_EQ(run({"--tets", "60", "--quiet"}), "");
  ASSERT_EQ(folder.run(TETSKIN_CAGE, {"--mesh", "box.obj", "--tets", "60", "-o", "c.vtk"}).status, 0);
  EXPECT_EQ(run({"--cage", "c.vtk"}).find("building"), std::string::npos) << "there is none to build";
}

TEST_F(Drop, RefusesContactsThatAReducedBodyDoesNotHave) {
  test::expectRefused(drop({"--body", "reduced", "--contact", "surface", "--out", "o"}), "--contact surface");
  EXPECT_FALSE(folder.exists("o"));
}

TEST_F(Drop, RefusesMoreThanTheDiskHasRoomFor) {
  const CommandResult result = drop({"--tets", "60", "--triangles", "300000", "--frames", "1000000", "--out", "o"});
  test::expectRefused(result, "--every");
  EXPECT_NE(result.err.find("o: 1000000 frames take about "), std::string::npos) << result.err;
  EXPECT_EQ(folder.count("o", ".obj"), 0u);
  EXPECT_FALSE(folder.exists("o/.tetskin_frames"));
}

TEST_F(Drop, ColoursItsOwnModelsAndLeavesOthersTheirMaterials) {
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

TEST_F(Drop, NamesTheFarthestVertexOutside) {
  folder.write("box.obj", boxObj(0.45, "-0.56"));
  folder.write("cube.vtk", cubeVtk());
  const CommandResult result = drop({"--mesh", "box.obj", "--cage", "cube.vtk", "--frames", "2", "--out", "o"});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto json = folder.json("o/summary.json");
  EXPECT_EQ(json["outside"], 1);
  EXPECT_EQ(json["worst_vertex"], 0);
  EXPECT_NEAR(json["worst_distance"], 0.06, 1e-6);
  EXPECT_NE(result.out.find("vertex 0, by 0.06"), std::string::npos) << result.out;
}

TEST_F(Drop, TellsTheToleranceByWhichItJudgesTheFloor) {
  folder.write("box.obj", boxObj());
  const CommandResult result = drop({"--mesh", "box.obj", "--tets", "60", "--every", "240", "--out", "o"});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto json = folder.json("o/summary.json");
  const double tolerance = json["floor_tolerance"], floor = json["floor_y"], lowest = json["lowest_y"];
  EXPECT_GT(tolerance, json["margin"]);
  EXPECT_LT(tolerance, json["margin"].get<double>() + 0.02);
  EXPECT_EQ(json["above_floor"].get<bool>(), lowest >= floor - tolerance);
  EXPECT_NE(result.out.find("tolerance"), std::string::npos) << result.out;
}

TEST_F(Drop, ModelsOfAnySizeAndPlaceGiveTheSameMotion) {
  for (const double half : {0.4, 400.0}) {
    folder.write("box.obj", boxObj(half));
    ASSERT_EQ(
        drop({"--mesh", "box.obj", "--tets", "100", "--frames", "40", "--out", "o" + std::to_string(half)}).status, 0);
  }
  const auto small = test::objPositions(folder.read("o" + std::to_string(0.4) + "/frame_0039.obj"));
  const auto large = test::objPositions(folder.read("o" + std::to_string(400.0) + "/frame_0039.obj"));
  for (std::size_t v = 0; v < small.size(); ++v) EXPECT_NEAR(large[v][1] / 1000.0, small[v][1], 1e-2);
}

TEST_F(Drop, QuietPrintsNothing) {
  folder.write("box.obj", boxObj());
  const CommandResult result =
      drop({"--mesh", "box.obj", "--tets", "60", "--frames", "2", "--quiet", "--json", "s.json"});
  EXPECT_EQ(result.status, 0);
  EXPECT_TRUE(result.out.empty()) << result.out;
  EXPECT_TRUE(result.err.empty()) << result.err;
  EXPECT_EQ(folder.json("s.json")["frames"], 2);
}

TEST_F(Drop, HelpListsTheOptions) {
  const CommandResult result = drop({"--help"});
  EXPECT_EQ(result.status, 0);
  for (const char* option :
       {"--mesh", "--cage", "--tets", "--outside", "--interpolation", "--normals", "--max-distance", "--frames",
        "--every", "--out", "--json", "--quiet", "--write-cage", "--view", "--no-view"}) {
    EXPECT_NE(result.out.find(option), std::string::npos) << option;
  }
}

TEST_F(Drop, RefusesAMissingMesh) {
  expectRefused({"--mesh", "nowhere.obj"}, {"nowhere.obj"});
}

TEST_F(Drop, RefusesAMissingCage) {
  folder.write("box.obj", boxObj());
  expectRefused({"--mesh", "box.obj", "--cage", "nowhere.vtk"}, {"nowhere.vtk"});
}

TEST_F(Drop, RefusesATruncatedCage) {
  folder.write("box.obj", boxObj());
  folder.write("cut.vtk", cubeVtk().substr(0, cubeVtk().find("4 0 6 4")));
  expectRefused({"--mesh", "box.obj", "--cage", "cut.vtk"}, {"cut.vtk:18", "complete"});
}

TEST_F(Drop, RefusesATruncatedMesh) {
  const std::string whole = boxObj();
  folder.write("cut.obj", whole.substr(0, whole.find("v 0.4") + 8));
  expectRefused({"--mesh", "cut.obj"}, {"cut.obj:"});
}

TEST_F(Drop, RefusesACageWithoutTets) {
  folder.write("box.obj", boxObj());
  std::string text = cubeVtk().substr(0, cubeVtk().find("CELLS"));
  folder.write("none.vtk", text + "CELLS 1 4\n3 0 1 2\nCELL_TYPES 1\n5\n");
  expectRefused({"--mesh", "box.obj", "--cage", "none.vtk"}, {"none.vtk", "tet"});
}

TEST_F(Drop, RefusesATetIndexOutOfRange) {
  folder.write("box.obj", boxObj());
  std::string text = cubeVtk();
  text.replace(text.find("4 0 2 6 7"), 9, "4 0 2 6 8");
  folder.write("range.vtk", text);
  expectRefused({"--mesh", "box.obj", "--cage", "range.vtk"}, {"range.vtk", "8"});
}

TEST_F(Drop, RefusesNanCoordinates) {
  folder.write("nan.obj", boxObj(0.4, "nan"));
  expectRefused({"--mesh", "nan.obj"}, {"nan.obj:3", "not finite"});
}

TEST_F(Drop, RefusesNanCoordinatesOfACage) {
  folder.write("box.obj", boxObj());
  std::string text = cubeVtk();
  text.replace(text.find("-0.5 -0.5 -0.5"), 4, "nan ");
  folder.write("nan.vtk", text);
  expectRefused({"--mesh", "box.obj", "--cage", "nan.vtk"}, {"nan.vtk"});
}

TEST_F(Drop, RefusesAnEmptyMesh) {
  folder.write("empty.obj", "# nothing\n");
  expectRefused({"--mesh", "empty.obj"}, {"empty.obj", "no vertices"});
}

TEST_F(Drop, RefusesAMeshInOtherUnitsThanItsCage) {
  folder.write("box.obj", boxObj(400.0));
  folder.write("cube.vtk", cubeVtk());
  expectRefused({"--mesh", "box.obj", "--cage", "cube.vtk"}, {"box.obj", "cube.vtk", "units"});
}

TEST_F(Drop, RefusesAnOutputFolderThatCannotBeWritten) {
  folder.write("box.obj", boxObj());
  folder.write("file", "in the way");
  expectRefused({"--mesh", "box.obj", "--tets", "60", "--frames", "2", "--out", "file/o"}, {"file/o"});
}

TEST_F(Drop, RefusesASummaryThatCannotBeWritten) {
  folder.write("box.obj", boxObj());
  const CommandResult result =
      drop({"--mesh", "box.obj", "--tets", "60", "--frames", "2", "--out", "o", "--json", "no/such/s.json"});
  test::expectRefused(result, "no/such/s.json");
  EXPECT_EQ(folder.count("o", ".obj"), 0u);
}

TEST_F(Drop, RefusesUnknownOptionsAndSenselessValues) {
  expectRefused({"--mehs", "x.obj"}, {"--mehs"});
  expectRefused({"--frames", "0"}, {"--frames"});
  expectRefused({"--every", "-1"}, {"--every"});
  expectRefused({"--tets", "0"}, {"--tets"});
  expectRefused({"--tets", "many"}, {"--tets"});
  expectRefused({"--outside", "somewhere"}, {"--outside", "nearest"});
  expectRefused({"--interpolation", "cubic"}, {"--interpolation", "quadratic"});
  expectRefused({"--normals", "bumpy"}, {"--normals", "transformed"});
  expectRefused({"--max-distance", "-1"}, {"--max-distance", "negative"});
}

TEST(Hello, RunsWithoutAnyFile) {
  const CommandFolder folder;
  const CommandResult result = folder.run(TETSKIN_HELLO, {});
  EXPECT_EQ(result.status, 0);
  EXPECT_NE(result.out.find("20000 inside"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("frame 60"), std::string::npos) << result.out;
}

TEST(Hello, LinksNeitherAssimpNorTheCageBuilder) {
  const CommandFolder folder;
  const CommandResult libraries = folder.run("ldd", {TETSKIN_HELLO});
  ASSERT_EQ(libraries.status, 0);
  EXPECT_NE(libraries.out.find("libBulletSoftBody"), std::string::npos);
  EXPECT_EQ(libraries.out.find("assimp"), std::string::npos);
  const CommandResult symbols = folder.run("nm", {"-C", TETSKIN_HELLO});
  ASSERT_EQ(symbols.status, 0);
  EXPECT_NE(symbols.out.find("tetskin::SoftBodySkin::update"), std::string::npos);
  EXPECT_EQ(symbols.out.find("buildCage"), std::string::npos);
}

}  // namespace
}  // namespace tetskin
