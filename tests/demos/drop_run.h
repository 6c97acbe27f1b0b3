// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Runs tetskin_drop for its tests, and has small models for it.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "command.h"

namespace tetskin::test {

/// A box around the origin, as an OBJ with quads, texture coordinates, groups and a comment.
inline std::string boxObj(double half = 0.4, const char* firstX = nullptr) {
  std::string text = "# a box\nmtllib box.mtl\n";
  for (int k = 0; k < 8; ++k) {
    const std::string x = k == 0 && firstX ? firstX : std::to_string(k & 1 ? half : -half);
    text += "v " + x + " " + std::to_string(k & 2 ? half : -half) + " " + std::to_string(k & 4 ? half : -half) + "\n";
  }
  text += "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\ng sides\nusemtl red\nf 1/1 3/2 4/3 2/4\nf 5/1 6/2 8/3 7/4\n";
  text += "f 1/1 2/2 6/3 5/4\nf 3/1 7/2 8/3 4/4\ng caps\nusemtl blue\nf 1/1 5/2 7/3 3/4\nf 2/1 4/2 8/3 6/4\n";
  return text;
}

/// One cube of edge 1 around the origin, as six tets.
inline std::string cubeVtk() {
  std::string text = "# vtk DataFile Version 2.0\ncube\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 8 double\n";
  for (int k = 0; k < 8; ++k) {
    text += std::string(k & 1 ? "0.5 " : "-0.5 ") + (k & 2 ? "0.5 " : "-0.5 ") + (k & 4 ? "0.5\n" : "-0.5\n");
  }
  text += "CELLS 6 30\n4 0 1 3 7\n4 0 3 2 7\n4 0 2 6 7\n4 0 6 4 7\n4 0 4 5 7\n4 0 5 1 7\nCELL_TYPES 6\n";
  return text + "10\n10\n10\n10\n10\n10\n";
}

class DropRun : public testing::Test {
 protected:
  CommandResult drop(std::vector<std::string> arguments) const { return folder.run(TETSKIN_DROP, arguments); }

  CommandFolder folder;
};

}  // namespace tetskin::test
