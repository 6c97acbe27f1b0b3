// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <array>
#include <string>
#include <vector>

#include "scenes/scene.h"

namespace tetskin::report {

/// The solvers that are compared, with the same cage and material.
enum class Solver {
  Tetskin,
  Xpbd,              ///< hand-written (see measure/xpbd.h), with the constants that fit this scene best
  XpbdUnfitted,      ///< the same with constants that follow from the material
  BulletNeoHookean,  ///< Bullet's forces, explicit
  BulletLinear,
  BulletNeoHookeanImplicit,  ///< the same, one Newton step per substep
  BulletLinearImplicit,
};
constexpr std::array<Solver, 7> kSolvers = {Solver::Tetskin,
                                            Solver::Xpbd,
                                            Solver::XpbdUnfitted,
                                            Solver::BulletNeoHookean,
                                            Solver::BulletLinear,
                                            Solver::BulletNeoHookeanImplicit,
                                            Solver::BulletLinearImplicit};

/// "tetskin", "xpbd", "xpbd_unfitted", "bullet_neo_hookean", "bullet_linear", and these two with "_implicit".
const char* nameOf(Solver solver);
bool isXpbd(Solver solver);
bool isBullets(Solver solver);

/// The solvers with these names, in the order above and without repetitions; "all" means all of them. Throws
/// InputError.
std::vector<Solver> solversOf(const std::vector<std::string>& names);

/// The scene's options for a solver of soft bodies in Bullet's world, not for XPBD.
scenes::SceneOptions withSolver(scenes::SceneOptions options, Solver solver, int substeps);

/// Seconds of damping with which a solver is tried; the best counts. They include the material's. XPBD may have none,
/// as its steps add damping. Bullet's steps, which treat damping implicitly, need that of half a substep at any
/// stiffness; with shorter substeps this may be less than the material's.
std::vector<double> dampings(const scenes::SceneOptions& material, Solver solver, int substeps);

}  // namespace tetskin::report
