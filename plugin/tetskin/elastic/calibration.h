// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Linear tets are too stiff, the coarser the more: a cage bends and twists less than the body whose shape it has. Most
// of that is one factor, known before anything is simulated: how much softer the cage becomes when it is refined.
#pragma once

#include <tetskin/core/cage.h>

#include <cstddef>
#include <string>
#include <vector>

namespace tetskin {

/// Options of `calibrate`.
struct CalibrationOptions {
  double poissonRatio = 0.3;  ///< 0 to below 0.5: of the material that will be simulated
  int modeCount = 6;          ///< number of softest vibration modes to compare, at least 1
};

/// Result of a calibration.
struct TETSKIN_ELASTIC_API CalibrationReport {
  double stiffnessFactor = 1.0;  ///< found factor of the stiffness, above 0 and at most 1
  int refinements = 0;           ///< number of uniform refinements; 0: the cage has too many tets, and the factor is 1
  std::size_t refinedTets = 0;   ///< number of tets in the finest refinement
  /// refinements + 1 values, from the cage to its finest refinement: displacement by the modes' loads, relative to that
  /// in the limit of infinite refinement, as a mean; the first, if it is not above 1, is `stiffnessFactor`
  std::vector<double> responses;
  int skippedModes = 0;  ///< modes that the refinements lack: of regions that are almost unattached
  /// Estimate of the remaining error: the root mean square error of the modes' responses with the factor, plus half of
  /// the extrapolation from the refinements. A fraction of the displacement.
  double remainingError = 0.0;
  double milliseconds = 0.0;  ///< wall time

  /// Readable summary, one line per item.
  std::string describe() const;
};

/// Sets the cage's `stiffnessFactor` so that its modal compliance matches that of the body with its shape, or, if the
/// cage stores volume fractions, of the mesh in it. The cage's own softest vibration modes (of the free body, so that
/// no scene is presumed) serve as loads, each a field of accelerations. The displacement of the cage under these loads
/// is compared with that of its uniform refinements, each with its own lumped masses, and extrapolated to the limit:
/// with order 2, which is that of linear tets; with two refinements, with the observed order, but not below 1. A mode
/// is weighted by the fraction of the body that takes part in it: the softest ones are often those of a thin tail.
/// Errors from regions that are fused in the cage appear in no refinement, and the factor does not correct them.
///
/// cage     valid (see `validate`), without flat tets; rest space, any unit and size; its stiffness factors are
///          replaced
/// Cost     some two seconds for 3,000 tets, ten for 30,000; about 2 KB per refined tet, at most 1 GB
/// Errors   InvalidOption: options out of range; those of `validate(const Cage&)`; Degenerate if a tet is flat, or the
///          cage's stiffness matrix cannot be factorised. On an error the cage is unchanged
TETSKIN_ELASTIC_API Result<CalibrationReport> calibrate(Cage& cage, const CalibrationOptions& options = {});

}  // namespace tetskin
