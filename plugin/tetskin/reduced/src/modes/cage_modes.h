// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/cage.h>
#include <tetskin/elastic/vibration_modes.h>

#include <Eigen/Core>
#include <vector>

namespace tetskin::reduced_detail {

/// Vibrations of fine tets, expressed by the nodes of a cage around them. For a density of 1.
struct CageModes {
  std::vector<std::vector<double>> shapes;  ///< mode x 3 nodeCount of the cage
  std::vector<double> masses;               ///< nodeCount of the cage, above 0
  std::vector<double> projectionErrors;     ///< by mode, see ReductionReport
  std::size_t outside = 0;                  ///< number of fine nodes in no tet
  std::vector<char> pinned;  ///< nodeCount of the cage: true for nodes that carry more pinned fine nodes than others

  // The mass of the fine tets, not of the cage, whose nodes are farther out.
  double mass = 0.0;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  ///< about the centre of mass
  std::vector<Eigen::Vector3d> momenta;               ///< by mode: sum of mass times displacement
};

/// For each mode, the cage's displacements for which the fine nodes are nearest to their displacements in the mode:
/// least squares, weighted by mass. Where no fine node determines the cage, it bends as little as possible.
/// count     modes to take, softest first
/// nodeTets  by fine node: its tet of the cage; empty: found by its position
/// Errors    those of `embed`; OutsideCage: the fine nodes are elsewhere; SizeMismatch, IndexOutOfRange of nodeTets
Result<CageModes> modesOfCage(const VibrationModes& modes, std::size_t count, const TetMesh& cage,
                              const std::vector<int>& nodeTets);

}  // namespace tetskin::reduced_detail
