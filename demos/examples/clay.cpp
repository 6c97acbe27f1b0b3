// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A ball of clay falls, and keeps its flat side; a stamp presses a cross into it, and lifts: the cross stays. Beside it
// falls a ball of the same stiffness that is elastic alone. Writes out/clay/frame_0000.obj, frame_0010.obj, ..., in the
// folder in which it is called. Exit status 1: the clay has not kept what was pressed into it.
#include <tetskin/cage/create_cage.h>
#include <tetskin/world/world.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

#include "materials/seen_boxes.h"

namespace {

using namespace tetskin;

constexpr double kRadius = 0.2;
constexpr double kAbove = 1.5, kStamped = 0.25;  // the stamps' heights, of their lower sides

TriangleMesh makeBall() {
  constexpr int kRings = 60, kAround = 120;
  TriangleMesh ball;
  ball.positions.emplace_back(0, -kRadius, 0);
  for (int k = 0; k < (kRings - 1) * kAround; ++k) {
    const double a = 3.14159265 * (k / kAround + 1) / kRings, b = 6.2831853 * (k % kAround) / kAround;
    ball.positions.emplace_back(kRadius * std::sin(a) * std::cos(b), -kRadius * std::cos(a),
                                kRadius * std::sin(a) * std::sin(b));
  }
  ball.positions.emplace_back(0, kRadius, 0);
  const int top = static_cast<int>(ball.vertexCount()) - 1;
  for (int k = 0; k < kAround; ++k) {
    const auto vertex = [&](int ring, int on) { return 1 + ring * kAround + (k + on) % kAround; };
    ball.triangles.push_back({0, vertex(0, 0), vertex(0, 1)});
    ball.triangles.push_back({top, vertex(kRings - 2, 1), vertex(kRings - 2, 0)});
    for (int ring = 0; ring + 2 < kRings; ++ring) {
      ball.triangles.push_back({vertex(ring, 0), vertex(ring + 1, 0), vertex(ring + 1, 1)});
      ball.triangles.push_back({vertex(ring, 0), vertex(ring + 1, 1), vertex(ring, 1)});
    }
  }
  return ball;
}

/// Height of the top of a ball, above the middle of the ground.
double topOf(const World::Body& ball) {
  return ball.skin.bounds().max().y();
}

btTransform placedAt(double x, double y) {
  return btTransform(btQuaternion::getIdentity(), btVector3(static_cast<btScalar>(x), static_cast<btScalar>(y), 0));
}

}  // namespace

int main() try {
  const auto mesh = std::make_shared<TriangleMesh>(makeBall());
  CageOptions cageOptions;
  cageOptions.targetTets = 4000;
  const auto cage = std::make_shared<Cage>(createCage(*mesh, cageOptions).value());
  World world;
  world.addRigidBody(std::make_shared<btStaticPlaneShape>(btVector3(0, 1, 0), 0), 0, placedAt(0, 0)).value();

  WorldBodyOptions options;
  options.binding.interpolation = Interpolation::Quadratic;
  options.material.density = 1500;
  options.material.youngsModulus = 1e6;
  options.material.stiffnessDamping = 0.002;
  const auto ballAt = [&](double x) {
    return world.addBody(cage, mesh, options, Eigen::Affine3d(Eigen::Translation3d(x, 1.0, 0))).value();
  };
  const std::shared_ptr<World::Body> clay = ballAt(-0.3), elastic = ballAt(0.3);
  Plasticity plasticity;
  plasticity.yieldStress = 3e4;
  plasticity.hardening = 5e4;
  if (const Status set = clay->body->setPlasticity(plasticity); !set.ok()) throw std::runtime_error(set.message);

  // Two stamps, of two crossed bars each.
  const btVector3 halves[2] = {btVector3(btScalar(0.3), btScalar(0.1), btScalar(0.03)),
                               btVector3(btScalar(0.03), btScalar(0.1), btScalar(0.3))};
  std::vector<std::shared_ptr<World::RigidBody>> bars;
  std::vector<std::pair<const btRigidBody*, btVector3>> drawn;
  for (const double x : {-0.3, 0.3}) {
    for (const btVector3& half : halves) {
      bars.push_back(
          world.addRigidBody(std::make_shared<btBoxShape>(half), 0, placedAt(x, kAbove + 0.1), 0.5, true).value());
      drawn.emplace_back(bars.back()->body.get(), half);
    }
  }
  TriangleMesh both = *mesh;
  for (const Eigen::Vector3d& p : mesh->positions) both.positions.push_back(p);
  for (const auto& t : mesh->triangles) {
    const int first = static_cast<int>(mesh->vertexCount());
    both.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  materials::SeenBoxes frames("out/clay", both, drawn);

  constexpr int kFalls = 120, kPresses = 240, kLifts = 360, kEnds = 480;
  double fallen[2] = {}, pressed[2] = {};
  for (int frame = 0; frame <= kEnds; ++frame) {
    const double down = frame < kPresses ? std::clamp((frame - kFalls) / 120.0, 0.0, 1.0)
                                         : std::clamp((kLifts - frame) / 120.0, 0.0, 1.0);
    const double height = kAbove + (kStamped - kAbove) * down;
    for (std::size_t k = 0; k < bars.size(); ++k) world.setPose(*bars[k], placedAt(k < 2 ? -0.3 : 0.3, height + 0.1));
    if (frame == kFalls) fallen[0] = topOf(*clay), fallen[1] = topOf(*elastic);
    if (frame % 10 == 0) {
      std::vector<float> points = clay->positions;
      points.insert(points.end(), elastic->positions.begin(), elastic->positions.end());
      const std::vector<double> strains = clay->body->plasticStrains();
      std::printf("%s: clay %.3f m high, elastic %.3f m; largest plastic strain %.2f\n",
                  frames.write(frame, std::move(points)).c_str(), topOf(*clay), topOf(*elastic),
                  *std::max_element(strains.begin(), strains.end()));
    }
    if (frame < kEnds) world.step(1.0 / 60).value();
  }
  pressed[0] = topOf(*clay), pressed[1] = topOf(*elastic);
  std::printf("after the fall: clay %.3f m, elastic %.3f m of %.3f; after the stamp: clay %.3f m, elastic %.3f m\n",
              fallen[0], fallen[1], 2 * kRadius, pressed[0], pressed[1]);
  const bool kept = fallen[0] < 0.95 * fallen[1] && pressed[0] < fallen[0] && pressed[1] > 0.95 * 2 * kRadius;
  std::printf("the clay keeps its shape, the other comes back: %s\n", kept ? "yes" : "no");
  return kept ? 0 : 1;
} catch (const std::exception& fault) {  // value() of a failed result: what, where, and the cure
  return std::puts(fault.what()), 2;
}
