// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Texts loaded as files, and what several of them hold.
#pragma once

#include <gtest/gtest.h>
#include <tetskin/core/cage.h>
#include <tetskin/io/files.h>

#include <array>
#include <map>
#include <set>
#include <string>
#include <vector>

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

/// The cage in a file of this name and text.
inline Result<Cage> loadCageText(const std::string& name, const std::string& text, TetFileReport* report = nullptr) {
  const TempFolder folder;
  return loadCage(folder.write(name, text), report);
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

/// The tets read from a tet of second order: eight tets, whose node k is at the middle of an edge of these corners.
/// corners, middles  by edge 01, 02, 03, 12, 13, 23: indices of nodes
inline void expectQuadraticTet(const Result<Cage>& cage, const std::array<int, 4>& corners,
                               const std::array<int, 6>& middles) {
  ASSERT_TRUE(cage.ok()) << cage.status().message;
  const Result<std::vector<QuadraticTet>> tets = quadraticTets(cage.value());
  ASSERT_TRUE(tets.ok()) << tets.status().message;
  ASSERT_EQ(tets.value().size(), 1u);
  const QuadraticTet& tet = tets.value()[0];
  std::map<std::set<int>, int> middleOf;
  std::size_t e = 0;
  for (std::size_t a = 0; a < 4; ++a) {
    for (std::size_t b = a + 1; b < 4; ++b) middleOf[{tet.nodes[a], tet.nodes[b]}] = tet.nodes[4 + e++];
  }
  e = 0;
  for (std::size_t a = 0; a < 4; ++a) {
    for (std::size_t b = a + 1; b < 4; ++b) EXPECT_EQ((middleOf[{corners[a], corners[b]}]), middles[e++]);
  }
}

/// The vertices of a quad, one in a line.
inline const std::string kQuadCorners = "0 0 0\n1 0 0\n1 1 0\n0 1 0.1\n";

}  // namespace tetskin::test
