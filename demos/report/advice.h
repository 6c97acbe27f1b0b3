// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// What the rows of one scene say together.
#pragma once

#include <string>
#include <vector>

#include "report/report_row.h"

namespace tetskin::report {

/// Marks the rows that no other choice beats in both time and error. The reference and Bullet's own path take no part.
void markPareto(std::vector<Row>& rows);

/// The power of the cage's edge with which an error falls, from each cage to the next finer one.
struct ObservedOrder {
  double coarseTets = 0, fineTets = 0;
  double total = 0, embedding = 0;  ///< 0 where an error is 0
};
/// Of the rows with this interpolation and material.
std::vector<ObservedOrder> observedOrders(const std::vector<Row>& rows, const std::string& interpolation,
                                          const std::string& material);

/// The power over all these cages: the slope of a straight line through the logarithms, by least squares. 0 if there
/// are fewer than two.
ObservedOrder overallOrder(const std::vector<Row>& rows, const std::string& interpolation, const std::string& material);

/// What the reference itself is wrong by, estimated from the two finest cages made as it is, split, filled and
/// calibrated, or else from the two finest bare ones: if errors against the truth fall as C edge^p, then those against
/// the reference are C (edge^p - reference edge^p), and two of them give C and p (which is kept between 1 and 3). 0 if
/// there are fewer than two.
double referenceError(const std::vector<Row>& rows);

/// A reduced body against cages, by the deformation.
struct ReductionLimit {
  double modes = 0;
  double amplitude =
      0;  ///< the largest at which the error is at most a tenth of it: RMS of the reference's surface from rest
};
/// Of the reduced row of most modes, over its frames; amplitude 0 if there is none, or none of its frames is so good.
ReductionLimit reductionLimit(const std::vector<Row>& rows);

/// What to take in this scene, in a sentence: the reduced body that gains most over the cages that cost no more, or
/// these. Empty without reduced rows.
std::string reductionAdvice(const std::vector<Row>& rows);

}  // namespace tetskin::report
