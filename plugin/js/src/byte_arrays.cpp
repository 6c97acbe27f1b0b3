// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "byte_arrays.h"

#include <tetskin/core/src/base/bytes.h>

namespace tetskin::js {
namespace {

constexpr char kMeshTag[] = "tsk-me01", kCageTag[] = "tsk-ca01";
constexpr std::size_t kTagBytes = 8;

/// An array as its size in bytes, followed by the bytes. WebAssembly is little-endian on every machine.
class Writer {
 public:
  explicit Writer(const char* tag) : bytes_(tag, tag + kTagBytes) {}
  template <class T>
  void array(const std::vector<T>& values) {
    append(values.data(), values.size() * sizeof(T));
  }
  void append(const void* data, std::size_t count) {
    const std::uint64_t size = count;
    const auto* head = reinterpret_cast<const unsigned char*>(&size);
    bytes_.insert(bytes_.end(), head, head + sizeof size);
    const auto* from = static_cast<const unsigned char*>(data);
    bytes_.insert(bytes_.end(), from, from + count);
  }
  std::vector<unsigned char> take() {
    const std::uint64_t hash = hashOf(bytes_.data(), bytes_.size());
    const auto* tail = reinterpret_cast<const unsigned char*>(&hash);
    bytes_.insert(bytes_.end(), tail, tail + sizeof hash);
    return std::move(bytes_);
  }

 private:
  std::vector<unsigned char> bytes_;
};

class Reader {
 public:
  Reader(const char* tag, const unsigned char* bytes, std::size_t count) : at_(bytes), left_(count) {
    if (count < kTagBytes + kHashBytes || std::memcmp(bytes, tag, kTagBytes) != 0 || !hashIsRight(bytes, count))
      damaged();
    at_ += kTagBytes;
    left_ -= kTagBytes + kHashBytes;
  }
  template <class T>
  void array(std::vector<T>& values) {
    const std::size_t size = next();
    if (size % sizeof(T) != 0) damaged();
    values.resize(size / sizeof(T));
    if (size > 0) std::memcpy(static_cast<void*>(values.data()), at_, size);
    skip(size);
  }
  std::string text() {
    const std::size_t size = next();
    std::string letters(reinterpret_cast<const char*>(at_), size);
    skip(size);
    return letters;
  }

 private:
  [[noreturn]] static void damaged() {
    fail(StatusCode::Malformed, "these are not the bytes that toBytes of this version of tetskin returns");
  }
  std::size_t next() {
    if (left_ < sizeof(std::uint64_t)) damaged();
    const std::uint64_t size = readBytes(at_, sizeof size);
    skip(sizeof size);
    if (size > left_) damaged();
    return static_cast<std::size_t>(size);
  }
  void skip(std::size_t count) {
    at_ += count;
    left_ -= count;
  }
  const unsigned char* at_;
  std::size_t left_;
};

/// Visits the arrays in their order, for a Writer or a Reader.
template <class Stream, class Mesh>
void serializeMesh(Stream& stream, Mesh& mesh) {
  stream.array(mesh.positions);
  stream.array(mesh.triangles);
  stream.array(mesh.normals);
  stream.array(mesh.texcoords);
}
template <class Stream, class AnyCage>
void serializeCage(Stream& stream, AnyCage& cage) {
  stream.array(cage.mesh.nodes);
  stream.array(cage.mesh.tets);
  stream.array(cage.vertexTets);
  stream.array(cage.volumeFraction);
  stream.array(cage.stiffnessFactor);
  stream.array(cage.masses);
  stream.array(cage.component);
  stream.array(cage.sourceTet);
  stream.array(cage.quadraticTet);
  stream.array(cage.fineVolumeFraction);
}

void checkLength(std::size_t length, std::size_t vertices) {
  if (length != 0 && length != vertices) fail(StatusCode::SizeMismatch, "bytes of a mesh: an array is too short");
}

}  // namespace

std::vector<unsigned char> bytesOf(const TriangleMesh& mesh) {
  Writer writer(kMeshTag);
  serializeMesh(writer, mesh);
  return writer.take();
}

MeshModel meshOfBytes(const unsigned char* bytes, std::size_t count) {
  Reader reader(kMeshTag, bytes, count);
  auto mesh = std::make_shared<TriangleMesh>();
  serializeMesh(reader, *mesh);
  check(validate(*mesh));
  checkLength(mesh->normals.size(), mesh->vertexCount());
  checkLength(mesh->texcoords.size(), mesh->vertexCount());
  return {std::move(mesh)};
}

std::vector<unsigned char> bytesOf(const CageModel& model) {
  const Cage& cage = *model.cage;
  Writer writer(kCageTag);
  serializeCage(writer, cage);
  std::vector<std::uint64_t> hash;
  if (cage.meshHash) hash.push_back(*cage.meshHash);
  writer.array(hash);
  writer.append(model.cage->report.data(), model.cage->report.size());
  return writer.take();
}

CageModel cageOfBytes(const unsigned char* bytes, std::size_t count) {
  Reader reader(kCageTag, bytes, count);
  Cage cage;
  serializeCage(reader, cage);
  std::vector<std::uint64_t> hash;
  reader.array(hash);
  if (!hash.empty()) cage.meshHash = hash.front();
  std::string report = reader.text();
  check(validate(cage));
  return cageModel(std::move(cage), std::move(report));
}

}  // namespace tetskin::js
