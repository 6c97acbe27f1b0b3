// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// What an engine draws with bones instead of skins, in whole runs of the drop and the twist.
#include "support/drawn_by_bones.h"

#include <tetskin/bullet/soft_body.h>
#include <tetskin/bullet/soft_body_skin.h>

#include "scenes/player.h"
#include "scenes/table.h"

namespace tetskin {
namespace {

using scenes::Carried;
using scenes::Player;

/// Mean and largest value.
struct Spread {
  double sum = 0.0, largest = 0.0, count = 0.0;

  void add(double value) {
    sum += value;
    largest = value <= largest ? largest : value;  // NaN counts as the largest
    count += 1.0;
  }
  double mean() const { return sum / count; }
};

double degrees(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return 180.0 / 3.14159265358979323846 * std::atan2(a.cross(b).norm(), a.dot(b));
}

/// How far bones are off one skin.
struct Offsets {
  Spread distance;  ///< in body's sizes; of the bones that an engine's own shader takes
  Spread degrees;   ///< of normals by the inverse transpose of gradients
};

Offsets offsetsOf(const char* scene, const scenes::ModelOptions& model, int frames, Interpolation interpolation) {
  Player player(model, scenes::makerOf(scene));
  SkinOptions options;
  options.interpolation = Interpolation::Quadratic;
  options.normals = Normals::Transformed;
  const Carried& quadratic = player.carry(options);
  options.interpolation = Interpolation::Linear;
  const Carried& linear = player.carry(options);
  const SoftBodySkin& skin = (interpolation == Interpolation::Quadratic ? quadratic : linear).skin;
  const SkinnedMesh skinned = skinnedMeshOf(*skin.binding()).value();
  PaletteOptions paletteOptions;
  paletteOptions.disableQuadratic = interpolation == Interpolation::Linear;
  auto palette = BonePalette<btScalar>::create(skin.binding(), paletteOptions).value();
  paletteOptions.gradients = true;
  auto gradients = BonePalette<btScalar>::create(skin.binding(), paletteOptions).value();
  TriangleMesh mesh = player.model().mesh;
  scenes::Placement atRest = player.placement();
  atRest.offset.setZero();
  atRest.toWorld(mesh.positions);
  const double size = boundingBox(mesh.positions).sizes().maxCoeff();
  const std::vector<Eigen::Vector3d> normals = restNormals(mesh);
  Offsets offsets;
  const auto measure = [&](int frame) {
    if (frame % 10 != 0) return;
    std::vector<Eigen::Vector3d> nodes = player.nodes();
    player.placement().toWorld(nodes);
    const auto bones = test::bonesFor(palette, nodes), turning = test::bonesFor(gradients, nodes);
    const auto drawn = test::drawnBy(bones, skinned, mesh.positions);
    for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
      const btScalar* p = skin.positions()[v];
      offsets.distance.add((drawn[v] - Eigen::Vector3d(p[0], p[1], p[2])).norm() / size);
      const Eigen::Vector3d own = Eigen::Map<const Eigen::Vector3f>(skin.normals()[v]).cast<double>();
      offsets.degrees.add(degrees(test::normalBy(turning, skinned, v, normals[v]), own));
    }
  };
  scenes::OutputOptions output;
  output.frames = frames;
  output.quiet = true;
  player.play("moving", output, measure, [](int) {});
  return offsets;
}

/// No tet of the drop or the twist is so crumpled that the skin limits what the bones draw.
TEST(BonesInScenes, AreWhereTheSkinIsWithNormalsCloseToItsOwn) {
  scenes::ModelOptions serpent, bar;
  serpent.triangles = bar.triangles = 20000;
  bar.builtIn = scenes::BuiltIn::Bar;
  bar.tets = 600;
  const struct {
    const char* scene;
    scenes::ModelOptions model;
    Interpolation interpolation;
    double mean, worst;  ///< degrees at most
  } cases[] = {{"obstacles", serpent, Interpolation::Linear, 0.6, 25.0},
               {"obstacles", serpent, Interpolation::Quadratic, 0.3, 10.0},
               {"wring", bar, Interpolation::Linear, 6.0, 50.0},
               {"wring", bar, Interpolation::Quadratic, 1.5, 20.0}};
  for (const auto& c : cases) {
    const Offsets offsets = offsetsOf(c.scene, c.model, 240, c.interpolation);
    SCOPED_TRACE(testing::Message() << c.scene << (c.interpolation == Interpolation::Linear ? ", linear: " : ": ")
                                    << offsets.degrees.mean() << " degrees, " << offsets.degrees.largest);
    EXPECT_LT(offsets.distance.largest, 1e-6);
    EXPECT_LT(offsets.degrees.mean(), c.mean);
    EXPECT_LT(offsets.degrees.largest, c.worst);
  }
}

}  // namespace
}  // namespace tetskin
