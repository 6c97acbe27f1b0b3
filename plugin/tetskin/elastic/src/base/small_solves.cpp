// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/elastic/src/base/small_solves.h>

#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

namespace tetskin::elastic_detail {
namespace {

/// Rows of what `SymmetricFactors` takes.
constexpr int kRows = 3;

/// The sum of products of a row's entries, of which each is `stride` after the one before, and a vector's: by halves,
/// as Eigen sums what has few entries.
double sumOfProducts(const double* row, int stride, const double* vector, int count) {
  if (count == 0) return 0.0;
  if (count == 1) return row[0] * vector[0];
  const int half = count / 2;
  return sumOfProducts(row, stride, vector, half) +
         sumOfProducts(row + half * stride, stride, vector + half, count - half);
}

/// The first row from `step` on whose entry in the column has the largest magnitude.
int largestOf(const double* column, int step, int size) {
  int found = step;
  for (int row = step + 1; row < size; ++row) {
    if (std::abs(column[row]) > std::abs(column[found])) found = row;
  }
  return found;
}

}  // namespace

void solveSmall(int size, double* matrix, double* vector) {
  assert(size > 0 && size <= kMostUnknowns);
  const auto at = [&](int row, int column) -> double& { return matrix[row + size * column]; };
  for (int step = 0; step < size; ++step) {
    const int pivot = largestOf(&at(0, step), step, size);
    for (int column = 0; pivot != step && column < size; ++column) std::swap(at(step, column), at(pivot, column));
    std::swap(vector[step], vector[pivot]);
    for (int row = step + 1; row < size; ++row) {
      if (at(step, step) != 0.0) at(row, step) /= at(step, step);
      for (int column = step + 1; column < size; ++column) at(row, column) -= at(row, step) * at(step, column);
    }
  }
  for (int row = 1; row < size; ++row) vector[row] -= sumOfProducts(&at(row, 0), size, vector, row);
  for (int row = size - 1; row >= 0; --row) {
    const int after = row + 1;
    if (after < size) vector[row] -= sumOfProducts(&at(row, after), size, vector + after, size - after);
    vector[row] /= at(row, row);
  }
}

SymmetricFactors::SymmetricFactors(const double* matrix) {
  for (int k = 0; k < kRows * kRows; ++k) factors_[k] = matrix[k];
  const auto at = [&](int row, int column) -> double& { return factors_[row + kRows * column]; };
  for (int step = 0; step < kRows; ++step) {
    int& pivot = rows_[step];
    pivot = step;
    for (int k = step + 1; k < kRows; ++k) {
      if (std::abs(at(k, k)) > std::abs(at(pivot, pivot))) pivot = k;
    }
    if (pivot != step) {  // rows and columns, of the lower triangle
      for (int k = 0; k < step; ++k) std::swap(at(step, k), at(pivot, k));
      for (int k = pivot + 1; k < kRows; ++k) std::swap(at(k, step), at(k, pivot));
      std::swap(at(step, step), at(pivot, pivot));
      for (int k = step + 1; k < pivot; ++k) std::swap(at(k, step), at(pivot, k));
    }
    double scaled[kRows] = {};
    for (int k = 0; k < step; ++k) scaled[k] = at(k, k) * at(step, k);
    for (int row = step; row < kRows && step > 0; ++row)
      at(row, step) -= sumOfProducts(&at(row, 0), kRows, scaled, step);
    if (at(step, step) == 0.0 || std::isnan(at(step, step))) {
      if (step > 0) continue;
      for (int k = 0; k < kRows; ++k) rows_[k] = k;  // the whole diagonal is 0
      return;
    }
    for (int row = step + 1; row < kRows; ++row) at(row, step) /= at(step, step);
  }
}

void SymmetricFactors::solve(double* vector) const {
  const auto at = [&](int row, int column) { return factors_[row + kRows * column]; };
  for (int k = 0; k < kRows; ++k) std::swap(vector[k], vector[rows_[k]]);
  for (int row = 1; row < kRows; ++row) vector[row] -= sumOfProducts(&factors_[row], kRows, vector, row);
  for (int k = 0; k < kRows; ++k) {
    vector[k] = std::abs(at(k, k)) > std::numeric_limits<double>::min() ? vector[k] / at(k, k) : 0.0;
  }
  for (int row = kRows - 2; row >= 0; --row) {
    vector[row] -= sumOfProducts(&factors_[row + 1 + kRows * row], 1, vector + row + 1, kRows - 1 - row);
  }
  for (int k = kRows - 1; k >= 0; --k) std::swap(vector[k], vector[rows_[k]]);
}

}  // namespace tetskin::elastic_detail
