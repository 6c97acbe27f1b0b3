// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/io/files.h>

#include "drop_run.h"

namespace tetskin::test {
namespace {

TEST(Pile, BodiesFallIntoTheBowlAndLieOnEachOther) {
  const CommandFolder folder;
  const CommandResult result = folder.run(
      TETSKIN_PILE, {"--bodies", "5", "--tets", "200", "--triangles", "4000", "--frames", "181", "--every", "180"});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto json = folder.json("out/pile/summary.json");
  EXPECT_TRUE(json["finite"]);
  EXPECT_EQ(json["contact"], "surface");
  EXPECT_GT(json["contacts_at_end"], 0);
  EXPECT_GT(json["iterations_per_step"], 1.0);
  EXPECT_GT(json["passes_per_step"], 0.1);
  EXPECT_EQ(json["steps_unconverged"], 0);
  EXPECT_GT(json["deepest_contact_at_end"], -0.05);  // coarse bodies that still move
  EXPECT_LE(json["deepest_vertex"], json["deepest_vertex_at_end"]);
  EXPECT_LT(json["deepest_vertex_at_end"], 0.0);
  EXPECT_GT(json["deepest_vertex_at_end"], -0.05);
  EXPECT_GT(json["vertices_inside_at_end"], 0);
  EXPECT_NE(result.out.find("  time  contacts  pairs  deepest vertex  vertices inside"), std::string::npos)
      << result.out;
  for (const char* row :
       {"\n  0.00  ", "\n  1.00  ", "\n  2.00  ", "\n  3.00  ", "\n  deepest vertex  ", "ms per frame\n"}) {
    EXPECT_NE(result.out.find(row), std::string::npos) << row << result.out;
  }
  const TriangleMesh first = loadMesh(folder.path("out/pile/frame_0000.obj")).value();
  const TriangleMesh last = loadMesh(folder.path("out/pile/frame_0180.obj")).value();
  ASSERT_EQ(first.vertexCount(), last.vertexCount());
  EXPECT_LT(boundingBox(last.positions).max().y(), 0.8 * boundingBox(first.positions).max().y());
  EXPECT_GT(boundingBox(last.positions).min().y(), -0.05);
  EXPECT_TRUE(loadMesh(folder.path("out/pile/obstacles.obj")).ok());
}

TEST(Pile, MeasuresTheDeepestVertexAsOftenAsIsAskedFor) {
  const CommandFolder folder;
  const auto deepest = [&](const char* every) {
    const CommandResult result =
        folder.run(TETSKIN_PILE, {"--bodies", "3", "--tets", "100", "--triangles", "3000", "--frames", "110", "--every",
                                  "109", "--depth-every", every});
    EXPECT_EQ(result.status, 0) << result.err;
    return folder.json("out/pile/summary.json");
  };
  const auto always = deepest("1"), seldom = deepest("1000");
  EXPECT_LE(always["deepest_vertex"], seldom["deepest_vertex"]);
  EXPECT_LT(always["deepest_vertex"], 0.0);
  EXPECT_EQ(always["deepest_vertex_at_end"], seldom["deepest_vertex_at_end"]);
  EXPECT_GT(always["deepest_vertex_frame"], 60);  // the bodies fall for a second
}

TEST(Pile, HeapsBodiesAndTellsHowLongEachStageTakes) {
  const CommandFolder folder;
  const CommandResult result =
      folder.run(TETSKIN_PILE, {"--scene", "heap", "--bodies", "5", "--tets", "60", "--triangles", "3000", "--threads",
                                "2", "--frames", "61", "--every", "60", "--self-contact", "off"});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto json = folder.json("out/pile/summary.json");
  EXPECT_EQ(json["scene"], "heap");
  EXPECT_EQ(json["bodies"], 5);
  EXPECT_EQ(json["threads"], 2);
  EXPECT_GT(json["contacts_at_end"], 0);
  EXPECT_GT(json["pairs_at_end"], 0);
  EXPECT_LE(json["pairs_at_end"], 5 * 4 / 2);
  EXPECT_GT(json["processor_ms_per_frame"], 0.0);
  EXPECT_TRUE(json["slowest_second_ms_per_frame"].is_null()) << "five bodies have ten pairs at most";
  double sum = 0.0;
  for (const auto& [stage, ms] : json["stages_ms_per_frame"].items()) {
    EXPECT_GT(ms, 0.0) << stage;
    sum += ms.get<double>();
  }
  EXPECT_EQ(json["stages_ms_per_frame"].size(), 7u);
  EXPECT_LE(sum, json["simulation_ms_per_frame"].get<double>());
  for (const char* line : {"\n    search, soft ", "\n    rest of Bullet's step ", "\n    skin "}) {
    EXPECT_NE(result.out.find(line), std::string::npos) << line << result.out;
  }
}

TEST(Pile, BallsAndCubesStartApartWhereTheSeedPutsThem) {
  const CommandFolder folder;
  for (const std::string scene : {"pit", "bin"}) {
    const auto start = [&](const std::string& seed) {
      const CommandResult result =
          folder.run(TETSKIN_PILE, {"--scene", scene, "--bodies", "20", "--tets", "60", "--seed", seed, "--frames", "1",
                                    "--format", "obj", "--out", "o"});
      EXPECT_EQ(result.status, 0) << result.err;
      EXPECT_EQ(folder.json("o/summary.json")["vertices_inside_at_end"], 0) << scene << seed;
      return folder.read("o/frame_0000.obj");
    };
    const std::string two = start("2");
    EXPECT_NE(start("1"), two) << scene;
    EXPECT_EQ(start("2"), two) << scene;
  }
}

TEST(Pile, LetsBallsSinkIntoAMatAndTellsWhatEachCosts) {
  const CommandFolder folder;
  const CommandResult result = folder.run(TETSKIN_PILE, {"--scene", "pit", "--bodies", "6", "--tets", "300", "--frames",
                                                         "61", "--every", "60", "--view", "view.html"});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto json = folder.json("out/pile/summary.json");
  EXPECT_TRUE(json["finite"]);
  EXPECT_EQ(json["bodies"], 1);
  EXPECT_EQ(json["balls"], 6);
  EXPECT_EQ(json["self_contact"], "off");
  EXPECT_GT(json["passes_per_step"], 0.1);
  EXPECT_GT(json["deepest_dent"], 0.02) << "where the heavy balls land";
  EXPECT_LE(json["deepest_dent_at_end"], json["deepest_dent"]);
  EXPECT_GT(json["deepest_dent_at_end"], 0.0);
  EXPECT_LT(json["deepest_dent"], 0.4) << "the mat is as thick";
  EXPECT_GT(json["deepest_vertex"], -0.01);
  EXPECT_LE(json["asleep_at_end"], 7);
  EXPECT_NEAR(json["simulation_us_per_thing_and_frame"], 1e3 / 6 * json["simulation_ms_per_frame"].get<double>(), 1e-6);
  for (const char* text : {"  time  asleep  fastest  deepest vertex  deepest dent  iterations    passes  ",
                           "each ball\n", "\n  1.00  ", "1 and 6 balls, ", " us per frame and ball\n"}) {
    EXPECT_NE(result.out.find(text), std::string::npos) << text << result.out;
  }
  const TriangleMesh first = loadMesh(folder.path("out/pile/frame_0000.obj")).value();
  const TriangleMesh last = loadMesh(folder.path("out/pile/frame_0060.obj")).value();
  EXPECT_EQ(first.triangleCount(), last.triangleCount());
  EXPECT_LT(boundingBox(last.positions).max().y(), boundingBox(first.positions).max().y() - 0.1) << "balls have fallen";
  EXPECT_GT(boundingBox(last.positions).min().y(), -0.01);
  // Where three.js is missing, there is no page.
  EXPECT_NE((folder.exists("view.html") ? folder.read("view.html") : "6 balls").find("6 balls"), std::string::npos);
}

TEST(Pile, CubesInABinTouchEachOtherAndStayInside) {
  const CommandFolder folder;
  const CommandResult result = folder.run(TETSKIN_PILE, {"--scene", "bin", "--bodies", "24", "--tets", "40",
                                                         "--threads", "2", "--frames", "81", "--every", "80"});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto json = folder.json("out/pile/summary.json");
  EXPECT_TRUE(json["finite"]);
  EXPECT_EQ(json["bodies"], 24);
  EXPECT_FALSE(json.contains("balls"));
  EXPECT_GT(json["pairs_at_end"], 0);
  EXPECT_GT(json["contacts_at_end"], 0);
  EXPECT_GT(json["deepest_vertex"], -0.02) << "a twentieth of a cube";
  EXPECT_NE(result.out.find("each cube\n"), std::string::npos) << result.out;
  const Box3 box = boundingBox(loadMesh(folder.path("out/pile/frame_0080.obj")).value().positions);
  EXPECT_GT(box.min().minCoeff(), -1.26);
  EXPECT_GT(box.min().y(), -0.01);
  EXPECT_LT(std::max(box.max().x(), box.max().z()), 1.26);
}

TEST(Pile, TakesAMeshOfTheUsers) {
  const CommandFolder folder;
  folder.write("box.obj", test::boxObj());
  const auto run = [&](const char* mesh) {
    return folder.run(TETSKIN_PILE, {"--mesh", mesh, "--bodies", "2", "--tets", "60", "--frames", "2"});
  };
  ASSERT_EQ(run("box.obj").status, 0);
  EXPECT_EQ(loadMesh(folder.path("out/pile/frame_0001.obj")).value().triangleCount(), 2u * 12u);
  folder.write("sheet.obj", "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nf 1 3 2\nf 1 4 3\n");
  expectRefused(run("sheet.obj"), "sheet.obj: ");
}

}  // namespace
}  // namespace tetskin::test
