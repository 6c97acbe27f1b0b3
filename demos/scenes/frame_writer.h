// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/tet_mesh.h>
#include <tetskin/core/triangle_mesh.h>
#include <tetskin/io/obj_sequence.h>

#include <set>
#include <string>
#include <vector>

#include "scenes/command_line.h"

namespace tetskin::scenes {

/// Whether float, which is what Bullet computes and viewers read, will do for a surface in this box: not if it lies so
/// far out that float cannot hold it.
bool fitsFloat(const Box3& box);

/// Whether a run writes, or removes, files of this name in its folder.
bool isOfFrames(const std::string& name);

/// Which frames a run writes, and where.
struct FramePlan {
  std::string folder;
  int frames = 0;
  int every = 1;           ///< every so many are written, the first among them
  bool cages = false;      ///< beside each its cage
  std::string materials;   ///< a material library for the frames; empty: the layout's own, or none
  TriangleMesh obstacles;  ///< what the frames' surface falls on, in a file of its own; or empty
  bool quiet = false;

  int count() const { return (frames - 1) / every + 1; }
};

/// A plan as the command line has it: frames, every, folder, quiet.
FramePlan framePlanOf(const OutputOptions& options);
/// The same, with the materials of what is drawn, and what that falls on.
FramePlan framePlanOf(const OutputOptions& options, const TriangleMesh& drawn, const TriangleMesh& obstacles);

/// Throws InputError if the disk has no room for frames of this mesh: what can be known before there is a cage for it.
/// The first frame is looked at again.
void requireRoomFor(const TriangleMesh& mesh, const ObjLayout& layout, const OutputOptions& options);

/// An OBJ sequence of surfaces in double, written as float where that will do, and perhaps the cages beside them. The
/// folder holds the frames of one run: what an earlier one wrote there and this one will not overwrite goes when the
/// first frame is written. What a run writes `.tetskin_frames` lists; no other file is touched, and a folder with
/// frames that the list does not know is refused.
///
/// Materials are written twice: once for all frames, named by their first line, and once beside each under its own
/// name, where f3d looks for them.
class FrameWriter {
 public:
  /// The layout has normals if the frames have. Throws InputError if the folder cannot be written to.
  FrameWriter(const FramePlan& plan, const ObjLayout& layout);
  /// Before it writes the first frame, which is number 0, tells how much the run will write. Throws InputError, then
  /// also where the disk has no room for that.
  /// bounds  of the surface
  /// cage    if and only if the plan has cages
  void write(int frame, const std::vector<Eigen::Vector3d>& surface, const Box3& bounds, PointView<const float> normals,
             const TetMesh* cage = nullptr);

 private:
  template <class Scalar>
  void writeFrame(int frame, PointView<const Scalar> surface, PointView<const float> normals, const TetMesh* cage);
  void begin(double frameBytes);
  std::string announcement(double bytes) const;
  std::vector<std::string> filesOf(int frame) const;
  std::vector<std::string> filesOfAllFrames() const;
  void refuseFramesOfOthers() const;
  void replaceEarlierRun() const;
  void writeMaterials(const std::string& name, const std::string& library) const;
  std::string pathOf(const std::string& name) const;

  FramePlan plan_;
  ObjLayout layout_;  ///< until the first frame is written
  ObjSequenceWriter writer_;
  std::vector<Eigen::Vector3f> rounded_;
};

}  // namespace tetskin::scenes
