// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Small vectors and matrices of double, evaluated at once. Eigen's expressions create a type per formula, which takes a
// compiler seconds in sources with many formulas; these have one type per size. Results have the bits of Eigen's
// fixed-size matrices, because sums have the same order: the sum of both halves' sums.
#pragma once

#include <cassert>
#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>

namespace tetskin {

/// The sum of value(k) for N numbers k from `first` on, as the sum of both halves' sums.
template <int N, class Value>
double halvedSum(const Value& value, int first = 0) {
  if constexpr (N == 1) {
    return value(first);
  } else {
    return halvedSum<N / 2>(value, first) + halvedSum<N - N / 2>(value, first + N / 2);
  }
}

/// Rows x Columns numbers; a vector has one column. Zero by default.
template <int Rows, int Columns = 1>
struct SmallMatrix {
  static constexpr int kSize = Rows * Columns;
  double values[kSize] = {};  ///< by columns

  double& operator()(int row, int column) {
    assert(row >= 0 && row < Rows && column >= 0 && column < Columns);
    return values[column * Rows + row];
  }
  double operator()(int row, int column) const {
    assert(row >= 0 && row < Rows && column >= 0 && column < Columns);
    return values[column * Rows + row];
  }
  double& operator[](int k) {
    assert(k >= 0 && k < kSize);
    return values[k];
  }
  double operator[](int k) const {
    assert(k >= 0 && k < kSize);
    return values[k];
  }
  SmallMatrix<Rows> column(int k) const {
    SmallMatrix<Rows> of;
    for (int i = 0; i < Rows; ++i) of[i] = (*this)(i, k);
    return of;
  }
  void setColumn(int k, const SmallMatrix<Rows>& to) {
    for (int i = 0; i < Rows; ++i) (*this)(i, k) = to[i];
  }

  SmallMatrix& operator+=(const SmallMatrix& other) {
    for (int k = 0; k < kSize; ++k) values[k] += other.values[k];
    return *this;
  }
  SmallMatrix& operator-=(const SmallMatrix& other) {
    for (int k = 0; k < kSize; ++k) values[k] -= other.values[k];
    return *this;
  }
  SmallMatrix& operator*=(double factor) {
    for (double& value : values) value *= factor;
    return *this;
  }
  friend SmallMatrix operator+(SmallMatrix a, const SmallMatrix& b) { return a += b; }
  friend SmallMatrix operator-(SmallMatrix a, const SmallMatrix& b) { return a -= b; }
  friend SmallMatrix operator*(double factor, SmallMatrix a) { return a *= factor; }
  friend SmallMatrix operator*(SmallMatrix a, double factor) { return a *= factor; }
  friend SmallMatrix operator-(SmallMatrix a) {
    for (double& value : a.values) value = -value;
    return a;
  }
};

using Small3 = SmallMatrix<3>;
using Small6 = SmallMatrix<6>;
using Small3x3 = SmallMatrix<3, 3>;
using Small3x6 = SmallMatrix<3, 6>;
using Small6x6 = SmallMatrix<6, 6>;

/// Copies a matrix of that size that is stored by columns, as Eigen's are.
template <int Rows, int Columns = 1>
SmallMatrix<Rows, Columns> smallFrom(const double* values) {
  SmallMatrix<Rows, Columns> to;
  for (int k = 0; k < to.kSize; ++k) to.values[k] = values[k];
  return to;
}

template <int Rows, int Columns>
SmallMatrix<Columns, Rows> transposed(const SmallMatrix<Rows, Columns>& a) {
  SmallMatrix<Columns, Rows> to;
  for (int i = 0; i < Rows; ++i) {
    for (int j = 0; j < Columns; ++j) to(j, i) = a(i, j);
  }
  return to;
}

template <int Rows, int Inner, int Columns>
SmallMatrix<Rows, Columns> operator*(const SmallMatrix<Rows, Inner>& a, const SmallMatrix<Inner, Columns>& b) {
  SmallMatrix<Rows, Columns> product;
  for (int j = 0; j < Columns; ++j) {
    for (int i = 0; i < Rows; ++i) {
      product(i, j) = halvedSum<Inner>([&](int k) { return a(i, k) * b(k, j); });
    }
  }
  return product;
}

/// a^T b
template <int Rows, int Inner, int Columns>
SmallMatrix<Rows, Columns> transposeTimes(const SmallMatrix<Inner, Rows>& a, const SmallMatrix<Inner, Columns>& b) {
  return transposed(a) * b;
}

template <int Size>
double dot(const SmallMatrix<Size>& a, const SmallMatrix<Size>& b) {
  return halvedSum<Size>([&](int k) { return a[k] * b[k]; });
}
template <int Size>
double squaredNorm(const SmallMatrix<Size>& a) {
  return dot(a, a);
}
template <int Size>
double norm(const SmallMatrix<Size>& a) {
  return std::sqrt(squaredNorm(a));
}

inline Small3 cross(const Small3& a, const Small3& b) {
  return {{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}};
}

/// The matrix of the cross product with `a` on the left.
inline Small3x3 smallCrossMatrix(const Small3& a) {
  return {{0, a[2], -a[1], -a[2], 0, a[0], a[1], -a[0], 0}};
}

/// True if every number is 0.
template <int Rows, int Columns>
bool isZero(const SmallMatrix<Rows, Columns>& a) {
  for (const double value : a.values) {
    if (value != 0.0) return false;
  }
  return true;
}

/// Calls visit(k) for k = 1, ..., Last - 1, each a constant.
template <int Last, int K = 1, class Visit>
void forConstants(const Visit& visit) {
  if constexpr (K < Last) {
    visit(std::integral_constant<int, K>());
    forConstants<Last, K + 1>(visit);
  }
}

/// Solves A x = b by LU decomposition with partial pivoting. If A is singular, x is not finite. Bits are those of
/// Eigen's PartialPivLU of this size.
template <int Size>
SmallMatrix<Size> solved(SmallMatrix<Size, Size> a, SmallMatrix<Size> b) {
  for (int k = 0; k < Size; ++k) {
    int pivot = k;
    for (int i = k + 1; i < Size; ++i) {
      if (std::abs(a(i, k)) > std::abs(a(pivot, k))) pivot = i;
    }
    for (int j = 0; j < Size; ++j) std::swap(a(k, j), a(pivot, j));
    std::swap(b[k], b[pivot]);
    for (int i = k + 1; i < Size; ++i) {
      if (a(k, k) != 0.0) a(i, k) /= a(k, k);
      for (int j = k + 1; j < Size; ++j) a(i, j) -= a(i, k) * a(k, j);
    }
  }
  forConstants<Size>([&](auto k) { b[k] -= halvedSum<k>([&](int j) { return a(k, j) * b[j]; }); });
  b[Size - 1] /= a(Size - 1, Size - 1);
  forConstants<Size>([&](auto k) {
    const int row = Size - 1 - k;
    b[row] -= halvedSum<k>([&](int j) { return a(row, j) * b[j]; }, row + 1);
    b[row] /= a(row, row);
  });
  return b;
}

/// The factors P^T L D L^T P of a symmetric matrix, with the larger diagonals first. It may be singular. The lower
/// triangle is read. Bits are those of Eigen's LDLT of this size.
template <int Size>
class SmallLdlt {
 public:
  explicit SmallLdlt(const SmallMatrix<Size, Size>& matrix) : factors_(matrix) {
    for (int k = 0; k < Size; ++k) eliminate(k);
  }

