// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// This work is based on:
//   "Geomview Manual", The Geometry Center, chapter "OFF Files"
#include <tetskin/io/src/mesh/mesh_readers.h>
#include <tetskin/io/src/mesh/polygon.h>
#include <tetskin/io/src/mesh/unit_normal.h>
#include <tetskin/io/src/text/coordinate_fault.h>
#include <tetskin/io/src/text/file_text.h>
#include <tetskin/io/src/text/text_records.h>

#include <cstdint>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace tetskin::io {

namespace {

class OffReader {
 public:
  OffReader(const std::string& path, std::string_view text) : path_(path), records_(text), record_(records_.next()) {}
  Result<TriangleMesh> read();

 private:
  Status readHeader();
  Status readMark(std::string_view mark);
  /// The next word, on this line or a later one.
  std::string_view word();
  template <class Number>
  bool number(Number& value);
  Status readVertex();
  Status readFace();
  Status error(StatusCode code, const std::string& what) const { return fileError(code, path_, record_.line(), what); }

  const std::string& path_;
  TextRecords records_;
  TextScanner record_;
  bool hasNormals_ = false;
  std::uint64_t vertices_ = 0, faces_ = 0;
  std::vector<int> polygon_;
  TriangleMesh mesh_;
};

std::string_view OffReader::word() {
  std::string_view word = record_.word();
  if (!word.empty()) return word;
  record_ = records_.next();
  return record_.word();
}

template <class Number>
bool OffReader::number(Number& value) {
  if constexpr (std::is_floating_point_v<Number>) {
    return parseDouble(word(), value);
  } else {
    return parseInteger(word(), value);
  }
}

/// The format's name, after letters for the vertices' data: normals, colours, texture coordinates; other dimensions are
/// not supported. It may touch the first count.
Status OffReader::readMark(std::string_view mark) {
  hasNormals_ = mark.find('N') != mark.npos;
  if (mark.find_first_not_of("NCST") == mark.npos) return {};
  return error(StatusCode::UnsupportedFormat,
               "is an OFF file of kind " + excerpt(mark) + ", which is not supported; save it as OFF, as text");
}

Status OffReader::readHeader() {
  std::string_view first = word();
  const std::size_t name = first.find("OFF");
  if (name != first.npos) {
    if (Status status = readMark(first.substr(0, name)); !status.ok()) return status;
    first.remove_prefix(name + 3);
    if (first.empty()) first = word();
  }
  const std::string_view second = first == "BINARY" ? std::string_view() : word();
  if (!parseInteger(first, vertices_) || !parseInteger(second, faces_)) {
    return error(StatusCode::Malformed, "has " + excerpt(second.empty() ? first : second) +
                                            " where a count is expected; is it an OFF model, as text?");
  }
  if (vertices_ <= Limits::kMaxVertices && records_.hasRoomFor(2 * vertices_) && records_.hasRoomFor(faces_)) return {};
  return error(StatusCode::Malformed, "states " + std::to_string(vertices_) + " vertices and " +
                                          std::to_string(faces_) +
                                          " faces, for which the file is too short; is it complete? Save it again");
}

Result<TriangleMesh> OffReader::read() {
  Status status = readHeader();
  for (std::uint64_t v = 0; status.ok() && v < vertices_; ++v) status = readVertex();
  for (std::uint64_t f = 0; status.ok() && f < faces_; ++f) status = readFace();
  if (!status.ok()) return status;
  if (!mesh_.triangles.empty()) return std::move(mesh_);
  return fileError(StatusCode::Empty, path_, 0, "has no triangles; export the model as a surface of polygons");
}

/// A vertex or a face begins a line; some programs break it.
Status OffReader::readVertex() {
  record_ = records_.next();
  Eigen::Vector3d numbers[2];
  for (int k = 0; k < (hasNormals_ ? 6 : 3); ++k) {
    if (number(numbers[k / 3][k % 3])) continue;
    return error(StatusCode::Malformed, "vertex " + std::to_string(mesh_.vertexCount()) + " of " +
                                            std::to_string(vertices_) +
                                            " lacks a number; is the file complete? Save it again");
  }
  if (const std::string fault = coordinateFault(numbers[0]); !fault.empty()) {
    return error(StatusCode::NonFinite, "vertex " + std::to_string(mesh_.vertexCount()) + fault);
  }
  mesh_.positions.push_back(numbers[0]);
  if (hasNormals_) mesh_.normals.push_back(unitNormal(numbers[1]));
  return {};
}

Status OffReader::readFace() {
  record_ = records_.next();
  std::uint64_t count = 0;
  bool good = number(count);
  polygon_.clear();
  for (std::uint64_t i = 0; good && i < count; ++i) {
    std::uint64_t vertex = 0;
    good = number(vertex);
    if (good && vertex >= mesh_.vertexCount()) {
      return error(StatusCode::IndexOutOfRange, "a face refers to vertex " + std::to_string(vertex) +
                                                    ", but there are " + std::to_string(mesh_.vertexCount()) +
                                                    ", counted from 0; correct it or export the model again");
    }
    polygon_.push_back(static_cast<int>(vertex));
  }
  if (!good) {
    return error(StatusCode::Malformed,
                 "has no face where one is expected: a count of corners and as many vertices; is it complete? Save it "
                 "again");
  }
  if (polygon_.size() >= 3) appendPolygon(mesh_.positions, polygon_, mesh_.triangles);
  return {};
}

}  // namespace

Result<TriangleMesh> readOff(const std::string& path) {
  const Result<std::string> text = readText(path);
  if (!text.ok()) return text.status();
  return OffReader(path, text.value()).read();
}

}  // namespace tetskin::io
