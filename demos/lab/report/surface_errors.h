// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <vector>

#include "report/reference.h"
#include "report/simulation.h"

namespace tetskin::report {

/// How far a surface is from the reference, in diagonals of the mesh's box, over all vertices and all frames after the
/// first.
struct SurfaceErrors {
  double rms = 0.0, max = 0.0;
  double normalMeanDeg = 0.0;
  std::vector<double> rmsByFrame;
  std::vector<double> amplitudeByFrame;  ///< RMS distance of the reference itself from rest
  std::vector<float> rmsByVertex;        ///< RMS over the frames
};

/// The errors of the surface that the nodes of a cage carry.
/// nodes  by frame; no more frames than the reference has
SurfaceErrors surfaceErrors(Reference& reference, const TriangleMesh& mesh, const Cage& cage, SurfaceKind kind,
                            const Trajectory& nodes);

/// The errors of many motions of one cage, approximate and fast: of some of the mesh's vertices, each of which follows
/// its tet linearly.
class SampledErrors {
 public:
  /// reference  read here only
  SampledErrors(Reference& reference, const TriangleMesh& mesh, const Cage& cage);

  /// As SurfaceErrors::rms.
  /// nodes  by frame; no more frames than the reference has
  double rms(const Trajectory& nodes) const;

 private:
  const Cage& cage_;
  std::vector<VertexBinding> samples_;
  std::vector<Points> right_;  ///< of the samples, by frame
  double diagonal_;
};

/// Root mean square distance between the surfaces that two motions of the same cage carry, in diagonals of the mesh's
/// box, over all vertices and all frames after the first that both have.
double surfaceDistance(const TriangleMesh& mesh, const Cage& cage, SurfaceKind kind, const Trajectory& nodes,
                       const Trajectory& others);

/// Root mean square distance of a cage's nodes to where the reference would take them, in diagonals of the mesh's box,
/// over all nodes and all frames after the first.
double nodeErrors(const Trajectory& nodes, const Trajectory& driven, const TriangleMesh& mesh);

}  // namespace tetskin::report
