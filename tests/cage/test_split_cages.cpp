// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Components and limbs of a mesh that are closer to each other than the size of a tet: they stay apart, and connected
// parts stay connected.
#include "cage_checks.h"
#include "cage_models.h"
#include "copy_checks.h"
#include "support/component_models.h"

#include <tetskin/core/src/base/mesh/tet_geometry.h>

namespace tetskin::test {
namespace {

using Eigen::Vector3d;

/// Debug builds are a hundred times slower, especially with sanitizers.
#ifdef NDEBUG
constexpr std::size_t kManyTets = 30000;
#else
constexpr std::size_t kManyTets = 6000;
#endif

Built checked(const TriangleMesh& mesh, std::size_t target, bool fit = true, bool split = true) {
  Built built = build(mesh, target, fit, split);
  EXPECT_EQ(faultOfCage(mesh, built.cage, built.report), "");
  return built;
}

/// The plane, moved away from where the limbs are joined, because tets near there reach from one limb to the other.
std::optional<Plane> clearOf(const std::optional<Plane>& plane, const CageReport& report) {
  constexpr double kSpacings = 1.5;
  if (!plane) return plane;
  Plane moved = *plane;
  moved.offset() -= kSpacings * report.spacing;
  return moved;
}

/// Expects the cage to have as many components beyond the plane as the mesh has, and also as a whole.
void expectComponents(const ComponentModel& model, const Built& built) {
  SCOPED_TRACE(model.name + " at " + std::to_string(built.cage.mesh.tetCount()) + " tets");
  ASSERT_GT(model.gap, built.report.spacing / 8.0) << "else nothing is promised";
  const auto plane = clearOf(model.plane, built.report);
  EXPECT_EQ(countComponentsBeyond(built.cage.mesh, plane), countComponentsBeyond(model.mesh, plane));
  EXPECT_EQ(built.report.components, model.plane ? 1u : static_cast<std::size_t>(model.components));
  EXPECT_EQ(built.report.fusedComponents, 0u);
  EXPECT_TRUE(built.report.targetMet()) << built.report.describe();
}

TEST(SplitCages, KeepPartsApartAt300Tets) {
  for (const ComponentModel& model : {twoPlates(0.15), jaw(0.12), claw(0.08), chain(3, 0.15), coil(4, 0.15)}) {
    for (const bool fit : {true, false}) expectComponents(model, checked(model.mesh, 300, fit));
  }
}

TEST(SplitCages, KeepPartsApartAndAreFilledByTheirVolumeAt3000Tets) {
  for (const ComponentModel& model : {twoPlates(0.06), jaw(0.06), claw(0.06), chain(3, 0.06), coil(4, 0.06)}) {
    const Built built = checked(model.mesh, 3000);
    expectComponents(model, built);
    EXPECT_NEAR(filledVolume(built.cage) / built.report.meshVolume, 1.0, 0.03) << model.name;
  }
}

TEST(SplitCages, KeepPartsApartAtManyTets) {
  expectComponents(jaw(0.04), checked(jaw(0.04).mesh, kManyTets));
}

TEST(SplitCages, TellPlatesApartThatAreAFifthOfATetApart) {
  const double spacing = checked(twoPlates(0.1).mesh, 3000).report.spacing;
  const Built built = checked(twoPlates(0.2 * spacing).mesh, 3000);
  EXPECT_NEAR(built.report.spacing, spacing, 0.1 * spacing);
  EXPECT_EQ(built.report.components, 2u);
  EXPECT_GT(built.report.duplicateTets, 100u);
  EXPECT_EQ(checked(twoPlates(0.2 * spacing).mesh, 3000, true, false).report.components, 1u);
}

/// No tet holds material of both components, but tets of one share nodes with those of the other.
TEST(SplitCages, TellApartWhatOnlyTouchesTheSameNodes) {
  const TriangleMesh boxes = joined(boxMesh({1, 1, 1}), transformed(boxMesh({1, 1, 1}), 1.0, {1.5, 0, 0}));
  const Built built = checked(boxes, 1000);
  EXPECT_EQ(built.report.components, 2u);
  EXPECT_EQ(checked(boxes, 1000, true, false).report.components, 1u);
  const ComponentModel open = claw(0.15);
  const Built hook = checked(open.mesh, 3000);
  EXPECT_EQ(countComponentsBeyond(hook.cage.mesh, clearOf(open.plane, hook.report)), 2);
}

TEST(SplitCages, HaveAPartForEachRingOfAChain) {
  for (const int rings : {2, 5}) {
    EXPECT_EQ(checked(chain(rings, 0.1).mesh, 2000).report.components, static_cast<std::size_t>(rings));
  }
}

/// However narrow a gap is, connected parts of the mesh are never torn, and the cage is sound.
TEST(SplitCages, NeverTearWhatHangsTogether) {
  for (const double gap : {1e-6, 0.02}) {
    for (const ComponentModel& model : {jaw(gap), claw(gap), coil(4, gap), sheet()}) {
      for (const std::size_t target : {300, 1000}) {
        const Built built = checked(model.mesh, target);
        EXPECT_EQ(built.report.components, 1u) << model.name << " " << gap;
      }
    }
  }
}

TEST(SplitCages, HoldEachPartsVerticesInItsOwnTets) {
  const TriangleMesh mesh = twoPlates(0.1).mesh;
  const Built built = checked(mesh, 3000);
  std::vector<int> plateOf(built.report.components, -1);
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
    const int component = built.cage.component[static_cast<std::size_t>(built.cage.vertexTets[v])];
    const int plate = mesh.positions[v].y() > 0.35;
    if (plateOf[component] < 0) plateOf[component] = plate;
    ASSERT_EQ(plateOf[component], plate) << v;
  }
}

TEST(SplitCages, AreTheSameForTheSameMesh) {
  const TriangleMesh mesh = jaw(0.06).mesh;
  EXPECT_TRUE(sameCage(checked(mesh, 1000).cage, checked(mesh, 1000).cage));
}

TEST(SplitCages, DoNotDependOnUnitAndPlace) {
  const TriangleMesh mesh = jaw(0.06).mesh;
  const Built built = checked(mesh, 1000);
  for (const double scale : {1.0 / 256.0, 4096.0}) {
    const Cage scaled = checked(transformed(mesh, scale, Vector3d::Zero()), 1000).cage;
    EXPECT_EQ(scaled.mesh.tets, built.cage.mesh.tets);
    EXPECT_EQ(scaled.vertexTets, built.cage.vertexTets);
    EXPECT_EQ(scaled.fineVolumeFraction, built.cage.fineVolumeFraction);
  }
  const Built moved = checked(transformed(mesh, 1.0, {8.0, -16.0, 32.0}), 1000);
  EXPECT_EQ(moved.cage.mesh.tets, built.cage.mesh.tets);
  EXPECT_EQ(moved.report.duplicateTets, built.report.duplicateTets);
}

/// Points on a prong's triangles lie in tets of that prong, although tets of the other one are as close.
TEST(SplitCages, TheLocatorStaysOnThePartOfTheTriangle) {
  const TriangleMesh mesh = jaw(0.06).mesh;
  const Built built = checked(mesh, 3000, false);
  const CageLocator locator(built.cage);
  const auto plane = clearOf(jaw(0.06).plane, built.report);
  const std::vector<int> tipOf = componentsBeyond(built.cage.mesh, *plane);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::size_t tested = 0, wrong = 0;
  for (const auto& t : mesh.triangles) {
    const double a = std::sqrt(uniform(random)), b = uniform(random) * a;
    const Vector3d p = (1 - a) * mesh.positions[t[0]] + (a - b) * mesh.positions[t[1]] + b * mesh.positions[t[2]];
    const int tip = tipOf[static_cast<std::size_t>(built.cage.vertexTets[static_cast<std::size_t>(t[0])])];
    const auto found = static_cast<std::size_t>(locator.locate(p, t));
    EXPECT_LE(barycentricDistance(BarycentricMap(cornersOf(built.cage.mesh, built.cage.mesh.tets[found]))(p)), 1e-9);
    if (tip < 0 || tipOf[found] < 0) continue;
    ++tested;
    wrong += tipOf[found] != tip;
  }
  EXPECT_GT(tested, mesh.triangleCount() / 3);
  EXPECT_EQ(wrong, 0u);
}

}  // namespace
}  // namespace tetskin::test
