// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "support/embed_into.h"
#include "support/odd_meshes.h"

#include <tetskin/core/embedding.h>
#include <tetskin/core/mesh_skin.h>
#include <tetskin/core/src/base/bytes.h>
#include <tetskin/core/src/base/embedding/embedding_data.h>

#include <cstdint>
#include <cstring>

namespace tetskin {
namespace {

using Bytes = std::vector<unsigned char>;

bool sameFloats(const float* a, const float* b, std::size_t count) {
  return count == 0 || std::memcmp(a, b, count * sizeof(float)) == 0;
}

/// Whether two embeddings are equal to the bit, including padding.
bool same(const Embedding& one, const Embedding& other) {
  const EmbeddingData &a = dataOf(one), &b = dataOf(other);
  if (a.vertexCount() != b.vertexCount() || a.insideCount != b.insideCount || a.nodeCount != b.nodeCount ||
      a.tetCount != b.tetCount || a.insideRunCount != b.insideRunCount) {
    return false;
  }
  const auto sameRun = [](const EmbeddingData::Run& x, const EmbeddingData::Run& y) {
    return std::equal(x.nodes, x.nodes + 4, y.nodes) && x.firstSlot == y.firstSlot && x.tet == y.tet;
  };
  if (!std::equal(a.runs.begin(), a.runs.end(), b.runs.begin(), b.runs.end(), sameRun)) return false;
  const auto samePlane = [](const std::vector<float>& x, const std::vector<float>& y, std::size_t count) {
    return x.size() == count + EmbeddingData::kPadding && y.size() == x.size() &&
           sameFloats(x.data(), y.data(), x.size());
  };
  for (std::size_t k = 0; k < 3; ++k) {
    if (!samePlane(a.weights[k], b.weights[k], a.vertexCount())) return false;
    if (!samePlane(a.closestWeights[k], b.closestWeights[k], a.vertexCount() - a.insideCount)) return false;
  }
  return a.slotVertices == b.slotVertices && a.vertexSlots == b.vertexSlots;
}

class SavedEmbedding : public testing::Test {
 protected:
  SavedEmbedding() { embedAround(1.2, 60); }

  void embedAround(double factor, std::size_t count) {
    const Eigen::Vector3d half = Eigen::Vector3d::Constant(0.5 * factor), centre = Eigen::Vector3d::Constant(0.5);
    const auto vertices = test::randomPoints(count, {centre - half, centre + half}, 6);
    EXPECT_TRUE(embedInto(cage, viewOf(vertices), {}, embedding).ok());
    bytes = embedding.save(cage);
  }

  static Result<Embedding> load(const Bytes& from, const TetMesh& with) {
    return Embedding::load(from.data(), from.size(), with);
  }
  void refused(const Bytes& from, const TetMesh& with, StatusCode code, const char* mentions) const {
    const Result<Embedding> loaded = load(from, with);
    EXPECT_EQ(loaded.status().code, code) << loaded.status().message;
    EXPECT_NE(loaded.status().message.find(mentions), std::string::npos) << loaded.status().message;
  }

