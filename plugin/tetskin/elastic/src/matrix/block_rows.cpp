// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/mesh/tets_around_nodes.h>
#include <tetskin/elastic/src/matrix/block_rows.h>

#include <algorithm>
#include <cassert>

namespace tetskin::elastic_detail {
namespace {

/// Number of fields that are processed together in registers.
constexpr int kTogether = 6;

/// By node: the node itself and those with which it shares a tet, ascending.
Lists<> neighboursOf(const TetMesh& mesh) {
  const Lists<> around = tetsAroundNodes(mesh);
  Lists<> neighbours;
  neighbours.starts.push_back(0);
  std::vector<std::uint32_t> found;
  for (std::size_t n = 0; n < mesh.nodeCount(); ++n) {
    found.clear();
    for (std::uint32_t k = around.starts[n]; k < around.starts[n + 1]; ++k) {
      for (const int other : mesh.tets[around.values[k]]) found.push_back(static_cast<std::uint32_t>(other));
    }
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    neighbours.values.insert(neighbours.values.end(), found.begin(), found.end());
    neighbours.starts.push_back(static_cast<std::uint32_t>(neighbours.values.size()));
  }
  return neighbours;
}

}  // namespace

BlockRows::BlockRows(const TetMesh& mesh, double poissonRatio, const std::vector<double>& scale)
    : columns_(neighboursOf(mesh)), blocks_(columns_.values.size(), Block::Zero()) {
  assert(scale.size() == mesh.tetCount());
  for (std::size_t t = 0; t < mesh.tetCount(); ++t) {
    const Tet& tet = mesh.tets[t];
    const Eigen::Matrix<double, 12, 12> stiffness = scale[t] * tetStiffness(cornersOf(mesh, tet), poissonRatio);
    for (int a = 0; a < 4; ++a) {
      for (int b = 0; b < 4; ++b) block(tet[a], tet[b]) += stiffness.block<3, 3>(3 * a, 3 * b);
    }
  }
}

std::size_t BlockRows::indexOf(int row, int column) const {
  const auto first = columns_.values.begin() + columns_.starts[row];
  const auto last = columns_.values.begin() + columns_.starts[row + 1];
  const auto found = std::lower_bound(first, last, static_cast<std::uint32_t>(column));
  assert(found != last && *found == static_cast<std::uint32_t>(column));
  return static_cast<std::size_t>(found - columns_.values.begin());
}

const BlockRows::Block& BlockRows::diagonalBlock(std::size_t node) const {
  return blocks_[indexOf(static_cast<int>(node), static_cast<int>(node))];
}

Eigen::SparseMatrix<double, Eigen::RowMajor> BlockRows::sparse() const {
  const auto nodes = static_cast<int>(columns_.starts.size() - 1);
  Eigen::SparseMatrix<double, Eigen::RowMajor> matrix(3 * nodes, 3 * nodes);
  matrix.reserve(static_cast<Eigen::Index>(9 * blocks_.size()));
  for (int row = 0; row < 3 * nodes; ++row) {
    matrix.startVec(row);
    for (std::uint32_t k = columns_.starts[row / 3]; k < columns_.starts[row / 3 + 1]; ++k) {
      for (int j = 0; j < 3; ++j) {
        matrix.insertBack(row, 3 * static_cast<int>(columns_.values[k]) + j) = blocks_[k](row % 3, j);
      }
    }
  }
  matrix.finalize();
  return matrix;
}

void BlockRows::multiply(const Fields& fields, Fields& product) const {
  assert(fields.rows() == product.rows() && fields.cols() == product.cols());
  Eigen::Index first = 0;
  for (; first + kTogether <= fields.cols(); first += kTogether) multiplyColumns<kTogether>(first, fields, product);
  for (; first < fields.cols(); ++first) multiplyColumns<1>(first, fields, product);
}

template <int kColumns>
void BlockRows::multiplyColumns(Eigen::Index first, const Fields& fields, Fields& product) const {
  assert(fields.rows() == 3 * static_cast<Eigen::Index>(columns_.starts.size() - 1));
  assert(first + kColumns <= fields.cols());
  using Some = Eigen::Array<double, 1, kColumns>;
  const Eigen::Index stride = fields.cols();
  for (std::size_t row = 0; row + 1 < columns_.starts.size(); ++row) {
    Some sums[3] = {Some::Zero(), Some::Zero(), Some::Zero()};
    for (std::uint32_t k = columns_.starts[row]; k < columns_.starts[row + 1]; ++k) {
      const double* from = fields.data() + 3 * stride * static_cast<Eigen::Index>(columns_.values[k]) + first;
      const Eigen::Map<const Some> x(from), y(from + stride), z(from + 2 * stride);
      for (int i = 0; i < 3; ++i) sums[i] += blocks_[k](i, 0) * x + blocks_[k](i, 1) * y + blocks_[k](i, 2) * z;
    }
    double* to = product.data() + 3 * stride * static_cast<Eigen::Index>(row) + first;
    for (int i = 0; i < 3; ++i) Eigen::Map<Some>(to + i * stride) = sums[i];
  }
}

Eigen::VectorXd BlockRows::diagonal() const {
  Eigen::VectorXd diagonal(static_cast<Eigen::Index>(3 * (columns_.starts.size() - 1)));
  for (std::size_t row = 0; row + 1 < columns_.starts.size(); ++row) {
    diagonal.segment<3>(static_cast<Eigen::Index>(3 * row)) = diagonalBlock(row).diagonal();
  }
  return diagonal;
}

}  // namespace tetskin::elastic_detail
