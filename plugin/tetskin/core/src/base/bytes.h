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
#include <string>
#include <type_traits>
#include <vector>

namespace tetskin {

/// A hash of the nodes' positions and the tets' nodes, in order. 0 and -0 are the same position.
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

/// An integer with the bits of a float or a double.
template <class Scalar>
using BitsOf = std::conditional_t<sizeof(Scalar) == 4, std::uint32_t, std::uint64_t>;

/// Appends a number to a string or a vector, the lowest byte first.
template <class Number, class Bytes>
void appendLittleEndian(Number number, Bytes& bytes) {
  if constexpr (std::is_floating_point_v<Number>) {
    BitsOf<Number> bits;
    std::memcpy(&bits, &number, sizeof bits);
    appendLittleEndian(bits, bytes);
  } else {
    static_assert(std::is_unsigned_v<Number>);
    for (std::size_t k = 0; k < sizeof number; ++k)
      bytes.push_back(static_cast<typename Bytes::value_type>(number >> (8 * k) & 0xFF));
  }
}

class ByteWriter {
 public:
  explicit ByteWriter(std::size_t size) { bytes_.reserve(size); }

  /// Writes a tag of eight letters.
  void tag(const char* letters) { u64(readBytes(reinterpret_cast<const unsigned char*>(letters), 8)); }
  void u64(std::uint64_t value) { appendLittleEndian(value, bytes_); }
  void u32(std::uint32_t value) { appendLittleEndian(value, bytes_); }
  template <class Scalar>
  void plane(const Scalar* values, std::size_t count) {
    for (std::size_t k = 0; k < count; ++k) appendLittleEndian(values[k], bytes_);
  }
  /// Returns all bytes, followed by their hash.
  std::vector<unsigned char> take() {
    u64(hashOf(bytes_.data(), bytes_.size()));
    return std::move(bytes_);
  }

 private:
  std::vector<unsigned char> bytes_;
};

/// Reads bytes whose count has already been checked.
class ByteReader {
 public:
  explicit ByteReader(const unsigned char* at) : at_(at) {}

  std::uint64_t u64() { return take(8); }
  std::uint32_t u32() { return static_cast<std::uint32_t>(take(4)); }
  /// Returns true if all values are finite.
  template <class Scalar>
  bool plane(Scalar* values, std::size_t count) {
    bool finite = true;
    for (std::size_t k = 0; k < count; ++k) {
      const auto bits = static_cast<BitsOf<Scalar>>(take(sizeof(Scalar)));
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
/// True if the bytes are unchanged since `take` returned them.
inline bool hashIsRight(const unsigned char* bytes, std::size_t count) {
  return count >= kHashBytes && ByteReader(bytes + count - kHashBytes).u64() == hashOf(bytes, count - kHashBytes);
}

/// The format of saved bytes: eight letters and the version, the rest of a header, anything, and the hash.
struct SavedFormat {
  const char* letters;
  std::uint64_t version;
  std::size_t headerBytes;
  const char *what, *name, *cure;  ///< for messages: "an embedding", "the saved embedding", "embed again"

  Status damaged(const std::string& how) const {
    return {StatusCode::Malformed, std::string(name) + " " + how + "; " + cure};
  }
  /// Ok if the bytes begin with a header of this format.
  Status check(const unsigned char* bytes, std::size_t count) const {
    if (count < 8 || std::memcmp(bytes, letters, 8) != 0) {
      return {StatusCode::UnsupportedFormat, std::string("these bytes are not ") + what + " saved by tetskin"};
    }
    if (count < headerBytes + kHashBytes) return damaged("ends within its header");
    const std::uint64_t own = ByteReader(bytes + 8).u64();
    if (own == version) return {};
    return {StatusCode::UnsupportedFormat, std::string(name) + " has version " + std::to_string(own) +
                                               ", but this library reads version " + std::to_string(version) +
                                               " only; " + cure};
  }
};

}  // namespace tetskin
