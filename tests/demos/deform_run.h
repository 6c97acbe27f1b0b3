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

struct Error {
  double rms = 0.0, max = 0.0;  ///< relative to the box's diagonal
};

/// Distances between two surfaces, relative to the diagonal of the first one's bounding box.
inline Error distances(const std::vector<Eigen::Vector3d>& exact, const std::vector<std::array<double, 3>>& surface,
                       double diagonal) {
  Error error;
  for (std::size_t v = 0; v < exact.size(); ++v) {
    const double distance = (exact[v] - Eigen::Vector3d(surface[v].data())).norm() / diagonal;
    error.rms += distance * distance / static_cast<double>(exact.size());
    error.max = std::max(error.max, distance);
  }
  error.rms = std::sqrt(error.rms);
  return error;
}

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

  /// How far the written surface is from where a map takes the mesh.
  Error errorOf(const Map& map, const std::string& interpolation) const {
    writeDeformed(map);
    const CommandResult result = deform({"--interpolation", interpolation});
    EXPECT_EQ(result.status, 0) << result.err;
    std::vector<Eigen::Vector3d> exact;
    for (const Eigen::Vector3d& p : mesh.positions) exact.push_back(map(p));
    return distances(exact, test::objPositions(folder.read("o.obj")), boundingBox(mesh.positions).diagonal().norm());
  }

  void expectGain(const Map& map, double gain) const {
    const Error linear = errorOf(map, "linear"), quadratic = errorOf(map, "quadratic");
    EXPECT_LT(gain * quadratic.rms, linear.rms) << "gain " << linear.rms / quadratic.rms;
    EXPECT_LE(quadratic.max, linear.max);
  }

  /// The origin of the maps: bend, twist and so on.
  Eigen::Vector3d centre() const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& p : cage.nodes) sum += p;
    return sum / static_cast<double>(cage.nodeCount());
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
