// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Numbers as bytes, little-endian on every machine, with a hash that detects changes.
#pragma once

#include <tetskin/core/mesh.h>
#include <tetskin/core/src/base/hash.h>

#include <cmath>
#include <cstddef>
#include <cstring>
#include <vector>

namespace tetskin {

/// A hash of the nodes' positions and the tets' nodes, in their order. 0 and -0 are the same position.
inline std::uint64_t hashOf(const TetMesh& tets) {
  Hash hash;
  hash.add(std::uint64_t{tets.nodeCount()});
  for (const Eigen::Vector3d& node : tets.nodes) {
    for (const double x : {node.x(), node.y(), node.z()}) hash.add(x);
  }
  for (const Tet& tet : tets.tets) {
    for (const int node : tet) hash.add(std::uint64_t{static_cast<std::uint32_t>(node)});
  }
  return hash.value();
}

inline std::uint64_t readBytes(const unsigned char* from, std::size_t bytes) {
  std::uint64_t value = 0;
  for (std::size_t k = 0; k < bytes; ++k) value |= static_cast<std::uint64_t>(from[k]) << (8 * k);
  return value;
}

/// A hash of bytes, in words of eight; the last word is padded with zeros.
inline std::uint64_t hashOf(const unsigned char* bytes, std::size_t count) {
  Hash hash;
  std::size_t k = 0;
  for (; k + 8 <= count; k += 8) hash.add(readBytes(bytes + k, 8));
  if (k < count) hash.add(readBytes(bytes + k, count - k));
  hash.add(std::uint64_t{count});
  return hash.value();
}

class ByteWriter {
 public:
  explicit ByteWriter(std::size_t size) { bytes_.reserve(size); }

  /// Writes a tag of eight letters.
  void tag(const char* letters) { u64(readBytes(reinterpret_cast<const unsigned char*>(letters), 8)); }
  void u64(std::uint64_t value) { put(value, 8); }
  void u32(std::uint32_t value) { put(value, 4); }
  void plane(const float* values, std::size_t count) {
    for (std::size_t k = 0; k < count; ++k) {
      std::uint32_t bits;
      std::memcpy(&bits, values + k, sizeof bits);
      u32(bits);
    }
  }
  void plane(const double* values, std::size_t count) {
    for (std::size_t k = 0; k < count; ++k) {
      std::uint64_t bits;
      std::memcpy(&bits, values + k, sizeof bits);
      u64(bits);
    }
  }
  /// Returns all bytes, followed by their hash.
  std::vector<unsigned char> take() {
    u64(hashOf(bytes_.data(), bytes_.size()));
    return std::move(bytes_);
  }

 private:
  void put(std::uint64_t value, int count) {
    for (int k = 0; k < count; ++k) bytes_.push_back(static_cast<unsigned char>(value >> (8 * k)));
  }
  std::vector<unsigned char> bytes_;
};

/// Reads bytes whose number has been checked before.
class ByteReader {
 public:
  explicit ByteReader(const unsigned char* at) : at_(at) {}

  std::uint64_t u64() { return take(8); }
  std::uint32_t u32() { return static_cast<std::uint32_t>(take(4)); }
  /// These functions return true if all values are finite.
  bool plane(float* values, std::size_t count) {
    bool finite = true;
    for (std::size_t k = 0; k < count; ++k) {
      const std::uint32_t bits = u32();
      std::memcpy(values + k, &bits, sizeof bits);
      finite &= std::isfinite(values[k]);
    }
    return finite;
  }
  bool plane(double* values, std::size_t count) {
    bool finite = true;
    for (std::size_t k = 0; k < count; ++k) {
      const std::uint64_t bits = u64();
      std::memcpy(values + k, &bits, sizeof bits);
      finite &= std::isfinite(values[k]);
    }
    return finite;
  }

 private:
  std::uint64_t take(std::size_t count) {
    const unsigned char* from = at_;
    at_ += count;
    return readBytes(from, count);
  }
  const unsigned char* at_;
};

/// Size of the hash that `ByteWriter::take` appends.
constexpr std::size_t kHashBytes = 8;
/// True if the bytes are as `take` has returned them.
inline bool hashIsRight(const unsigned char* bytes, std::size_t count) {
  return count >= kHashBytes && ByteReader(bytes + count - kHashBytes).u64() == hashOf(bytes, count - kHashBytes);
}

}  // namespace tetskin
