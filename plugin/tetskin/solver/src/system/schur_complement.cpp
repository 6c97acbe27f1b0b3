// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/solver/src/system/schur_complement.h>

#include <algorithm>
#include <cassert>
#include <numeric>

namespace tetskin::bullet_detail {
namespace {

// Loops, as each of Eigen's products of matrices takes the compiler a second.

/// value = by^T value
void multiplyFromLeft(const SchurComplement::Matrix& by, SchurComplement::Block& value) {
  std::vector<double> column(static_cast<std::size_t>(value.rows()));
  for (Eigen::Index j = 0; j < value.cols(); ++j) {
    std::copy(&value(0, j), &value(0, j) + value.rows(), column.begin());
    for (Eigen::Index i = 0; i < value.rows(); ++i) {
      value(i, j) = std::inner_product(column.begin(), column.end(), &by(0, i), 0.0);
    }
  }
}

/// value = value by
void multiplyFromRight(const SchurComplement::Matrix& by, SchurComplement::Block& value) {
  std::vector<double> row(static_cast<std::size_t>(value.cols()));
  for (Eigen::Index i = 0; i < value.rows(); ++i) {
    for (Eigen::Index k = 0; k < value.cols(); ++k) row[static_cast<std::size_t>(k)] = value(i, k);
    for (Eigen::Index j = 0; j < value.cols(); ++j) {
      value(i, j) = std::inner_product(row.begin(), row.end(), &by(0, j), 0.0);
    }
  }
}

}  // namespace

Eigen::Index SchurComplement::addRigid(const Matrix& inverseMass) {
  assert(inverseMass.rows() == inverseMass.cols());
  const Eigen::Index first = add(inverseMass.rows());
  Group& group = groups_.back();
  group.inverseMass = inverseMass;
  const Eigen::LDLT<Matrix> factors(inverseMass);
  group.root = factors.matrixL();
  group.root *= factors.vectorD().cwiseMax(0.0).cwiseSqrt().asDiagonal();
  group.root = (factors.transpositionsP().transpose() * group.root).eval();
  return first;
}

Eigen::Index SchurComplement::add(Eigen::Index size) {
  assert(size > 0);
  Group& group = groups_.emplace_back();
  group.first = size_;
  group.size = size;
  group.rows = {groups_.size() - 1};
  groupOf_.resize(groupOf_.size() + static_cast<std::size_t>(size), groups_.size() - 1);
  size_ += size;
  return group.first;
}

SchurComplement::Group& SchurComplement::groupAt(Eigen::Index first) {
  assert(first >= 0 && first < size_);
  Group& group = groups_[groupOf_[static_cast<std::size_t>(first)]];
  assert(group.first == first);
  return group;
}

void SchurComplement::couple(Eigen::Index a, Eigen::Index b) {
  if (a == b) return;
  groupAt(std::min(a, b)).rows.push_back(groupOf_[static_cast<std::size_t>(std::max(a, b))]);
}

void SchurComplement::order() {
  matrix_.resize(size_, size_);
  Eigen::Index values = 0;
  for (Group& group : groups_) {
    std::sort(group.rows.begin(), group.rows.end());
    group.rows.erase(std::unique(group.rows.begin(), group.rows.end()), group.rows.end());
    group.tops.clear();
    group.height = 0;
    for (const std::size_t row : group.rows) {
      group.tops.push_back(group.height);
      group.height += groups_[row].size;
    }
    group.firstValue = values;
    values += group.height * group.size;
  }
  matrix_.resizeNonZeros(values);
  using Index = Eigen::SparseMatrix<double>::StorageIndex;
  Index *begin = matrix_.outerIndexPtr(), *index = matrix_.innerIndexPtr();
  for (const Group& group : groups_) {
    for (Eigen::Index k = 0; k < group.size; ++k) {
      *begin++ = static_cast<Index>(group.firstValue + k * group.height);
      for (const std::size_t row : group.rows) {
        std::iota(index, index + groups_[row].size, static_cast<Index>(groups_[row].first));
        index += groups_[row].size;
      }
    }
  }
  *begin = static_cast<Index>(values);
  setZero();
  factor_.analyzePattern(matrix_);
}

void SchurComplement::setZero() {
  std::fill(matrix_.valuePtr(), matrix_.valuePtr() + matrix_.nonZeros(), 0.0);
}

SchurComplement::Block SchurComplement::block(Eigen::Index row, Eigen::Index column) {
  assert(row >= column);
  const Group &rows = groupAt(row), &columns = groupAt(column);
  const std::size_t wanted = groupOf_[static_cast<std::size_t>(row)];
  const auto found = std::lower_bound(columns.rows.begin(), columns.rows.end(), wanted);
  assert(found != columns.rows.end() && *found == wanted);
  const Eigen::Index top = columns.tops[static_cast<std::size_t>(found - columns.rows.begin())];
  return {matrix_.valuePtr() + columns.firstValue + top, rows.size, columns.size, Eigen::OuterStride<>(columns.height)};
}

void SchurComplement::add(Eigen::Index row, Eigen::Index column, const Small6x6& more) {
  Block to = block(row, column);
  assert(to.rows() == 6 && to.cols() == 6);
  for (int j = 0; j < 6; ++j) {
    for (int i = 0; i < 6; ++i) to(i, j) += more(i, j);
  }
}

void SchurComplement::addProduct(Eigen::Index row, Eigen::Index column, double sign,
                                 const Eigen::Matrix<double, 3, Eigen::Dynamic>& a, const Small3x3& h,
                                 const Eigen::Matrix<double, 3, Eigen::Dynamic>& b) {
  Block to = block(row, column);
  // Sums are in the order of Eigen's products, which depends on their size.
  const bool halved = 3 + a.cols() + b.cols() < 20;
  for (Eigen::Index i = 0; i < a.cols(); ++i) {
    const Small3 left = sign * transposeTimes(h, smallFrom<3>(&a(0, i)));
    for (Eigen::Index j = 0; j < b.cols(); ++j) {
      const double terms[3] = {left[0] * b(0, j), left[1] * b(1, j), left[2] * b(2, j)};
      to(i, j) += halved ? terms[0] + (terms[1] + terms[2]) : (terms[0] + terms[1]) + terms[2];
    }
  }
}

void SchurComplement::factor() {
  for (const Group& columns : groups_) {
    for (const std::size_t r : columns.rows) {
      const Group& rows = groups_[r];
      Block value = block(rows.first, columns.first);
      if (rows.isRigid()) multiplyFromLeft(rows.root, value);
      if (columns.isRigid()) multiplyFromRight(columns.root, value);
      for (Eigen::Index k = 0; &rows == &columns && rows.isRigid() && k < rows.size; ++k) value(k, k) += 1.0;
    }
  }
  factor_.factorize(matrix_);
  isPositive_ = factor_.info() == Eigen::Success;
  if (!isPositive_) pivoted_.compute(Matrix(matrix_));  // reads the lower triangle
}

void SchurComplement::transform(Factor factor, Vector& unknowns) const {
  assert(unknowns.size() == size_);
  for (const Group& group : groups_) {
    if (!group.isRigid()) continue;
    auto own = unknowns.segment(group.first, group.size);
    if (factor == Factor::Root) {
      own = (group.root * own).eval();
    } else {
      own = (group.root.transpose() * own).eval();
    }
  }
}

SchurComplement::Vector SchurComplement::solve(Vector right) const {
  transform(Factor::TransposedRoot, right);
  if (isPositive_) {
    right = factor_.solve(right).eval();
  } else {
    right = pivoted_.solve(right).eval();
  }
  transform(Factor::Root, right);
  return right;
}

SchurComplement::Vector SchurComplement::timesInverseMass(Vector unknowns) const {
  assert(unknowns.size() == size_);
  for (const Group& group : groups_) {
    if (!group.isRigid()) continue;
    auto own = unknowns.segment(group.first, group.size);
    own = (group.inverseMass * own).eval();
  }
  return unknowns;
}

}  // namespace tetskin::bullet_detail
