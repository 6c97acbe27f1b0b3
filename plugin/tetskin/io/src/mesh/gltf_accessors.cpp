// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// This work is based on:
//   "glTF 2.0 Specification", Khronos Group, 2021, 3.6 "Binary Data Storage"
//   "KHR_mesh_quantization", Khronos Group
#include <tetskin/io/src/mesh/gltf_accessors.h>
#include <tetskin/io/src/mesh/gltf_uri.h>
#include <tetskin/io/src/text/binary_numbers.h>
#include <tetskin/io/src/text/file_text.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace tetskin::io {

namespace {

NumberType numberType(int component) {
  switch (component) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return {1};
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return {1, false, false};
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return {2};
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return {2, false, false};
    case TINYGLTF_COMPONENT_TYPE_INT:
      return {4};
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return {4, false, false};
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      return {4, true};
    case TINYGLTF_COMPONENT_TYPE_DOUBLE:
      return {8, true};
    default:
      return {};
  }
}

/// The largest value of an integer type, by which normalised numbers are divided; 1 for other types.
double largestOf(const NumberType& type) {
  return type.real ? 1.0 : std::ldexp(1.0, static_cast<int>(8 * type.bytes) - (type.sign ? 1 : 0)) - 1.0;
}

}  // namespace

Status GltfAccessors::error(StatusCode code, const std::string& what) const {
  return fileError(code, path_, 0, what + "; export the model again");
}

Status GltfAccessors::needs(const std::string& extension) const {
  return fileError(StatusCode::UnsupportedFormat, path_, 0,
                   "needs the extension " + excerpt(extension) +
                       ", which is not supported; save it without (Blender: no compression; gltfpack: without -c)");
}

Status GltfAccessors::bufferBytes(int buffer, std::string_view& bytes) {
  const tinygltf::Value& buffers = model_.extras;
  if (buffer < 0 || static_cast<std::size_t>(buffer) >= buffers.ArrayLen()) {
    return error(StatusCode::IndexOutOfRange,
                 "refers to buffer " + std::to_string(buffer) + " of " + std::to_string(buffers.ArrayLen()));
  }
  const tinygltf::Value& stated = buffers.Get(buffer);
  const bool hasUri = stated.Has("uri") && stated.Get("uri").IsString();
  if (!hasUri && buffer == 0 && binaryChunk_) {
    bytes = *binaryChunk_;
    return {};
  }
  const auto known = buffers_.find(buffer);
  if (known != buffers_.end()) {
    bytes = known->second;
    return {};
  }
  if (!hasUri) {
    const std::vector<std::string> extensions =
        stated.Has("extensions") ? stated.Get("extensions").Keys() : std::vector<std::string>();
    if (!extensions.empty()) return needs(extensions.front());
    return error(StatusCode::Malformed, "has no data for buffer " + std::to_string(buffer));
  }
  Result<std::string> read = readUri(path_, stated.Get("uri").Get<std::string>());
  if (!read.ok()) return read.status();
  bytes = buffers_[buffer] = std::move(read).value();
  return {};
}

Status GltfAccessors::viewBytes(int view, std::string_view& bytes) {
  if (view < 0 || static_cast<std::size_t>(view) >= model_.bufferViews.size()) {
    return error(StatusCode::IndexOutOfRange,
                 "refers to buffer view " + std::to_string(view) + " of " + std::to_string(model_.bufferViews.size()));
  }
  const tinygltf::BufferView& stated = model_.bufferViews[static_cast<std::size_t>(view)];
  std::string_view buffer;
  if (Status status = bufferBytes(stated.buffer, buffer); !status.ok()) return status;
  if (stated.byteOffset > buffer.size() || stated.byteLength > buffer.size() - stated.byteOffset) {
    return error(StatusCode::Malformed, "has " + std::to_string(stated.byteLength) + " bytes from " +
                                            std::to_string(stated.byteOffset) + " on in buffer view " +
                                            std::to_string(view) + ", but its buffer contains " +
                                            std::to_string(buffer.size()) + "; is it complete?");
  }
  bytes = buffer.substr(stated.byteOffset, stated.byteLength);
  return {};
}

