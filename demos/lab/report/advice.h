// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Conclusions from the rows of one scene together.
#pragma once

#include <string>
#include <vector>

#include "report/report_row.h"

namespace tetskin::report {

/// Marks rows that no other choice beats in both time and error. The reference is left out.
void markPareto(std::vector<Row>& rows);

/// A cage made as a reference is, but coarser: mean length of its edges, and its distance from the reference.
struct CoarserLevel {
  double edge = 0, error = 0;
};
/// The error of a reference itself, estimated from coarser levels, the finer one first. If errors against the truth
/// fall as C edge^p, then those against the reference are C (edge^p - reference edge^p), and two of them give C and p
/// (which is kept between 1 and 3). One level alone is taken to be of order 1, which is cautious. 0 without any.
/// edge  of the reference
double ownError(double edge, const std::vector<CoarserLevel>& coarser);

/// The error in space that the reference's row gives for itself; 0 if it is not known.
double referenceError(const std::vector<Row>& rows);

/// An error of a row says something if it is this many times the reference's own.
constexpr double kResolved = 3.0;
/// Marks the rows whose errors the reference resolves.
void markResolved(std::vector<Row>& rows);

/// The reference's own error in time, estimated from its error in fewer substeps and the order (kept between 1 and 3)
/// that the finest cage has between the fewest and the most substeps. 0 if either is missing.
double referenceTimeError(const std::vector<Row>& rows);

/// How a reduced body compares with cages, by the size of the deformation.
struct ReductionLimit {
  double modes = 0;
  double amplitude = 0;  ///< the largest amplitude at which the error is at most a tenth of it: RMS distance of the
                         ///< reference's surface from rest
};
/// The limit of the reduced row with most modes, over its frames. The amplitude is 0 if there is no such row, or if
/// none of its frames is that good.
ReductionLimit reductionLimit(const std::vector<Row>& rows);

/// A sentence on what to use in this scene: the reduced body that gains most over the cages of the same cost, or these
/// cages. Empty without reduced rows.
std::string reductionAdvice(const std::vector<Row>& rows);

}  // namespace tetskin::report
