// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/io/src/mesh/mesh_readers.h>
#include <tetskin/io/src/mesh/obj_scanner.h>
#include <tetskin/io/src/mesh/polygon.h>
#include <tetskin/io/src/mesh/unit_normal.h>
#include <tetskin/io/src/text/coordinate_fault.h>
#include <tetskin/io/src/text/file_text.h>
#include <tetskin/io/src/text/number_text.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

namespace tetskin::io {

namespace {

/// A corner without this index.
constexpr int kNone = -1;
constexpr int kMissing = std::numeric_limits<int>::max();  ///< larger than any real index

struct Corner {
  int vertex = kNone, texcoord = kNone, normal = kNone;
};

struct Face {
  std::size_t firstCorner = 0;
  std::size_t line = 0;
  bool complete = true;  ///< the texture coordinates and normals that it names exist
};

struct Run {
  std::size_t firstFace = 0;
  std::string_view name, material;
};

void note(MeshFileReport::Faces& faces, std::size_t line) {
  if (faces.count++ == 0) faces.firstLine = line;
}

/// Collects the statements of one file, with polygons not yet triangulated.
class ObjParser {
 public:
  /// map  null: none
  ObjParser(const std::string& path, std::string_view text, MeshFileReport& report, MapRequest* map)
      : path_(path), scanner_(text), report_(report), map_(map) {}
  Result<TriangleMesh> parse();

 private:
  Status readStatement();
  Status readNumbers(int needed, int wanted, Eigen::Vector3d& values);
  Status readPosition();
  Status readColour();
  Status readFace();
  Status readCorner(std::string_view word, Corner& corner);
  Status readIndex(std::string_view text, const char* what, std::size_t count, long long& index);
  Status readVertex(std::string_view text, int& vertex);
  Status readAttribute(std::string_view text, const char* what, std::size_t count, int& attribute);
  void beginRun();
  Status checkIndices();
  void dropMissing(Face& face, std::size_t count, int& attribute) const;
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
  MeshFileReport& report_;
  MapRequest* map_;
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
  return map_ ? readColour() : Status();
}

/// Three numbers after the position; a single one is its weight.
Status ObjParser::readColour() {
  constexpr std::size_t kColourAt = 3, kWithColour = 6;
  ObjWords words(statement_.rest);
  std::array<std::string_view, kWithColour> all;
  for (std::string_view& word : all) word = words.next();
  if (all.back().empty()) return {};
  map_->present.insert({"red", "green", "blue"});
  const int channel = colourChannel(map_->name);
  if (channel < 0 || channel > 2) return {};
  const std::string_view word = all[kColourAt + static_cast<std::size_t>(channel)];
  if (parseDouble(word, map_->values.emplace_back())) return {};
  return error(StatusCode::Malformed, excerpt(word) + " is not a number; correct it");
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
  if (corners_.size() - firstCorner < 3) {  // a point or a line, as some programs write them
    corners_.resize(firstCorner);
    note(report_.droppedFaces, statement_.line);
    return {};
  }
  beginRun();
  faces_.push_back({firstCorner, statement_.line, true});
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
  Status status = readVertex(parts[0], corner.vertex);
  if (status.ok()) status = readAttribute(parts[1], "texture coordinate", texcoords_.size(), corner.texcoord);
  if (status.ok()) status = readAttribute(parts[2], "normal", normals_.size(), corner.normal);
  return status;
}

/// Converts an index of the file, which counts from 1, or backwards from the last one so far, to one that counts from
/// 0. Whether it is too large is only known at the end of the file, because faces may refer to later lines.
Status ObjParser::readIndex(std::string_view text, const char* what, std::size_t count, long long& index) {
  long long number = 0;
  if (!parseInteger(text, number)) {
    return error(StatusCode::Malformed, excerpt(text) + " is not the index of a " + what + "; correct the face");
  }
  index = number > 0 ? number - 1 : number == 0 ? -1 : static_cast<long long>(count) + number;
  return {};
}

Status ObjParser::readVertex(std::string_view text, int& vertex) {
  long long index = 0;
  if (Status status = readIndex(text, "vertex", mesh_.vertexCount(), index); !status.ok()) return status;
  if (index < 0 || index > std::numeric_limits<int>::max()) {
    return error(StatusCode::IndexOutOfRange,
                 "the face refers to vertex " + std::string(text) +
                     (text == "0" ? ", but an OBJ file counts from 1" : ", which does not exist") +
                     "; correct the face");
  }
  vertex = static_cast<int>(index);
  return {};
}

/// An index that cannot exist is kMissing until the end of the file.
Status ObjParser::readAttribute(std::string_view text, const char* what, std::size_t count, int& attribute) {
  if (text.empty()) return {};
  long long index = 0;
  Status status = readIndex(text, what, count, index);
  attribute = index < 0 || index > kMissing ? kMissing : static_cast<int>(index);
  return status;
}

/// Starts a group at the next face if its name or material differ from the last one's.
void ObjParser::beginRun() {
  assert(runs_.empty() || runs_.back().firstFace < faces_.size());
  if (!runs_.empty() && runs_.back().name == name_ && runs_.back().material == material_) return;
  runs_.push_back({faces_.size(), name_, material_});
}

/// Drops references to texture coordinates and normals that do not exist.
Status ObjParser::checkIndices() {
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    for (std::size_t c = faces_[f].firstCorner; c < cornerEnd(f); ++c) {
      const auto vertex = static_cast<std::size_t>(corners_[c].vertex);
      if (vertex >= mesh_.vertexCount()) {
        return fileError(StatusCode::IndexOutOfRange, path_, faces_[f].line,
                         "the face refers to number " + std::to_string(vertex + 1) +
                             " of the vertices, but the file has " + std::to_string(mesh_.vertexCount()) +
                             "; correct the face or complete the file");
      }
      dropMissing(faces_[f], texcoords_.size(), corners_[c].texcoord);
      dropMissing(faces_[f], normals_.size(), corners_[c].normal);
    }
    if (!faces_[f].complete) note(report_.incompleteFaces, faces_[f].line);
  }
  return {};
}

void ObjParser::dropMissing(Face& face, std::size_t count, int& attribute) const {
  if (attribute == kNone || static_cast<std::size_t>(attribute) < count) return;
  attribute = kNone;
  face.complete = false;
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

Result<TriangleMesh> readObj(const std::string& path, MeshFileReport& report, MapRequest* map) {
  const Result<std::string> text = readObjText(path);
  if (!text.ok()) return text.status();
  return ObjParser(path, withoutMark(text.value()), report, map).parse();
}

}  // namespace tetskin::io