  /// Where a diagonal entry is 0, the solution is 0, too.
  SmallMatrix<Size> solve(SmallMatrix<Size> right) const {
    for (int k = 0; k < Size; ++k) std::swap(right[k], right[swapped_[k]]);
    forConstants<Size>([&](auto k) { right[k] -= halvedSum<k>([&](int j) { return factors_(k, j) * right[j]; }); });
    for (int k = 0; k < Size; ++k) {
      const double diagonal = factors_(k, k);
      right[k] = std::abs(diagonal) > kSmallest ? right[k] / diagonal : 0.0;
    }
    forConstants<Size>([&](auto k) {
      const int row = Size - 1 - k;
      right[row] -= halvedSum<k>([&](int j) { return factors_(j, row) * right[j]; }, row + 1);
    });
    for (int k = Size - 1; k >= 0; --k) std::swap(right[k], right[swapped_[k]]);
    return right;
  }

 private:
  /// The smallest normal number, as in Eigen 3.4.
  static constexpr double kSmallest = std::numeric_limits<double>::min();

  void exchange(int k, int with) {
    for (int j = 0; j < k; ++j) std::swap(factors_(k, j), factors_(with, j));
    for (int i = with + 1; i < Size; ++i) std::swap(factors_(i, k), factors_(i, with));
    std::swap(factors_(k, k), factors_(with, with));
    for (int i = k + 1; i < with; ++i) std::swap(factors_(i, k), factors_(with, i));
  }

  void eliminate(int k) {
    int largest = k;
    for (int i = k + 1; i < Size; ++i) {
      if (std::abs(factors_(i, i)) > std::abs(factors_(largest, largest))) largest = i;
    }
    swapped_[k] = largest;
    if (largest != k) exchange(k, largest);
    for (int i = k; i < Size && k > 0; ++i) {
      double sum = factors_(i, 0) * (factors_(0, 0) * factors_(k, 0));
      for (int j = 1; j < k; ++j) sum += factors_(i, j) * (factors_(j, j) * factors_(k, j));
      // The rows below still need the pivot's old value.
      if (i == k) {
        pivot_ = sum;
      } else {
        factors_(i, k) -= sum;
      }
    }
    if (k > 0) factors_(k, k) -= pivot_;
    if (!(std::abs(factors_(k, k)) > 0.0)) return;
    for (int i = k + 1; i < Size; ++i) factors_(i, k) /= factors_(k, k);
  }

  SmallMatrix<Size, Size> factors_;  ///< D on the diagonal, L below it
  int swapped_[Size] = {};           ///< the row with which each was exchanged
  double pivot_ = 0.0;
};

}  // namespace tetskin
