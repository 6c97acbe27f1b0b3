// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Hand-written XPBD in a scene in which bodies only hang by their pins, with the constants that suit it best.
#pragma once

#include <tetskin/core/cage.h>

#include <functional>
#include <vector>

#include "measure/xpbd.h"
#include "report/simulation.h"
#include "scenes/table.h"

namespace tetskin::report {

/// XPBD's constants instead of a material.
struct XpbdConstants {
  /// Stiffness of the springs along edges, relative to the one with which a fine isotropic lattice of them has the
  /// material's Young's modulus (and a Poisson ratio of 1/4).
  double stiffness = 1.0;
  /// Pressure per relative change of a tet's volume, over the material's first Lame parameter; 0: no constraint on
  /// volumes; infinite: rigid.
  double volume = 0.0;
  double damping = 0.0;  ///< seconds
};

/// The constants that follow from a material. Springs give a lattice the second Lame parameter of a Poisson ratio of
/// 1/4, and an equal first one; volumes add the rest.
XpbdConstants constantsOf(const scenes::SceneOptions& options);

/// A scene's body, for XPBD. Masses, pins and gravity are those of the scene's body in Bullet. An edge's stiffness is
/// that of the tets around it: their volume times their factor of stiffness, over its squared length.
class XpbdModel {
 public:
  XpbdModel(const scenes::SceneEntry& entry, const Cage& cage, const scenes::SceneOptions& options);

  measure::XpbdBody with(const XpbdConstants& constants) const;

 private:
  measure::XpbdBody body_;  ///< with constants of 1, and no damping
};

/// As `simulate`, without surfaces.
Simulation simulateXpbd(const measure::XpbdBody& body, const scenes::SceneOptions& options, const FrameDone& done);

/// The constants with the least error in these substeps: a search over a grid of factors of two, for each choice of
/// volumes and of damping, then more finely around the best.
/// errorOf  infinite where the body explodes
XpbdConstants bestConstants(const std::vector<double>& dampings,
                            const std::function<double(const XpbdConstants&)>& errorOf);

}  // namespace tetskin::report
