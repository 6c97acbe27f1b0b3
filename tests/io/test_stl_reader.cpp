// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "loaded_texts.h"

#include <tetskin/core/src/base/bytes.h>
#include <tetskin/io/files.h>

namespace tetskin::test {
namespace {

const std::string kFacet =
    " facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n   vertex 0 1e0 0\n  endloop\n endfacet\n";

/// A binary file of one triangle that claims this many.
std::string binaryStl(std::uint32_t triangles, const std::string& begin = "") {
  std::string bytes = begin + std::string(80 - begin.size(), '\0');
  appendLittleEndian(triangles, bytes);
  for (const float number : {0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.5f}) {
    appendLittleEndian(number, bytes);
  }
  return bytes + std::string(2, '\0');
}

TEST(LoadStl, ReadsStlOfBothKinds) {
  const TriangleMesh text = loadMeshText("m.STL", "solid two\n" + kFacet + kFacet + "endsolid two\n").value();
  EXPECT_EQ(text.vertexCount(), 6u);
  EXPECT_EQ(text.triangles[1], (std::array<int, 3>{3, 4, 5}));
  EXPECT_EQ(text.positions[5], Eigen::Vector3d(0, 1, 0));
  const std::string empty = "solid empty\nendsolid empty\n";
  for (const std::string& begin : {empty, std::string(" "), std::string("\t ")}) {
    EXPECT_EQ(loadMeshText("m.stl", begin + "solid two\n" + kFacet).value().triangleCount(), 1u) << begin;
  }
  for (const char* begin : {"", "solid", "any"}) {
    const TriangleMesh binary = loadMeshText("m.stl", binaryStl(1, begin)).value();
    ASSERT_EQ(binary.triangleCount(), 1u) << begin;
    EXPECT_EQ(binary.positions[2], Eigen::Vector3d(0, 1, 0.5)) << begin;
  }
}

TEST(LoadStl, RefusesDamagedStl) {
  // In 32-bit arithmetic, 2147483649 triangles take as many bytes as one.
  for (const std::uint32_t count : {2u, 2000000000u, 2147483649u, 0xFFFFFFFFu}) {
    for (const char* begin : {"", "solid"}) {
      expectError(loadMeshText("m.stl", binaryStl(count, begin)), kMalformed,
                  {"m.stl: states " + std::to_string(count) + " triangles", "contains 134 bytes", "complete"});
    }
  }
  expectError(loadMeshText("m.stl", "solid x\n facet\n outer loop\n vertex 0 0 0\n"), kMalformed,
              {"m.stl:4: ", "within"});
  expectError(loadMeshText("m.stl", "solid x\n vertex 0 0\n"), kMalformed, {"m.stl:2: ", "three numbers"});
  expectError(loadMeshText("m.stl", "solid x\n vertex 0 0 1e30\n"), kNonFinite, {"vertex 0"});
  for (const char* empty : {"", "solid x\nendsolid x\n", "# nothing"}) {
    expectError(loadMeshText("m.stl", empty), StatusCode::Empty, {"m.stl", "no triangles"});
  }
}

}  // namespace
}  // namespace tetskin::test
