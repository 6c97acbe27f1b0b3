// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Parts of a mesh that lie nearer to each other than a tet: they stay apart, and what hangs together stays together.
#include "cage_checks.h"
#include "cage_models.h"
#include "copy_checks.h"
#include "support/part_models.h"

#include <gtest/gtest.h>
#include <tetskin/core/src/shared/mesh/tet_geometry.h>

#include <cmath>
#include <random>

namespace tetskin::test {
namespace {

using Eigen::Vector3d;

/// Debug builds, with sanitizers above all, are a hundred times slower.
#ifdef NDEBUG
constexpr std::size_t kMany = 30000;
#else
constexpr std::size_t kMany = 6000;
#endif

struct Built {
  Cage cage;
  CageReport report;
};

Built build(const TriangleMesh& mesh, std::size_t target, bool fit = true, bool split = true) {
  Built built;
  CageOptions options;
  options.targetTets = target;
  options.fit = fit;
  options.split = split;
  built.cage = buildCage(mesh, options, &built.report).value();
  EXPECT_EQ(faultOfCage(mesh, built.cage, built.report), "");
  return built;
}

/// The plane, farther from where the parts hang together: there tets reach from one part to the other.
std::optional<Plane> clearOf(const std::optional<Plane>& plane, const CageReport& report) {
  constexpr double kSpacings = 1.5;
  if (!plane) return plane;
  Plane moved = *plane;
  moved.offset() -= kSpacings * report.spacing;
  return moved;
}

/// Beyond the plane the cage falls into as many parts as the mesh does, and as a whole too.
void expectParts(const PartModel& model, const Built& built) {
  SCOPED_TRACE(model.name + " at " + std::to_string(built.cage.tetCount()) + " tets");
  ASSERT_GT(model.gap, built.report.spacing / 8.0) << "else nothing is promised";
  const auto plane = clearOf(model.plane, built.report);
  EXPECT_EQ(countPartsBeyond(built.cage, plane), countPartsBeyond(model.mesh, plane));
  EXPECT_EQ(built.report.parts, model.plane ? 1u : static_cast<std::size_t>(model.parts));
  EXPECT_EQ(built.report.fusedParts, 0u);
  EXPECT_TRUE(built.report.targetMet()) << built.report.describe();
}

TEST(SplitCages, KeepPartsApartAt300Tets) {
  for (const PartModel& model : {twoPlates(0.15), jaw(0.12), claw(0.08), chain(3, 0.15), coil(4, 0.15)}) {
    for (const bool fit : {true, false}) expectParts(model, build(model.mesh, 300, fit));
  }
}

TEST(SplitCages, KeepPartsApartAndAreFilledByTheirVolumeAt3000Tets) {
  for (const PartModel& model : {twoPlates(0.06), jaw(0.06), claw(0.06), chain(3, 0.06), coil(4, 0.06)}) {
    const Built built = build(model.mesh, 3000);
    expectParts(model, built);
    EXPECT_NEAR(filledVolume(built.cage) / built.report.meshVolume, 1.0, 0.03) << model.name;
  }
}

TEST(SplitCages, KeepPartsApartAtManyTets) {
  expectParts(jaw(0.04), build(jaw(0.04).mesh, kMany));
}

TEST(SplitCages, TellPlatesApartThatAreAFifthOfATetApart) {
  const double spacing = build(twoPlates(0.1).mesh, 3000).report.spacing;
  const Built built = build(twoPlates(0.2 * spacing).mesh, 3000);
  EXPECT_NEAR(built.report.spacing, spacing, 0.1 * spacing);
  EXPECT_EQ(built.report.parts, 2u);
  EXPECT_GT(built.report.copies, 100u);
  EXPECT_EQ(build(twoPlates(0.2 * spacing).mesh, 3000, true, false).report.parts, 1u);
}

/// No tet holds material of both, but tets of one have nodes in common with those of the other.
TEST(SplitCages, TellApartWhatOnlyTouchesTheSameNodes) {
  const TriangleMesh boxes = joined(boxMesh({1, 1, 1}), transformed(boxMesh({1, 1, 1}), 1.0, {1.5, 0, 0}));
  const Built built = build(boxes, 1000);
  EXPECT_EQ(built.report.parts, 2u);
  EXPECT_EQ(build(boxes, 1000, true, false).report.parts, 1u);
  const PartModel open = claw(0.15);
  const Built hook = build(open.mesh, 3000);
  EXPECT_EQ(countPartsBeyond(hook.cage, clearOf(open.plane, hook.report)), 2);
}

TEST(SplitCages, HaveAPartForEachRingOfAChain) {
  for (const int rings : {2, 5}) {
    EXPECT_EQ(build(chain(rings, 0.1).mesh, 2000).report.parts, static_cast<std::size_t>(rings));
  }
}

/// However narrow a gap is, what the mesh joins is never torn, and a cage is sound.
TEST(SplitCages, NeverTearWhatHangsTogether) {
  for (const double gap : {1e-6, 0.02}) {
    for (const PartModel& model : {jaw(gap), claw(gap), coil(4, gap), sheet()}) {
      for (const std::size_t target : {300, 1000}) {
        const Built built = build(model.mesh, target);
        EXPECT_EQ(built.report.parts, 1u) << model.name << " " << gap;
      }
    }
  }
}

TEST(SplitCages, HoldEachPartsVerticesInItsOwnTets) {
  const TriangleMesh mesh = twoPlates(0.1).mesh;
  const Built built = build(mesh, 3000);
  std::vector<int> plateOf(built.report.parts, -1);
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
    const int part = built.cage.parts[static_cast<std::size_t>(built.cage.vertexTets[v])];
    const int plate = mesh.positions[v].y() > 0.35;
    if (plateOf[part] < 0) plateOf[part] = plate;
    ASSERT_EQ(plateOf[part], plate) << v;
  }
}

TEST(SplitCages, AreTheSameForTheSameMesh) {
  const TriangleMesh mesh = jaw(0.06).mesh;
  EXPECT_TRUE(sameCage(build(mesh, 1000).cage, build(mesh, 1000).cage));
}

TEST(SplitCages, DoNotDependOnUnitAndPlace) {
  const TriangleMesh mesh = jaw(0.06).mesh;
  const Built built = build(mesh, 1000);
  for (const double scale : {1.0 / 256.0, 4096.0}) {
    const Cage scaled = build(transformed(mesh, scale, Vector3d::Zero()), 1000).cage;
    EXPECT_EQ(scaled.tets, built.cage.tets);
    EXPECT_EQ(scaled.vertexTets, built.cage.vertexTets);
    EXPECT_EQ(scaled.fineFill, built.cage.fineFill);
  }
  const Built moved = build(transformed(mesh, 1.0, {8.0, -16.0, 32.0}), 1000);
  EXPECT_EQ(moved.cage.tets, built.cage.tets);
  EXPECT_EQ(moved.report.copies, built.report.copies);
}

/// Points on the prongs' triangles lie in tets of their own prong, though those of the other are as near.
TEST(SplitCages, TheLocatorStaysOnThePartOfTheTriangle) {
  const TriangleMesh mesh = jaw(0.06).mesh;
  const Built built = build(mesh, 3000, false);
  const CageLocator locator(built.cage);
  const auto plane = clearOf(jaw(0.06).plane, built.report);
  const std::vector<int> tipOf = partsBeyond(built.cage, *plane);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::size_t tested = 0, wrong = 0;
  for (const auto& t : mesh.triangles) {
    const double a = std::sqrt(uniform(random)), b = uniform(random) * a;
    const Vector3d p = (1 - a) * mesh.positions[t[0]] + (a - b) * mesh.positions[t[1]] + b * mesh.positions[t[2]];
    const int tip = tipOf[static_cast<std::size_t>(built.cage.vertexTets[static_cast<std::size_t>(t[0])])];
    const auto found = static_cast<std::size_t>(locator.locate(p, t));
    EXPECT_LE(barycentricDistance(BarycentricMap(cornersOf(built.cage, built.cage.tets[found]))(p)), 1e-9);
    if (tip < 0 || tipOf[found] < 0) continue;
    ++tested;
    wrong += tipOf[found] != tip;
  }
  EXPECT_GT(tested, mesh.triangleCount() / 3);
  EXPECT_EQ(wrong, 0u);
}

}  // namespace
}  // namespace tetskin::test