  TetMesh cage = test::latticeCage(2, 2, 2, 0.5);
  Embedding embedding;
  Bytes bytes;
};

TEST_F(SavedEmbedding, IsTheSameToTheBit) {
  for (const double factor : {0.9, 1.2, 3.0}) {
    embedAround(factor, 3000);
    const Result<Embedding> loaded = load(bytes, cage);
    ASSERT_TRUE(loaded.ok()) << loaded.status().message;
    EXPECT_TRUE(same(loaded.value(), embedding));
    EXPECT_EQ(loaded.value().save(cage), bytes);
  }
}

TEST_F(SavedEmbedding, AllVerticesInsideOrOutside) {
  embedAround(0.9, 500);
  ASSERT_EQ(embedding.insideCount(), 500u);
  EXPECT_TRUE(same(load(bytes, cage).value(), embedding));
  const std::vector<Eigen::Vector3d> outside{{2, 2, 2}, {-1, 0, 0}, {0.5, 0.5, 7}};
  ASSERT_TRUE(embedInto(cage, viewOf(outside), {}, embedding).ok());
  ASSERT_EQ(embedding.insideCount(), 0u);
  bytes = embedding.save(cage);
  EXPECT_TRUE(same(load(bytes, cage).value(), embedding));
}

TEST_F(SavedEmbedding, FormatOfVersion1DoesNotChange) {
  cage = test::singleTet();
  const std::vector<Eigen::Vector3d> vertices{{0.25, 0.25, 0.25}, {0.0, 0.0, -1.0}};
  ASSERT_TRUE(embedInto(cage, viewOf(vertices), {}, embedding).ok());
  bytes = embedding.save(cage);
  ASSERT_EQ(bytes.size(), 72u + 2 * 8 + 2 * 16 + 12 + 8);
  EXPECT_EQ(std::string(bytes.begin(), bytes.begin() + 8), "tetskemb");
  EXPECT_EQ(bytes[8], 1);
  EXPECT_EQ(bytes[24], 4);                              // number of nodes
  EXPECT_EQ(bytes[32], 1);                              // number of tets
  EXPECT_EQ(bytes[40], 2);                              // number of vertices
  EXPECT_EQ(bytes[48], 1);                              // number of vertices inside
  const unsigned char quarter[4] = {0, 0, 0x80, 0x3e};  // 0.25f, little-endian
  EXPECT_EQ(std::memcmp(&bytes[72 + 2 * 8 + 2 * 4], quarter, 4), 0);
}

TEST_F(SavedEmbedding, EveryDamagedByteIsNoticed) {
  for (std::size_t k = 0; k < bytes.size(); ++k) {
    for (const int bits : {0x01, 0x80, 0xFF}) {
      Bytes bad = bytes;
      bad[k] = static_cast<unsigned char>(bad[k] ^ bits);
      EXPECT_FALSE(load(bad, cage).ok()) << "byte " << k;
    }
  }
}

TEST_F(SavedEmbedding, EveryOtherLengthIsNoticed) {
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    EXPECT_FALSE(load(Bytes(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length)), cage).ok());
  }
  Bytes longer = bytes;
  longer.push_back(0);
  refused(longer, cage, StatusCode::Malformed, "should have");
  bytes.resize(bytes.size() / 2);
  refused(bytes, cage, StatusCode::Malformed, "should have");
  bytes.resize(20);
  refused(bytes, cage, StatusCode::Malformed, "header");
  refused({}, cage, StatusCode::UnsupportedFormat, "not an embedding");
}

TEST_F(SavedEmbedding, OtherFormatsAndVersionsAreRefused) {
  Bytes other = bytes;
  other[8] = 2;
  refused(other, cage, StatusCode::UnsupportedFormat, "version 2");
  other = bytes;
  other[0] = 'X';
  refused(other, cage, StatusCode::UnsupportedFormat, "not an embedding");
}

TEST_F(SavedEmbedding, DamageIsCalledDamage) {
  bytes[bytes.size() / 2] ^= 4;
  refused(bytes, cage, StatusCode::Malformed, "damaged");
}

TEST_F(SavedEmbedding, AnyOtherCageIsRefused) {
  TetMesh moved = cage;
  moved.nodes[13].y() = std::nextafter(moved.nodes[13].y(), 9.0);
  refused(bytes, moved, StatusCode::CageMismatch, "rest nodes or tets");
  TetMesh turned = cage;
  std::swap(turned.tets[5][0], turned.tets[5][1]);
  refused(bytes, turned, StatusCode::CageMismatch, "rest nodes or tets");
  TetMesh reordered = cage;
  std::swap(reordered.tets[5], reordered.tets[6]);
  refused(bytes, reordered, StatusCode::CageMismatch, "rest nodes or tets");
  TetMesh fewer = cage;
  fewer.tets.pop_back();
  refused(bytes, fewer, StatusCode::CageMismatch, "48 tets");
  refused(bytes, TetMesh{}, StatusCode::CageMismatch, "nodes");
}

TEST_F(SavedEmbedding, MinusZeroIsTheSamePlace) {
  ASSERT_EQ(cage.nodes[0], Eigen::Vector3d::Zero());
  cage.nodes[0].x() = -0.0;
  EXPECT_TRUE(load(bytes, cage).ok());
}

