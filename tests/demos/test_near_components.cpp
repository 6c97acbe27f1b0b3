// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The built-in models whose limbs lie close to each other, and the tets that fill them by formula.

#include <tetskin/core/embedding.h>

#include <numeric>
#include <utility>

#include "scenes/hand.h"
#include "scenes/model.h"
#include "scenes/slotted_beam.h"
#include "support/component_models.h"
#include "support/surface_checks.h"

namespace tetskin::scenes {
namespace {

using Eigen::Vector3d;
using test::countComponentsBeyond;
using test::enclosedVolume;

constexpr std::size_t kSmall = 6000;  ///< triangles
/// Debug builds are a hundred times slower, especially with sanitizers.
#ifdef NDEBUG
constexpr std::size_t kMany = 100000;
constexpr double kManyVolumeError = 0.01;
#else
constexpr std::size_t kMany = 20000;
constexpr double kManyVolumeError = 0.03;
#endif

double volumeOf(const TetMesh& mesh, const Tet& tet) {
  const auto edge = [&](int corner) -> Vector3d { return mesh.nodes[tet[corner]] - mesh.nodes[tet[0]]; };
  return edge(1).cross(edge(2)).dot(edge(3)) / 6.0;
}

/// Expects a clean, positive and conforming mesh: the boundary is closed, and encloses the same volume as the tets.
void expectConforming(const TetMesh& mesh) {
  EXPECT_TRUE(checkTetMesh(mesh).clean()) << checkTetMesh(mesh).describe();
  EXPECT_GT(std::accumulate(mesh.tets.begin(), mesh.tets.end(), 1.0,
                            [&](double minimum, const Tet& tet) { return std::min(minimum, volumeOf(mesh, tet)); }),
            0.0);
  TriangleMesh boundary;
  boundary.positions = mesh.nodes;
  boundary.triangles = boundaryFaces(mesh);
  EXPECT_TRUE(test::isClosedAndOriented(boundary));
  EXPECT_NEAR(enclosedVolume(boundary), totalVolume(mesh), 1e-9);
}

/// Greatest distance of a vertex from the tets. Also expects each vertex to be carried by a tet on its own limb;
/// `partOf` gives a limb's number for points beyond the plane.
double farthestOutside(const TriangleMesh& mesh, const TetMesh& tets, const Eigen::Hyperplane<double, 3>& plane,
                       int (*partOf)(const Vector3d&)) {
  EmbedReport report;
  const Result<Embedding> embedding = embed(tets, viewOf(mesh.positions), {}, &report);
  EXPECT_TRUE(embedding.ok());
  std::size_t wrong = 0, v = 0;
  for (const VertexBinding& binding : embedding.value().bindings()) {
    Vector3d centroid = Vector3d::Zero();
    for (const int node : tets.tets[binding.tet]) centroid += 0.25 * tets.nodes[node];
    const Vector3d& p = mesh.positions[v++];
    wrong += plane.signedDistance(p) > 0.0 && partOf(centroid) != partOf(p);
  }
  EXPECT_EQ(wrong, 0u);
  return report.outside > 0 ? report.maxDistance : 0.0;
}

/// The number of the finger, 0 to 4 from left to right.
int fingerAt(const Vector3d& p) {
  return static_cast<int>(std::floor((p.x() + 0.625) / 0.25));
}

int prongAt(const Vector3d& p) {
  const Vector3d along = slottedBeamPlane().normal();
  return p.dot(along.cross(Vector3d::UnitZ())) > 0.0;
}

TEST(SlottedBeam, IsAClosedSurfaceOfExactVolume) {
  for (const std::size_t triangles : {std::size_t{2000}, kSmall, std::size_t{60000}}) {
    const TriangleMesh mesh = makeSlottedBeam(triangles);
    EXPECT_TRUE(validate(mesh).ok());
    EXPECT_TRUE(test::isClosedAndOriented(mesh));
    EXPECT_EQ(countComponentsBeyond(mesh), 1);
    EXPECT_EQ(countComponentsBeyond(mesh, slottedBeamPlane()), 2);
    EXPECT_NEAR(enclosedVolume(mesh), kSlottedBeamVolume, 1e-9);
    EXPECT_GT(test::flattestTriangle(mesh), 0.2);
    EXPECT_GE(mesh.triangleCount(), triangles);
    EXPECT_LT(static_cast<double>(mesh.triangleCount()), 1.15 * static_cast<double>(triangles));
  }
}

TEST(SlottedBeam, IsFilledByTetsThatDoNotFuseItsProngs) {
  const TriangleMesh mesh = makeSlottedBeam(kSmall);
  for (const std::size_t tets : {kMinSlottedBeamTets, std::size_t{2000}, std::size_t{10000}, kMany}) {
    const TetMesh filling = makeSlottedBeamTets(tets);
    expectConforming(filling);
    EXPECT_NEAR(totalVolume(filling), kSlottedBeamVolume, 1e-9);
    EXPECT_EQ(countComponentsBeyond(filling), 1);
    EXPECT_EQ(countComponentsBeyond(filling, slottedBeamPlane()), 2);
    EXPECT_GE(filling.tetCount(), tets);
    EXPECT_LT(static_cast<double>(filling.tetCount()), 1.25 * static_cast<double>(tets));
    EXPECT_LT(farthestOutside(mesh, filling, slottedBeamPlane(), prongAt), 1e-9);
  }
}

TEST(Hand, IsAClosedSurfaceOnTheZeroOfItsDistance) {
  for (const std::size_t triangles : {kMinHandTriangles, kSmall, std::size_t{60000}}) {
    const TriangleMesh mesh = makeHand(triangles);
    EXPECT_TRUE(validate(mesh).ok());
    EXPECT_TRUE(test::isClosedAndOriented(mesh));
    EXPECT_EQ(countComponentsBeyond(mesh), 1);
    EXPECT_EQ(countComponentsBeyond(mesh, handPlane()), 5);
    EXPECT_GT(test::flattestTriangle(mesh), 0.1);
    EXPECT_NEAR(static_cast<double>(mesh.triangleCount()), static_cast<double>(triangles),
                0.05 * static_cast<double>(triangles));
    for (const Vector3d& p : mesh.positions) ASSERT_NEAR(handDistance(p), 0.0, 1e-4);
  }
}

TEST(Hand, HasGapsAQuarterAsWideAsItsFingers) {
  const Vector3d root = handPlane().projection(Vector3d::Zero());
  const auto distance = [&](double x) { return handDistance(root + x * Vector3d::UnitX()); };
  double inside = 0.0, outside = 0.0;
  constexpr double kStep = 1e-4;
  for (double x = 0.0; x < 0.25; x += kStep) (distance(x) < 0.0 ? inside : outside) += kStep;
  EXPECT_NEAR(outside / inside, 0.3, 0.05);
}

TEST(Hand, IsFilledByTetsThatDoNotFuseItsFingers) {
  const TriangleMesh mesh = makeHand(kSmall);
  const double volume = enclosedVolume(makeHand());
  struct Case {
    std::size_t tets;
    double volumeError, outside;  // error by the chords of a polygon, coarsest at the tips; a gap is 0.05
  };
  for (const auto& [tets, error, outside] : {Case{kMinHandTets, 0.01, 0.03}, Case{kMany, kManyVolumeError, 0.01}}) {
    const TetMesh filling = makeHandTets(tets);
    expectConforming(filling);
    EXPECT_NEAR(totalVolume(filling), volume, error * volume);
    EXPECT_EQ(countComponentsBeyond(filling), 1);
    EXPECT_EQ(countComponentsBeyond(filling, handPlane()), 5);
    EXPECT_NEAR(static_cast<double>(filling.tetCount()), static_cast<double>(tets), 0.05 * static_cast<double>(tets));
    EXPECT_LT(farthestOutside(mesh, filling, handPlane(), fingerAt), outside);
  }
}

TEST(BuiltInModels, HaveNamesSurfacesAndSomeHaveTets) {
  for (const BuiltIn model : builtInModels()) {
    ModelOptions options;
    options.builtIn = model;
    options.triangles = kSmall;
    const Surface surface = loadSurface(options);
    EXPECT_EQ(surface.name, nameOf(model));
    EXPECT_NEAR(static_cast<double>(surface.mesh.triangleCount()), static_cast<double>(kSmall), 0.05 * kSmall);
    const bool isBeam = model == BuiltIn::SlottedBeam;
    EXPECT_EQ(conformingTets(model, 15000).has_value(), isBeam || model == BuiltIn::Hand) << surface.name;
    EXPECT_EQ(conformingTets(model, 1000).has_value(), isBeam) << surface.name;
    EXPECT_EQ(fewestConformingTets(model) > 0, conformingTets(model, 15000).has_value());
  }
}

}  // namespace
}  // namespace tetskin::scenes
