// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/elastic/src/matrix/block_rows.h>

#include <algorithm>
#include <cassert>

namespace tetskin::elastic_detail {
namespace {

/// Number of fields that are processed together in registers.
constexpr int kTogether = 6;

/// By node: the node itself and the nodes with which it shares a tet, ascending.
/// tets       the linear ones
Lists<> neighboursOf(std::size_t nodes, const std::vector<Tet>& tets, const std::vector<RestQuadraticTet>& quadratic) {
  // By node, the tets around it: quadratic ones are numbered after the linear ones.
  const Lists<> around = packLists(nodes, [&](auto&& add) {
    std::uint32_t number = 0;
    const auto addTet = [&](const auto& ofTet) {
      for (const int n : ofTet) add(static_cast<std::size_t>(n), number);
      ++number;
    };
    for (const Tet& tet : tets) addTet(tet);
    for (const RestQuadraticTet& tet : quadratic) addTet(tet.nodes);
  });
  Lists<> neighbours;
  neighbours.starts.push_back(0);
  std::vector<std::uint32_t> found;
  const auto find = [&](const auto& ofTet) { found.insert(found.end(), ofTet.begin(), ofTet.end()); };
  for (std::size_t n = 0; n < nodes; ++n) {
    found.clear();
    for (std::uint32_t k = around.starts[n]; k < around.starts[n + 1]; ++k) {
      const std::size_t t = around.values[k];
      t < tets.size() ? find(tets[t]) : find(quadratic[t - tets.size()].nodes);
    }
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    neighbours.values.insert(neighbours.values.end(), found.begin(), found.end());
    neighbours.starts.push_back(static_cast<std::uint32_t>(neighbours.values.size()));
  }
  return neighbours;
}

std::vector<RestQuadraticTet> quadraticPart(const Cage& cage, const std::vector<double>& scale) {
  const Result<std::vector<QuadraticTet>> tets = quadraticTets(cage);
  assert(tets.ok());
  return restQuadraticTets(cage, tets.value(), scale);
}

}  // namespace

BlockRows::BlockRows(const Cage& cage, double poissonRatio, const std::vector<double>& scale) {
  assert(scale.empty() || scale.size() == cage.mesh.tetCount());
  const std::vector<RestQuadraticTet> quadratic = quadraticPart(cage, scale);
  const std::vector<double> factors = scale.empty() ? cage.stiffnessScale() : scale;
  std::vector<Tet> linear;
  std::vector<double> factorOf;
  for (std::size_t t = 0; t < cage.mesh.tetCount(); ++t) {
    if (!cage.quadraticTet.empty() && cage.quadraticTet[t] >= 0) continue;
    linear.push_back(cage.mesh.tets[t]);
    factorOf.push_back(factors.empty() ? 1.0 : factors[t]);
  }
  columns_ = neighboursOf(cage.mesh.nodeCount(), linear, quadratic);
  blocks_.assign(columns_.values.size(), Block::Zero());
  for (std::size_t t = 0; t < linear.size(); ++t) {
    add(linear[t], (factorOf[t] * tetStiffness(cornersOf(cage.mesh, linear[t]), poissonRatio)).eval());
  }
  for (const RestQuadraticTet& tet : quadratic) add(tet.nodes, tetStiffness(tet, poissonRatio));
}

template <class Nodes, class Matrix>
void BlockRows::add(const Nodes& nodes, const Matrix& stiffness) {
  const auto count = static_cast<int>(nodes.size());
  assert(stiffness.rows() == 3 * count);
  for (int a = 0; a < count; ++a) {
    for (int b = 0; b < count; ++b) {
      block(nodes[a], nodes[b]) += stiffness.template block<3, 3>(3 * a, 3 * b);
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
