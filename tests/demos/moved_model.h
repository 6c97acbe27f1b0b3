// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// For tests of recipes: the serpent, twisted by its cage, as its skin has it.
#pragma once

#include "support/drawn_by_bones.h"

#include <cmath>

#include "scenes/model.h"
#include "scenes/twist.h"

namespace tetskin::test {

/// A kind of bones.
struct BoneKind {
  const char* name;
  Interpolation interpolation;
  bool gradients;
  double meanDegrees;  ///< of normals off the skin's own, at most; infinite if they do not turn

  bool turnsNormals() const { return meanDegrees < HUGE_VAL; }
};
constexpr BoneKind kBoneKinds[] = {{"linear", Interpolation::Linear, false, HUGE_VAL},
                                   {"linear with gradients", Interpolation::Linear, true, 4.0},
                                   {"quadratic", Interpolation::Quadratic, false, 0.5}};

/// The largest side of the model at rest is `size`.
struct MovedModel {
  explicit MovedModel(const BoneKind& kind, BoneLayout layout, std::size_t triangles = 20000) {
    scenes::ModelOptions options;
    options.triangles = triangles;
    model = scenes::loadModel(options);
    SkinOptions skinOptions;
    skinOptions.interpolation = Interpolation::Quadratic;
    skinOptions.normals = Normals::Transformed;
    skinOptions.disableQuadratic = kind.interpolation == Interpolation::Linear;
    EXPECT_TRUE(skin.bind(model.cage, model.mesh, skinOptions).ok());
    skinned = skinnedMeshOf(*skin.binding()).value();
    PaletteOptions paletteOptions;
    paletteOptions.disableQuadratic = skinOptions.disableQuadratic;
    paletteOptions.gradients = kind.gradients;
    paletteOptions.layout = layout;
    palette = BonePalette<float>::create(skin.binding(), paletteOptions).value();
    const scenes::Twist twist = scenes::twistOf(boundingBox(model.cage.mesh.nodes), 4.0);
    for (const Eigen::Vector3d& p : model.cage.mesh.nodes) nodes.push_back(twist.point(p).cast<float>());
    EXPECT_EQ(skin.update(viewOf(std::as_const(nodes))), StatusCode::Ok);
    for (const Eigen::Vector3d& p : model.mesh.positions) restPositions.push_back(p.cast<float>());
    for (const Eigen::Vector3d& n : restNormals(model.mesh)) normals.push_back(n.cast<float>());
    size = boundingBox(model.mesh.positions).sizes().maxCoeff();
  }

  /// Farthest of these positions, of a number of vertices, from where the skin has them, in sizes of the model.
  double farthest(const std::vector<Eigen::Vector3f>& positions) const {
    double longest = 0.0;
    for (std::size_t v = 0; v < positions.size(); ++v) {
      const double distance = (positions[v] - Eigen::Vector3f(skin.positions()[v])).norm();
      longest = distance <= longest ? longest : distance;  // NaN counts as the largest
    }
    return longest / size;
  }
  /// Mean angle in degrees between these normals and the skin's own.
  double meanDegrees(const std::vector<Eigen::Vector3f>& directions) const {
    double sum = 0.0;
    for (std::size_t v = 0; v < directions.size(); ++v) {
      const Eigen::Vector3d a = directions[v].cast<double>(), b = Eigen::Vector3f(skin.normals()[v]).cast<double>();
      sum += std::atan2(a.cross(b).norm(), a.dot(b));
    }
    return 180.0 / 3.14159265358979323846 * sum / static_cast<double>(directions.size());
  }

  scenes::Model model;
  MeshSkin<float> skin;
  SkinnedMesh skinned;
  BonePalette<float> palette;
  std::vector<Eigen::Vector3f> nodes, restPositions, normals;
  double size = 1.0;
};

}  // namespace tetskin::test
