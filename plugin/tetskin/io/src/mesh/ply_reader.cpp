// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// This work is based on:
//   Greg Turk, "The PLY Polygon File Format", 1994
#include <tetskin/core/src/base/mesh/mesh_checks.h>
#include <tetskin/io/src/mesh/mesh_readers.h>
#include <tetskin/io/src/mesh/ply_header.h>
#include <tetskin/io/src/mesh/polygon.h>
#include <tetskin/io/src/mesh/unit_normal.h>
#include <tetskin/io/src/text/coordinate_fault.h>
#include <tetskin/io/src/text/file_text.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <vector>

namespace tetskin::io {

namespace {

/// One instance of an element: by property its numbers; a single number unless it is a list.
using Row = std::vector<std::vector<double>>;

/// The columns of the relevant properties; those of missing ones are beyond the last.
struct Columns {
  std::array<std::size_t, 3> position{}, normal{};
  std::array<std::size_t, 2> texcoord{};
  std::size_t corners = 0, cornerTexcoords = 0;  ///< lists
  std::array<std::size_t, 1> map{};

  Columns() = default;
  /// wanted  null: none
  Columns(const PlyElement& element, const MapRequest* wanted)
      : position{element.find({"x"}), element.find({"y"}), element.find({"z"})},
        normal{element.find({"nx"}), element.find({"ny"}), element.find({"nz"})},
        texcoord{element.find({"s", "u", "texture_u"}), element.find({"t", "v", "texture_v"})},
        corners(element.find({"vertex_indices", "vertex_index"}, true)),
        cornerTexcoords(element.find({"texcoord"}, true)),
        map{wanted ? element.find({wanted->name}) : element.properties.size()} {}
};

/// The numbers in some columns of a row; false if it lacks one.
template <std::size_t Count>
bool take(const Row& row, const std::array<std::size_t, Count>& columns, double* to) {
  for (std::size_t k = 0; k < Count; ++k) {
    if (columns[k] >= row.size()) return false;
    to[k] = row[columns[k]][0];
  }
  return true;
}

class PlyReader {
 public:
  PlyReader(const std::string& path, std::string_view text, MapRequest* map) : path_(path), in_(text), map_(map) {}
  Result<TriangleMesh> read();

 private:
  bool linesSuffice() const;
  Status readElement(const PlyElement& element);
  Status checkVertices(const PlyElement& element);
  void findMap(const PlyElement& element);
  Status checkRoom(const PlyElement& element) const;
  Status readRow(const PlyElement& element, std::uint64_t index, Row& row);
  bool readNumber(const NumberType& type, double& value);
  bool readCount(const PlyProperty& property, std::size_t& count);

  Status addVertex(std::uint64_t index, const Row& row);
  Status addFace(std::uint64_t index, const Row& row);
  Status addStrips(std::uint64_t index, const Row& row);
  Status readCorner(std::string_view what, std::uint64_t index, double number, int& vertex) const;
  void addTexcoords(const std::vector<double>& numbers);
  /// Lines of binary data are not worth reporting.
  Status error(StatusCode code, const std::string& what) const {
    return fileError(code, path_, header_.binary ? 0 : in_.line(), what);
  }

