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

TEST_F(DropRefuses, FilesThatAreNoMesh) {
  const std::string whole = boxObj();
  folder.write("cut.obj", whole.substr(0, whole.find("v 0.4") + 8));
  folder.write("nan.obj", boxObj(0.4, "nan"));
  folder.write("empty.obj", "# nothing\n");
  expectRefused({"--mesh", "nowhere.obj"}, {"nowhere.obj"});
  expectRefused({"--mesh", "cut.obj"}, {"cut.obj:"});
  expectRefused({"--mesh", "nan.obj"}, {"nan.obj:3", "not finite"});
  expectRefused({"--mesh", "empty.obj"}, {"empty.obj", "no vertices"});
}

TEST_F(DropRefuses, FilesThatAreNoCage) {
  const std::string whole = cubeVtk();
  const auto with = [&](const char* before, const char* after) {
    std::string text = whole;
    return text.replace(text.find(before), std::string(before).size(), after);
  };
  folder.write("box.obj", boxObj());
  folder.write("cut.vtk", whole.substr(0, whole.find("4 0 6 4")));
  folder.write("none.vtk", whole.substr(0, whole.find("CELLS")) + "CELLS 1 4\n3 0 1 2\nCELL_TYPES 1\n5\n");
  folder.write("range.vtk", with("4 0 2 6 7", "4 0 2 6 8"));
  folder.write("nan.vtk", with("-0.5 ", "nan "));
  expectRefused({"--mesh", "box.obj", "--cage", "nowhere.vtk"}, {"nowhere.vtk"});
  expectRefused({"--mesh", "box.obj", "--cage", "cut.vtk"}, {"cut.vtk:18", "complete"});
  expectRefused({"--mesh", "box.obj", "--cage", "none.vtk"}, {"none.vtk", "tet"});
  expectRefused({"--mesh", "box.obj", "--cage", "range.vtk"}, {"range.vtk", "8"});
  expectRefused({"--mesh", "box.obj", "--cage", "nan.vtk"}, {"nan.vtk"});
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
