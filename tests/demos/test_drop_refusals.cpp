// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Bad input produces one line that names it, and no files.
#include <gtest/gtest.h>

#include "drop_run.h"

namespace tetskin {
namespace {

using test::boxObj;
using test::CommandResult;
using test::cubeVtk;

class DropRefuses : public test::DropRun {};

TEST_F(DropRefuses, ContactsThatAReducedBodyDoesNotHave) {
  test::expectRefused(drop({"--body", "reduced", "--contact", "surface", "--out", "o"}), "--contact surface");
  EXPECT_FALSE(folder.exists("o"));
}

TEST_F(DropRefuses, ContactsThatABodyOfBulletsForcesDoesNotHave) {
  test::expectRefused(drop({"--elasticity", "bullet", "--contact", "surface", "--out", "o"}), "--contact surface");
  test::expectRefused(drop({"--elasticity", "bullet", "--self-contact", "on", "--out", "o"}), "--self-contact on");
  EXPECT_FALSE(folder.exists("o"));
}

TEST_F(DropRefuses, AMissingMesh) {
  expectRefused({"--mesh", "nowhere.obj"}, {"nowhere.obj"});
}

TEST_F(DropRefuses, AMissingCage) {
  folder.write("box.obj", boxObj());
  expectRefused({"--mesh", "box.obj", "--cage", "nowhere.vtk"}, {"nowhere.vtk"});
}

TEST_F(DropRefuses, ATruncatedCage) {
  folder.write("box.obj", boxObj());
  folder.write("cut.vtk", cubeVtk().substr(0, cubeVtk().find("4 0 6 4")));
  expectRefused({"--mesh", "box.obj", "--cage", "cut.vtk"}, {"cut.vtk:18", "complete"});
}

TEST_F(DropRefuses, ATruncatedMesh) {
  const std::string whole = boxObj();
  folder.write("cut.obj", whole.substr(0, whole.find("v 0.4") + 8));
  expectRefused({"--mesh", "cut.obj"}, {"cut.obj:"});
}

TEST_F(DropRefuses, ACageWithoutTets) {
  folder.write("box.obj", boxObj());
  std::string text = cubeVtk().substr(0, cubeVtk().find("CELLS"));
  folder.write("none.vtk", text + "CELLS 1 4\n3 0 1 2\nCELL_TYPES 1\n5\n");
  expectRefused({"--mesh", "box.obj", "--cage", "none.vtk"}, {"none.vtk", "tet"});
}

TEST_F(DropRefuses, ATetIndexOutOfRange) {
  folder.write("box.obj", boxObj());
  std::string text = cubeVtk();
  text.replace(text.find("4 0 2 6 7"), 9, "4 0 2 6 8");
  folder.write("range.vtk", text);
  expectRefused({"--mesh", "box.obj", "--cage", "range.vtk"}, {"range.vtk", "8"});
}

TEST_F(DropRefuses, NanCoordinates) {
  folder.write("nan.obj", boxObj(0.4, "nan"));
  expectRefused({"--mesh", "nan.obj"}, {"nan.obj:3", "not finite"});
}

TEST_F(DropRefuses, NanCoordinatesOfACage) {
  folder.write("box.obj", boxObj());
  std::string text = cubeVtk();
  text.replace(text.find("-0.5 -0.5 -0.5"), 4, "nan ");
  folder.write("nan.vtk", text);
  expectRefused({"--mesh", "box.obj", "--cage", "nan.vtk"}, {"nan.vtk"});
}

TEST_F(DropRefuses, AnEmptyMesh) {
  folder.write("empty.obj", "# nothing\n");
  expectRefused({"--mesh", "empty.obj"}, {"empty.obj", "no vertices"});
}

TEST_F(DropRefuses, AMeshInOtherUnitsThanItsCage) {
  folder.write("box.obj", boxObj(400.0));
  folder.write("cube.vtk", cubeVtk());
  expectRefused({"--mesh", "box.obj", "--cage", "cube.vtk"}, {"box.obj", "cube.vtk", "units"});
}

TEST_F(DropRefuses, AnOutputFolderThatCannotBeWritten) {
  folder.write("box.obj", boxObj());
  folder.write("file", "in the way");
  expectRefused({"--mesh", "box.obj", "--tets", "60", "--frames", "2", "--out", "file/o"}, {"file/o"});
}

TEST_F(DropRefuses, ASummaryThatCannotBeWritten) {
  folder.write("box.obj", boxObj());
  const CommandResult result =
      drop({"--mesh", "box.obj", "--tets", "60", "--frames", "2", "--out", "o", "--json", "no/such/s.json"});
  test::expectRefused(result, "no/such/s.json");
  EXPECT_FALSE(folder.exists("o"));
}

TEST_F(DropRefuses, VibrationsOfABodyThatHasNone) {
  expectRefused({"--modes", "5"}, {"--modes needs --body reduced"});
  expectRefused({"--fine-tets", "5000"}, {"--fine-tets needs --body reduced"});
}

TEST_F(DropRefuses, MoreTetsThanACageCanHave) {
  expectRefused({"--tets", "20000001"}, {"from 1 to 20000000"});
}

TEST_F(DropRefuses, UnknownOptionsAndSenselessValues) {
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

}  // namespace
}  // namespace tetskin
