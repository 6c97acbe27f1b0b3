// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/bullet/src/system/schur_complement.h>

#include <algorithm>
#include <cassert>
#include <numeric>

namespace tetskin::bullet_detail {

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

void SchurComplement::factor() {
  for (const Group& columns : groups_) {
    for (const std::size_t r : columns.rows) {
      const Group& rows = groups_[r];
      Block value = block(rows.first, columns.first);
      if (rows.isRigid()) value = (rows.root.transpose() * value).eval();
      if (columns.isRigid()) value = (value * columns.root).eval();
      if (&rows == &columns && rows.isRigid()) value.diagonal().array() += 1.0;
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
