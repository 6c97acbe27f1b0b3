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

/// What to calibrate a cage for.
struct CalibrationOptions {
  double poissonRatio = 0.3;  ///< 0 to below 0.5, of the material that will be simulated
  int modes = 6;              ///< softest vibrations to compare, at least 1
};

/// What a calibration found.
struct TETSKIN_ELASTIC_API CalibrationReport {
  double factor = 1.0;          ///< of the stiffness, above 0 and at most 1
  int refinements = 0;          ///< how often the cage was refined; 0: it has too many tets, and the factor is 1
  std::size_t refinedTets = 0;  ///< of the finest refinement
  /// refinements + 1, from the cage to its finest refinement: how far the vibrations' loads move the body, over how far
  /// they would move the limit of all refinements, in the mean; the first, if it is not above 1, is `factor`
  std::vector<double> responses;
  int skippedModes = 0;  ///< vibrations that the refinements do not have: of what hangs on next to nothing
  /// Estimate of what is left: how far the vibrations' responses are from right, with the factor, in the root mean
  /// square, together with half of what the refinements were extrapolated by. A share of the displacement.
  double left = 0.0;
  double milliseconds = 0.0;  ///< wall time

  /// One line a fact, for people.
  std::string describe() const;
};

/// Sets the cage's `factor` so that it has the modal compliance of the body whose shape it has, or the mesh in it has
/// where the cage knows its fill. The cage's own softest vibrations (of the free body, so that no scene is presumed)
/// are taken for loads, each a field of accelerations; how far these move the cage is compared with how far they move
/// its uniform refinements, each with its own lumped masses, and extrapolated to the limit: with order 2, which is that
/// of linear tets; with two refinements, with the order seen, but not below 1. A vibration counts by the share of the
/// body that takes part in it: the softest ones are often those of a thin tail. What parts have in common where they
/// have fused no refinement shows, and the factor leaves as it is.
///
/// cage     usable (see `usable`), without flat tets; rest space, any unit and size; its factors are replaced
/// Cost     some two seconds for 3,000 tets, ten for 30,000; about 2 KB a refined tet, at most 1 GB
/// Errors   InvalidOption; those of `usable` and `Cage::check`; Degenerate if a tet is flat, or the cage's stiffness
///          cannot be factorised. The cage stays as it was
TETSKIN_ELASTIC_API Result<CalibrationReport> calibrate(Cage& cage, const CalibrationOptions& options = {});

}  // namespace tetskin
