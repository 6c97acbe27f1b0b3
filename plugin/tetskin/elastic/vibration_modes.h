// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// How a body vibrates: what model reduction steps instead of its tets. With Bullet, see `ReducedBody`
// (tetskin/reduced).
#pragma once

#include <tetskin/core/tet_mesh.h>

#include <cstddef>
#include <functional>
#include <vector>

namespace tetskin {

/// Which vibrations to find, of what body.
struct VibrationOptions {
  int modes = 20;                      ///< at least 1
  double poissonRatio = 0.3;           ///< 0 to below 0.5
  std::vector<double> stiffnessScale;  ///< tetCount, above 0: times the stiffness; empty: 1
  std::vector<double> nodeMasses;  ///< nodeCount, above 0, for a density of 1; empty: a quarter of each tet's volume
  std::vector<int> pinned;         ///< nodes that are held; none: the body is free
  /// Told now and then how much is done, from 0 to 1, ascending.
  std::function<void(double share)> progress;
};

/// The softest vibrations of a tet mesh, softest first, for a Young's modulus and a density of 1: one body's modes
/// serve any stiffness, size of time step and mass. Rigid motions, of a free body, are none of them.
struct TETSKIN_ELASTIC_API VibrationModes {
  std::vector<Eigen::Vector3d> nodes;       ///< nodeCount, rest space: those of the tets
  std::vector<double> masses;               ///< nodeCount
  std::vector<int> pinned;                  ///< nodes that are held, ascending
  double poissonRatio = 0.0;                ///< of the material
  std::vector<double> eigenvalues;          ///< modeCount, ascending: squares of angular frequencies
  std::vector<std::vector<double>> shapes;  ///< modeCount x 3 nodeCount displacements; mass-orthonormal
  int iterations = 0;                       ///< that it took; 0: all at once
  double milliseconds = 0.0;                ///< wall time

  std::size_t nodeCount() const { return nodes.size(); }        ///< of the tets
  std::size_t modeCount() const { return eigenvalues.size(); }  ///< of `shapes`
  /// modeCount angular frequencies of a body of this stiffness and density, radians a second; both above 0.
  std::vector<double> frequencies(double youngsModulus, double density) const;

  /// All of it as bytes, the same on every machine: 24 bytes a node and mode, and 8 a node.
  /// tets  those that the modes are of: their hash goes with the bytes
  std::vector<unsigned char> save(const TetMesh& tets) const;
  /// What `save` wrote, equal to the bit; iterations and time are 0. Never crashes, whatever the bytes.
  /// bytes   `count` of them
  /// Errors  UnsupportedFormat: bytes of something else, or of another version; Malformed: too few, too many or
  ///         damaged; CageMismatch: of other tets
  static Result<VibrationModes> load(const unsigned char* bytes, std::size_t count, const TetMesh& tets);
};

/// The softest vibrations of linear tets with masses at their nodes, by preconditioned block iteration, in memory
/// proportional to the mesh: see vibration_modes.cpp. Modes of one frequency span the right space, in some basis of it.
///
/// tets    usable (see `usable`), one part, without flat ones; rest space, any unit and size. At least as many free
///         nodes as modes
/// Cost    about proportional to tets x modes; see demos/README.md. Memory some 0.5 KB a tet, and 60 bytes a tet and
///         mode
/// Errors  those of `usable`; InvalidOption: options out of range, more modes than free nodes, or all nodes pinned;
///         SizeMismatch; IndexOutOfRange: a pinned node does not exist; Degenerate: flat tets, nodes in no tet, several
///         parts, parts that hang together by a node or an edge alone, so that nothing resists their turning, or no
///         convergence
TETSKIN_ELASTIC_API Result<VibrationModes> vibrationModes(const TetMesh& tets, const VibrationOptions& options = {});

}  // namespace tetskin
