// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "models.h"

#include <cmath>

namespace tetskin::facade {
const Vec3& finite(const Vec3& vector, const char* name) {
  for (const double number : vector) {
    if (!(std::abs(number) <= Limits::kMaxCoordinate)) {
      fail(StatusCode::NonFinite, std::string(name) + ": a number is not finite, or larger than 1e18");
    }
  }
  return vector;
}

Interpolation interpolationOf(const std::string& name) {
  if (name == "linear") return Interpolation::Linear;
  if (name == "quadratic") return Interpolation::Quadratic;
  throw std::invalid_argument("interpolation: 'linear' or 'quadratic'");
}

BindingOptions bindingOptions(const Choice<Interpolation>& interpolation, const Choice<Normals>& normals,
                              const Choice<OutsideRule>& outside, std::optional<double> maxDistance) {
  BindingOptions options;
  options.interpolation = interpolationOf(interpolation.name);
  if (normals.name == "none") {
    options.normals = Normals::None;
  } else if (normals.name == "transformed") {
    options.normals = Normals::Transformed;
  } else if (normals.name == "recomputed") {
    options.normals = Normals::Recomputed;
  } else {
    throw std::invalid_argument("normals: 'none', 'transformed' or 'recomputed'");
  }
  if (outside.name != "nearest" && outside.name != "barycentric")
    throw std::invalid_argument("outside: 'nearest' or 'barycentric'");
  options.outside = outside.name == "nearest" ? OutsideRule::Nearest : OutsideRule::Barycentric;
  if (maxDistance) options.maxDistance = *maxDistance;
  return options;
}

Eigen::Affine3d placementOf(const Vec3& position, const Quaternion& rotation) {
  finite(position, "position");
  const Eigen::Quaterniond q(rotation[3], rotation[0], rotation[1], rotation[2]);
  if (!(q.squaredNorm() > 1e-12 && q.squaredNorm() < 1e12))
    fail(StatusCode::InvalidOption, "rotation: must be a quaternion x, y, z, w other than 0");
  Eigen::Affine3d placement = Eigen::Affine3d::Identity();
  placement.translate(Eigen::Vector3d(position[0], position[1], position[2]));
  if (q.vec() != Eigen::Vector3d::Zero()) placement.rotate(q.normalized());
  return placement;
}

}  // namespace tetskin::facade
