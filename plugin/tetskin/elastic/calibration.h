// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Linear tets are too stiff, and more so in coarser cages: a cage bends and twists less than a body of its shape. Most
// of this error is one factor, which can be found before the simulation: how much softer the cage becomes when refined.
// If thin parts need another factor than thick ones, factors are found by region. The same factor makes a cage too soft
// in compression and tension, where linear tets are correct: `CalibrationReport::stretchError` tells by how much.
#pragma once

#include <tetskin/core/cage.h>

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace tetskin {

/// Options of `calibrate`.
struct CalibrationOptions {
  double poissonRatio = 0.3;  ///< 0 to below 0.5: of the material that will be simulated
  int modeCount = 6;          ///< number of softest vibration modes to compare, at least 1
  /// Called now and then with the fraction done, an estimate from 0 to 1, never decreasing; returns false to cancel.
  /// May be empty.
  std::function<bool(double fraction)> progress{};
};

/// Result of a calibration.
struct TETSKIN_ELASTIC_API CalibrationReport {
  double stiffnessFactor = 1.0;  ///< factor of the stiffness, above 0 and at most 1: of all tets, or their mean
  bool byRegion = false;         ///< the factors differ by region, because one factor does not fit the whole body
  double leastFactor = 1.0;      ///< the smallest factor of all tets
  double greatestFactor = 1.0;   ///< the largest factor of all tets
  bool needless = false;         ///< all tets are quadratic and full: the factor is 1, without a comparison
  int refinements = 0;           ///< number of uniform refinements; 0: the cage has too many tets, and the factor is 1
  std::size_t refinedTets = 0;   ///< number of tets in the finest refinement
  /// refinements + 1 values, from the cage without a factor to its finest refinement: displacement under the same
  /// loads, relative to that in the limit of infinite refinement, as a geometric mean
  std::vector<double> responses;
  int skippedModes = 0;  ///< modes left out because the refinements lack them: those of almost unattached regions
  /// Root mean square error of the calibrated cage relative to the limit, as a fraction: of the displacement by its
  /// modes' accelerations, which is twice the error of their frequencies.
  double modeError = 0.0;
  double sagError = 0.0;  ///< the same for the displacement under sags
  /// How much farther than in the limit, as a fraction of the displacement, the cage without factors is compressed or
  /// stretched by forces along its axes; negative: too stiff.
  double plainStretchError = 0.0;
  double stretchError = 0.0;  ///< the same for the calibrated cage. A body that is mostly compressed, like a column
                              ///< under its own weight, is better left uncalibrated, or given quadratic tets or more
                              ///< tets
  /// Estimate of the remaining error: the mean of both errors, plus half of the extrapolation from the refinements. A
  /// fraction of the displacement.
  double remainingError = 0.0;
  double milliseconds = 0.0;  ///< wall time

  /// Readable summary, one line per item.
  std::string describe() const;
};

/// Sets the cage's `stiffnessFactor` so that it is as compliant as a body of its shape or, if the cage stores volume
/// fractions, as the mesh in it. The cage is compared with the limit of its uniform refinements under two kinds of
/// loads; neither assumes particular pins. The first kind are the accelerations of its softest free modes, with each
/// body's own lumped masses. The second are sags: gravity that grows from the middle to the ends of the body, in three
/// directions, the same on all bodies. Both kinds count equally. A mode is weighted by the fraction of the body that
/// takes part in it, because the softest modes are often those of a thin tail. The limit is extrapolated from two
/// refinements with order 2, that of linear tets; for a cage of more than 4,687 tets it is the first refinement, made
/// of quadratic tets.
///
/// All tets get one factor, unless factors by region, found from one kind of loads, predict the other kind clearly
/// better; then each tet has its own factor, which varies slowly over the body. Cages may mix quadratic and linear
/// tets: full quadratic tets keep the factor 1, and the eight tets of any other have the same factor. Errors from
/// regions that are fused in the cage appear in no refinement, so no factor corrects them.
///
/// cage     valid (see `validate`), without flat tets; rest space, any unit and size; its stiffness factors are
///          replaced
/// Cost     some two seconds for 3,000 tets, ten for 30,000; about 2 KB per refined tet, at most 1 GB
/// Errors   InvalidOption: options out of range; those of `validate(const Cage&)`; Degenerate if a tet is flat, or the
///          cage's stiffness matrix cannot be factorised; Cancelled: by `options.progress`. The cage is unchanged on an
///          error
TETSKIN_ELASTIC_API Result<CalibrationReport> calibrate(Cage& cage, const CalibrationOptions& options = {});

}  // namespace tetskin
