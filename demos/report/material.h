// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include "scenes/table.h"

namespace tetskin::report {

/// Whose forces bodies have, and how they are stepped.
enum class Elasticity { Tetskin, BulletExplicit, BulletImplicit };
/// "tetskin", "explicit", "implicit".
const char* nameOf(Elasticity elasticity);

/// What every cage of a comparison is made of, and how it is stepped. Chosen by the reference, which is the least
/// stable: where bodies do not land, linear elasticity, which Bullet turns with each tet, and whose damping then keeps
/// any stiffness stable; where they do, and that would sink into the ground, neo-Hookean elasticity, with as many
/// substeps as its stiffness needs in a landing.
/// Its density is by the volume of the mesh, where the reference knows that: so weigh all cages that know it as well;
/// bare tets weigh more, as they are larger than the mesh.
/// elasticity: of the library, the same material is stepped as scenes are by default, which it can bear.
/// relativeStiffness  Young's modulus over density x gravity x size; 0: the scene's own
scenes::SceneOptions materialOf(const scenes::SceneEntry& scene, const Cage& reference, double relativeStiffness,
                                Elasticity elasticity);

}  // namespace tetskin::report
