// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/cage.h>
#include <tetskin/elastic/vibration_modes.h>

#include <Eigen/Core>
#include <vector>

namespace tetskin::reduced_detail {

/// Vibrations of fine tets as the nodes of a cage around them have them. For a density of 1.
struct CageModes {
  std::vector<std::vector<double>> shapes;  ///< mode x 3 nodeCount of the cage
  std::vector<double> masses;               ///< nodeCount of the cage, above 0
  std::vector<double> projectionErrors;     ///< by mode, see ReductionReport
  std::size_t outside = 0;                  ///< fine nodes in no tet
  std::vector<char> held;                   ///< nodeCount of the cage: carries pinned fine nodes more than others

  // Of the fine tets, not of the cage, whose nodes lie farther out.
  double mass = 0.0;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  ///< about the centre
  std::vector<Eigen::Vector3d> momenta;               ///< by mode: mass times displacement, of all
};

/// The displacements of the cage that carry the fine nodes nearest to where each mode has them: least squares, by mass.
/// Where no fine node tells, the cage bends as little as it can.
/// count     modes to take, softest first
/// nodeTets  by fine node: its tet of the cage; empty: by its place
/// Errors    those of `embed`; OutsideCage: the fine nodes are elsewhere; SizeMismatch, IndexOutOfRange of nodeTets
Result<CageModes> modesOfCage(const VibrationModes& modes, std::size_t count, const TetMesh& cage,
                              const std::vector<int>& nodeTets);

}  // namespace tetskin::reduced_detail
