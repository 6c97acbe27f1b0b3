// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Cages for the built-in models whose limbs lie close to each other: fingers and prongs stay apart.
#include <gtest/gtest.h>

#include <tetskin/cage/create_cage.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "scenes/hand.h"
#include "scenes/slotted_beam.h"
#include "support/component_models.h"

namespace tetskin::scenes {
namespace {

using Eigen::Vector3d;

/// Distance from where fingers or prongs are joined within which tets may reach across, in spacings of the lattice.
constexpr double kClear = 1.5;

struct Built {
  Cage cage;
  CageReport report;
  test::Plane plane;  ///< clear of where the limbs are joined
};

Built build(const TriangleMesh& mesh, test::Plane plane, std::size_t target) {
  Built built;
  CageOptions options;
  options.targetTets = target;
  built.cage = createCage(mesh, options, &built.report).value();
  EXPECT_TRUE(built.report.targetMet());
  EXPECT_EQ(built.report.verticesOutside, 0u);
  EXPECT_EQ(built.report.components, 1u);
  plane.offset() -= kClear * built.report.spacing;
  built.plane = plane;
  return built;
}

void expectApart(const TriangleMesh& mesh, const test::Plane& plane, std::size_t target, int limbs) {
  const Built built = build(mesh, plane, target);
  EXPECT_EQ(test::countComponentsBeyond(mesh, built.plane), limbs);
  EXPECT_EQ(test::countComponentsBeyond(built.cage.mesh, built.plane), limbs);
  EXPECT_TRUE(built.cage.hasDuplicates());
}

TEST(NearPartCages, KeepProngsAndFingersApart) {
  for (const std::size_t target : {2000, 6000}) expectApart(makeSlottedBeam(6000), slottedBeamPlane(), target, 2);
  for (const std::size_t target : {1000, 3000}) expectApart(makeHand(6000), handPlane(), target, 5);
}

/// Points on a finger's triangles are found in that finger's own tets.
TEST(NearPartCages, TheLocatorStaysOnTheFinger) {
  const TriangleMesh mesh = makeHand(6000);
  const Built built = build(mesh, handPlane(), 1000);
  const std::vector<int> partOf = test::componentsBeyond(built.cage.mesh, built.plane);
  const CageLocator locator(built.cage);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::map<int, int> tested;  // by finger
  int wrong = 0;
  for (const auto& t : mesh.triangles) {
    const double a = std::sqrt(uniform(random)), b = uniform(random) * a;
    const Vector3d p = (1 - a) * mesh.positions[t[0]] + (a - b) * mesh.positions[t[1]] + b * mesh.positions[t[2]];
    const int finger = partOf[built.cage.vertexTets[t[0]]], found = partOf[locator.locate(p, t)];
    if (finger < 0 || found < 0) continue;
    ++tested[finger];
    wrong += found != finger;
  }
  EXPECT_EQ(tested.size(), 5u);
  EXPECT_TRUE(std::all_of(tested.begin(), tested.end(), [](const auto& t) { return t.second > 50; }));
  EXPECT_EQ(wrong, 0);
}

}  // namespace
}  // namespace tetskin::scenes
