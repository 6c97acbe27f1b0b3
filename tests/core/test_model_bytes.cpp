// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The bytes of meshes and cages that bindings to other languages make and read.
#include "support/odd_meshes.h"

#include <facade/models.h>
#include <tetskin/core/src/base/hash.h>

#include <cstring>

namespace tetskin::test {
namespace {

using ModelBytes = std::vector<unsigned char>;

template <class Model>
ModelBytes bytesOf(const Model& model) {
  ModelBytes bytes;
  facade::writeBytes(model, [&](std::size_t count) {
    bytes.resize(count);
    return bytes.data();
  });
  return bytes;
}

void hashAgain(ModelBytes& bytes) {
  const std::uint64_t hash = hashInLanes(bytes.data() + sizeof hash, bytes.size() - sizeof hash);
  std::memcpy(bytes.data(), &hash, sizeof hash);
}

TriangleMesh fullMesh() {
  TriangleMesh mesh = sphere(4, 1.0, Eigen::Vector3d::Zero());
  mesh.normals.resize(mesh.vertexCount(), {0, 0, 1});
  mesh.tangents.resize(mesh.vertexCount(), {1, 0, 0, 1});
  mesh.texcoords.resize(mesh.vertexCount(), {0, 1});
  mesh.groups = {{"one", "red", 0, 3}, {"other", "blue", 3, mesh.triangleCount() - 3}};
  return mesh;
}

Cage fullCage() {
  Cage cage = latticeCage(2, 1, 1);
  cage.masses.assign(cage.mesh.nodeCount(), 2.0);
  cage.volumeFraction.assign(cage.mesh.tetCount(), 0.5);
  cage.vertexTets = {3, 1, 4};
  cage.meshHash = 7;
  return cage;
}

/// Ok, or the error with which these bytes are refused.
StatusCode refusalOf(const ModelBytes& bytes) {
  try {
    (void)facade::meshOfBytes(bytes.data(), bytes.size());
  } catch (const facade::Failure& failure) {
    return failure.code;
  }
  return StatusCode::Ok;
}
StatusCode refusalOf(TriangleMesh mesh) {
  return refusalOf(bytesOf(facade::MeshModel{std::make_shared<TriangleMesh>(std::move(mesh))}));
}

TEST(ModelBytes, KeepAllThatAMeshHas) {
  const TriangleMesh mesh = fullMesh();
  const ModelBytes bytes = bytesOf(facade::MeshModel{std::make_shared<TriangleMesh>(mesh)});
  const TriangleMesh read = *facade::meshOfBytes(bytes.data(), bytes.size()).mesh;
  EXPECT_EQ(read.positions, mesh.positions);
  EXPECT_EQ(read.triangles, mesh.triangles);
  EXPECT_EQ(read.normals, mesh.normals);
  EXPECT_EQ(read.tangents, mesh.tangents);
  EXPECT_EQ(read.texcoords, mesh.texcoords);
  EXPECT_EQ(read.groups.size(), 2u);
  EXPECT_EQ(bytesOf(facade::MeshModel{std::make_shared<TriangleMesh>(read)}), bytes);
}

TEST(ModelBytes, OfAMeshThatDoesNotFitTogetherAreRefused) {
  EXPECT_EQ(refusalOf(fullMesh()), StatusCode::Ok);
  TriangleMesh mesh = fullMesh();
  mesh.groups[1].triangleCount -= 1;
  EXPECT_EQ(refusalOf(mesh), StatusCode::Malformed);
  mesh.groups[1].triangleCount += 2;
  EXPECT_EQ(refusalOf(mesh), StatusCode::Malformed);
  mesh = fullMesh();
  mesh.groups[1].firstTriangle = 2;
  EXPECT_EQ(refusalOf(mesh), StatusCode::Malformed);
  mesh = fullMesh();
  mesh.tangents.pop_back();
  EXPECT_EQ(refusalOf(mesh), StatusCode::SizeMismatch);
}

TEST(ModelBytes, OfAnotherLengthAreRefusedAlsoWithARightHash) {
  const ModelBytes good = bytesOf(facade::MeshModel{std::make_shared<TriangleMesh>(fullMesh())});
  for (const std::size_t length : {std::size_t(0), std::size_t(8), std::size_t(20), good.size() - 1, good.size() + 1}) {
    ModelBytes bytes = good;
    bytes.resize(length);
    if (length >= sizeof(std::uint64_t)) hashAgain(bytes);
    EXPECT_EQ(refusalOf(bytes), StatusCode::Malformed) << length;
  }
}

/// Damages bytes and hashes them again, many times: what is read is refused, or can be written. Returns how often it
/// was read. For builds with sanitizers.
template <class Read>
int readDamaged(const ModelBytes& good, Read&& read) {
  std::mt19937 random(2);
  int accepted = 0;
  for (int k = 0; k < 1000; ++k) {
    ModelBytes bytes = good;
    for (unsigned flips = 1 + random() % 3; flips > 0; --flips)
      bytes[8 + random() % (bytes.size() - 8)] ^= static_cast<unsigned char>(1u << random() % 8);
    hashAgain(bytes);
    try {
      EXPECT_EQ(bytesOf(read(bytes.data(), bytes.size())).size(), bytes.size());
      ++accepted;
    } catch (const facade::Failure& failure) {
      EXPECT_NE(failure.code, StatusCode::Ok);
    }
  }
  return accepted;
}

TEST(ModelBytes, ThatAreDamagedWithARightHashHarmNoMemory) {
  const facade::MeshModel mesh{std::make_shared<TriangleMesh>(fullMesh())};
  const facade::CageModel cage = facade::cageModel(fullCage(), "words");
  for (const int accepted :
       {readDamaged(bytesOf(mesh), facade::meshOfBytes), readDamaged(bytesOf(cage), facade::cageOfBytes)}) {
    EXPECT_GT(accepted, 100);  // most bytes are numbers, which may have any value
    EXPECT_LT(accepted, 1000);
  }
}

}  // namespace
}  // namespace tetskin::test
