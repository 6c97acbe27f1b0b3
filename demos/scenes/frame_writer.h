// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/tet_mesh.h>
#include <tetskin/io/obj_sequence.h>

#include <string>
#include <vector>

namespace tetskin::scenes {

/// Whether float, which is what Bullet computes and viewers read, will do for a surface in this box: not if it lies so
/// far out that float cannot hold it.
bool fitsFloat(const Box3& box);

/// Which frames a run writes, and where.
struct FramePlan {
  std::string folder;
  int frames = 0;
  int every = 1;       ///< every so many are written, the first among them
  bool cages = false;  ///< beside each its cage
};

/// An OBJ sequence of surfaces in double, written as float where that will do, and perhaps the cages beside them. The
/// folder holds the frames of one run: what an earlier one wrote there and this one will not overwrite goes when the
/// first frame is written. What a run writes `.tetskin_frames` lists; no other file is touched.
class FrameWriter {
 public:
  /// The layout has normals if the frames have. Throws InputError if the folder cannot be written to.
  FrameWriter(const FramePlan& plan, const ObjLayout& layout);
  /// bounds  of the surface. Throws InputError.
  void write(int frame, const std::vector<Eigen::Vector3d>& surface, const Box3& bounds,
             PointView<const float> normals);
  /// Throws InputError.
  void writeCage(int frame, const TetMesh& cage);

  /// How much the run will write, judged by its first frame, which is there. One line, for people.
  std::string announcement() const;

 private:
  std::vector<std::string> filesOf(int frame) const;
  void replaceEarlierRun() const;

  FramePlan plan_;
  ObjSequenceWriter writer_;
  std::vector<Eigen::Vector3f> rounded_;
};

}  // namespace tetskin::scenes
