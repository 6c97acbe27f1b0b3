// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/cage.h>
#include <tetskin/io/files.h>

#include <algorithm>

#include "command.h"
#include "scenes/model.h"
#include "support/odd_meshes.h"

namespace tetskin::test {
namespace {

class CageCommand : public testing::Test {
 protected:
  CommandResult cage(const std::vector<std::string>& arguments) const { return folder.run(TETSKIN_CAGE, arguments); }

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
  ASSERT_EQ(cage({"--triangles", "8000", "--tets", "1000", "--no-fit", "-o", "c.vtk", "--json", "c.json"}).status, 0);
  EXPECT_NEAR(folder.json("c.json")["min_dihedral_deg"], 60, 1e-3) << "all tets keep one shape";
}

TEST_F(CageCommand, ASplitCageIsOfUseToItsMeshAlone) {
  ASSERT_EQ(cage({"--model", "slotted_beam", "--triangles", "2000", "--tets", "1500", "-o", "c.vtk", "--quiet"}).status,
            0);
  const auto drop = [&](const char* triangles) {
    return folder.run(TETSKIN_DROP, {"--model", "slotted_beam", "--triangles", triangles, "--cage", "c.vtk", "--frames",
                                     "2", "--out", "o", "--quiet"});
  };
  const CommandResult fits = drop("2000");
  EXPECT_EQ(fits.status, 0) << fits.err;
  expectRefused(drop("4000"), "c.vtk is not a cage of ");
  expectRefused(drop("4000"), "with tetskin_cage");
}

TEST_F(CageCommand, PaintsMapsOfTheMeshsFile) {
  const std::string box =
      "v 0 0 0 0 0 0\nv 4 0 0 1 0 0\nv 0 1 0 0 0 0\nv 4 1 0 1 0 0\nv 0 0 1 0 0 0\nv 4 0 1 1 0 0\nv 0 1 1 0 0 0\n"
      "v 4 1 1 1 0 0\nf 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
  folder.write("box.obj", box);
  const auto painted = [&](const std::vector<std::string>& maps) {
    std::vector<std::string> arguments = {"--mesh", "box.obj", "--tets", "200", "-o", "c.vtk", "--quiet"};
    arguments.insert(arguments.end(), maps.begin(), maps.end());
    return cage(arguments);
  };
  const CommandResult result =
      painted({"--stiffness-map", "red:1:4", "--density-map", "green:2:3", "--damping-map", "blue"});
  ASSERT_EQ(result.status, 0) << result.err;
  const Result<Cage> read = loadCage(folder.path("c.vtk"));
  ASSERT_TRUE(read.ok()) << read.status().message;
  EXPECT_EQ(read.value().paintedDensity, std::vector<double>(read.value().mesh.tetCount(), 2.0));
  EXPECT_EQ(read.value().paintedDamping, std::vector<double>(read.value().mesh.tetCount(), 0.0));
  const auto [least, greatest] =
      std::minmax_element(read.value().paintedStiffness.begin(), read.value().paintedStiffness.end());
  EXPECT_LT(*least, 1.3);
  EXPECT_GT(*greatest, 3.2);
  expectRefused(painted({"--stiffness-map", "rot"}), "box.obj: has no map 'rot'");
  expectRefused(painted({"--stiffness-map", "red:1"}), "'red:1' is not NAME:LOW:HIGH");
  expectRefused(painted({"--stiffness-map", "red"}), "the stiffness map is 0.000000 at vertex 0");
}

TEST_F(CageCommand, TellsInOneLineWhatOfAMeshWasNotRead) {
  folder.write("box.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 2\nf 2/7 3/7 4/7\nf 3 1 4\n");
  const CommandResult result = cage({"--mesh", "box.obj", "--tets", "100", "-o", "c.vtk", "--quiet"});
  EXPECT_EQ(result.status, 0);
  EXPECT_EQ(
      result.err,
      "box.obj: 1 face of fewer than 3 corners left out (first in line 7), 1 face read without texture coordinates "
      "or normals that do not exist (first in line 8)\n");
}

TEST_F(CageCommand, MakesQuadraticTetsOfAFilledMesh) {
  const TetMesh filled = test::latticeCage(3, 1, 1);
  ASSERT_TRUE(saveTetMesh(filled, folder.path("f.vtk")).ok());
  const auto made = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"--filled", "f.vtk", "-o", "c.vtk", "--json", "c.json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const CommandResult result = cage(arguments);
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(result.err, "");
    return loadCage(folder.path("c.vtk")).value();
  };
  const Cage plain = made({});
  EXPECT_EQ(plain.mesh.tets, filled.tets);
  EXPECT_TRUE(plain.quadraticTet.empty());
  EXPECT_EQ(folder.json("c.json")["quadratic_tets"], 0);
  const Cage each = made({"--quadratic"}), expected = refineQuadratic(filled).value();
  EXPECT_EQ(each.mesh.nodes, expected.mesh.nodes);
  EXPECT_EQ(each.quadraticTet, expected.quadraticTet);
  EXPECT_EQ(folder.json("c.json")["quadratic_tets"], filled.tetCount());
  // Those that the file has stay, with or without.
  ASSERT_TRUE(saveCage(expected, folder.path("f.vtk")).ok());
  EXPECT_EQ(quadraticTets(made({})).value().size(), filled.tetCount());
  EXPECT_EQ(made({"--quadratic"}).mesh.tetCount(), expected.mesh.tetCount());
}

TEST_F(CageCommand, TellsOfVerticesOutsideAFilledMesh) {
  ASSERT_TRUE(saveTetMesh(test::singleTet(), folder.path("f.vtk")).ok());
  folder.write("big.obj", "v 0 0 0\nv 3 0 0\nv 0 1 0\nf 1 2 3\n");
  const CommandResult result = cage({"--filled", "f.vtk", "--mesh", "big.obj", "-o", "c.vtk", "--quiet"});
  EXPECT_EQ(result.status, 1);
  EXPECT_NE(result.err.find("1 vertices lie outside the cage"), std::string::npos) << result.err;
}

}  // namespace
}  // namespace tetskin::test
