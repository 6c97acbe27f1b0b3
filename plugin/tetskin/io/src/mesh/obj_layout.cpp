// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/io/obj_sequence.h>
#include <tetskin/io/src/mesh/obj_scanner.h>
#include <tetskin/io/src/text/atomic_file.h>
#include <tetskin/io/src/text/file_text.h>
#include <tetskin/io/src/text/number_text.h>

#include <algorithm>
#include <cassert>
#include <filesystem>
#include <system_error>

namespace tetskin {

namespace fs = std::filesystem;

namespace {

/// A corner of a face without its normal: "1/2/3" is "1/2", "1//3" is "1".
std::string_view withoutNormal(std::string_view corner) {
  const std::size_t first = corner.find('/');
  if (first == corner.npos) return corner;
  const std::size_t second = corner.find('/', first + 1);
  const std::size_t end = std::min(second, corner.size());
  return corner.substr(0, end == first + 1 ? first : end);
}

/// A corner without a normal, with its vertex's number as normal: "1/2" is "1/2/1", "1" is "1//1".
void appendWithNormal(std::string_view corner, std::string& text) {
  const std::size_t slash = corner.find('/');
  text += corner;
  text += slash == corner.npos ? "//" : "/";
  text += corner.substr(0, slash);
}

std::string folderOf(const std::string& path) {
  const fs::path folder = fs::path(path).parent_path();
  return folder.empty() ? std::string(".") : folder.string();
}

/// A name as one OBJ word.
std::string objName(const std::string& name) {
  std::string word = name;
  std::replace_if(
      word.begin(), word.end(), [](char c) { return static_cast<unsigned char>(c) <= ' '; }, '_');
  return word;
}

void appendFaces(const TriangleMesh& mesh, std::size_t first, std::size_t count, std::string& text) {
  assert(first + count <= mesh.triangleCount());
  for (std::size_t t = first; t < first + count; ++t) {
    text += 'f';
    for (const int v : mesh.triangles[t]) {
      text += ' ';
      io::appendNumber(text, v + 1);
      if (mesh.texcoords.empty()) continue;
      text += '/';
      io::appendNumber(text, v + 1);
    }
    text += '\n';
  }
}

}  // namespace

Result<ObjLayout> ObjLayout::load(const std::string& objPath) {
  const Result<std::string> source = io::readObjText(objPath);
  if (!source.ok()) return source.status();
  ObjLayout layout;
  std::error_code ignored;
  layout.sourceFolder_ = fs::absolute(folderOf(objPath), ignored).string();
  layout.text_.reserve(source.value().size());
  io::ObjScanner scanner(io::withoutMark(source.value()));
  for (io::ObjStatement statement; scanner.next(statement);) {
    if (statement.keyword == "v") {
      Status status = layout.addPosition(objPath, statement);
      if (!status.ok()) return status;
    } else if (statement.keyword == "f") {
      layout.addFace(statement);
    } else if (statement.keyword == "mtllib") {
      layout.addLibraries(statement);
    } else if (statement.keyword != "vn") {
      layout.text_ += statement.text;
    }
  }
  if (layout.gaps_.empty()) {
    return io::fileError(StatusCode::Empty, objPath, 0, "has no vertices ('v' lines); is it a Wavefront OBJ model?");
  }
  return layout;
}

Status ObjLayout::addPosition(const std::string& path, const io::ObjStatement& statement) {
  io::ObjWords words(statement.rest);
  const std::string_view x = words.next();
  words.next();
  const std::string_view z = words.next();
  if (z.empty()) {
    return io::fileError(StatusCode::Malformed, path, statement.line, "'v' needs 3 numbers; complete the line");
  }
  const std::string_view text = statement.text;
  text_.append(text.data(), x.data());
  gaps_.push_back(text_.size());
  text_.append(z.data() + z.size(), text.data() + text.size());
  return {};
}

void ObjLayout::addFace(const io::ObjStatement& statement) {
  const std::string_view text = statement.text;
  const char* copied = text.data();
  io::ObjWords words(statement.rest);
  for (std::string_view corner = words.next(); !corner.empty(); corner = words.next()) {
    const std::string_view kept = withoutNormal(corner);
    if (kept.size() == corner.size()) continue;
    text_.append(copied, kept.data() + kept.size());
    copied = corner.data() + corner.size();
  }
  text_.append(copied, text.data() + text.size());
}

/// A name may contain blanks, or there may be several names: takes every one that exists as a file.
void ObjLayout::addLibraries(const io::ObjStatement& statement) {
  const auto offset = [&, start = text_.size()](std::string_view name) {
    return start + static_cast<std::size_t>(name.data() - statement.text.data());
  };
  text_ += statement.text;
  const std::string_view whole = io::ObjWords(statement.rest).name();
  if (whole.empty() || addLibrary(whole, offset(whole))) return;
  io::ObjWords words(statement.rest);
  for (std::string_view name = words.next(); !name.empty(); name = words.next()) addLibrary(name, offset(name));
}

bool ObjLayout::addLibrary(std::string_view name, std::size_t offset) {
  assert(offset + name.size() <= text_.size() && text_.compare(offset, name.size(), name) == 0);
  std::error_code ignored;
  const fs::path file(name);
  if (file.is_absolute() || !fs::exists(fs::path(sourceFolder_) / file, ignored)) return false;
  libraries_.push_back({offset, std::string(name)});
  return true;
}

ObjLayout ObjLayout::create(const TriangleMesh& mesh) {
  assert(mesh.texcoords.empty() || mesh.texcoords.size() == mesh.vertexCount());
  ObjLayout layout;
  std::string& text = layout.text_;
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
    text += "v ";
    layout.gaps_.push_back(text.size());
    text += '\n';
  }
  for (const Eigen::Vector2f& texcoord : mesh.texcoords) {
    text += "vt ";
    io::appendNumber(text, texcoord[0]);
    text += ' ';
    io::appendNumber(text, texcoord[1]);
    text += '\n';
  }
  if (mesh.groups.empty()) appendFaces(mesh, 0, mesh.triangleCount(), text);
  std::string material;
  for (const TriangleGroup& group : mesh.groups) {
    text += "g " + objName(group.name) + "\n";
    // An empty name means no material, which must only be stated after another material.
    if (group.material != material) text += "usemtl " + objName(group.material) + "\n";
    material = group.material;
    appendFaces(mesh, group.firstTriangle, group.triangleCount, text);
  }
  return layout;
}

