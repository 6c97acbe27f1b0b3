// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Texts loaded as files, and what several of them hold.
#pragma once

#include <gtest/gtest.h>
#include <tetskin/io/files.h>

#include <string>

#include "temp_folder.h"

namespace tetskin::test {

/// The surface in a file of this name and text.
inline Result<TriangleMesh> loadMeshText(const std::string& name, const std::string& text) {
  const TempFolder folder;
  return loadMesh(folder.write(name, text));
}

/// The tets in a file of this name and text.
inline Result<TetMesh> loadTetMeshText(const std::string& name, const std::string& text,
                                       TetFileReport* report = nullptr) {
  const TempFolder folder;
  return loadTetMesh(folder.write(name, text), report);
}

/// Two tets that share a face.
inline TetMesh twoTets() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.1, 1, 1}}, {{0, 1, 2, 3}, {1, 2, 3, 4}}};
}

inline void expectTwoTets(const Result<TetMesh>& mesh) {
  ASSERT_TRUE(mesh.ok()) << mesh.status().message;
  EXPECT_EQ(mesh.value().nodes, twoTets().nodes);
  EXPECT_EQ(mesh.value().tets, twoTets().tets);
}

/// The vertices of a quad, one in a line.
inline const std::string kQuadCorners = "0 0 0\n1 0 0\n1 1 0\n0 1 0.1\n";

}  // namespace tetskin::test
