// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/io/obj_layout.h>

#include <string>
#include <vector>

namespace tetskin {

/// Writes the frames of one deforming mesh as `DIR/frame_0000.obj`, ...: four digits, more from frame 10,000 on.
/// float positions are written as the shortest numbers that read back as the same floats, double positions as doubles
/// (about twice as long): no frame loses a digit of what the caller has.
class ObjSequenceWriter {
 public:
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