/// The number of a normal is that of its vertex if counted from the front, and also if counted from the back, because
/// its line directly follows the vertex's.
ObjLayout ObjLayout::withNormals() const {
  assert(!hasNormals());
  ObjLayout result;
  result.sourceFolder_ = sourceFolder_;
  result.libraries_ = libraries_;
  std::string& text = result.text_;
  auto library = result.libraries_.begin();
  io::ObjScanner scanner(text_);
  for (io::ObjStatement statement; scanner.next(statement);) {
    const auto start = static_cast<std::size_t>(statement.text.data() - text_.data());
    for (; library != result.libraries_.end() && library->offset < start + statement.text.size(); ++library) {
      library->offset += text.size() - start;
    }
    if (statement.keyword == "f") {
      result.addFaceWithNormals(statement);
      continue;
    }
    if (statement.keyword == "v") result.gaps_.push_back(gaps_[result.gaps_.size()] + text.size() - start);
    text += statement.text;
    if (statement.keyword != "v") continue;
    text += text.back() == '\n' ? "vn " : "\nvn ";
    result.normalGaps_.push_back(text.size());
    text += '\n';
  }
  return result;
}

void ObjLayout::addFaceWithNormals(const io::ObjStatement& statement) {
  assert(statement.keyword == "f");
  const std::string_view text = statement.text;
  const char* copied = text.data();
  io::ObjWords words(statement.rest);
  for (std::string_view corner = words.next(); !corner.empty(); corner = words.next()) {
    text_.append(copied, corner.data());
    appendWithNormal(corner, text_);
    copied = corner.data() + corner.size();
  }
  text_.append(copied, text.data() + text.size());
}

ObjLayout ObjLayout::withMaterialLibrary(const std::string& name) const {
  ObjLayout result = *this;
  const std::string line = "mtllib " + objName(name) + "\n";
  result.text_.insert(0, line);
  for (std::size_t& gap : result.gaps_) gap += line.size();
  for (std::size_t& gap : result.normalGaps_) gap += line.size();
  for (Library& library : result.libraries_) library.offset += line.size();
  return result;
}

ObjLayout ObjLayout::forFolder(const std::string& folder) const {
  ObjLayout result = *this;
  std::error_code error;
  // From the last name to the first, so that the offsets of the earlier ones stay valid.
  for (std::size_t i = libraries_.size(); i-- > 0;) {
    const Library& library = libraries_[i];
    const fs::path path = fs::proximate(fs::path(sourceFolder_) / library.name, fs::absolute(folder, error), error);
    if (error || path.empty()) continue;
    const std::string name = path.generic_string();
    result.text_.replace(library.offset, library.name.size(), name);
    const std::size_t grown = name.size() - library.name.size();  // wraps around if it shrinks, and back when added
    for (std::size_t& gap : result.gaps_) gap += gap > library.offset ? grown : 0;
    for (std::size_t& gap : result.normalGaps_) gap += gap > library.offset ? grown : 0;
  }
  result.libraries_.clear();
  return result;
}

namespace {

template <class Scalar>
char* formatPoint(char* out, const Scalar* point) {
  out = io::formatNumber(out, point[0]);
  *out++ = ' ';
  out = io::formatNumber(out, point[1]);
  *out++ = ' ';
  return io::formatNumber(out, point[2]);
}

}  // namespace

