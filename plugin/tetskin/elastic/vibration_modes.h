// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The vibrations of a body: model reduction steps these instead of its tets. With Bullet, see `ReducedBody`
// (tetskin/reduced).
#pragma once

#include <tetskin/core/cage.h>

#include <cstddef>
#include <functional>
#include <vector>

namespace tetskin {

/// Options of `computeVibrationModes`.
struct VibrationOptions {
  int modeCount = 20;                  ///< number of modes, at least 1
  double poissonRatio = 0.3;           ///< 0 to below 0.5
  std::vector<double> stiffnessScale;  ///< tetCount, above 0: factors of the stiffness; empty: those of the cage
  /// nodeCount, above 0, for a density of 1; empty: the cage's or, if it has none, a quarter of each tet's volume
  std::vector<double> nodeMasses;
  std::vector<int> pinned;  ///< indices of pinned nodes; empty: the body is free
  /// Called now and then with the fraction done, from 0 to 1, never decreasing. May be empty.
  std::function<void(double fraction)> progress;
};

/// The softest vibration modes of a cage's tets, softest first, for a Young's modulus and a density of 1: the modes of
/// one body serve any stiffness, time step and mass. Rigid motions of a free body are not included.
struct TETSKIN_ELASTIC_API VibrationModes {
  std::vector<Eigen::Vector3d> nodes;       ///< nodeCount, rest space: nodes of the tets
  std::vector<double> masses;               ///< nodeCount, for a density of 1
  std::vector<int> pinned;                  ///< indices of pinned nodes, ascending
  double poissonRatio = 0.0;                ///< of the material
  std::vector<double> eigenvalues;          ///< modeCount, ascending: squares of angular frequencies
  std::vector<std::vector<double>> shapes;  ///< modeCount x 3 nodeCount displacements; mass-orthonormal
  int iterations = 0;                       ///< number of iterations; 0: solved directly
  double milliseconds = 0.0;                ///< wall time

  std::size_t nodeCount() const { return nodes.size(); }        ///< number of nodes
  std::size_t modeCount() const { return eigenvalues.size(); }  ///< number of modes
  /// modeCount angular frequencies, in radians per second, of a body with this stiffness (pressure units) and density
  /// (mass per volume), both above 0.
  std::vector<double> frequencies(double youngsModulus, double density) const;

  /// Serialises the modes to bytes, identical on every machine: 24 bytes per node and mode, and 8 per node.
  /// cage  for which the modes were computed: a hash of its tets, and of the set of quadratic ones, is stored
  std::vector<unsigned char> save(const Cage& cage) const;
  /// Reads what `save` wrote, bit-identical; iterations and time are 0. Safe for arbitrary bytes.
  /// bytes   `count` bytes; not kept
  /// cage    with which the modes were saved
  /// Errors  UnsupportedFormat: other data, or another version; Malformed: too few, too many or damaged bytes;
  ///         CageMismatch: saved with other tets, or with another set of quadratic ones
  static Result<VibrationModes> load(const unsigned char* bytes, std::size_t count, const Cage& cage);
};

/// Computes the softest vibration modes of linear and quadratic tets with lumped masses, by preconditioned block
/// iteration, in memory proportional to the mesh: see vibration_modes.cpp. Modes of equal frequency span the correct
/// space, in an arbitrary basis.
///
/// cage    valid (see `validate`), one component, without flat tets; rest space, any unit and size. At least as many
///         free nodes as modes
/// Cost    about proportional to tets x modes; see demos/README.md. Memory some 0.5 KB per tet (1 KB if it is
///         quadratic), and 60 bytes per tet and mode
/// Errors  those of `validate(const Cage&)`; InvalidOption: options out of range, more modes than free nodes, or all
///         nodes pinned; SizeMismatch: an array of the wrong length; IndexOutOfRange: a pinned node does not exist;
///         Degenerate: flat tets, nodes in no tet, several components, regions that are connected only by a node or an
///         edge, so that nothing resists their rotation, or no convergence
TETSKIN_ELASTIC_API Result<VibrationModes> computeVibrationModes(const Cage& cage,
                                                                 const VibrationOptions& options = {});

}  // namespace tetskin
