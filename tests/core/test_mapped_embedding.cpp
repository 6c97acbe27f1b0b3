// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Embedding by a cage's own map, `Cage::vertexTets`.
#include "support/odd_meshes.h"
#include "support/two_plates.h"

#include <tetskin/core/embedding.h>
#include <tetskin/core/mesh_skin.h>

#include <limits>

namespace tetskin::test {
namespace {

using Eigen::Vector3d;

void expectRefused(const Cage& cage, const TriangleMesh& mesh, StatusCode code,
                   std::initializer_list<std::string> components) {
  EmbedReport report;
  const Result<Embedding> made = embed(cage, mesh, {}, &report);
  EXPECT_STREQ(toString(made.status().code), toString(code)) << made.status().message;
  for (const std::string& part : components) {
    EXPECT_NE(made.status().message.find(part), std::string::npos) << made.status().message;
  }
  EXPECT_EQ(report.unbound, mesh.vertexCount());
  EXPECT_EQ(report.mapped, 0u);
}

TEST(MappedEmbedding, BelievesTheMapWhereThePlaceWouldChooseTheOtherCopy) {
  const TwoPlates plates = platesOfCopies();
  EmbedReport report;
  const Result<Embedding> made = embed(plates.cage, plates.mesh, {}, &report);
  ASSERT_TRUE(made.ok()) << made.status().message;
  const auto mapped = made.value().bindings();
  const auto placed = embed(plates.cage.mesh, viewOf(plates.mesh.positions)).value().bindings();
  for (std::size_t v = 0; v < mapped.size(); ++v) {
    EXPECT_EQ(mapped[v].tet, plates.cage.vertexTets[v]);
    EXPECT_TRUE(mapped[v].inside);
    EXPECT_EQ(mapped[v].weights, placed[v].weights);  // the copies are at the same position
    EXPECT_LT(static_cast<std::size_t>(placed[v].tet), plates.latticeTets);
  }
}

TEST(MappedEmbedding, ReportsWhatASearchWould) {
  const TwoPlates plates = platesOfCopies();
  EmbedReport mapped, placed;
  EmbedOptions options;
  ASSERT_TRUE(embed(plates.cage, plates.mesh, options, &mapped).ok());
  ASSERT_TRUE(embed(plates.cage.mesh, viewOf(plates.mesh.positions), options, &placed).ok());
  const std::size_t vertices = plates.mesh.vertexCount();
  EXPECT_EQ(mapped.vertexCount, vertices);
  EXPECT_EQ(mapped.inside, vertices);
  EXPECT_EQ(mapped.outside, 0u);
  EXPECT_EQ(mapped.unbound, 0u);
  EXPECT_EQ(mapped.mapped, vertices);
  EXPECT_EQ(mapped.overlapping, 0u);
  EXPECT_EQ(mapped.candidates, 0u);
  EXPECT_EQ(mapped.maxDistance, 0.0);
  EXPECT_EQ(mapped.restErrorMax, placed.restErrorMax);
  EXPECT_EQ(mapped.maxWeight, placed.maxWeight);
  EXPECT_EQ(mapped.meshBox.max(), placed.meshBox.max());
  EXPECT_EQ(mapped.cageBox.min(), placed.cageBox.min());
  EXPECT_FALSE(mapped.unitsDiffer());
  EXPECT_EQ(mapped.describe().find("only a Cage with its map"), std::string::npos) << mapped.describe();

  EXPECT_EQ(placed.mapped, 0u);
  EXPECT_GT(placed.overlapping, vertices / 2);  // the other vertices are on faces
  EXPECT_NE(placed.describe().find("only a Cage with its map"), std::string::npos) << placed.describe();
}

TEST(MappedEmbedding, CountsCoincidentVerticesAndFlatTets) {
  TwoPlates plates = platesOfCopies();
  const TriangleMesh once = plates.mesh;
  plates.mesh.positions.insert(plates.mesh.positions.end(), once.positions.begin(), once.positions.end());
  std::vector<int>& map = plates.cage.vertexTets;
  map.insert(map.end(), map.begin(), map.begin() + static_cast<std::ptrdiff_t>(once.vertexCount()));
  plates.cage.meshHash.reset();
  Cage bare = plates.cage;
  bare.mesh.tets.push_back({0, 1, 2, 2});
  for (auto* array : {&bare.volumeFraction, &bare.stiffnessFactor, &bare.masses}) array->clear();
  for (auto* array : {&bare.component, &bare.sourceTet}) array->clear();
  bare.fineVolumeFraction.clear();
  EmbedReport report;
  const Result<Embedding> made = embed(bare, plates.mesh, {}, &report);
  ASSERT_TRUE(made.ok()) << made.status().message;
  EXPECT_EQ(report.coincident, once.vertexCount());
  EXPECT_EQ(report.flatTets, 1u);
  const auto bindings = made.value().bindings();
  for (std::size_t v = 0; v < once.vertexCount(); ++v) {
    EXPECT_EQ(bindings[v].tet, bindings[v + once.vertexCount()].tet);
    EXPECT_EQ(bindings[v].weights, bindings[v + once.vertexCount()].weights);
  }
}

TEST(MappedEmbedding, OnlyThePlateWhoseCopyMovesMoves) {
  const TwoPlates plates = platesOfCopies();
  for (const Interpolation interpolation : {Interpolation::Linear, Interpolation::Quadratic}) {
    SkinOptions options;
    options.interpolation = interpolation;
    auto binding = SkinBinding<double>::create(plates.cage, plates.mesh, options);
    ASSERT_TRUE(binding.ok()) << binding.status().message;
    std::vector<Vector3d> nodes = plates.cage.mesh.nodes;
    for (std::size_t n = nodes.size() / 2; n < nodes.size(); ++n) nodes[n] += Vector3d(0, 3, 1);
    MeshSkin<double> skin;
    ASSERT_TRUE(skin.bind(std::move(binding).value(), viewOf(std::as_const(nodes))).ok());
    for (std::size_t v = 0; v < plates.mesh.vertexCount(); ++v) {
      const Vector3d moved = Eigen::Map<const Vector3d>(skin.positions()[v]) - plates.mesh.positions[v];
      EXPECT_LT((moved - (plates.upper(v) ? Vector3d(0, 3, 1) : Vector3d(0, 0, 0))).norm(), 1e-6) << v;
    }
  }
}

TEST(MappedEmbedding, TakesAMeshRoundedToFloat) {
  TwoPlates plates = platesOfCopies();
  const Vector3d far(1000, -500, 200);
  for (Vector3d& p : plates.cage.mesh.nodes) p += far;
  for (Vector3d& p : plates.mesh.positions) p = (p + far).cast<float>().cast<double>();
  EmbedReport report;
  const Result<Embedding> made = embed(plates.cage, plates.mesh, {}, &report);
  ASSERT_TRUE(made.ok()) << made.status().message;
  const auto bindings = made.value().bindings();
  for (std::size_t v = 0; v < bindings.size(); ++v) EXPECT_EQ(bindings[v].tet, plates.cage.vertexTets[v]);
  EXPECT_EQ(report.inside + report.outside, plates.mesh.vertexCount());
  EXPECT_LT(report.maxDistance, 1e-4);
}

TEST(MappedEmbedding, ReportsTheVertexThatRoundingPutFarthestOut) {
  TwoPlates plates = platesOfCopies();
  const int tet = plates.cage.vertexTets[4];
  const Tet& corners = plates.cage.mesh.tets[static_cast<std::size_t>(tet)];
  const auto& nodes = plates.cage.mesh.nodes;
  const Vector3d centroid = (nodes[corners[0]] + nodes[corners[1]] + nodes[corners[2]]) / 3.0;
  const Vector3d outwards = (centroid - nodes[corners[3]]).normalized();
  plates.mesh.positions[4] = centroid + 1e-4 * outwards;
  EmbedReport report;
  const Result<Embedding> made = embed(plates.cage, plates.mesh, {}, &report);
  ASSERT_TRUE(made.ok()) << made.status().message;
  EXPECT_EQ(report.outside, 1u);
  EXPECT_EQ(report.maxDistanceVertex, 4u);
  EXPECT_EQ(report.maxDistancePosition, plates.mesh.positions[4]);
  EXPECT_GT(report.maxDistance, 1e-5);
  EXPECT_LE(report.maxDistance, 1e-4);
  EXPECT_GT(report.maxBarycentricDistance, 0.0);
  EXPECT_EQ(made.value().bindings()[4].tet, tet);
  EXPECT_FALSE(made.value().bindings()[4].inside);

  EmbedOptions strict;
  strict.maxDistance = 1e-6;
  const Status refused = embed(plates.cage, plates.mesh, strict, &report).status();
  EXPECT_EQ(refused.code, StatusCode::OutsideCage);
  EXPECT_NE(refused.message.find("vertex 4"), std::string::npos) << refused.message;
}

TEST(MappedEmbedding, RefusesAnotherMesh) {
  const TwoPlates plates = platesOfCopies();
  TriangleMesh other = plates.mesh;
  other.positions[23].y() += 0.8;
  expectRefused(
      plates.cage, other, StatusCode::CageMismatch,
      {"vertex 23 at (", "is not in tet " + std::to_string(plates.cage.vertexTets[23]), "build a cage for this mesh"});
  other = plates.mesh;
  for (Vector3d& p : other.positions) p.x() += 0.5;
  expectRefused(plates.cage, other, StatusCode::CageMismatch, {"one of the two was moved"});
  other = plates.mesh;
  other.positions.push_back(other.positions[0]);
  expectRefused(plates.cage, other, StatusCode::CageMismatch,
                {"has 364 vertices, but the mesh has 365", "build a cage for this mesh"});
}

TEST(MappedEmbedding, LetsOnlyVerticesOfNoTriangleBeAnywhere) {
  TwoPlates plates = platesOfCopies();
  plates.cage.meshHash.reset();
  plates.mesh.positions.emplace_back(900.0, 0.0, 0.0);
  plates.cage.vertexTets.push_back(3);
  const std::size_t loose = plates.mesh.vertexCount() - 1;
  EmbedReport report;
  EmbedOptions strict;
  strict.maxDistance = 0.0;
  const Result<Embedding> made = embed(plates.cage, plates.mesh, strict, &report);
  ASSERT_TRUE(made.ok()) << made.status().message;
  EXPECT_EQ(report.outside, 1u);
  EXPECT_EQ(report.maxDistance, 0.0);
  EXPECT_LT(report.meshBox.max().x(), 5.0);
  EXPECT_FALSE(report.unitsDiffer());
  EXPECT_EQ(made.value().at(loose).tet, 3);
  EXPECT_FALSE(made.value().at(loose).inside);
  plates.mesh.triangles[0][0] = static_cast<int>(loose);
  expectRefused(plates.cage, plates.mesh, StatusCode::CageMismatch, {"vertex 364 at (900"});
  plates.mesh.triangles.clear();  // a cloud, of which all points count
  expectRefused(plates.cage, plates.mesh, StatusCode::CageMismatch, {"vertex 364 at (900"});
}

TEST(MappedEmbedding, RefusesAMapThatNamesAFlatTet) {
  TwoPlates plates = platesOfCopies();
  Tet& tet = plates.cage.mesh.tets[static_cast<std::size_t>(plates.cage.vertexTets[0])];
  tet[3] = tet[2];
  expectRefused(plates.cage, plates.mesh, StatusCode::Degenerate, {"to vertex 0, which is flat", "build"});
}

TEST(MappedEmbedding, RefusesCagesThatAreNotInOrder) {
  TwoPlates plates = platesOfCopies();
  plates.cage.volumeFraction.pop_back();
  expectRefused(plates.cage, plates.mesh, StatusCode::SizeMismatch, {"volumeFraction"});
  plates = platesOfCopies();
  plates.cage.vertexTets[3] = 1000;
  expectRefused(plates.cage, plates.mesh, StatusCode::IndexOutOfRange, {"assigns tet 1000 to vertex 3"});
  plates = platesOfCopies();
  plates.cage.mesh.tets[0][0] = -1;
  expectRefused(plates.cage, plates.mesh, StatusCode::IndexOutOfRange, {});
  plates = platesOfCopies();
  plates.mesh.positions[8].x() = std::numeric_limits<double>::quiet_NaN();
  expectRefused(plates.cage, plates.mesh, StatusCode::NonFinite, {"vertex 8"});
}

TEST(MappedEmbedding, IsTheSameAfterReversingTets) {
  TwoPlates plates = platesOfCopies();
  const auto before = embed(plates.cage, plates.mesh).value().bindings();
  for (Tet& tet : plates.cage.mesh.tets) std::swap(tet[2], tet[3]);
  const auto after = embed(plates.cage, plates.mesh).value().bindings();
  for (std::size_t v = 0; v < before.size(); ++v) {
    EXPECT_EQ(after[v].tet, before[v].tet);
    EXPECT_NEAR(after[v].weights[2], before[v].weights[3], 1e-6);
  }
}

TEST(MappedEmbedding, IsSavedAndLoaded) {
  const TwoPlates plates = platesOfCopies();
  const Embedding made = embed(plates.cage, plates.mesh).value();
  const std::vector<unsigned char> bytes = made.save(plates.cage.mesh);
  const Result<Embedding> loaded = Embedding::load(bytes.data(), bytes.size(), plates.cage.mesh);
  ASSERT_TRUE(loaded.ok()) << loaded.status().message;
  const auto before = made.bindings(), after = loaded.value().bindings();
  for (std::size_t v = 0; v < before.size(); ++v) EXPECT_EQ(after[v].tet, before[v].tet);
}

}  // namespace
}  // namespace tetskin::test
