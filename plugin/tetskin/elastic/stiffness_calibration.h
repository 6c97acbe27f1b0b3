// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Linear tets are too stiff, the coarser the more: a cage bends and twists less than the body whose shape it has. Most
// of that is one factor, known before anything is simulated: how much softer the cage becomes when it is refined.
#pragma once

#include <tetskin/core/tet_mesh.h>

#include <vector>

namespace tetskin {

struct CalibrationOptions {
  double poissonRatio = 0.3;  ///< 0 to below 0.5, of the material that will be simulated
  int modes = 12;             ///< softest vibrations to compare, at least 1
  int refinements = 1;        ///< how often the cage is refined, every tet into eight; at least 1
};

struct StiffnessCalibration {
  /// Multiply Young's modulus by this, above 0 and at most 1, and leave the mass alone.
  double factor = 1.0;
  /// refinements + 1, from the cage to its finest refinement: how far the vibrations' loads move the body, over how far
  /// they would move the limit of all refinements, in the mean; the first, if it is not above 1, is `factor`
  std::vector<double> responses;
  double milliseconds = 0.0;  ///< wall time
};

/// Finds the factor on Young's modulus that gives a cage the modal compliance of the body whose shape it has. The
/// cage's own softest vibrations (of the free body, so that no scene is presumed) are taken for loads, each a field of
/// accelerations; how far these move the cage is compared with how far they move its uniform refinement, each with its
/// own lumped masses, and extrapolated to the limit: with order 2, which is that of linear tets; with two refinements
/// or more, with the order seen, but not below 1. A vibration counts by the share of the body that takes part in it:
/// the softest ones are often those of a thin tail. What the cage lacks by its shape (it is fatter than its mesh; parts
/// that lie close together may have fused) no refinement of it shows, and the factor leaves as it is.
///
/// cage     usable (see `usable`), without flat tets; rest space, any unit and size
/// Cost     with one refinement one to two seconds for 3,000 tets and six for 10,000; about 2 KB a refined tet
/// Errors   InvalidOption; those of `usable`; Degenerate if a tet is flat, or the cage's stiffness cannot be factorised
TETSKIN_ELASTIC_API Result<StiffnessCalibration> calibrateStiffness(const TetMesh& cage,
                                                                    const CalibrationOptions& options = {});

}  // namespace tetskin
