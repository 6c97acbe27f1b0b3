// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <gtest/gtest.h>
#include <tetskin/io/tet_files.h>

#include <algorithm>

#include "command.h"

namespace tetskin {
namespace {

using test::CommandFolder;
using test::CommandResult;

class CageCommand : public testing::Test {
 protected:
  CommandResult cage(const std::vector<std::string>& arguments) const { return folder.run(TETSKIN_CAGE, arguments); }

  void expectRefused(const std::vector<std::string>& arguments, const std::string& word) const {
    const CommandResult result = cage(arguments);
    EXPECT_EQ(result.status, 2) << result.err;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_NE(result.err.find(word), std::string::npos) << result.err;
    EXPECT_FALSE(folder.exists("c.vtk"));
  }

  CommandFolder folder;
};

TEST_F(CageCommand, WritesACageThatHoldsEveryVertex) {
  const CommandResult result = cage({"--triangles", "8000", "--tets", "1000", "-o", "c.vtk", "--json", "c.json"});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto json = folder.json("c.json");
  EXPECT_NEAR(json["tets"].get<double>(), 1000, 100);
  EXPECT_EQ(json["vertices_outside"], 0);
  EXPECT_GE(json["min_dihedral_deg"], 10);
  EXPECT_LE(json["max_dihedral_deg"], 165);
  EXPECT_GE(json["components"], 1);
  EXPECT_GT(json["build_ms"], 0);
  const Result<TetMesh> read = loadTetMesh(folder.path("c.vtk"));
  ASSERT_TRUE(read.ok());
  EXPECT_EQ(read.value().tetCount(), json["tets"].get<std::size_t>());
  EXPECT_EQ(read.value().nodeCount(), json["nodes"].get<std::size_t>());
}

TEST_F(CageCommand, WritesEveryTetFormat) {
  for (const char* name : {"c.vtk", "c.msh", "c.ele"}) {
    ASSERT_EQ(cage({"--triangles", "2000", "--tets", "300", "-o", name, "--quiet"}).status, 0);
    EXPECT_TRUE(loadTetMesh(folder.path(name)).ok()) << name;
  }
}

TEST_F(CageCommand, LooseCagesHaveMoreVolumeAndOneShapeOfTet) {
  for (const std::string name : {"fit", "loose"}) {
    std::vector<std::string> arguments{"--triangles", "8000",  "--tets", "3000",
                                       "-o",          "c.vtk", "--json", name + ".json"};
    if (name == "loose") arguments.emplace_back("--loose");
    ASSERT_EQ(cage(arguments).status, 0);
  }
  const auto fit = folder.json("fit.json"), loose = folder.json("loose.json");
  EXPECT_LT(fit["volume_ratio"], 0.85 * loose["volume_ratio"].get<double>());
  EXPECT_NEAR(loose["min_dihedral_deg"], 60, 1e-3);
  EXPECT_NEAR(loose["max_dihedral_deg"], 90, 1e-3);
}

TEST_F(CageCommand, FlatSheetGetsAThinCage) {
  folder.write("sheet.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
  ASSERT_EQ(cage({"--mesh", "sheet.obj", "--tets", "300", "-o", "c.vtk", "--json", "c.json"}).status, 0);
  EXPECT_EQ(folder.json("c.json")["vertices_outside"], 0);
}

TEST_F(CageCommand, RefusesBadInput) {
  folder.write("empty.obj", "# nothing\n");
  folder.write("nan.obj", "v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n");
  folder.write("far.obj", "v 0 0 0\nv 1 0 0\nv 0 1e31 0\nf 1 2 3\n");
  folder.write("point.obj", "v 1 1 1\nv 1 1 1\nv 1 1 1\nf 1 2 3\n");
  folder.write("ok.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  expectRefused({"--mesh", "nowhere.obj", "-o", "c.vtk"}, "nowhere.obj");
  expectRefused({"--mesh", "empty.obj", "-o", "c.vtk"}, "empty.obj");
  expectRefused({"--mesh", "nan.obj", "-o", "c.vtk"}, "nan.obj:2");
  expectRefused({"--mesh", "far.obj", "-o", "c.vtk"}, "far.obj:3: vertex 2 has a coordinate beyond 1e18");
  expectRefused({"--mesh", "point.obj", "-o", "c.vtk"}, "point.obj");
  expectRefused({"--mesh", "ok.obj", "--tets", "0", "-o", "c.vtk"}, "--tets");
  expectRefused({"--mesh", "ok.obj", "--tets", "900000000", "-o", "c.vtk"}, "ok.obj");
  expectRefused({"--mesh", "ok.obj", "-o", "c.xyz"}, "c.xyz");
  expectRefused({"--mesh", "ok.obj", "-o", "no/such/c.vtk"}, "no/such/c.vtk");
  expectRefused({"--mesh", "ok.obj"}, "--output");
}

}  // namespace
}  // namespace tetskin
