// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Moving bodies, for the tests of ElasticBody.
#pragma once

#include <gtest/gtest.h>
#include <tetskin/core/src/base/mesh/tet_geometry.h>
#include <tetskin/elastic/elastic_body.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "elastic_fixtures.h"
#include "support/bars.h"

namespace tetskin::test {

/// A box that starts at the origin, of linear tets, or of quadratic ones in cubes of twice the size.
/// cubes  even numbers, of the linear one
inline Cage boxCage(const std::array<int, 3>& cubes, const Eigen::Vector3d& size, bool quadratic) {
  if (!quadratic) return Cage(makeBox(cubes, size));
  return refineQuadratic(Cage(makeBox({cubes[0] / 2, cubes[1] / 2, cubes[2] / 2}, size))).value();
}

constexpr double kInfinity = std::numeric_limits<double>::infinity();

inline ElasticOptions soft() {
  ElasticOptions options;
  options.youngsModulus = 1e4;
  options.density = 100.0;
  return options;
}

template <class S>
ElasticBody<S> made(const Cage& cage, const ElasticOptions& options) {
  Result<ElasticBody<S>> body = ElasticBody<S>::create(cage, options);
  EXPECT_TRUE(body.ok()) << body.status().message;
  return std::move(body).value();
}

template <class S>
Points pointsOf(PointView<S> view) {
  Points points(view.size());
  for (std::size_t n = 0; n < view.size(); ++n) points[n] = Eigen::Vector3d(view[n][0], view[n][1], view[n][2]);
  return points;
}

template <class S>
void fill(PointView<S> view, const Points& points) {
  for (std::size_t n = 0; n < view.size(); ++n) {
    for (int k = 0; k < 3; ++k) view[n][k] = static_cast<S>(points[n][k]);
  }
}

/// Node masses for a density of 1: a quarter of the mass of each tet.
inline std::vector<double> lumped(const TetMesh& cage) {
  std::vector<double> masses(cage.nodeCount(), 0.0);
  for (const Tet& tet : cage.tets) {
    for (const int n : tet) masses[static_cast<std::size_t>(n)] += std::abs(signedVolume(cornersOf(cage, tet))) / 4.0;
  }
  return masses;
}

/// Quantities that a motion conserves.
struct Motion {
  Eigen::Vector3d momentum = Eigen::Vector3d::Zero(), angular = Eigen::Vector3d::Zero();
  double kinetic = 0.0, elastic = 0.0;

  double energy() const { return kinetic + elastic; }
};

template <class S>
Motion motionOf(ElasticBody<S>& body, const std::vector<double>& masses) {
  const Points positions = pointsOf(body.positions()), velocities = pointsOf(body.velocities());
  Motion motion;
  for (std::size_t n = 0; n < masses.size(); ++n) {
    motion.momentum += masses[n] * velocities[n];
    motion.angular += masses[n] * positions[n].cross(velocities[n]);
    motion.kinetic += 0.5 * masses[n] * velocities[n].squaredNorm();
  }
  motion.elastic = body.energy();
  return motion;
}

/// The least ratio of a tet's volume to its volume at rest; below 0 if a tet is inside out.
inline double smallestVolume(const TetMesh& cage, const Points& nodes) {
  const TetMesh now{nodes, cage.tets};
  double minimum = kInfinity;
  for (std::size_t t = 0; t < cage.tetCount(); ++t) {
    const double ratio = signedVolume(cornersOf(now, cage.tets[t])) / signedVolume(cornersOf(cage, cage.tets[t]));
    if (std::isnan(ratio)) return -kInfinity;
    minimum = std::min(minimum, ratio);
  }
  return minimum;
}

/// The largest speed of a node; infinite if a velocity is not finite.
template <class S>
double fastest(ElasticBody<S>& body) {
  double maximum = 0.0;
  for (const Eigen::Vector3d& v : pointsOf(body.velocities())) {
    if (!v.allFinite()) return kInfinity;
    maximum = std::max(maximum, v.norm());
  }
  return maximum;
}

/// Pins the nodes at x = 0 of a bar along x.
template <class S>
void pinTheEnd(ElasticBody<S>& body, const TetMesh& cage) {
  for (std::size_t n = 0; n < cage.nodeCount(); ++n) {
    if (cage.nodes[n].x() == 0.0) body.setPinned(n);
  }
}

}  // namespace tetskin::test
