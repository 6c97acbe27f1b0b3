// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Cages as files, and files as text.
#pragma once

#include <gtest/gtest.h>
#include <tetskin/core/cage.h>
#include <tetskin/io/files.h>

#include <string>

#include "loaded_texts.h"
#include "temp_folder.h"

namespace tetskin::test {

/// A cage of two tets with every field filled in, in numbers of one or two digits.
inline Cage smallCage() {
  Cage cage(twoTets());
  cage.vertexTets = {1, 0, 1};
  cage.volumeFraction = {0.5, 1};
  cage.stiffnessFactor = {2, 0.25};
  cage.masses = {1, 2, 3, 4, 5};
  cage.component = {0, 1};
  cage.sourceTet = {7, 7};
  for (std::size_t k = 0; k < 2 * kFineTets; ++k) cage.fineVolumeFraction.push_back(static_cast<std::uint8_t>(255 - k));
  cage.meshHash = 0x89ABCDEF01234567u;
  return cage;
}

inline std::string textOf(const Cage& cage) {
  const TempFolder folder;
  EXPECT_TRUE(saveCage(cage, folder.path("c.vtk")).ok());
  return TempFolder::read(folder.path("c.vtk"));
}

inline Result<Cage> loadCageText(const std::string& text, TetFileReport* report = nullptr) {
  return loadCageText("c.vtk", text, report);
}

inline std::string with(std::string text, const std::string& old, const std::string& replacement) {
  const std::size_t index = text.find(old);
  EXPECT_NE(index, std::string::npos) << old;
  return index == std::string::npos ? text : text.replace(index, old.size(), replacement);
}

inline const std::string kTwoTets =
    "# vtk DataFile Version 2.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 5 double\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n"
    "0.1 1 1\nCELLS 2 10\n4 0 1 2 3\n4 1 2 3 4\nCELL_TYPES 2\n10\n10\n";

}  // namespace tetskin::test
