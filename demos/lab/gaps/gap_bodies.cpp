// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "gaps/gap_scenes.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "scenes/caged_mesh.h"
#include "scenes/serpent.h"
#include "scenes/stuffed_solid.h"

namespace tetskin::gaps {
namespace {

using Eigen::Vector3d;
using scenes::ImplicitSolid;

ImplicitSolid solidIn(const Box3& box, std::function<double(const Vector3d&)> value) {
  return {box, std::move(value), [](const Vector3d& p) -> Vector3d { return p; }};
}

ImplicitSolid roundSolid() {
  return solidIn(Box3(Vector3d::Constant(-0.6), Vector3d::Constant(0.6)),
                 [](const Vector3d& p) { return p.norm() - 0.5; });
}

/// A line segment with a radius at either end.
struct Limb {
  Vector3d from, to;
  double radius, endRadius;

  double distance(const Vector3d& p) const {
    const Vector3d along = to - from;
    const double t = std::clamp((p - from).dot(along) / along.squaredNorm(), 0.0, 1.0);
    return (p - from - t * along).norm() - (radius + t * (endRadius - radius));
  }
};

/// A smooth union that blends over a joint.
double joined(double a, double b) {
  constexpr double kJoint = 0.05;
  const double overlap = std::max(kJoint - std::abs(a - b), 0.0);
  return std::min(a, b) - overlap * overlap / (4.0 * kJoint);
}

/// A trunk along x, four separate legs, a neck and a tail.
ImplicitSolid animalSolid() {
  static const std::array<Limb, 7> limbs = {{
      {{-0.28, 0.0, 0.0}, {0.28, 0.0, 0.0}, 0.16, 0.14},
      {{-0.30, 0.0, 0.09}, {-0.34, -0.38, 0.20}, 0.08, 0.055},
      {{-0.30, 0.0, -0.09}, {-0.34, -0.38, -0.20}, 0.08, 0.055},
      {{0.30, 0.0, 0.09}, {0.34, -0.38, 0.20}, 0.08, 0.055},
      {{0.30, 0.0, -0.09}, {0.34, -0.38, -0.20}, 0.08, 0.055},
      {{0.32, 0.03, 0.0}, {0.47, 0.24, 0.0}, 0.09, 0.11},
      {{-0.36, 0.05, 0.0}, {-0.56, 0.16, 0.0}, 0.06, 0.03},
  }};
  return solidIn(Box3(Vector3d(-0.7, -0.5, -0.35), Vector3d(0.7, 0.45, 0.35)), [](const Vector3d& p) {
    double nearest = limbs[0].distance(p);
    for (std::size_t k = 1; k < limbs.size(); ++k) nearest = joined(nearest, limbs[k].distance(p));
    return nearest;
  });
}

/// The number of triangles is roughly proportional to the square of the lattice's number of cubes.
TriangleMesh meshOf(const ImplicitSolid& solid, std::size_t triangles) {
  constexpr double kFirst = 0.05;
  const auto coarse = static_cast<double>(scenes::surfaceOf(solid, kFirst).triangleCount());
  return scenes::surfaceOf(solid, kFirst * std::sqrt(coarse / static_cast<double>(triangles)));
}

TriangleMesh meshNamed(const std::string& name, std::size_t triangles) {
  if (name == "serpent") return scenes::makeSerpent({triangles});
  return meshOf(name == "round" ? roundSolid() : animalSolid(), triangles);
}

}  // namespace

measure::ModelPtr makeGapBody(const std::string& name, std::size_t tets) {
  constexpr std::size_t kTriangles = 20000;
  TriangleMesh mesh = meshNamed(name, kTriangles);
  mesh.groups.clear();
  scenes::CagedMesh body = scenes::inWorld(std::move(mesh), tets);
  return measure::makeModel(std::move(body.mesh), std::move(body.cage));
}

}  // namespace tetskin::gaps
