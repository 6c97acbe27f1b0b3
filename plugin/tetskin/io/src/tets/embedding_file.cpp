// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/io/files.h>
#include <tetskin/io/src/text/atomic_file.h>
#include <tetskin/io/src/text/file_text.h>

namespace tetskin {

Status saveEmbedding(const Embedding& embedding, const TetMesh& cage, const std::string& path) {
  const std::vector<unsigned char> bytes = embedding.save(cage);
  return io::writeFile(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

Result<Embedding> loadEmbedding(const std::string& path, const TetMesh& cage) {
  const Result<std::string> bytes = io::readFile(path);
  if (!bytes.ok()) return bytes.status();
  const auto* data = reinterpret_cast<const unsigned char*>(bytes.value().data());
  Result<Embedding> loaded = Embedding::load(data, bytes.value().size(), cage);
  if (!loaded.ok()) return io::fileError(loaded.status().code, path, 0, loaded.status().message);
  return loaded;
}

}  // namespace tetskin
