// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The results for meshes whose components cannot be separated, or for which the inside is unclear.
#include "cage_checks.h"
#include "cage_models.h"
#include "copy_checks.h"
#include "support/component_models.h"
#include "support/odd_meshes.h"

namespace tetskin::test {
namespace {

CageReport reportOf(const TriangleMesh& mesh, std::size_t target) {
  CageOptions options;
  options.targetTets = target;
  CageReport report;
  const Cage cage = createCage(mesh, options, &report).value();
  EXPECT_EQ(faultOfCage(mesh, cage, report), "") << target;
  return report;
}

TEST(SplitOutcomes, WhatLiesInEachOtherStaysTogether) {
  for (const TriangleMesh& mesh :
       {crossedBoxes().mesh, joined(unitSphere(16), unitSphere(16)), joined(unitSphere(16), sphere(16, 0.3, {0, 0, 0})),
        joined(unitSphere(16), sphere(16, 0.8, {0.9, 0.1, 0.2}))}) {
    for (const std::size_t target : {300, 2000}) {
      const CageReport report = reportOf(mesh, target);
      EXPECT_EQ(report.components, 1u);
      EXPECT_EQ(report.fusedComponents, report.meshComponents - 1u);
    }
  }
}

TEST(SplitOutcomes, WhatTouchesStaysTogether) {
  EXPECT_EQ(reportOf(twoPlates(0.0).mesh, 1000).components, 1u);
  EXPECT_EQ(reportOf(joined(boxMesh({1, 1, 1}), transformed(boxMesh({1, 1, 1}), 1.0, {1, 0, 0})), 1000).components, 1u);
}

TEST(SplitOutcomes, FusedPartsAreThoseThatTheCageDoesNotTellApart) {
  for (const double gap : {1e-3, 0.02, 0.1, 0.3}) {
    const CageReport report = reportOf(twoPlates(gap).mesh, 500);
    EXPECT_EQ(report.fusedComponents, 2u - report.components) << gap;
    EXPECT_EQ(report.describe().find("fused") == std::string::npos, report.components == 2u);
  }
}

TEST(SplitOutcomes, SheetsHaveNoInsideAndMayFuse) {
  for (const double gap : {0.01, 0.1}) {
    for (const std::size_t target : {300, 3000}) {
      const CageReport report = reportOf(twoSheets(gap).mesh, target);
      EXPECT_EQ(report.meshVolume, 0.0);
      EXPECT_GE(report.components, 1u);
      EXPECT_EQ(report.components + report.fusedComponents, 2u);
    }
  }
}

TEST(SplitOutcomes, UnorientedSurfacesAreNotSplit) {
  // A Moebius band has no inside.
  TriangleMesh band;
  constexpr int kSteps = 48;
  for (int k = 0; k < kSteps; ++k) {
    const double angle = 6.283185307179586 * k / kSteps;
    for (const double side : {-0.3, 0.3}) {
      const double r = 1.0 + side * std::cos(0.5 * angle);
      band.positions.emplace_back(r * std::cos(angle), r * std::sin(angle), side * std::sin(0.5 * angle));
    }
  }
  for (int k = 0; k < kSteps; ++k) {
    const bool last = k + 1 == kSteps;
    const int a = 2 * k, b = 2 * k + 1, c = last ? 1 : 2 * k + 2, d = last ? 0 : 2 * k + 3;
    band.triangles.push_back({a, c, b});
    band.triangles.push_back({b, c, d});
  }
  EXPECT_EQ(reportOf(band, 1000).duplicateTets, 0u);
  EXPECT_EQ(reportOf(band, 1000).components, 1u);
}

/// Variants of the jaw that are not one consistent closed surface.
TEST(SplitOutcomes, DamagedMeshesGetSoundCages) {
  const TriangleMesh good = jaw(0.08).mesh;
  std::vector<TriangleMesh> damaged = {
      unwelded(good),     shuffledOrientation(good), shuffledOrientation(unwelded(good)),
      invertedMesh(good), joined(good, good),        joined(good, invertedMesh(good))};
  TriangleMesh holed = good;
  for (std::size_t t = 0; t < holed.triangles.size(); t += 7) holed.triangles[t] = holed.triangles.back();
  damaged.push_back(holed);  // this one also has repeated triangles
  TriangleMesh loose = good;
  loose.positions.emplace_back(3.0, 0.0, 0.5);  // in the gap
  loose.positions.emplace_back(2.0, 3.0, 0.5);  // far from everything
  damaged.push_back(loose);
  TriangleMesh crossing = good;
  for (Eigen::Vector3d& p : crossing.positions) {
    if (p.x() > 2.0) p.y() *= -1.0;  // the prongs pass through each other
  }
  damaged.push_back(crossing);
  for (const TriangleMesh& mesh : damaged) {
    for (const std::size_t target : {200, 800}) {
      const CageReport report = reportOf(mesh, target);
      EXPECT_LE(report.components, report.meshComponents);
    }
  }
}

TEST(SplitOutcomes, ASoupOfTheJawIsSplitAsTheJawIs) {
  const TriangleMesh good = jaw(0.08).mesh;
  const CageReport whole = reportOf(good, 1500), soup = reportOf(shuffledOrientation(unwelded(good)), 1500);
  EXPECT_EQ(soup.duplicateTets, whole.duplicateTets);
  EXPECT_EQ(soup.components, 1u);
}

TEST(SplitOutcomes, LooseVerticesAreNoComponents) {
  TriangleMesh mesh = twoPlates(0.1).mesh;
  mesh.positions.emplace_back(0.0, 0.35, 0.0);  // between the plates
  mesh.positions.emplace_back(0.0, 5.0, 0.0);   // far away
  const CageReport report = reportOf(mesh, 3000);
  EXPECT_EQ(report.looseVertices, 2u);
  EXPECT_EQ(report.components, 2u);
  EXPECT_EQ(report.fusedComponents, 0u);
}

}  // namespace
}  // namespace tetskin::test
