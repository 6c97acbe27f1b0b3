// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "support/smooth_maps.h"

#include "support/odd_meshes.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tetskin::test {
namespace {

using Vector = Eigen::Vector3d;
using Matrix = Eigen::Matrix3d;

constexpr double kTurn = 1.5;
constexpr double kRadius = 1.25;
constexpr double kHeight = 0.05;

Matrix columns(const Vector& x, const Vector& y, const Vector& z) {
  Matrix m;
  m << x, y, z;
  return m;
}

SmoothMap about(const Vector& centre, std::string name, std::function<Vector(const Vector&)> at,
                std::function<Matrix(const Vector&)> gradient) {
  return {std::move(name), [=](const Vector& p) -> Vector { return centre + at(p - centre); },
          [=](const Vector& p) -> Matrix { return gradient(p - centre); }};
}

SmoothMap twist(const Vector& centre) {
  return about(
      centre, "twist",
      [](const Vector& q) {
        const double c = std::cos(kTurn * q.x()), s = std::sin(kTurn * q.x());
        return Vector(q.x(), c * q.y() - s * q.z(), s * q.y() + c * q.z());
      },
      [](const Vector& q) {
        const double c = std::cos(kTurn * q.x()), s = std::sin(kTurn * q.x());
        return columns({1, -kTurn * (s * q.y() + c * q.z()), kTurn * (c * q.y() - s * q.z())}, {0, c, s}, {0, -s, c});
      });
}

SmoothMap bend(const Vector& centre) {
  return about(
      centre, "bend",
      [](const Vector& q) {
        const double angle = q.x() / kRadius, r = kRadius - q.y();
        return Vector(r * std::sin(angle), kRadius - r * std::cos(angle), q.z());
      },
      [](const Vector& q) {
        const double angle = q.x() / kRadius, r = kRadius - q.y(), c = std::cos(angle), s = std::sin(angle);
        return columns({r * c / kRadius, r * s / kRadius, 0}, {-s, c, 0}, {0, 0, 1});
      });
}

SmoothMap sag(const Vector& centre) {
  return about(
      centre, "sag",
      [](const Vector& q) { return Vector(q.x(), q.y() - 0.15 * q.x() * q.x() * (3.0 - std::abs(q.x())), q.z()); },
      [](const Vector& q) {
        return columns({1, -0.15 * q.x() * (6.0 - 3.0 * std::abs(q.x())), 0}, {0, 1, 0}, {0, 0, 1});
      });
}

SmoothMap waves(const Vector& centre) {
  return about(
      centre, "waves",
      [](const Vector& q) -> Vector {
        return q + kHeight * Vector(std::sin(4 * q.y()), std::sin(4 * q.x()), std::sin(3 * q.x() + 2 * q.y()));
      },
      [](const Vector& q) -> Matrix {
        const double c = std::cos(3 * q.x() + 2 * q.y());
        return Matrix::Identity() +
               kHeight * columns({0, 4 * std::cos(4 * q.x()), 3 * c}, {4 * std::cos(4 * q.y()), 0, 2 * c}, {0, 0, 0});
      });
}

std::vector<Vector> numbers(std::size_t count, unsigned seed) {
  return randomPoints(count, {Vector::Constant(-1), Vector::Constant(1)}, seed);
}

}  // namespace

std::vector<Vector> SmoothMap::operator()(std::vector<Vector> points) const {
  std::transform(points.begin(), points.end(), points.begin(), at);
  return points;
}

std::vector<SmoothMap> smoothMaps(const Vector& centre) {
  return {twist(centre), bend(centre), sag(centre), waves(centre)};
}

SmoothMap affineMap(unsigned seed) {
  const std::vector<Vector> n = numbers(4, seed);
  const Matrix linear = columns(n[0], n[1], n[2]);
  return {"affine map " + std::to_string(seed), [=](const Vector& p) -> Vector { return linear * p + n[3]; },
          [=](const Vector&) -> Matrix { return linear; }};
}

SmoothMap quadraticMap(unsigned seed, double amount) {
  const std::vector<Vector> n = numbers(13, seed);
  const Matrix linear = Matrix::Identity() + 0.2 * columns(n[0], n[1], n[2]);
  std::array<Matrix, 3> second;  // by component
  for (int k = 0; k < 3; ++k) {
    const Matrix m = amount * columns(n[4 + k], n[7 + k], n[10 + k]);
    second[k] = 0.5 * (m + m.transpose());
  }
  return {"quadratic map " + std::to_string(seed),
          [=](const Vector& p) -> Vector {
            return linear * p + n[3] + 0.5 * Vector(p.dot(second[0] * p), p.dot(second[1] * p), p.dot(second[2] * p));
          },
          [=](const Vector& p) -> Matrix {
            Matrix g = linear;
            for (int k = 0; k < 3; ++k) g.row(k) += (second[k] * p).transpose();
            return g;
          }};
}

SmoothMap partOf(const SmoothMap& map, double amount) {
  return {map.name, [=](const Vector& p) -> Vector { return p + amount * (map.at(p) - p); },
          [=](const Vector& p) -> Matrix { return (1.0 - amount) * Matrix::Identity() + amount * map.gradient(p); }};
}

}  // namespace tetskin::test
