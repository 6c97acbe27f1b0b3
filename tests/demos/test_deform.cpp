// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/cage/create_cage.h>
#include <tetskin/core/mesh_skin.h>
#include <tetskin/core/src/base/mesh/uniform_refinement.h>
#include <tetskin/io/files.h>
#include <tetskin/io/obj_sequence.h>

#include <sstream>

#include "deform_run.h"
#include "support/odd_meshes.h"

namespace tetskin::test {
namespace {

using Eigen::Vector3d;

class Deform : public DeformRun {};

/// Two tets on either side of a triangle, the second of them inside out, and a triangle that sticks out of the first
/// tet.
void writeTwoTets(const CommandFolder& folder) {
  TetMesh cage;
  cage.nodes = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, -1}};
  cage.tets = {{0, 1, 2, 3}, {0, 1, 2, 4}};
  ASSERT_TRUE(saveTetMesh(cage, folder.path("rest.vtk")).ok());
  ASSERT_TRUE(saveTetMesh(cage, folder.path("now.vtk")).ok());
  folder.write("m.obj",
               "v 0.125 0.25 0.25\nv 0.25 0.125 -0.5\nv -0.125 0.25 0.25\nvt 0 0\nvn 1 0 0\nf 1/1/1 2/1/1 3/1/1\n");
}

TEST_F(Deform, DumpsTetAndWeightsOfEveryVertex) {
  writeTwoTets(folder);
  ASSERT_EQ(deform({"--dump-embedding", "e.csv"}).status, 0);
  EXPECT_EQ(folder.read("e.csv"),
            "vertex,tet,b0,b1,b2,b3,inside\n0,0,0.375,0.125,0.25,0.25,1\n1,1,0.125,0.25,0.125,0.5,1\n"
            "2,0,0.625,-0.125,0.25,0.25,0\n");
}

/// A tet of second order, whose nodes a map moves.
void writeQuadraticTet(const CommandFolder& folder, const std::string& name, const Map& map) {
  const TetMesh mesh = refineUniformly({{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2}}, {{0, 1, 2, 3}}}).mesh;
  std::ostringstream text;
  text.precision(17);
  text << "# vtk DataFile Version 2.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 10 double\n";
  for (const auto& [a, b] : {std::pair(0, 0), {1, 1}, {2, 2}, {3, 3}, {0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}}) {
    text << map(0.5 * (mesh.nodes[a] + mesh.nodes[b])).transpose() << "\n";
  }
  folder.write(name, text.str() + "CELLS 1 11\n10 0 1 2 3 4 5 6 7 8 9\nCELL_TYPES 1\n24\n");
}

TEST_F(Deform, TakesTetsOfSecondOrderAsTheyAreDeformed) {
  folder.write("m.obj", "v 0.125 0.25 0.25\nv 0.25 0.125 0.5\nv 1 0.25 0.25\nf 1 2 3\n");
  mesh = loadMesh(folder.path("m.obj")).value();
  // Squeezed along one axis after the other, so that each of the diagonals is the shortest.
  for (int axis = 0; axis < 3; ++axis) {
    const Map map = [axis](const Vector3d& p) -> Vector3d {
      Vector3d x = p + 0.2 * Vector3d(p.y() * p.y(), p.x() * p.z(), p.x() * p.x());
      x[axis] *= 0.25;
      return x;
    };
    writeQuadraticTet(folder, "rest.vtk", still);
    writeQuadraticTet(folder, "now.vtk", map);
    const CommandResult result = deform({"--interpolation", "quadratic"});
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(result.err, "") << "nodes of the deformed tet stay on its curved edges";
    const auto moved = test::objPositions(folder.read("o.obj"));
    for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
      EXPECT_LT((Vector3d(moved[v].data()) - map(mesh.positions[v])).norm(), 1e-5);
    }
  }
}

TEST_F(Deform, WritesNormalsIfAskedFor) {
  writeTwoTets(folder);
  for (const char* normals : {"transformed", "recomputed"}) {
    ASSERT_EQ(deform({"--normals", normals}).status, 0);
    EXPECT_EQ(loadMesh(folder.path("o.obj")).value().normals.size(), 3u) << normals;
  }
  ASSERT_EQ(deform({"--normals", "none"}).status, 0);
  EXPECT_EQ(folder.read("o.obj").find("vn "), std::string::npos);
}

TEST_F(Deform, KeepsTheDigitsOfASurfaceFarOut) {
  writeTwoTets(folder);
  cage = loadTetMesh(folder.path("rest.vtk")).value();
  writeDeformed([](const Vector3d& p) -> Vector3d { return p + Vector3d(1e6, 0, 0); });
  ASSERT_EQ(deform().status, 0);
  const auto moved = test::objPositions(folder.read("o.obj"));
  EXPECT_NEAR(moved[0][0], 1e6 + 0.125, 1e-6);
  EXPECT_NEAR(moved[2][0], 1e6 - 0.125, 1e-6);
}

}  // namespace
}  // namespace tetskin::test
