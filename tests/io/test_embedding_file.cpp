// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "support/embed_into.h"
#include "support/odd_meshes.h"
#include "temp_folder.h"

#include <tetskin/io/files.h>

namespace tetskin::test {
namespace {

class EmbeddingFile : public testing::Test {
 protected:
  EmbeddingFile() {
    const auto vertices = randomPoints(500, {Eigen::Vector3d::Constant(-0.1), Eigen::Vector3d::Constant(1.1)}, 1);
    EXPECT_TRUE(embedInto(cage, viewOf(vertices), {}, embedding).ok());
  }

  TetMesh cage = latticeCage(3, 3, 3, 1.0 / 3.0);
  Embedding embedding;
  TempFolder folder;
};

TEST_F(EmbeddingFile, IsTheSameAfterSavingAndLoading) {
  const std::string path = folder.path("dragon.tetskin");
  ASSERT_TRUE(saveEmbedding(embedding, cage, path).ok());
  const Result<Embedding> loaded = loadEmbedding(path, cage);
  ASSERT_TRUE(loaded.ok()) << loaded.status().message;
  EXPECT_EQ(loaded.value().save(cage), embedding.save(cage));
}

TEST_F(EmbeddingFile, FitsACageThatWasSavedAndLoaded) {
  for (const char* name : {"cage.vtk", "cage.ele"}) {
    ASSERT_TRUE(saveTetMesh(cage, folder.path(name)).ok());
    ASSERT_TRUE(saveEmbedding(embedding, cage, folder.path("saved")).ok());
    const Result<TetMesh> again = loadTetMesh(folder.path(name));
    ASSERT_TRUE(again.ok()) << again.status().message;
    EXPECT_TRUE(loadEmbedding(folder.path("saved"), again.value()).ok()) << name;
  }
}

TEST_F(EmbeddingFile, FaultsNameTheFile) {
  const std::string path = folder.path("saved");
  expectError(loadEmbedding(path, cage), kFileNotFound, {path});
  expectError(saveEmbedding(embedding, cage, folder.path("no/such/folder")), StatusCode::FileNotWritable, {"folder"});
  ASSERT_TRUE(saveEmbedding(embedding, cage, path).ok());
  expectError(loadEmbedding(path, latticeCage(2, 2, 2)), StatusCode::CageMismatch, {path, "64 nodes"});
  std::string bytes = TempFolder::read(path);
  bytes[100] = static_cast<char>(bytes[100] ^ 1);
  expectError(loadEmbedding(folder.write("bad", bytes), cage), kMalformed, {"bad", "damaged"});
  expectError(loadEmbedding(folder.write("other", "v 0 0 0\n"), cage), kUnsupportedFormat, {"other"});
}

}  // namespace
}  // namespace tetskin::test
