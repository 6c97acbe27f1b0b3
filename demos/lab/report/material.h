// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include "scenes/table.h"

namespace tetskin::report {

/// The material of every cage of a comparison, and how it is stepped. Both follow from the reference, which is the
/// least stable.
/// The density is that of the mesh's volume, where the reference knows it: all cages that know it have the same mass.
/// Bare tets are heavier, as they are larger than the mesh.
/// relativeStiffness  Young's modulus over density x gravity x size; 0: the scene's own
/// bullets            with Bullet's explicit forces. Bodies that do not land have linear elasticity, which Bullet
///                    rotates with each tet, and whose damping then keeps any stiffness stable. Bodies that land would
///                    sink into the ground with it, so they have neo-Hookean elasticity, with as many substeps as its
///                    stiffness needs in a landing. With the library's force, the same material is stepped as scenes
///                    are by default, which is stable
scenes::SceneOptions materialOf(const scenes::SceneEntry& scene, const Cage& reference, double relativeStiffness,
                                bool bullets);

/// Seconds of damping at which Bullet's explicit steps of this length are stable at any stiffness.
double stableDamping(double substep);

/// The same in some substeps per frame.
/// substeps  0: the options' own
scenes::SceneOptions withSubsteps(scenes::SceneOptions options, int substeps);

/// The same with a solver that leaves so little of the residual that it adds nothing to the error of many substeps.
scenes::SceneOptions converged(scenes::SceneOptions options);

}  // namespace tetskin::report
