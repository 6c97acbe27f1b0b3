// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/io/src/mesh/obj_reader.h>
#include <tetskin/io/src/mesh/obj_scanner.h>
#include <tetskin/io/src/mesh/polygon.h>
#include <tetskin/io/src/mesh/unit_normal.h>
#include <tetskin/io/src/text/coordinate_fault.h>
#include <tetskin/io/src/text/file_text.h>
#include <tetskin/io/src/text/number_text.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace tetskin::io {

namespace {

constexpr int kNone = -1;

struct Corner {
  int vertex = kNone, texcoord = kNone, normal = kNone;
};

struct Face {
  std::size_t firstCorner = 0;
  std::size_t line = 0;
};

struct Run {
  std::size_t firstFace = 0;
  std::string_view name, material;
};

/// Collects the statements of one file, with polygons that are not yet triangulated.
class ObjParser {
 public:
  ObjParser(const std::string& path, std::string_view text) : path_(path), scanner_(text) {}
  Result<TriangleMesh> parse();

 private:
  Status readStatement();
  Status readNumbers(int needed, int wanted, Eigen::Vector3d& values);
  Status readPosition();
  Status readFace();
  Status readCorner(std::string_view word, Corner& corner);
  Status readIndex(std::string_view text, const char* what, std::size_t count, int& index);
  void beginRun();
  Status checkIndices() const;
  Status checkIndex(int index, std::size_t count, const char* what, std::size_t line) const;
  std::size_t cornerEnd(std::size_t face) const {
    assert(face < faces_.size());
    return face + 1 < faces_.size() ? faces_[face + 1].firstCorner : corners_.size();
  }
  void triangulate();
  template <class Point>
  std::vector<Point> perVertex(int Corner::*attribute, const std::vector<Point>& values) const;
  Status error(StatusCode code, const std::string& what) const { return fileError(code, path_, statement_.line, what); }

  const std::string& path_;
  ObjScanner scanner_;
  ObjStatement statement_;
  std::string_view name_, material_;
  std::vector<Corner> corners_;
  std::vector<Face> faces_;
  std::vector<Run> runs_;
  std::vector<Eigen::Vector2f> texcoords_;
  std::vector<Eigen::Vector3f> normals_;
  TriangleMesh mesh_;
};

Result<TriangleMesh> ObjParser::parse() {
  while (scanner_.next(statement_)) {
    Status status = readStatement();
    if (!status.ok()) return status;
  }
  if (mesh_.positions.empty()) {
    return fileError(StatusCode::Empty, path_, 0, "has no vertices ('v' lines); is it a Wavefront OBJ model?");
  }
  if (faces_.empty()) {
    return fileError(StatusCode::Empty, path_, 0,
                     "has vertices but no faces ('f' lines); export the model as a surface of polygons");
  }
  Status status = checkIndices();
  if (!status.ok()) return status;
  triangulate();
  mesh_.texcoords = perVertex(&Corner::texcoord, texcoords_);
  mesh_.normals = perVertex(&Corner::normal, normals_);
  return std::move(mesh_);
}

Status ObjParser::readStatement() {
  const std::string_view keyword = statement_.keyword;
  if (keyword == "v") return readPosition();
  if (keyword == "f") return readFace();
  Eigen::Vector3d values(0, 0, 0);
  if (keyword == "vt") {
    Status status = readNumbers(1, 2, values);
    const bool finite = std::isfinite(values[0]) && std::isfinite(values[1]);
    texcoords_.emplace_back(finite ? Eigen::Vector2f(values.head<2>().cast<float>()) : Eigen::Vector2f(0, 0));
    return status;
  }
  if (keyword == "vn") {
    Status status = readNumbers(3, 3, values);
    normals_.push_back(unitNormal(values));
    return status;
  }
  if (keyword == "g" || keyword == "o") name_ = ObjWords(statement_.rest).name();
  if (keyword == "usemtl") material_ = ObjWords(statement_.rest).name();
  return {};
}

Status ObjParser::readNumbers(int needed, int wanted, Eigen::Vector3d& values) {
  assert(needed <= wanted && wanted <= 3);
  ObjWords words(statement_.rest);
  for (int i = 0; i < wanted; ++i) {
    const std::string_view word = words.next();
    if (word.empty() && i >= needed) break;
    if (word.empty()) {
      return error(StatusCode::Malformed, "'" + std::string(statement_.keyword) + "' needs " + std::to_string(needed) +
                                              " numbers and has " + std::to_string(i) + "; complete the line");
    }
    if (!parseDouble(word, values[i])) {
      return error(StatusCode::Malformed, excerpt(word) + " is not a number; correct it");
    }
  }
  return {};
}

Status ObjParser::readPosition() {
  Eigen::Vector3d position;
  Status status = readNumbers(3, 3, position);
  if (!status.ok()) return status;
  if (const std::string fault = coordinateFault(position); !fault.empty()) {
    return error(StatusCode::NonFinite, "vertex " + std::to_string(mesh_.vertexCount()) + fault);
  }
  if (mesh_.vertexCount() == static_cast<std::size_t>(std::numeric_limits<int>::max())) {
    return error(StatusCode::UnsupportedFormat, "more than 2147483647 vertices; split the model");
  }
  mesh_.positions.push_back(position);
  return {};
}

Status ObjParser::readFace() {
  const std::size_t firstCorner = corners_.size();
  ObjWords words(statement_.rest);
  for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
    Corner corner;
    Status status = readCorner(word, corner);
    if (!status.ok()) return status;
    corners_.push_back(corner);
  }
  const std::size_t count = corners_.size() - firstCorner;
  if (count < 3) {
    return error(StatusCode::Malformed, "a face of " + std::to_string(count) +
                                            " corners, but at least 3 are needed; complete the line or remove it");
  }
  beginRun();
  faces_.push_back({firstCorner, statement_.line});
  return {};
}