  const std::string& path_;
  TextScanner in_;
  MapRequest* map_;        ///< null: none
  double mapScale_ = 1.0;  ///< of integers of colours
  PlyHeader header_;
  bool byLine_ = false;  ///< a text in which each element begins a line; anything after it on the line is ignored
  Columns columns_;      ///< of the element that is being read
  std::vector<int> polygon_;
  std::vector<char> hasTexcoord_;  ///< by vertex; used if texture coordinates come from faces' corners
  bool texcoordsDiffer_ = false;   ///< corners at one vertex differ, or some have none
  TriangleMesh mesh_;
};

Result<TriangleMesh> PlyReader::read() {
  Result<PlyHeader> header = readPlyHeader(path_, in_);
  if (!header.ok()) return header.status();
  header_ = std::move(header).value();
  byLine_ = !header_.binary && linesSuffice();
  for (const PlyElement& element : header_.elements) {
    Status status = readElement(element);
    if (!status.ok()) return status;
  }
  if (mesh_.positions.empty()) {
    return fileError(StatusCode::Empty, path_, 0, "has no vertices; export the model again");
  }
  if (mesh_.triangles.empty()) {
    return fileError(StatusCode::Empty, path_, 0, "has no triangles; export the model as a surface of polygons");
  }
  if (mesh_.normals.size() != mesh_.vertexCount()) mesh_.normals.clear();
  const bool someHaveNone = std::find(hasTexcoord_.begin(), hasTexcoord_.end(), 0) != hasTexcoord_.end();
  if (mesh_.texcoords.size() != mesh_.vertexCount() || texcoordsDiffer_ || someHaveNone) mesh_.texcoords.clear();
  return std::move(mesh_);
}

/// Whether there are as many lines as elements. Otherwise line breaks are ignored.
bool PlyReader::linesSuffice() const {
  std::uint64_t lines = 0;
  for (TextScanner ahead = in_; ahead.remaining() > 0; ++lines) ahead.restOfLine();
  for (const PlyElement& element : header_.elements) {
    if (element.properties.empty()) continue;
    if (element.count > lines) return false;
    lines -= element.count;
  }
  return true;
}

Status PlyReader::readElement(const PlyElement& element) {
  Status status = checkRoom(element);
  if (!status.ok() || element.properties.empty()) return status;
  columns_ = Columns(element, map_);
  const bool isVertex = element.name == "vertex", isFace = element.name == "face",
             isStrip = element.name == "tristrips";
  if (isVertex) status = checkVertices(element);
  if (isVertex && map_) findMap(element);
  Row row(element.properties.size());
  for (std::uint64_t index = 0; status.ok() && index < element.count; ++index) {
    status = readRow(element, index, row);
    if (!status.ok()) return status;
    if (isVertex) status = addVertex(index, row);
    if (isFace && columns_.corners < row.size()) status = addFace(index, row);
    if (isStrip && columns_.corners < row.size()) status = addStrips(index, row);
    if (byLine_) in_.restOfLine();
  }
  return status;
}

/// Notes which maps there are, and how numbers of the wanted one are scaled.
void PlyReader::findMap(const PlyElement& element) {
  for (const PlyProperty& property : element.properties) {
    if (property.isList) continue;
    map_->present.emplace(property.name);
    const NumberType& type = property.type;
    const bool whole = property.name == map_->name && colourChannel(property.name) >= 0 && !type.real;
    if (whole) mapScale_ = 1.0 / (std::ldexp(1.0, static_cast<int>(8 * type.bytes) - (type.sign ? 1 : 0)) - 1.0);
  }
  for (const char* place : {"x", "y", "z"}) map_->present.erase(place);
}

Status PlyReader::checkVertices(const PlyElement& element) {
  const Status status = checkTriangleCounts(element.count, 0);
  if (!status.ok()) return fileError(status.code, path_, element.line, status.message);
  const std::size_t last = *std::max_element(columns_.position.begin(), columns_.position.end());
  if (last < element.properties.size()) return {};
  return fileError(StatusCode::Malformed, path_, element.line,
                   "has vertices without x, y or z; export the model again");
}

/// Ok if this many instances fit into the rest of the file, with all lists empty.
Status PlyReader::checkRoom(const PlyElement& element) const {
  std::uint64_t minimum = 0;
  for (const PlyProperty& property : element.properties) {
    minimum += !header_.binary ? 2 : property.isList ? property.countType.bytes : property.type.bytes;
  }
  // The last number of a text needs no blank after it.
  if (minimum == 0 || element.count <= (in_.remaining() + 1) / minimum) return {};
  return fileError(StatusCode::Malformed, path_, element.line,
                   "states " + std::to_string(element.count) + " of element " + excerpt(element.name) + ", at least " +
                       std::to_string(minimum) + " bytes each, but only " + std::to_string(in_.remaining()) +
                       " bytes are left for them; is it complete? Save it again");
}

bool PlyReader::readNumber(const NumberType& type, double& value) {
  if (!header_.binary) return in_.number(value);
  if (in_.remaining() < type.bytes) return false;
  value = decodeNumber(in_.bytes(type.bytes).data(), type, header_.order);
  return true;
}

/// Reads how many numbers follow: no more than fit into the file.
bool PlyReader::readCount(const PlyProperty& property, std::size_t& count) {
  assert(!header_.binary || property.type.bytes > 0);
  count = 1;
  if (!property.isList) return true;
  double stated = 0.0;
  if (!readNumber(property.countType, stated)) return false;
  const std::size_t maximum = in_.remaining() / (header_.binary ? property.type.bytes : 2) + 1;
  if (!(stated >= 0.0 && stated <= static_cast<double>(maximum)) || stated != std::floor(stated)) return false;
  count = static_cast<std::size_t>(stated);
  return true;
}

Status PlyReader::readRow(const PlyElement& element, std::uint64_t index, Row& row) {
  assert(row.size() == element.properties.size());
  for (std::size_t p = 0; p < row.size(); ++p) {
    const PlyProperty& property = element.properties[p];
    std::size_t count = 0;
    bool good = readCount(property, count);
    row[p].resize(count);
    for (std::size_t i = 0; good && i < count; ++i) good = readNumber(property.type, row[p][i]);
    if (good) continue;
    const std::string what = std::string(element.name) + " " + std::to_string(index) + " of " +
                             std::to_string(element.count) + " has no number for " + excerpt(property.name);
    return error(StatusCode::Malformed, what + ", or more than the file holds; is it complete? Save it again");
  }
  return {};
}

Status PlyReader::addVertex(std::uint64_t index, const Row& row) {
  assert(index <= mesh_.vertexCount());
  Eigen::Vector3d position, normal;
  take(row, columns_.position, position.data());
  if (const std::string fault = coordinateFault(position); !fault.empty()) {
    return error(StatusCode::NonFinite, "vertex " + std::to_string(index) + fault);
  }
  mesh_.positions.push_back(position);
  if (take(row, columns_.normal, normal.data())) mesh_.normals.push_back(unitNormal(normal));
  double value = 0.0;
  if (map_ && take(row, columns_.map, &value)) map_->values.push_back(mapScale_ * value);
  Eigen::Vector2d texcoord;
  if (take(row, columns_.texcoord, texcoord.data())) mesh_.texcoords.push_back(texcoord.cast<float>());
  return {};
}

Status PlyReader::readCorner(std::string_view what, std::uint64_t index, double number, int& vertex) const {
  if (number >= 0.0 && number < static_cast<double>(mesh_.vertexCount()) && number == std::floor(number)) {
    vertex = static_cast<int>(number);
    return {};
  }
  std::string named;
  appendNumber(named, number);
  return error(StatusCode::IndexOutOfRange, std::string(what) + " " + std::to_string(index) + " refers to vertex " +
                                                named + ", but there are " + std::to_string(mesh_.vertexCount()) +
                                                " before it, counted from 0; correct it or export the model again");
}

Status PlyReader::addFace(std::uint64_t index, const Row& row) {
  assert(columns_.corners < row.size());
  const std::vector<double>& corners = row[columns_.corners];
  polygon_.resize(corners.size());
  for (std::size_t i = 0; i < corners.size(); ++i) {
    Status status = readCorner("face", index, corners[i], polygon_[i]);
    if (!status.ok()) return status;
  }
  if (polygon_.size() < 3) return {};
  appendPolygon(mesh_.positions, polygon_, mesh_.triangles);
  if (columns_.cornerTexcoords < row.size()) addTexcoords(row[columns_.cornerTexcoords]);
  return {};
}

/// Gives the vertices of the polygon its corners' texture coordinates.
void PlyReader::addTexcoords(const std::vector<double>& numbers) {
  texcoordsDiffer_ = texcoordsDiffer_ || numbers.size() != 2 * polygon_.size();
  if (texcoordsDiffer_) return;
  hasTexcoord_.resize(mesh_.vertexCount(), 0);
  mesh_.texcoords.resize(mesh_.vertexCount(), Eigen::Vector2f::Zero());
  for (std::size_t i = 0; i < polygon_.size(); ++i) {
    const auto v = static_cast<std::size_t>(polygon_[i]);
    const Eigen::Vector2f texcoord(static_cast<float>(numbers[2 * i]), static_cast<float>(numbers[2 * i + 1]));
    if (hasTexcoord_[v] && mesh_.texcoords[v] != texcoord) texcoordsDiffer_ = true;
    mesh_.texcoords[v] = texcoord;
    hasTexcoord_[v] = 1;
  }
}

/// A list of strips separated by -1: each vertex from the third on makes a triangle with the two before it; every
/// second triangle has the opposite orientation.
Status PlyReader::addStrips(std::uint64_t index, const Row& row) {
  assert(columns_.corners < row.size());
  polygon_.clear();
  for (const double number : row[columns_.corners]) {
    if (number == -1.0) {
      polygon_.clear();
      continue;
    }
    Status status = readCorner("strip", index, number, polygon_.emplace_back());
    if (!status.ok()) return status;
    const std::size_t last = polygon_.size() - 1;
    if (last < 2) continue;
    mesh_.triangles.push_back({polygon_[last - 2], polygon_[last - 1], polygon_[last]});
    if (last % 2 == 1) std::swap(mesh_.triangles.back()[0], mesh_.triangles.back()[1]);
  }
  return {};
}

/// Converts the line ends of old Macs, single carriage returns, to line feeds, in the text part of the file.
void endLines(std::string& text) {
  if (text.substr(0, 4) != "ply\r" || text.substr(4, 1) == "\n") return;
  const std::size_t header = std::min(text.find("end_header\r"), text.size());
  const bool binary = std::string_view(text).substr(0, header).find("\rformat binary") != text.npos;
  const std::size_t end = binary ? std::min(header + 11, text.size()) : text.size();
  std::replace(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(end), '\r', '\n');
}

}  // namespace

Result<TriangleMesh> readPly(const std::string& path, MapRequest* map) {
  Result<std::string> text = readFile(path);
  if (!text.ok()) return text.status();
  endLines(text.value());
  return PlyReader(path, text.value(), map).read();
}

}  // namespace tetskin::io