TEST_F(SavedEmbedding, CarriesASkinAsTheOriginalDoes) {
  const TriangleMesh mesh = test::sphere(20, 0.53, Eigen::Vector3d::Constant(0.5));
  for (const Normals normals : {Normals::None, Normals::Transformed, Normals::Recomputed}) {
    SkinOptions options;
    options.interpolation = Interpolation::Quadratic;
    options.normals = normals;
    MeshSkin<float> original, again;
    ASSERT_TRUE(original.bind(cage, mesh, options).ok());
    const Bytes saved = original.binding()->embedding().save(cage);
    const auto binding = SkinBinding<float>::create(cage, mesh, options, load(saved, cage).value()).value();
    ASSERT_TRUE(binding);
    std::vector<Eigen::Vector3f> nodes;
    for (const Eigen::Vector3d& p : cage.nodes) nodes.emplace_back(p.x(), p.y() + p.x() * p.z(), p.z());
    ASSERT_TRUE(again.bind(binding, viewOf(std::as_const(nodes)), instanceOf(options)).ok());
    ASSERT_EQ(original.update(viewOf(std::as_const(nodes))), StatusCode::Ok);
    ASSERT_EQ(again.positions().size(), original.positions().size());
    EXPECT_TRUE(sameFloats(again.positions().data(), original.positions().data(), 3 * mesh.vertexCount()));
    ASSERT_EQ(again.normals().size(), original.normals().size());
    EXPECT_TRUE(sameFloats(again.normals().data(), original.normals().data(), 3 * again.normals().size()));
  }
}

TEST_F(SavedEmbedding, OfAnotherMeshOrCageCarriesNoSkin) {
  const auto refuses = [&](const TetMesh& with, const TriangleMesh& mesh, const char* mentions) {
    const auto made = SkinBinding<float>::create(with, mesh, {}, embedding);
    EXPECT_EQ(made.status().code, StatusCode::SizeMismatch);
    EXPECT_NE(made.status().message.find(mentions), std::string::npos) << made.status().message;
  };
  TriangleMesh mesh;
  mesh.positions.assign(60, Eigen::Vector3d::Zero());
  refuses(test::singleTet(), mesh, "4 nodes");
  TetMesh fewer = cage;
  fewer.tets.pop_back();
  refuses(fewer, mesh, "47 tets");
  mesh.positions.pop_back();
  refuses(cage, mesh, "59 vertices");
}

/// Corrects the checksum, so that the data after it is tested.
void seal(Bytes& bytes) {
  std::uint64_t hash = hashOf(bytes.data(), bytes.size() - 8);
  for (std::size_t at = bytes.size() - 8; at < bytes.size(); ++at, hash >>= 8) bytes[at] = hash & 0xFF;
}

TEST_F(SavedEmbedding, SealIsTheChecksum) {
  Bytes again = bytes;
  seal(again);
  EXPECT_EQ(again, bytes);
  // Saved data of other versions has this hash.
  const std::string words = "tetskin, 19 letters";
  EXPECT_EQ(hashOf(reinterpret_cast<const unsigned char*>(words.data()), words.size()), 0x52CEFADC2DDDC3DDu);
}

TEST_F(SavedEmbedding, ForgeriesAreRefusedOrSound) {
  // Loaded data must be valid: a permutation, runs in order, and existing tets.
  std::mt19937 random(7);
  int loadedOnes = 0;
  for (int round = 0; round < 20000; ++round) {
    Bytes forged = bytes;
    const std::size_t changes = 1 + random() % 3;
    for (std::size_t c = 0; c < changes; ++c) {
      const std::size_t at = 24 + random() % (forged.size() - 32);
      forged[at] = static_cast<unsigned char>(random() % 4 == 0 ? random() : random() % 8);
    }
    seal(forged);
    const Result<Embedding> loaded = load(forged, cage);
    if (!loaded.ok()) continue;
    ++loadedOnes;
    const Embedding& e = loaded.value();
    std::vector<std::uint32_t> vertices = e.slotVertices();
    std::sort(vertices.begin(), vertices.end());
    for (std::uint32_t v = 0; v < vertices.size(); ++v) ASSERT_EQ(vertices[v], v);
    ASSERT_EQ(dataOf(e).runs.back().firstSlot, e.vertexCount());
    for (const VertexBinding& binding : e.bindings()) ASSERT_LT(static_cast<std::size_t>(binding.tet), e.tetCount());
  }
  EXPECT_GT(loadedOnes, 1000);  // the loaded ones have other weights
}

TEST_F(SavedEmbedding, HugeCountsAreRefused) {
  for (std::size_t field = 24; field < 72; field += 8) {
    for (const int width : {4, 5, 8}) {
      Bytes forged = bytes;
      std::fill_n(forged.begin() + static_cast<std::ptrdiff_t>(field), width, static_cast<unsigned char>(0xFF));
      seal(forged);
      EXPECT_FALSE(load(forged, cage).ok());
    }
  }
}

}  // namespace
}  // namespace tetskin
