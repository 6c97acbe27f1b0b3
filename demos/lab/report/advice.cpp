// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// This work is based on:
//   Patrick Roache, "Perspective: A Method for Uniform Reporting of Grid Refinement Studies", J. Fluids Eng. 116, 1994
#include "report/advice.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <tuple>

namespace tetskin::report {
namespace {

/// Share of the deformation: a larger error is visible.
constexpr double kVisible = 0.1;
constexpr double kMinOrder = 1.0, kMaxOrder = 3.0;

/// The rows of each cage and surface with several numbers of substeps, fewest first; fewest tets first.
std::vector<std::vector<Row>> seriesInTime(const std::vector<Row>& rows) {
  std::map<std::tuple<double, std::string, std::string>, std::map<double, Row>> found;
  for (const Row& row : rows) {
    if (row.integrator != rows.front().integrator) continue;  // of another solver
    if (row.isChoice() && !row.isReduced()) found[{row.tets, row.material, row.interpolation}][row.substeps] = row;
  }
  std::vector<std::vector<Row>> series;
  for (const auto& [cage, bySubsteps] : found) {
    if (bySubsteps.size() < 2) continue;
    series.emplace_back();
    for (const auto& [substeps, row] : bySubsteps) series.back().push_back(row);
  }
  return series;
}

/// If errors against the truth fall as C x^p, then those against a reference are C (x^p - reference^p): this p, from
/// two of them, kept between kMinOrder and kMaxOrder.
double orderAgainst(double reference, double coarseError, double fineError, double coarse, double fine) {
  double low = kMinOrder, high = kMaxOrder;
  for (int k = 0; k < 60; ++k) {
    const double p = 0.5 * (low + high), own = std::pow(reference, p);
    // The ratio of the gaps increases with the order.
    ((std::pow(coarse, p) - own) / (std::pow(fine, p) - own) < coarseError / fineError ? low : high) = p;
  }
  return low;
}

/// The reference's own error C reference^p, from the error C (x^p - reference^p) against it.
double ownError(double reference, double p, double error, double x) {
  const double own = std::pow(reference, p);
  return error * own / (std::pow(x, p) - own);
}

}  // namespace

void markPareto(std::vector<Row>& rows) {
  for (Row& row : rows) {
    row.pareto = row.isChoice() && std::none_of(rows.begin(), rows.end(), [&](const Row& other) {
                   return other.isChoice() && other.totalMs <= row.totalMs &&
                          other.errorTotalRms <= row.errorTotalRms &&
                          (other.totalMs < row.totalMs || other.errorTotalRms < row.errorTotalRms);
                 });
  }
}

ReductionLimit reductionLimit(const std::vector<Row>& rows) {
  const Row* best = nullptr;
  for (const Row& row : rows) {
    if (row.isReduced() && (!best || row.modes > best->modes)) best = &row;
  }
  if (!best) return {};
  double good = 0.0;
  for (std::size_t k = 0; k < best->errorByFrame.size(); ++k) {
    const double amplitude = best->amplitudeByFrame[k];
    if (best->errorByFrame[k] <= kVisible * amplitude) good = std::max(good, amplitude);
  }
  return {best->modes, good};
}

namespace {

/// The most accurate cage that costs no more; null if there is none.
const Row* cageBeside(const Row& other, const std::vector<Row>& rows) {
  const Row* best = nullptr;
  for (const Row& row : rows) {
    if (!row.isChoice() || row.isReduced() || row.totalMs > other.totalMs) continue;
    if (!best || row.errorTotalRms < best->errorTotalRms) best = &row;
  }
  return best;
}

std::string inWords(const Row& row) {
  char text[128];
  std::snprintf(text, sizeof text, " has an error of %.2e at %.3g ms per frame", row.errorTotalRms, row.totalMs);
  const std::string cage = "a cage of " + std::to_string(std::lround(row.tets)) + " tets in " +
                           std::to_string(std::lround(row.substeps)) + (row.substeps == 1.0 ? " substep" : " substeps");
  return (row.isReduced() ? std::to_string(std::lround(row.modes)) + " modes in " + cage : cage) + text;
}

}  // namespace

std::string reductionAdvice(const std::vector<Row>& rows) {
  const Row *reduced = nullptr, *cage = nullptr;
  double gain = 0.0;
  for (const Row& row : rows) {
    if (!row.isReduced() || !row.isChoice()) continue;
    const Row* beside = cageBeside(row, rows);
    const double quotient = beside ? beside->errorTotalRms / row.errorTotalRms : HUGE_VAL;
    if (reduced && quotient <= gain) continue;
    reduced = &row;
    cage = beside;
    gain = quotient;
  }
  if (!reduced) return {};
  if (!cage)
    return "Use a reduced body only where no cage is fast enough: " + inWords(*reduced) + "; no cage is as fast.";
  const char* winner = gain > 1.0 ? "Use a reduced body: " : "Use an embedding: ";
  const Row &better = gain > 1.0 ? *reduced : *cage, &worse = gain > 1.0 ? *cage : *reduced;
  return winner + inWords(better) + ", " + inWords(worse) + ".";
}

double ownError(double edge, const std::vector<CoarserLevel>& coarser) {
  if (coarser.empty()) return 0.0;
  const CoarserLevel& fine = coarser[0];
  const double p =
      coarser.size() < 2 ? kMinOrder : orderAgainst(edge, coarser[1].error, fine.error, coarser[1].edge, fine.edge);
  return ownError(edge, p, fine.error, fine.edge);
}

double referenceError(const std::vector<Row>& rows) {
  const auto known = std::find_if(rows.begin(), rows.end(),
                                  [](const Row& row) { return row.isReference() && row.errorSpaceRms > 0.0; });
  return known == rows.end() ? 0.0 : known->errorSpaceRms;
}

void markResolved(std::vector<Row>& rows) {
  const double least = kResolved * referenceError(rows);
  for (Row& row : rows) row.resolved = row.isReference() || row.errorTotalRms >= least;
}

double referenceTimeError(const std::vector<Row>& rows) {
  // The reference comes behind the same cage in fewer substeps.
  const auto fewer = std::find_if(rows.begin(), rows.end(), [](const Row& row) { return row.isReference(); });
  if (fewer == rows.end() || std::next(fewer) == rows.end()) return 0.0;
  const Row& reference = *std::next(fewer);
  if (!reference.isReference() || reference.integrator != fewer->integrator) return 0.0;
  const std::vector<std::vector<Row>> series = seriesInTime(rows);
  if (series.empty()) return 0.0;
  const auto step = [](const Row& row) { return 1.0 / row.substeps; };
  const Row& coarse = series.back().front();
  const Row& fine = series.back().back();
  if (!(step(fine) > step(reference) && fine.errorTimeRms > 0.0)) return 0.0;
  const double p = orderAgainst(step(reference), coarse.errorTimeRms, fine.errorTimeRms, step(coarse), step(fine));
  return ownError(step(reference), p, fewer->errorTimeRms, step(*fewer));
}

}  // namespace tetskin::report
