// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/triangle_mesh.h>

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace tetskin {

namespace io {
struct ObjStatement;
}

/// An OBJ file without its vertex positions: the text of a written file, formatted once, with a gap for every vertex.
///
/// What is kept: everything an OBJ file has, byte for byte (order, polygons, texture coordinates, groups, materials,
/// comments, vertex colours behind the coordinates), except
/// - normals: `vn` lines and the faces' references to them are left out. Authored normals belong to the rest shape and
///   would be wrong on a deformed one; without any, every viewer makes its own, and current ones go in by
///   `withNormals`;
/// - a byte order mark, on which some readers stumble.
class TETSKIN_IO_API ObjLayout {
 public:
  /// The layout of an OBJ file; its k-th `v` line is vertex k.
  /// Errors: FileNotFound; Malformed, with the line, for a `v` line without three numbers; Empty without `v` lines.
  static Result<ObjLayout> fromFile(const std::string& objPath);

  /// A layout for a mesh from elsewhere: `v`, `vt` (if it has texture coordinates), `f`, and `g` and `usemtl` for its
  /// groups. Blanks in names become underscores, as OBJ separates names by blanks. Indices must be in range.
  static ObjLayout fromMesh(const TriangleMesh& mesh);

  /// `v` lines of a written file.
  std::size_t vertexCount() const { return gaps_.size(); }
  /// Whether files of this layout have normals.
  bool hasNormals() const { return !normalGaps_.empty(); }

  /// The same layout with a `vn` line behind every `v` line, and faces that name them: "1" becomes "1//1", "1/2"
  /// becomes "1/2/1". So there is one normal a vertex of the file: where authored normals differ between the corners at
  /// one vertex, as at an edge whose vertices are not doubled, the corners share the current one.
  ObjLayout withNormals() const;

  /// The same layout with a first line that names a material library, to lie beside the files that are written.
  ObjLayout withLibrary(const std::string& name) const;

  /// The same layout for a file in `folder`: material libraries (`mtllib`) that lie beside the source file are named by
  /// their path from that folder, others are kept as they are.
  ObjLayout inFolder(const std::string& folder) const;

  /// The whole file with these positions, in `buffer`, whose memory is reused: nothing is allocated if it has served
  /// the same layout before. Every number is the shortest that reads back as the same float, or double.
  /// positions  vertexCount x 3, finite; the count is asserted
  /// normals    likewise if the layout has normals, otherwise none
  template <class Scalar>
  std::string_view format(PointView<const Scalar> positions, std::vector<char>& buffer,
                          PointView<const float> normals = {}) const;

  /// Writes one file, complete or not at all, whose `mtllib` lines fit its folder.
  /// Cost: formats about 30 million numbers a second.
  /// Errors: SizeMismatch; NonFinite, as OBJ has no such numbers; FileNotWritable.
  Status writeTo(const std::string& path, PointView<const float> positions, PointView<const float> normals = {}) const;
  /// The same.
  Status writeTo(const std::string& path, PointView<const double> positions, PointView<const float> normals = {}) const;

  /// Ok if these can be written at `path`: the first two errors above.
  template <class Scalar>
  Status checkPoints(const std::string& path, PointView<const Scalar> positions,
                     PointView<const float> normals = {}) const;

 private:
  struct Library {
    std::size_t offset = 0;  ///< of the name in text_
    std::string name;        ///< as written
  };

  Status addPosition(const std::string& path, const io::ObjStatement& statement);
  void addFace(const io::ObjStatement& statement);
  void addLibraries(const io::ObjStatement& statement);
  bool addLibrary(std::string_view name, std::size_t offset);
  void addFaceWithNormals(const io::ObjStatement& statement);

  std::string text_;
  std::vector<std::size_t> gaps_;        ///< vertexCount offsets in text_, ascending: where each position goes
  std::vector<std::size_t> normalGaps_;  ///< likewise for the normals, each after its position's; or empty
  std::vector<Library> libraries_;       ///< the material libraries found beside the source
  std::string sourceFolder_;
};

/// The layout in which a mesh loaded by `loadMesh(meshPath)` is written: that of the file itself if it is an OBJ file,
/// otherwise one made from the mesh.
/// Errors: those of `ObjLayout::fromFile`; SizeMismatch if the file has changed since it was loaded.
TETSKIN_IO_API Result<ObjLayout> objLayoutFor(const std::string& meshPath, const TriangleMesh& mesh);

/// Writes the frames of one deforming mesh as `DIR/frame_0000.obj`, ...: four digits, more from frame 10,000 on.
/// float positions are written as the shortest numbers that read back as the same floats, double positions as doubles
/// (about twice as long): no frame loses a digit of what the caller has.
class TETSKIN_IO_API ObjSequenceWriter {
 public:
  /// Writes nothing; use `create`.
  ObjSequenceWriter() = default;

  /// Makes the folder, with those above it, and tries to write there. Files already in it stay, unless overwritten.
  /// Errors: FileNotWritable.
  static Result<ObjSequenceWriter> create(const std::string& directory, const ObjLayout& layout,
                                          std::string baseName = "frame_");

  /// Writes one frame, complete or not at all. `frame` must not be negative. Normals, one a vertex, if the layout was
  /// made for them (`ObjLayout::withNormals`), otherwise none.
  /// Cost: the buffer for the text, about the size of a file, is allocated by the first frame only.
  /// Errors: SizeMismatch; NonFinite, as OBJ has no such numbers; FileNotWritable.
  Status write(int frame, PointView<const float> positions, PointView<const float> normals = {});
  /// The same.
  Status write(int frame, PointView<const double> positions, PointView<const float> normals = {});

  /// Where a frame goes.
  std::string framePath(int frame) const;

 private:
  template <class Scalar>
  Status writeFrame(int frame, PointView<const Scalar> positions, PointView<const float> normals);

  std::string directory_;
  std::string baseName_;
  ObjLayout layout_;
  std::vector<char> buffer_;
};

}  // namespace tetskin
