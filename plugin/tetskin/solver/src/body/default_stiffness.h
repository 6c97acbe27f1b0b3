// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The stiffness of a body that is given none: by its weight and size, see SoftBodyOptions::relativeStiffness.
#pragma once

#include <tetskin/bullet/soft_body.h>

#include <vector>

namespace tetskin::bullet_detail {

/// Density times gravity times size: the unit of relative stiffness, in pascals. Without gravity, that of the earth.
/// masses  by node of the cage
double weightPressure(const Cage& cage, const std::vector<double>& masses, double gravity);

/// In pascals.
/// pressure  see `weightPressure`
/// bounded   limit it to what explicit elastic forces can simulate stably
double defaultYoungsModulus(const TetMesh& cage, const SoftBodyOptions& options, const std::vector<double>& masses,
                            double pressure, bool bounded);

}  // namespace tetskin::bullet_detail
