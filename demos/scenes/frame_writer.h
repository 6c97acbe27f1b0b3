// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/io/obj_sequence_writer.h>

#include <string>
#include <vector>

namespace tetskin::scenes {

/// Whether float, which is what Bullet computes and viewers read, will do for a surface in this box: not if it lies so
/// far out that float cannot hold it.
bool fitsFloat(const Box3& box);

/// An OBJ sequence of surfaces in double, written as float where that will do.
class FrameWriter {
 public:
  /// The layout has normals if the frames have. Throws InputError if the folder cannot be written to.
  FrameWriter(const std::string& folder, const ObjLayout& layout);
  /// bounds  of the surface. Throws InputError.
  void write(int frame, const std::vector<Eigen::Vector3d>& surface, const Box3& bounds,
             PointView<const float> normals);

 private:
  ObjSequenceWriter writer_;
  std::vector<Eigen::Vector3f> rounded_;
};

}  // namespace tetskin::scenes
