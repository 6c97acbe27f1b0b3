// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The motions and surfaces with which others are compared.
#pragma once

#include <tetskin/core/mesh_skin.h>

#include <vector>

#include "report/simulation.h"
#include "scenes/twist.h"

namespace tetskin::report {

using Points = std::vector<Eigen::Vector3d>;

/// Current positions and unit normals of the mesh's vertices, vertexCount each.
struct ReferenceSurface {
  Points positions, normals;
};

/// The motion that counts as exact, of any point of the rest body.
class Reference {
 public:
  virtual ~Reference() = default;
  /// The number of frames; the first is at rest.
  virtual int frameCount() const = 0;
  /// Valid until the next call.
  virtual const ReferenceSurface& surfaceAt(int frame) = 0;
  /// Where the nodes of a cage would be if they followed the reference, by frame.
  virtual Trajectory drive(const Cage& cage) const = 0;
};

/// A simulated cage. Both the mesh and the nodes of other cages follow it by quadratic skinning, which continues its
/// motion smoothly to nodes that lie outside of it: coarse cages are larger than fine ones (see DrivenNodes).
class SimulatedReference : public Reference {
 public:
  /// All arguments must outlive this object. Throws InputError.
  SimulatedReference(const TriangleMesh& mesh, const Cage& cage, const Trajectory& trajectory);

  int frameCount() const override { return static_cast<int>(trajectory_.size()); }
  const ReferenceSurface& surfaceAt(int frame) override;
  Trajectory drive(const Cage& cage) const override;

 private:
  const TriangleMesh& mesh_;
  const Trajectory& trajectory_;
  MeshSkin<double> skin_;
  Cage cage_;  ///< with the tets of the mesh's vertices
  ReferenceSurface surface_;
};

/// A smooth map, so that the only error is that of the interpolation.
class ExactReference : public Reference {
 public:
  ExactReference(const TriangleMesh& mesh, const scenes::Twist& map);

  int frameCount() const override { return 2; }
  const ReferenceSurface& surfaceAt(int frame) override;
  Trajectory drive(const Cage& cage) const override;

 private:
  scenes::Twist twistAt(int frame) const;

  const TriangleMesh& mesh_;
  scenes::Twist map_;
  Points restNormals_;
  ReferenceSurface surface_;
};

/// The nodes of a frame in double precision, as skins of double need them.
Points toDouble(const std::vector<Eigen::Vector3f>& nodes);

}  // namespace tetskin::report