/// Passes each number to take(element, k, number).
template <class Take>
Status GltfAccessors::readElements(const Elements& elements, Take&& take) {
  std::string_view bytes;
  if (Status status = viewBytes(elements.view, bytes); !status.ok()) return status;
  const NumberType type = numberType(elements.component);
  const std::uint64_t size = type.bytes * elements.arity;
  const std::uint64_t stated = model_.bufferViews[static_cast<std::size_t>(elements.view)].byteStride;
  const std::uint64_t stride = stated == 0 || elements.packed ? size : stated;
  if (size == 0) {
    return error(StatusCode::Malformed, "has numbers of type " + std::to_string(elements.component));
  }
  // The last element is not padded to the stride.
  if (elements.count > 0 && (elements.offset > bytes.size() || bytes.size() - elements.offset < size ||
                             elements.count - 1 > (bytes.size() - elements.offset - size) / stride)) {
    return error(StatusCode::Malformed, "states " + std::to_string(elements.count) + " elements in buffer view " +
                                            std::to_string(elements.view) + ", which has room for fewer");
  }
  for (std::uint64_t e = 0; e < elements.count; ++e) {
    const char* data = bytes.data() + elements.offset + e * stride;
    for (std::uint64_t k = 0; k < elements.arity; ++k) {
      take(e, k, decodeNumber(data + k * type.bytes, type, ByteOrder::Little));
    }
  }
  return {};
}

/// Replaces some of the elements, as given by the accessor's indices and values.
Status GltfAccessors::addSparse(const tinygltf::Accessor& accessor, std::uint64_t arity, std::vector<double>& numbers) {
  const auto& sparse = accessor.sparse;
  if (sparse.count < 0 || sparse.indices.byteOffset < 0 || sparse.values.byteOffset < 0) {
    return error(StatusCode::Malformed, "has a sparse accessor with a negative count or offset");
  }
  const auto count = static_cast<std::uint64_t>(sparse.count);
  std::vector<double> indices;
  Status status = readElements({sparse.indices.bufferView, static_cast<std::uint64_t>(sparse.indices.byteOffset),
                                sparse.indices.componentType, 1, count, true},
                               [&](std::uint64_t, std::uint64_t, double index) { indices.push_back(index); });
  if (!status.ok()) return status;
  for (const double index : indices) {
    if (index >= 0.0 && index < static_cast<double>(accessor.count)) continue;
    return error(StatusCode::IndexOutOfRange, "has a sparse accessor that replaces elements beyond its last");
  }
  return readElements({sparse.values.bufferView, static_cast<std::uint64_t>(sparse.values.byteOffset),
                       accessor.componentType, arity, count, true},
                      [&](std::uint64_t e, std::uint64_t k, double number) {
                        numbers[static_cast<std::size_t>(indices[e]) * arity + k] = number;
                      });
}

Status GltfAccessors::read(int accessor, int arity, std::vector<double>& numbers) {
  assert(arity >= 1 && arity <= 4);
  if (accessor < 0 || static_cast<std::size_t>(accessor) >= model_.accessors.size()) {
    return error(StatusCode::IndexOutOfRange,
                 "refers to accessor " + std::to_string(accessor) + " of " + std::to_string(model_.accessors.size()));
  }
  const tinygltf::Accessor& stated = model_.accessors[static_cast<std::size_t>(accessor)];
  const int types[] = {TINYGLTF_TYPE_SCALAR, TINYGLTF_TYPE_VEC2, TINYGLTF_TYPE_VEC3, TINYGLTF_TYPE_VEC4};
  if (stated.type != types[arity - 1]) {
    return error(StatusCode::Malformed, "has another number than " + std::to_string(arity) +
                                            " of components in accessor " + std::to_string(accessor));
  }
  const auto width = static_cast<std::uint64_t>(arity);
  numbers.clear();
  Status status;
  if (stated.bufferView != -1) {
    status = readElements({stated.bufferView, stated.byteOffset, stated.componentType, width, stated.count, false},
                          [&](std::uint64_t, std::uint64_t, double number) { numbers.push_back(number); });
  } else {
    // A file can request any number of zeros: no more are created than a reasonable model may have.
    constexpr std::uint64_t kMaxZeros = std::uint64_t(1) << 24;
    if (stated.count > kMaxZeros) {
      return error(StatusCode::Malformed, "states " + std::to_string(stated.count) + " elements without data");
    }
    numbers.resize(stated.count * width, 0.0);
  }
  if (status.ok() && stated.sparse.isSparse) status = addSparse(stated, width, numbers);
  if (!status.ok() || !stated.normalized) return status;
  const NumberType type = numberType(stated.componentType);
  const double largest = largestOf(type);
  for (double& number : numbers) number = std::max(number / largest, type.real ? number : -1.0);
  return {};
}

}  // namespace tetskin::io
