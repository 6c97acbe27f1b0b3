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

TEST_F(DropRefuses, FilesThatAreNoMeshOrNoCage) {
  folder.write("box.obj", boxObj());
  folder.write("nan.obj", boxObj(0.4, "nan"));
  folder.write("cut.vtk", cubeVtk().substr(0, cubeVtk().find("4 0 6 4")));
  expectRefused({"--mesh", "nowhere.obj"}, {"nowhere.obj"});
  expectRefused({"--mesh", "nan.obj"}, {"nan.obj:3", "not finite"});
  expectRefused({"--mesh", "box.obj", "--cage", "nowhere.vtk"}, {"nowhere.vtk"});
  expectRefused({"--mesh", "box.obj", "--cage", "cut.vtk"}, {"cut.vtk:18", "complete"});
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

TEST_F(DropRefuses, VibrationsOfABodyThatHasNone) {
  expectRefused({"--modes", "5"}, {"--modes needs --body reduced"});
  expectRefused({"--fine-tets", "5000"}, {"--fine-tets needs --body reduced"});
}

}  // namespace
}  // namespace tetskin
