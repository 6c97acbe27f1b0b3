// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Runs tetskin_deform.
#pragma once

#include <gtest/gtest.h>
#include <tetskin/cage/create_cage.h>
#include <tetskin/io/files.h>
#include <tetskin/io/obj_sequence.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "command.h"
#include "scenes/serpent.h"

namespace tetskin::test {

using Map = std::function<Eigen::Vector3d(const Eigen::Vector3d&)>;

class DeformRun : public testing::Test {
 protected:
  /// Writes m.obj, the serpent, and rest.vtk, its cage.
  void makeModel(std::size_t triangles = 6000, std::size_t tets = 3000) {
    mesh = scenes::makeSerpent({triangles});
    CageOptions options;
    options.targetTets = tets;
    cage = createCage(mesh, options).value().mesh;
    ASSERT_TRUE(ObjLayout::create(mesh).writeTo(folder.path("m.obj"), viewOf(std::as_const(mesh.positions))).ok());
    ASSERT_TRUE(saveTetMesh(cage, folder.path("rest.vtk")).ok());
  }

  /// Writes the cage as a map moves it.
  void writeDeformed(const Map& map, const std::string& name = "now.vtk") const {
    TetMesh moved = cage;
    for (Eigen::Vector3d& p : moved.nodes) p = map(p);
    ASSERT_TRUE(saveTetMesh(moved, folder.path(name)).ok());
  }

  /// The usual files and further options, whose values replace those of the same name.
  static std::vector<std::string> with(const std::vector<std::string>& others) {
    std::vector<std::string> arguments{"--mesh", "m.obj", "--cage", "rest.vtk", "--deformed", "now.vtk", "-o", "o.obj"};
    for (std::size_t k = 0; k < others.size(); ++k) {
      const auto entry = std::find(arguments.begin(), arguments.end(), others[k]);
      if (entry == arguments.end()) {
        arguments.push_back(others[k]);
      } else {
        entry[1] = others[++k];
      }
    }
    return arguments;
  }
  CommandResult deform(const std::vector<std::string>& others = {}) const {
    return folder.run(TETSKIN_DEFORM, with(others));
  }

  /// Expects exit status 2, one line on standard error that mentions the words, and no files written.
  void expectRefused(const std::vector<std::string>& arguments, const std::vector<std::string>& words) const {
    const CommandResult result = folder.run(TETSKIN_DEFORM, arguments);
    SCOPED_TRACE(testing::PrintToString(arguments));
    EXPECT_EQ(result.status, 2) << result.err;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    for (const std::string& word : words) EXPECT_NE(result.err.find(word), std::string::npos) << result.err;
    EXPECT_FALSE(folder.exists("o.obj"));
  }

  CommandFolder folder;
  TriangleMesh mesh;
  TetMesh cage;
};

inline Eigen::Vector3d still(const Eigen::Vector3d& p) {
  return p;
}

}  // namespace tetskin::test