Status ObjParser::readCorner(std::string_view word, Corner& corner) {
  std::string_view parts[3];
  std::string_view rest = word;
  for (std::string_view& part : parts) {
    part = rest.substr(0, rest.find('/'));
    rest.remove_prefix(std::min(rest.size(), part.size() + 1));
  }
  if (!rest.empty()) return error(StatusCode::Malformed, excerpt(word) + " is not a corner of a face; use v/vt/vn");
  Status status = readIndex(parts[0], "vertex", mesh_.vertexCount(), corner.vertex);
  if (status.ok() && !parts[1].empty()) {
    status = readIndex(parts[1], "texture coordinate", texcoords_.size(), corner.texcoord);
  }
  if (status.ok() && !parts[2].empty()) status = readIndex(parts[2], "normal", normals_.size(), corner.normal);
  return status;
}

/// Converts an index of the file, which counts from 1, or backwards from the last one so far, to one that counts from
/// 0. Whether it is too large is only known at the end of the file, as faces may refer to what comes later.
Status ObjParser::readIndex(std::string_view text, const char* what, std::size_t count, int& index) {
  long long number = 0;
  if (!parseInteger(text, number)) {
    return error(StatusCode::Malformed, excerpt(text) + " is not the index of a " + what + "; correct the face");
  }
  const long long resolved = number > 0 ? number - 1 : static_cast<long long>(count) + number;
  if (number == 0 || resolved < 0 || resolved > std::numeric_limits<int>::max()) {
    return error(StatusCode::IndexOutOfRange,
                 "the face refers to " + std::string(what) + " " + std::to_string(number) +
                     (number == 0 ? ", but an OBJ file counts from 1" : ", which does not exist") +
                     "; correct the face");
  }
  index = static_cast<int>(resolved);
  return {};
}

/// Starts a group at the next face if its name or material differ from the last one's.
void ObjParser::beginRun() {
  assert(runs_.empty() || runs_.back().firstFace < faces_.size());
  if (!runs_.empty() && runs_.back().name == name_ && runs_.back().material == material_) return;
  runs_.push_back({faces_.size(), name_, material_});
}

Status ObjParser::checkIndices() const {
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    for (std::size_t c = faces_[f].firstCorner; c < cornerEnd(f); ++c) {
      Status status = checkIndex(corners_[c].vertex, mesh_.vertexCount(), "vertices", faces_[f].line);
      if (status.ok())
        status = checkIndex(corners_[c].texcoord, texcoords_.size(), "texture coordinates", faces_[f].line);
      if (status.ok()) status = checkIndex(corners_[c].normal, normals_.size(), "normals", faces_[f].line);
      if (!status.ok()) return status;
    }
  }
  return {};
}

Status ObjParser::checkIndex(int index, std::size_t count, const char* what, std::size_t line) const {
  if (index < 0 || static_cast<std::size_t>(index) < count) return {};
  return fileError(StatusCode::IndexOutOfRange, path_, line,
                   "the face refers to number " + std::to_string(std::size_t(index) + 1) + " of the " + what +
                       ", but the file has " + std::to_string(count) + "; correct the face or complete the file");
}

void ObjParser::triangulate() {
  assert(!runs_.empty() && runs_.front().firstFace == 0 && corners_.size() >= 3 * faces_.size());
  mesh_.triangles.reserve(corners_.size() - 2 * faces_.size());
  std::vector<int> polygon;
  std::size_t run = 0;
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    if (run < runs_.size() && runs_[run].firstFace == f) {
      mesh_.groups.push_back(
          {std::string(runs_[run].name), std::string(runs_[run].material), mesh_.triangleCount(), 0});
      ++run;
    }
    polygon.clear();
    for (std::size_t c = faces_[f].firstCorner; c < cornerEnd(f); ++c) polygon.push_back(corners_[c].vertex);
    appendPolygon(mesh_.positions, polygon, mesh_.triangles);
    mesh_.groups.back().triangleCount = mesh_.triangleCount() - mesh_.groups.back().firstTriangle;
  }
  const TriangleGroup& only = mesh_.groups.front();
  if (mesh_.groups.size() == 1 && only.name.empty() && only.material.empty()) mesh_.groups.clear();
}

/// The values of an attribute by vertex, if each vertex in a face has exactly one; otherwise empty.
template <class Point>
std::vector<Point> ObjParser::perVertex(int Corner::*attribute, const std::vector<Point>& values) const {
  if (values.empty()) return {};
  std::vector<int> chosen(mesh_.vertexCount(), kNone);
  for (const Corner& corner : corners_) {
    const int value = corner.*attribute;
    assert(value == kNone || static_cast<std::size_t>(value) < values.size());
    int& previous = chosen[static_cast<std::size_t>(corner.vertex)];
    if (value == kNone) return {};
    if (previous == kNone) previous = value;
    if (previous != value && values[std::size_t(previous)] != values[std::size_t(value)]) return {};
  }
  std::vector<Point> result(mesh_.vertexCount(), Point::Zero());
  for (std::size_t v = 0; v < result.size(); ++v) {
    if (chosen[v] != kNone) result[v] = values[static_cast<std::size_t>(chosen[v])];
  }
  return result;
}

}  // namespace

Result<TriangleMesh> readObj(const std::string& path) {
  const Result<std::string> text = readObjText(path);
  if (!text.ok()) return text.status();
  return ObjParser(path, withoutMark(text.value())).parse();
}

}  // namespace tetskin::io
