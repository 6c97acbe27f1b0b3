// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// --self-contact in the programs that drop, pile and drag bodies.
#include <tetskin/core/src/base/mesh/winding_tree.h>
#include <tetskin/io/files.h>

#include "drop_run.h"

namespace tetskin::test {
namespace {

using Eigen::Vector3d;

class SelfContact : public DropRun {
 protected:
  /// Runs with the options that all runs here need. A sheet encloses nothing, so it has no inside.
  CommandResult dropSheet(std::vector<std::string> more) const {
    folder.write("sheet.obj", "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nf 1 3 2\nf 1 4 3\n");
    more.insert(more.begin(), {"--mesh", "sheet.obj", "--tets", "60", "--frames", "2", "--out", "o", "--no-view"});
    return drop(more);
  }
  TriangleMesh frame(const std::string& name) const { return loadMesh(folder.path(name)).value(); }
};

/// By vertex: whether the point above it by a thousandth of the size is inside the surface. This is also the case at
/// the roots of horns.
std::vector<bool> areCovered(const TriangleMesh& mesh) {
  const double above = 1e-3 * boundingBox(mesh.positions).sizes().maxCoeff();
  std::vector<Vector3d> normals(mesh.vertexCount(), Vector3d::Zero());
  for (const auto& triangle : mesh.triangles) {
    const auto corner = [&](int k) { return mesh.positions[static_cast<std::size_t>(triangle[k])]; };
    const Vector3d normal = (corner(1) - corner(0)).cross(corner(2) - corner(0));
    for (const int v : triangle) normals[static_cast<std::size_t>(v)] += normal;
  }
  const WindingTree tree(mesh);
  std::vector<bool> covered;
  for (std::size_t v = 0; v < normals.size(); ++v) {
    covered.push_back(tree.windingNumber(mesh.positions[v] + above * normals[v].normalized()) > kInside);
  }
  return covered;
}

TEST_F(SelfContact, KeepsTheSerpentOutOfItselfInEveryFrame) {
  ASSERT_EQ(drop({"--triangles", "8000", "--tets", "1000", "--every", "15", "--no-view"}).status, 0);
  EXPECT_EQ(folder.json("out/drop/summary.json")["self_contact"], "on");
  const std::vector<bool> before = areCovered(frame("out/drop/frame_0000.obj"));
  for (int k = 15; k < 240; k += 15) {
    char name[40];
    std::snprintf(name, sizeof name, "out/drop/frame_%04d.obj", k);
    const std::vector<bool> now = areCovered(frame(name));
    std::size_t sunk = 0;
    for (std::size_t v = 0; v < now.size(); ++v) sunk += now[v] && !before[v];
    // 6.8 % without self-contact.
    EXPECT_LT(static_cast<double>(sunk), 0.005 * static_cast<double>(now.size())) << name;
  }
}

TEST_F(SelfContact, IsOffWhereContactIsAtTheCageAndOnWhereItIsAskedFor) {
  folder.write("box.obj", boxObj());
  const auto self = [&](const std::vector<std::string>& more) {
    std::vector<std::string> all = {"--mesh", "box.obj", "--tets", "60", "--frames", "2", "--out", "o", "--no-view"};
    all.insert(all.end(), more.begin(), more.end());
    const CommandResult result = drop(all);
    EXPECT_EQ(result.status, 0) << result.err;
    const std::string word = folder.json("o/summary.json")["self_contact"];
    EXPECT_NE(result.out.find("self-contact           " + word), std::string::npos) << result.out;
    return word;
  };
  EXPECT_EQ(self({}), "on");
  EXPECT_EQ(self({"--self-contact", "off"}), "off");
  EXPECT_EQ(self({"--contact", "cage"}), "off");
  EXPECT_EQ(self({"--contact", "cage", "--self-contact", "on"}), "on");
}

TEST_F(SelfContact, IsDoneWithoutWhereTheMeshIsOpenAndThatIsSaid) {
  const CommandResult result = dropSheet({});
  ASSERT_EQ(result.status, 0) << result.err;
  const std::string line = "Self-contact is off: sheet.obj: ";
  EXPECT_NE(result.out.find(line), std::string::npos) << result.out;
  const auto json = folder.json("o/summary.json");
  EXPECT_EQ(json["self_contact"], "refused");
  EXPECT_EQ(json["self_contact_refusal"].get<std::string>().rfind("sheet.obj: ", 0), 0u);
  EXPECT_EQ(dropSheet({"--self-contact", "off"}).out.find(line), std::string::npos);
  EXPECT_EQ(dropSheet({"--quiet"}).out, "");
}

}  // namespace
}  // namespace tetskin::test
