// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/mesh.h>

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace tetskin {

namespace io {
struct ObjStatement;
}

/// An OBJ file without its vertex positions: the text to write, formatted once, with a gap for every vertex.
///
/// It keeps everything in the OBJ file, byte for byte (order, polygons, texture coordinates, groups, materials,
/// comments, vertex colours behind the coordinates), except
/// - normals: `vn` lines and the faces' references to them are left out. Authored normals belong to the rest shape and
///   would be wrong on a deformed one; without any, every viewer computes its own, and `withNormals` inserts current
///   ones;
/// - a byte order mark, which some readers do not accept.
class TETSKIN_IO_API ObjLayout {
 public:
  /// Reads the layout of an OBJ file; its k-th `v` line is vertex k.
  /// Errors: FileNotFound; Malformed, with the line, for a `v` line without three numbers; Empty without `v` lines.
  static Result<ObjLayout> load(const std::string& objPath);

  /// Creates a layout for a mesh from elsewhere: `v`, `vt` (if it has texture coordinates), `f`, and `g` and `usemtl`
  /// for its groups. Blanks in names become underscores, because OBJ separates names by blanks. Indices must be in
  /// range.
  static ObjLayout create(const TriangleMesh& mesh);

  /// Number of `v` lines of a written file.
  std::size_t vertexCount() const { return gaps_.size(); }
  /// True if files of this layout have normals.
  bool hasNormals() const { return !normalGaps_.empty(); }

  /// Returns this layout with a `vn` line after every `v` line, and with faces that refer to them: "1" becomes "1//1",
  /// "1/2" becomes "1/2/1". There is then one normal per vertex of the file: if authored normals differ between the
  /// corners at one vertex, as at an edge whose vertices are not duplicated, the corners share the current one.
  ObjLayout withNormals() const;

  /// Returns this layout with a first line that names a material library, located beside the written files.
  ObjLayout withMaterialLibrary(const std::string& name) const;

  /// Returns this layout for a file in `folder`: material libraries (`mtllib`) beside the source file are named by
  /// their path from that folder; others are unchanged.
  ObjLayout forFolder(const std::string& folder) const;

  /// Formats the whole file with these positions in `buffer`, reusing its memory: if it was used with this layout
  /// before, nothing is allocated. Every number is the shortest that reads back as the same float, or double. The
  /// result is a view of `buffer`.
  /// positions  vertexCount x 3, finite; the count is asserted
  /// normals    vertexCount x 3, finite, if the layout has normals, otherwise none
  template <class Scalar>
  std::string_view format(PointView<const Scalar> positions, std::vector<char>& buffer,
                          PointView<const float> normals = {}) const;

  /// Writes one file, complete or not at all, with `mtllib` lines adapted to its folder.
  /// Cost: formats about 30 million numbers per second.
  /// Errors: SizeMismatch; NonFinite, because OBJ has no such numbers; FileNotWritable.
  Status writeTo(const std::string& path, PointView<const float> positions, PointView<const float> normals = {}) const;
  /// Overload for positions in double, with the same cost and errors as for float.
  Status writeTo(const std::string& path, PointView<const double> positions, PointView<const float> normals = {}) const;

  /// Checks that these points can be written; `path` is for the message. Errors: SizeMismatch, NonFinite.
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
  std::vector<std::size_t> gaps_;  ///< vertexCount offsets in text_, ascending: where each position goes
  /// vertexCount offsets in text_ for the normals, each after its position's; or empty
  std::vector<std::size_t> normalGaps_;
  std::vector<Library> libraries_;  ///< the material libraries found beside the source
  std::string sourceFolder_;
};

/// The layout for writing a mesh that was loaded by `loadMesh(meshPath)`: that of the file itself if it is an OBJ file,
/// otherwise one created from the mesh.
/// Errors: those of `ObjLayout::load`; SizeMismatch if the file has changed since it was loaded.
TETSKIN_IO_API Result<ObjLayout> objLayoutFor(const std::string& meshPath, const TriangleMesh& mesh);

/// Writes the frames of one deforming mesh as `DIR/frame_0000.obj`, ...: four digits, more from frame 10,000 on. Float
/// positions are written as the shortest numbers that read back as the same floats, double positions as doubles (about
/// twice as long): no frame loses precision.
class TETSKIN_IO_API ObjSequenceWriter {
 public:
  /// An empty writer; use `create`.
  ObjSequenceWriter() = default;

  /// Creates the folder and its parents, and tests whether it is writable. Files already in it stay, unless
  /// overwritten.
  /// Errors: FileNotWritable.
  static Result<ObjSequenceWriter> create(const std::string& directory, const ObjLayout& layout,
                                          std::string baseName = "frame_");

  /// Writes one frame, complete or not at all. `frame` must not be negative. Positions are vertexCount x 3; normals as
  /// well if the layout was made for them (`ObjLayout::withNormals`), otherwise none.
  /// Cost: only the first frame allocates the text buffer, about the size of a file.
  /// Errors: SizeMismatch; NonFinite, because OBJ has no such numbers; FileNotWritable.
  Status write(int frame, PointView<const float> positions, PointView<const float> normals = {});
  /// Overload for positions in double, with the same errors as for float.
  Status write(int frame, PointView<const double> positions, PointView<const float> normals = {});

  /// Path of the file of a frame.
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
