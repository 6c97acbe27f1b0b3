// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Bodies for the tests of elasticity, and their matrix computed in an independent way.
#pragma once

#include <gtest/gtest.h>
#include <tetskin/core/cage.h>
#include <tetskin/elastic/src/matrix/block_matrix.h>
#include <tetskin/elastic/src/tets/corotated_tets.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include "dense_reference.h"
#include "support/instruction_sets.h"

namespace tetskin::test {

using namespace elastic_detail;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using Points = std::vector<Vector3d>;

/// Base of the tests that are made in both precisions.
template <class S>
class WithScalar : public testing::Test {
 protected:
  static constexpr double kEpsilon = std::numeric_limits<S>::epsilon();
};
using Scalars = testing::Types<float, double>;

/// Random numbers from -1 to 1, the same with every standard library.
class Random {
 public:
  explicit Random(unsigned seed) : generator_(seed) {}
  double operator()() { return static_cast<double>(generator_()) / 2147483648.0 - 1.0; }
  Eigen::Vector3d vector() {
    const double x = (*this)(), y = (*this)();
    return {x, y, (*this)()};
  }
  Eigen::VectorXd vector(std::size_t size) {
    Eigen::VectorXd v(static_cast<Eigen::Index>(size));
    for (double& x : v) x = (*this)();
    return v;
  }

 private:
  std::mt19937 generator_;
};

inline Eigen::Matrix3d turnBy(double degrees, const Eigen::Vector3d& axis) {
  return Eigen::AngleAxisd(degrees * 3.14159265358979323846 / 180.0, axis.normalized()).toRotationMatrix();
}

inline Points mapped(Points points, const Eigen::Matrix3d& gradient, const Eigen::Vector3d& shift) {
  for (Eigen::Vector3d& p : points) p = (gradient * p + shift).eval();
  return points;
}

inline Points scattered(Points points, double amount, unsigned seed) {
  Random random(seed);
  for (Eigen::Vector3d& p : points) p += amount * random.vector();
  return points;
}

/// The velocities at a point of the six rigid motions: translations along the axes, and rotations about a point.
inline Eigen::Matrix<double, 3, 6> rigidVelocityAt(const Eigen::Vector3d& point, const Eigen::Vector3d& about) {
  Eigen::Matrix<double, 3, 6> velocity;
  for (int k = 0; k < 3; ++k) {
    velocity.col(k) = Eigen::Vector3d::Unit(k);
    velocity.col(3 + k) = Eigen::Vector3d::Unit(k).cross(point - about);
  }
  return velocity;
}

/// The mass matrix of these motions: times their rates, it gives the impulses on them.
inline Eigen::Matrix<double, 6, 6> rigidMass(const Points& nodes, const std::vector<double>& masses,
                                             const Eigen::Vector3d& about) {
  Eigen::Matrix<double, 6, 6> sum = Eigen::Matrix<double, 6, 6>::Zero();
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const Eigen::Matrix<double, 3, 6> velocity = rigidVelocityAt(nodes[n], about);
    sum += masses[n] * velocity.transpose() * velocity;
  }
  return sum;
}

/// Tets that all differ: linear ones, quadratic ones of eight each, or some of both; the number of each kind is not a
/// multiple of eight.
Cage oddCage();
Cage oddQuadraticCage();
Cage oddMixedCage();
inline std::vector<Cage> oddCages() {
  return {oddCage(), oddQuadraticCage(), oddMixedCage()};
}

/// A different factor of the stiffness for every tet, and for the eight of a quadratic one in common.
std::vector<double> variedScale(const Cage& cage);
constexpr Lame kLame{1.0, 0.7};

/// An integration point of a tet, linear or quadratic: the data for formulas of finite elements, in double.
struct PlainPoint {
  std::vector<int> nodes;
  Eigen::Matrix3Xd gradients;  ///< of the nodes' shape functions
  double volume = 0.0;         ///< times the factor of the stiffness

  Eigen::Matrix3d gradientAt(const Points& positions) const;
};
/// scale  see `variedScale`
std::vector<PlainPoint> plainPoints(const Cage& cage, const std::vector<double>& scale);

