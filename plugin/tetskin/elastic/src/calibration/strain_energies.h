// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/elastic/src/matrix/linear_elasticity.h>

#include <vector>

namespace tetskin::elastic_detail {

/// Twice the strain energies, tetCount x displacements; a quadratic tet's energy is shared by its eight tets. Their sum
/// over the tets is the work of the load that caused the displacement.
/// cage, scale  see BlockRows
/// Cost         O(T) for T tets and each displacement
Eigen::MatrixXd strainEnergies(const Cage& cage, double poissonRatio, const std::vector<double>& scale,
                               const Fields& displacements);

}  // namespace tetskin::elastic_detail
