// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/mesh.h>
#include <tetskin/io/animation.h>
#include <tetskin/io/obj_sequence.h>

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "scenes/command_line.h"
#include "scenes/formats.h"

namespace tetskin::scenes {

/// Whether float, which Bullet computes in and viewers read, suffices for a surface in this box: it does not if the
/// surface lies too far from the origin.
bool fitsFloat(const Box3& box);

/// Whether a run writes or removes files with this name in its folder.
bool isOfFrames(const std::string& name);

/// Which frames a run writes, and where.
struct FramePlan {
  std::string folder;
  Formats formats;
  int frames = 0;
  int every = 1;           ///< every n-th frame is written, beginning with the first
  bool cages = false;      ///< writes the cage beside each frame
  std::string materials;   ///< a material library for the frames; empty: that of the layout, or none
  TriangleMesh obstacles;  ///< the obstacles on which the surface falls, in a separate file; may be empty
  bool quiet = false;

  int count() const { return (frames - 1) / every + 1; }
};

/// A plan from the command line's frames, every, folder and quiet.
FramePlan framePlanOf(const OutputOptions& options);
/// A plan from the command line, with the materials of the drawn mesh, and the obstacles that it falls on.
FramePlan framePlanOf(const OutputOptions& options, const TriangleMesh& drawn, const TriangleMesh& obstacles);

/// Throws InputError if the disk has no room for frames of this mesh, as far as this is known before it has a cage. It
/// is checked again before the first frame.
void requireRoomFor(const TriangleMesh& mesh, const ObjLayout& layout, const OutputOptions& options);

/// An OBJ sequence of surfaces in double precision, written as float where that suffices, or a point cache of them in
/// float with the first as its mesh, `animation.pc2` and `animation.obj`; and optionally the cages beside them. The
/// folder holds the frames of one run: files of an earlier run that this one does not overwrite are removed when the
/// first frame is written. `.tetskin_frames` lists the files that a run writes; no other file is touched, and a folder
/// that contains frames which the list does not name is refused.
///
/// Materials are written twice: once for all frames, named by their first line, and once beside each frame under its
/// own name, where f3d looks for them.
class FrameWriter {
 public:
  /// The layout has normals if the frames have. Throws InputError if the folder cannot be written.
  FrameWriter(const FramePlan& plan, const ObjLayout& layout);
  /// Announces, before the first frame, that another writer adds a file of this name to the folder at the end of the
  /// run.
  void addOther(const std::string& name, double bytes);
  /// Before it writes the first frame, which is number 0, prints how much the run will write. Throws InputError, also
  /// if the disk has no room for that.
  /// bounds  of the surface
  /// cage    if and only if the plan has cages
  void write(int frame, const std::vector<Eigen::Vector3d>& surface, const Box3& bounds, PointView<const float> normals,
             const TetMesh* cage = nullptr);
  /// Completes files that hold all frames. Throws InputError.
  void finish();

 private:
  template <class Scalar>
  void writeFrame(int frame, PointView<const Scalar> surface, PointView<const float> normals, const TetMesh* cage);
  void begin(double bytes);
  template <class Scalar>
  void beginCache(PointView<const Scalar> surface, PointView<const float> normals);
  std::string announcement(double bytes) const;
  std::vector<std::string> filesOf(int frame) const;
  std::vector<std::string> filesOfAllFrames() const;
  void refuseFramesOfOthers() const;
  void replaceEarlierRun() const;
  void writeMaterials(const std::string& name, const std::string& library) const;
  std::string pathOf(const std::string& name) const;

  FramePlan plan_;
  ObjLayout layout_;  ///< used until the first frame is written
  ObjSequenceWriter writer_;
  std::optional<Pc2Writer> cache_;
  std::vector<std::string> others_;  ///< files of all frames that somebody else writes
  double otherBytes_ = 0.0;
  std::vector<Eigen::Vector3f> rounded_;
};

}  // namespace tetskin::scenes