template <class Scalar>
std::string_view ObjLayout::format(PointView<const Scalar> positions, std::vector<char>& buffer,
                                   PointView<const float> normals) const {
  assert(positions.size() == vertexCount() && normals.size() == normalGaps_.size());
  // Number of characters: three numbers, and blanks between them.
  constexpr std::size_t kPointRoom = 3 * io::kNumberRoom + 2;
  buffer.resize(std::max(buffer.size(), text_.size() + (gaps_.size() + normalGaps_.size()) * kPointRoom));
  char* out = buffer.data();
  const char* copied = text_.data();
  const auto copyTo = [&](std::size_t gap) {
    assert(copied <= text_.data() + gap && gap <= text_.size());
    out = std::copy(copied, text_.data() + gap, out);
    copied = text_.data() + gap;
  };
  for (std::size_t v = 0; v < vertexCount(); ++v) {
    copyTo(gaps_[v]);
    out = formatPoint(out, positions[v]);
    if (normals.empty()) continue;
    copyTo(normalGaps_[v]);
    out = formatPoint(out, normals[v]);
  }
  copyTo(text_.size());
  assert(static_cast<std::size_t>(out - buffer.data()) <= buffer.size());
  return {buffer.data(), static_cast<std::size_t>(out - buffer.data())};
}

namespace {

Status checkCount(const std::string& path, std::size_t count, std::size_t wanted, const char* what) {
  if (count == wanted) return {};
  return io::fileError(StatusCode::SizeMismatch, path, 0,
                       "cannot be written from " + std::to_string(count) + " " + what + "s, as the mesh has " +
                           std::to_string(wanted) + " vertices; pass one " + what + " per vertex");
}

template <class Scalar>
Status checkFinite(const std::string& path, PointView<const Scalar> points, const char* what) {
  const std::size_t bad = firstNonFinite(points);
  if (bad == points.size()) return {};
  return io::fileError(StatusCode::NonFinite, path, 0,
                       "cannot be written, as vertex " + std::to_string(bad) + " has a " + what +
                           " that is not finite; check whether the simulation has exploded");
}

}  // namespace

template <class Scalar>
Status ObjLayout::checkPoints(const std::string& path, PointView<const Scalar> positions,
                              PointView<const float> normals) const {
  if (!hasNormals() && !normals.empty()) {
    return io::fileError(
        StatusCode::SizeMismatch, path, 0,
        "cannot be written with normals, as its layout has none; create the layout with ObjLayout::withNormals");
  }
  Status status = checkCount(path, positions.size(), vertexCount(), "position");
  if (status.ok() && hasNormals()) status = checkCount(path, normals.size(), vertexCount(), "normal");
  if (status.ok()) status = checkFinite(path, positions, "coordinate");
  if (status.ok()) status = checkFinite(path, normals, "normal");
  return status;
}

namespace {

template <class Scalar>
Status writeLayout(const ObjLayout& layout, const std::string& path, PointView<const Scalar> positions,
                   PointView<const float> normals) {
  Status status = layout.checkPoints(path, positions, normals);
  if (!status.ok()) return status;
  std::vector<char> buffer;
  return io::writeFile(path, layout.forFolder(folderOf(path)).format(positions, buffer, normals));
}

}  // namespace

Status ObjLayout::writeTo(const std::string& path, PointView<const float> positions,
                          PointView<const float> normals) const {
  return writeLayout(*this, path, positions, normals);
}

Status ObjLayout::writeTo(const std::string& path, PointView<const double> positions,
                          PointView<const float> normals) const {
  return writeLayout(*this, path, positions, normals);
}

Result<ObjLayout> objLayoutFor(const std::string& meshPath, const TriangleMesh& mesh) {
  if (io::lowerExtension(meshPath) != ".obj") return ObjLayout::create(mesh);
  Result<ObjLayout> layout = ObjLayout::load(meshPath);
  if (layout.ok() && layout.value().vertexCount() != mesh.vertexCount()) {
    return io::fileError(StatusCode::SizeMismatch, meshPath, 0,
                         "has " + std::to_string(layout.value().vertexCount()) + " vertices, but the mesh has " +
                             std::to_string(mesh.vertexCount()) + "; load the mesh again, the file has changed");
  }
  return layout;
}

template std::string_view ObjLayout::format(PointView<const float>, std::vector<char>&, PointView<const float>) const;
template std::string_view ObjLayout::format(PointView<const double>, std::vector<char>&, PointView<const float>) const;
template Status ObjLayout::checkPoints(const std::string&, PointView<const float>, PointView<const float>) const;
template Status ObjLayout::checkPoints(const std::string&, PointView<const double>, PointView<const float>) const;

}  // namespace tetskin
