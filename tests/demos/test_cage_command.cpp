// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <gtest/gtest.h>
#include <tetskin/core/cage.h>
#include <tetskin/io/files.h>

#include <algorithm>

#include "command.h"
#include "scenes/model.h"
#include "support/odd_meshes.h"

namespace tetskin {
namespace {

using test::CommandFolder;
using test::CommandResult;

class CageCommand : public testing::Test {
 protected:
  CommandResult cage(const std::vector<std::string>& arguments) const { return folder.run(TETSKIN_CAGE, arguments); }

  void expectRefused(const std::vector<std::string>& arguments, const std::string& word) const {
    test::expectRefused(cage(arguments), word);
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

TEST_F(CageCommand, WritesWhatIsKnownOfTheCage) {
  const scenes::ModelOptions model{scenes::BuiltIn::Serpent, "", "", 300, 2000};
  ASSERT_EQ(cage({"--triangles", "2000", "--tets", "300", "-o", "c.vtk", "--quiet"}).status, 0);
  const Result<Cage> read = loadCage(folder.path("c.vtk"));
  ASSERT_TRUE(read.ok()) << read.status().message;
  const scenes::Model built = scenes::loadModel(model);
  EXPECT_EQ(read.value().mesh.nodes, built.cage.mesh.nodes);
  EXPECT_EQ(read.value().vertexTets, built.cage.vertexTets);
  EXPECT_EQ(read.value().volumeFraction, built.cage.volumeFraction);
  EXPECT_EQ(read.value().masses, built.cage.masses);
  EXPECT_EQ(read.value().meshHash, built.cage.meshHash);
  EXPECT_TRUE(read.value().checkMesh(built.mesh).ok());
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
  test::expectRefused(drop("4000"), "c.vtk is not a cage of ");
  test::expectRefused(drop("4000"), "with tetskin_cage");
}

TEST_F(CageCommand, AWholeCageIsOfUseToOtherMeshesInIt) {
  folder.write("box.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
  folder.write("moved.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 0.9\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
  ASSERT_EQ(cage({"--mesh", "box.obj", "--tets", "100", "-o", "c.vtk", "--quiet"}).status, 0);
  const CommandResult fits =
      folder.run(TETSKIN_DROP, {"--mesh", "moved.obj", "--cage", "c.vtk", "--frames", "2", "--out", "o", "--quiet"});
  EXPECT_EQ(fits.status, 0) << fits.err;
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

TEST_F(CageCommand, CopiesNeedAFormatThatKeepsTheirMap) {
  const CommandResult refused = cage({"--model", "slotted_beam", "--tets", "1500", "-o", "c.ele", "--quiet"});
  test::expectRefused(refused, ".vtk");
}

TEST_F(CageCommand, LooseCagesHaveMoreVolumeAndOneShapeOfTet) {
  for (const std::string name : {"fit", "loose"}) {
    std::vector<std::string> arguments{"--triangles", "8000",  "--tets", "3000",
                                       "-o",          "c.vtk", "--json", name + ".json"};
    if (name == "loose") arguments.emplace_back("--no-fit");
    ASSERT_EQ(cage(arguments).status, 0);
  }
  const auto fit = folder.json("fit.json"), loose = folder.json("loose.json");
  EXPECT_LT(fit["volume_ratio"], 0.85 * loose["volume_ratio"].get<double>());
  EXPECT_NEAR(loose["min_dihedral_deg"], 60, 1e-3);
  EXPECT_NEAR(loose["max_dihedral_deg"], 90, 1e-3);
}

TEST_F(CageCommand, TellsOfVerticesThatNoTriangleUses) {
  folder.write("cut.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 5 5 5\nv 0 0 50\nf 1 2 3 4\n");
  const CommandResult result = cage({"--mesh", "cut.obj", "--tets", "300", "-o", "c.vtk", "--json", "c.json"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(folder.json("c.json")["loose_vertices"], 2);
  EXPECT_EQ(folder.json("c.json")["components"], 1);
  EXPECT_EQ(folder.json("c.json")["vertices_outside"], 0);
  EXPECT_NE(result.out.find("\n2 vertices shape no cage"), std::string::npos) << result.out;
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
  // Those that were refined before are found, with or without.
  ASSERT_TRUE(saveTetMesh(expected.mesh, folder.path("f.vtk")).ok());
  EXPECT_EQ(quadraticTets(made({})).value().size(), filled.tetCount());
  EXPECT_EQ(made({"--quadratic"}).mesh.tetCount(), expected.mesh.tetCount());
}

TEST_F(CageCommand, TellsInOneLineOfCurvedEdges) {
  folder.write("f.vtk",
               "# vtk DataFile Version 2.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 10 float\n0 0 0\n1 0 0\n0 1 "
               "0\n0 0 1\n.5 0 0\n.75 .75 0\n0 .5 0\n0 0 .5\n.5 0 .5\n0 .5 .5\nCELLS 1 11\n10 0 1 2 3 4 5 6 7 8 "
               "9\nCELL_TYPES 1\n24\n");
  const CommandResult result = cage({"--filled", "f.vtk", "-o", "c.vtk", "--quiet"});
  EXPECT_EQ(result.status, 0);
  EXPECT_EQ(result.err,
            "f.vtk: 1 tets of second order became quadratic tets, each of eight tets, 1 nodes on curved edges "
            "were moved to their middles, by up to 0.354\n");
  EXPECT_EQ(quadraticTets(loadCage(folder.path("c.vtk")).value()).value().size(), 1u);
}

TEST_F(CageCommand, TellsOfVerticesOutsideAFilledMesh) {
  ASSERT_TRUE(saveTetMesh(test::singleTet(), folder.path("f.vtk")).ok());
  folder.write("big.obj", "v 0 0 0\nv 3 0 0\nv 0 1 0\nf 1 2 3\n");
  const CommandResult result = cage({"--filled", "f.vtk", "--mesh", "big.obj", "-o", "c.vtk", "--quiet"});
  EXPECT_EQ(result.status, 1);
  EXPECT_NE(result.err.find("1 vertices lie outside the cage"), std::string::npos) << result.err;
}

TEST_F(CageCommand, RefusesBadInput) {
  folder.write("nan.obj", "v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n");
  folder.write("point.obj", "v 1 1 1\nv 1 1 1\nv 1 1 1\nf 1 2 3\n");
  folder.write("ok.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  expectRefused({"--mesh", "nowhere.obj", "-o", "c.vtk"}, "nowhere.obj");
  expectRefused({"--mesh", "nan.obj", "-o", "c.vtk"}, "nan.obj:2");
  expectRefused({"--mesh", "point.obj", "-o", "c.vtk"}, "point.obj");
  expectRefused({"--mesh", "ok.obj", "-o", "c.xyz"}, "c.xyz");
  expectRefused({"--mesh", "ok.obj", "-o", "no/such/c.vtk"}, "no/such/c.vtk");
  expectRefused({"--mesh", "ok.obj"}, "--output");
  ASSERT_TRUE(saveTetMesh(test::singleTet(), folder.path("f.vtk")).ok());
  expectRefused({"--filled", "nowhere.vtk", "-o", "c.vtk"}, "nowhere.vtk");
  expectRefused({"--filled", "f.vtk", "--tets", "100", "-o", "c.vtk"}, "takes no --tets");
  expectRefused({"--mesh", "ok.obj", "--quadratic", "-o", "c.vtk"}, "--filled");
}

}  // namespace
}  // namespace tetskin
