// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/io/files.h>

#include "command.h"

namespace tetskin::test {
namespace {

TEST(Drag, TheSerpentIsPickedSwungHungAndPushed) {
  const CommandFolder folder;
  const CommandResult result =
      folder.run(TETSKIN_DRAG, {"--tets", "300", "--triangles", "20000", "--frames", "481", "--every", "240"});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto json = folder.json("out/drag/summary.json");
  EXPECT_TRUE(json["finite"]);
  EXPECT_LT(json["lag_swinging"], 0.01);
  EXPECT_GT(json["lag_swinging"], 0);
  EXPECT_LT(json["stretch_hanging"], 0.001);
  EXPECT_GT(json["pushed_vertices"], 10);
  EXPECT_GT(json["iterations_per_step"], 0.1);
  EXPECT_GT(json["passes_per_step"], 0.01);
  EXPECT_EQ(json["steps_unconverged"], 0);
  EXPECT_NE(result.out.find("  phase                   from    to  largest stretch"), std::string::npos) << result.out;
  for (const char* row : {"\n  lies on the floor       0.00  0.25 ", "\n  is lifted               0.25  1.50 ",
                          "\n  is swung                1.50  4.50 ", "\n  is carried to the ring  4.50  5.50 ",
                          "\n  hangs on the ring       5.50  7.00 ", "\n  is pushed               7.00  8.00 ",
                          "\n  lag while swung ", "ms per frame\n"}) {
    EXPECT_NE(result.out.find(row), std::string::npos) << row << result.out;
  }
  const TriangleMesh first = loadMesh(folder.path("out/drag/frame_0000.obj")).value();
  const TriangleMesh swung = loadMesh(folder.path("out/drag/frame_0240.obj")).value();
  ASSERT_EQ(first.vertexCount(), swung.vertexCount());
  EXPECT_GT(boundingBox(swung.positions).sizes().y(), 1.0);  // it hangs at its full length
  EXPECT_TRUE(loadMesh(folder.path("out/drag/obstacles.obj")).ok());
}

TEST(Drag, TheSerpentIsPickedWhereAHornEndsInOneVertex) {
  const CommandFolder folder;
  const CommandResult result =
      folder.run(TETSKIN_DRAG, {"--tets", "200", "--triangles", "4000", "--frames", "200", "--every", "199"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_GT(folder.json("out/drag/summary.json")["lag_swinging"], 0);
}

}  // namespace
}  // namespace tetskin::test
