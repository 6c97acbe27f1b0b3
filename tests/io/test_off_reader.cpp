// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "loaded_texts.h"

#include <tetskin/io/files.h>

namespace tetskin::test {
namespace {

using Triangle = std::array<int, 3>;

Result<TriangleMesh> loadOff(const std::string& text) {
  return loadMeshText("m.off", text);
}

void expectQuad(const std::string& text) {
  const Result<TriangleMesh> mesh = loadOff(text);
  ASSERT_TRUE(mesh.ok()) << mesh.status().message;
  ASSERT_EQ(mesh.value().vertexCount(), 4u);
  EXPECT_EQ(mesh.value().positions[3], Eigen::Vector3d(0, 1, 0.1));
  EXPECT_EQ(mesh.value().triangles, std::vector<Triangle>({{0, 1, 2}, {0, 2, 3}}));
  EXPECT_TRUE(mesh.value().groups.empty());
}

TEST(LoadOff, ReadsEveryFormOfHeader) {
  const std::string body = kQuadCorners + "4 0 1 2 3\n";
  for (const char* header : {"OFF\n4 1 0\n", "4 1 0\n", "OFF 4 1 0\n", "\t OFF4 1 0 # touches\n", "OFF\n4 1\n",
                             "# one\nOFF # two\n\n4\n1 0\n", "COFF\n4 1 4\n", "OFF\r\n4 1 0\r\n"}) {
    expectQuad(header + body);
  }
}

TEST(LoadOff, IgnoresWhatStandsBehindVerticesAndFaces) {
  expectQuad("COFF\n4 1 0\n0 0 0 255 0 0 255\n1 0 0 1 1 1\n\n1 1 0 # red\n0 1 .1 9\n4 0 1 2 3 0.5 0.5 0.5\n");
}

TEST(LoadOff, AFaceMaySpanLines) {
  expectQuad("OFF\n4 1 0\n0 0 0\n1 0\n0\n1 1 0\n0 1 0.1\n4 0 \n1 \n2\n3 \n\n");
}

TEST(LoadOff, ReadsNormals) {
  const Result<TriangleMesh> mesh = loadOff("NOFF\n3 1 0\n0 0 0 0 0 2\n1 0 0 0 3 4\n0 1 0 0 0 1\n3 0 1 2\n");
  ASSERT_TRUE(mesh.ok()) << mesh.status().message;
  ASSERT_EQ(mesh.value().normals.size(), 3u);
  EXPECT_LT((mesh.value().normals[1] - Eigen::Vector3f(0, 0.6f, 0.8f)).norm(), 1e-6f);
}

TEST(LoadOff, LeavesOutFacesOfFewerCorners) {
  const Result<TriangleMesh> mesh = loadOff("OFF\n4 4 0\n" + kQuadCorners + "3 0 1 2\n0\n2 0 1\n1 3\n");
  ASSERT_TRUE(mesh.ok()) << mesh.status().message;
  EXPECT_EQ(mesh.value().triangleCount(), 1u);
  expectError(loadOff("OFF\n4 1 0\n" + kQuadCorners + "2 0 1\n"), StatusCode::Empty,
              {"m.off: ", "no triangles", "export"});
}

TEST(LoadOff, RefusesWhatIsNoOffText) {
  expectError(loadOff("4OFF\n4 1 0\n"), kUnsupportedFormat, {"m.off:1:", "'4'", "save it"});
  expectError(loadOff("STCNnOFF\n3\n4 1 0\n"), kUnsupportedFormat, {"m.off:1:", "'STCNn'"});
  for (const char* text : {"", "OFF", "OFF BINARY\n\1\2", "OFF\n-1 2 0\n", "solid\n", "OFF\n1 20.5 0\n0 0 0\n"}) {
    expectError(loadOff(text), kMalformed, {"m.off:", "where a count is expected"});
  }
}

TEST(LoadOff, RefusesCountsThatTheFileCannotHold) {
  for (const char* header : {"OFF\n2000000000 1 0\n", "OFF\n4 2000000000 0\n", "OFF\n18446744073709551615 1 0\n"}) {
    expectError(loadOff(header + kQuadCorners + "3 0 1 2\n"), kMalformed,
                {"m.off:2: states ", " vertices and ", "too short", "complete"});
  }
  expectError(loadOff("OFF\n4 2 0\n" + kQuadCorners + "3 0 1 2\n"), kMalformed, {"m.off:", "no face"});
}

TEST(LoadOff, NamesTheLineOfAFault) {
  expectError(loadOff("OFF\n3 1 0\n0 0 0\n1 0 0\n0 inf 0\n3 0 1 2\n"), kNonFinite, {"m.off:5: vertex 2", "correct it"});
  expectError(loadOff("OFF\n4 1 0\n" + kQuadCorners + "3 0 1 4\n"), kIndexOutOfRange,
              {"m.off:7: ", "vertex 4", "there are 4"});
  expectError(loadOff("OFF\n4 1 0\n" + kQuadCorners + "3 0 1 -1\n"), kMalformed, {"m.off:7: "});
}

}  // namespace
}  // namespace tetskin::test
