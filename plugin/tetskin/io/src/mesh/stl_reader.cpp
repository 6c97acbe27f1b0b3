// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/io/src/mesh/mesh_readers.h>
#include <tetskin/io/src/text/binary_numbers.h>
#include <tetskin/io/src/text/coordinate_fault.h>
#include <tetskin/io/src/text/file_text.h>
#include <tetskin/io/src/text/text_records.h>

#include <string_view>

namespace tetskin::io {

namespace {

// A binary file: a text of any kind, the number of triangles, and for each a normal, three corners and two bytes.
constexpr std::size_t kStlText = 80, kStlHeader = kStlText + 4, kStlTriangle = 50, kStlNormal = 12;
constexpr NumberType kStlCount{4, false, false}, kStlReal{4, true};

/// True for a binary file: of exactly the size that it states, or with a zero among its first 84 bytes, or not
/// beginning with "solid". Some binary files begin with that, too, but a text has no zeros.
bool isBinaryStl(const std::string& bytes, std::size_t triangles) {
  if (bytes.size() < kStlHeader) return false;
  if (bytes.size() == kStlHeader + triangles * kStlTriangle) return true;
  if (bytes.find('\0') < kStlHeader) return true;
  const std::size_t first = bytes.find_first_not_of(" \t\r\n");
  return first == bytes.npos || bytes.compare(first, 5, "solid") != 0;
}

Status addStlVertex(const std::string& path, std::size_t line, const Eigen::Vector3d& vertex, TriangleMesh& mesh) {
  if (const std::string fault = coordinateFault(vertex); !fault.empty()) {
    return fileError(StatusCode::NonFinite, path, line, "vertex " + std::to_string(mesh.vertexCount()) + fault);
  }
  mesh.positions.push_back(vertex);
  if (mesh.vertexCount() % 3 == 0) {
    const int last = static_cast<int>(mesh.vertexCount()) - 1;
    mesh.triangles.push_back({last - 2, last - 1, last});
  }
  return {};
}

Result<TriangleMesh> readBinaryStl(const std::string& path, const std::string& bytes, std::size_t triangles) {
  if (triangles > (bytes.size() - kStlHeader) / kStlTriangle) {
    return fileError(StatusCode::Malformed, path, 0,
                     "states " + std::to_string(triangles) + " triangles, but contains " +
                         std::to_string(bytes.size()) + " bytes; is it complete? Export it again");
  }
  TriangleMesh mesh;
  for (std::size_t t = 0; t < triangles; ++t) {
    const char* at = bytes.data() + kStlHeader + t * kStlTriangle + kStlNormal;
    for (int corner = 0; corner < 3; ++corner) {
      Eigen::Vector3d vertex;
      for (int k = 0; k < 3; ++k, at += kStlReal.bytes) vertex[k] = decodeNumber(at, kStlReal, ByteOrder::Little);
      if (Status status = addStlVertex(path, 0, vertex, mesh); !status.ok()) return status;
    }
  }
  return mesh;
}

/// In a text file, only the lines of vertices describe the shape.
Result<TriangleMesh> readStlText(const std::string& path, const std::string& text) {
  TriangleMesh mesh;
  TextRecords records(text);
  std::size_t line = 0;
  for (;;) {
    TextScanner record = records.next();
    const std::string_view word = record.word();
    if (word.empty()) break;
    if (word != "vertex") continue;
    line = record.line();
    Eigen::Vector3d vertex;
    for (int k = 0; k < 3; ++k) {
      if (parseDouble(record.word(), vertex[k])) continue;
      return fileError(StatusCode::Malformed, path, line,
                       "has a vertex without three numbers; correct it or export the model again");
    }
    if (Status status = addStlVertex(path, line, vertex, mesh); !status.ok()) return status;
  }
  if (mesh.vertexCount() % 3 == 0) return mesh;
  return fileError(StatusCode::Malformed, path, line, "ends within a triangle; is it complete? Export it again");
}

}  // namespace

Result<TriangleMesh> readStl(const std::string& path) {
  const Result<std::string> file = readFile(path);
  if (!file.ok()) return file.status();
  const std::string& bytes = file.value();
  const std::size_t triangles =
      bytes.size() < kStlHeader
          ? 0
          : static_cast<std::size_t>(decodeInteger(bytes.data() + kStlText, kStlCount, ByteOrder::Little));
  Result<TriangleMesh> mesh =
      isBinaryStl(bytes, triangles) ? readBinaryStl(path, bytes, triangles) : readStlText(path, bytes);
  if (!mesh.ok() || !mesh.value().triangles.empty()) return mesh;
  return fileError(StatusCode::Empty, path, 0, "has no triangles; is it an STL model?");
}

}  // namespace tetskin::io