/// A deformed body, and its matrix computed independently.
struct DeformedBody {
  DeformedBody(const Cage& rest, double amount, double alphaOfMatrix);

  void hold(std::size_t node) { masses[node] = 0.0; }
  RestTets restTets() const { return elastic_detail::restTets(whole, quadraticTets(whole).value(), scale); }

  /// M + alpha K, with three rows per node, by polar decompositions.
  Eigen::MatrixXd dense() const;

  Cage whole;
  TetMesh cage;
  Points nodes;
  std::vector<double> scale;  ///< by tet, of the stiffness
  Lame lame = kLame;
  std::vector<double> masses;
  double alpha;
};

/// With the matrix as the library assembles it.
template <class S>
struct AssembledBody : DeformedBody {
  explicit AssembledBody(const Cage& rest, double amount = 0.1, double alphaOfMatrix = 0.3)
      : DeformedBody(rest, amount, alphaOfMatrix),
        matrix(rest.mesh.nodeCount(), restTets()),
        tets(restTets(), matrix.pattern().slotOf, matrix.slotCount()) {
    tets.setMaterial(lame);
    assemble();
  }

  void assemble(ParallelFor* threads = nullptr) {
    const std::size_t slots = matrix.slotCount();
    std::vector<S> points(4 * slots), forces(4 * slots);
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      matrix.setMass(n, static_cast<S>(masses[n]));
      for (int k = 0; k < 3; ++k)
        points[4 * matrix.slotOf(n) + static_cast<std::size_t>(k)] = static_cast<S>(nodes[n][k]);
    }
    // This is repeated because each call advances the rotations by only a few iterations.
    for (int k = 0; k < 3; ++k) tets.forces(points.data(), forces.data(), threads);
    matrix.assemble(tets.cornersForMatrix(static_cast<S>(alpha), threads), tets.ratio(), threads);
  }

  Eigen::VectorXd fromWide(const S* wide) const {
    Eigen::VectorXd v(static_cast<Eigen::Index>(3 * nodes.size()));
    for (std::size_t i = 0; i < 3 * nodes.size(); ++i) v[static_cast<Eigen::Index>(i)] = wide[wideIndex(i)];
    return v;
  }
  void toWide(const Eigen::VectorXd& v, S* wide) const {
    for (std::size_t i = 0; i < 3 * nodes.size(); ++i)
      wide[wideIndex(i)] = static_cast<S>(v[static_cast<Eigen::Index>(i)]);
  }
  /// Four scalars per slot; the last one has no meaning.
  std::vector<S> toPoints(const Eigen::VectorXd& v) const {
    std::vector<S> points(4 * matrix.slotCount(), S(0));
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      for (std::size_t k = 0; k < 3; ++k) {
        points[4 * matrix.slotOf(n) + k] = static_cast<S>(v[static_cast<Eigen::Index>(3 * n + k)]);
      }
      points[4 * matrix.slotOf(n) + 3] = std::numeric_limits<S>::quiet_NaN();
    }
    return points;
  }
  Eigen::VectorXd times(const Eigen::VectorXd& v, ParallelFor* threads = nullptr) const {
    std::vector<S> wide(matrix.wideSize());
    matrix.multiply(toPoints(v).data(), wide.data(), threads);
    return fromWide(wide.data());
  }

  BlockMatrix<S> matrix;
  CorotatedTets<S> tets;

 private:
  std::size_t wideIndex(std::size_t i) const { return matrix.wideOf(i / 3) + i % 3 * kernels::kGroup; }
};

/// The matrix as a dense one, found column by column.
template <class S>
MatrixXd columnsOf(const AssembledBody<S>& body) {
  const auto size = static_cast<Eigen::Index>(3 * body.nodes.size());
  MatrixXd columns(size, size);
  for (Eigen::Index k = 0; k < size; ++k) columns.col(k) = body.times(VectorXd::Unit(size, k));
  return columns;
}

}  // namespace tetskin::test
