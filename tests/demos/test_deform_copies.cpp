// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/cage.h>
#include <tetskin/io/files.h>
#include <tetskin/io/obj_sequence.h>

#include <sstream>

#include "deform_run.h"
#include "support/two_plates.h"

namespace tetskin::test {
namespace {

using Eigen::Vector3d;

class DeformCopies : public DeformRun {};

/// Writes m.obj, two plates, and rest.vtk, their cage of duplicate elements.
test::TwoPlates writePlates(const CommandFolder& folder) {
  test::TwoPlates plates = test::platesOfCopies();
  const ObjLayout layout = ObjLayout::create(plates.mesh);
  EXPECT_TRUE(layout.writeTo(folder.path("m.obj"), viewOf(std::as_const(plates.mesh.positions))).ok());
  // The mesh as the tools will read it.
  plates.mesh = loadMesh(folder.path("m.obj")).value();
  plates.cage.meshHash = positionsHash(plates.mesh.positions);
  EXPECT_TRUE(saveCage(plates.cage, folder.path("rest.vtk")).ok());
  return plates;
}

TEST_F(DeformCopies, OnlyThePlateWhoseCopyOfTheTetsMovesMoves) {
  const test::TwoPlates plates = writePlates(folder);
  TetMesh moved = plates.cage.mesh;
  for (std::size_t n = moved.nodeCount() / 2; n < moved.nodeCount(); ++n) moved.nodes[n] += Vector3d(0.5, 2, -1);
  for (const std::string now : {"now.vtk", "now.ele"}) {  // files without a map
    ASSERT_TRUE(saveTetMesh(moved, folder.path(now)).ok());
    for (const char* interpolation : {"linear", "quadratic"}) {
      const CommandResult result = deform({"--deformed", now, "--interpolation", interpolation});
      ASSERT_EQ(result.status, 0) << result.err;
      const auto written = test::objPositions(folder.read("o.obj"));
      ASSERT_EQ(written.size(), plates.mesh.vertexCount());
      for (std::size_t v = 0; v < written.size(); ++v) {
        const Vector3d direction = Vector3d(written[v].data()) - plates.mesh.positions[v];
        EXPECT_LT((direction - (plates.upper(v) ? Vector3d(0.5, 2, -1) : Vector3d(0, 0, 0))).norm(), 1e-5) << v;
      }
    }
  }
}

TEST_F(DeformCopies, TakesADeformedCageWithItsTetsInAnotherOrder) {
  test::TwoPlates plates = writePlates(folder);
  std::reverse(plates.cage.mesh.tets.begin(), plates.cage.mesh.tets.end());
  for (Tet& tet : plates.cage.mesh.tets) std::swap(tet[0], tet[3]);
  ASSERT_TRUE(saveTetMesh(plates.cage.mesh, folder.path("now.vtk")).ok());
  const CommandResult result = deform();
  ASSERT_EQ(result.status, 0) << result.err;
  const auto written = test::objPositions(folder.read("o.obj"));
  for (std::size_t v = 0; v < written.size(); ++v) {
    EXPECT_LT((Vector3d(written[v].data()) - plates.mesh.positions[v]).norm(), 1e-5);
  }
}

TEST_F(DeformCopies, RefusesADeformedCageWithItsNodesInAnotherOrder) {
  test::TwoPlates plates = writePlates(folder);
  TetMesh other = plates.cage.mesh;
  const int upper = static_cast<int>(other.nodeCount() / 2);
  std::swap(other.nodes[0], other.nodes[static_cast<std::size_t>(upper) + 1]);
  for (Tet& tet : other.tets) {
    for (int& node : tet) node = node == 0 ? upper + 1 : node == upper + 1 ? 0 : node;
  }
  ASSERT_TRUE(saveTetMesh(other, folder.path("other.vtk")).ok());
  expectRefused(with({"--deformed", "other.vtk"}),
                {"other.vtk: has ", " tet of nodes 0, ", "but the rest cage rest.vtk has ", "same order"});
}

TEST_F(DeformCopies, RefusesTheCageOfAnotherMesh) {
  const test::TwoPlates plates = writePlates(folder);
  TriangleMesh other = plates.mesh;
  other.positions[5].x() += 0.001;
  const ObjLayout layout = ObjLayout::create(other);
  ASSERT_TRUE(layout.writeTo(folder.path("other.obj"), viewOf(std::as_const(other.positions))).ok());
  expectRefused(with({"--mesh", "other.obj", "--deformed", "rest.vtk"}),
                {"rest.vtk is not a cage of other.obj", "build a cage for this one with tetskin_cage"});
  std::string text = folder.read("rest.vtk");
  text.replace(text.find("vertex_tets 1 364"), 17, "vertex_tets 1 365");
  folder.write("wrong.vtk", text);
  expectRefused(with({"--cage", "wrong.vtk", "--deformed", "rest.vtk"}), {"wrong.vtk:"});
}

}  // namespace
}  // namespace tetskin::test
