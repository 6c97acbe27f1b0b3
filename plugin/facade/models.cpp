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

void checkMesh(const TriangleMesh& mesh) {
  check(validate(mesh));
  const auto checkCount = [&](std::size_t length, const char* name) {
    if (length != 0 && length != mesh.vertexCount())
      fail(StatusCode::SizeMismatch, std::string(name) + ": " + std::to_string(length) + " for " +
                                         std::to_string(mesh.vertexCount()) + " vertices");
  };
  checkCount(mesh.normals.size(), "normals");
  checkCount(mesh.tangents.size(), "tangents");
  checkCount(mesh.texcoords.size(), "texcoords");
}

ElasticLaw::Kind valueOf(const Choice<ElasticLaw::Kind>& law) {
  if (law.name == "corotated") return ElasticLaw::Kind::Corotated;
  if (law.name == "neo-hookean") return ElasticLaw::Kind::NeoHookean;
  if (law.name == "yeoh") return ElasticLaw::Kind::Yeoh;
  throw std::invalid_argument("law: 'corotated', 'neo-hookean' or 'yeoh'");
}

Loading valueOf(const Choice<Loading>& loading) {
  if (loading.name == "uniaxial") return Loading::Uniaxial;
  if (loading.name == "equibiaxial") return Loading::Equibiaxial;
  if (loading.name == "planar") return Loading::Planar;
  throw std::invalid_argument("loading: 'uniaxial', 'equibiaxial' or 'planar'");
}

Interpolation valueOf(const Choice<Interpolation>& interpolation) {
  if (interpolation.name == "linear") return Interpolation::Linear;
  if (interpolation.name == "quadratic") return Interpolation::Quadratic;
  throw std::invalid_argument("interpolation: 'linear' or 'quadratic'");
}

Normals valueOf(const Choice<Normals>& normals) {
  if (normals.name == "none") return Normals::None;
  if (normals.name == "transformed") return Normals::Transformed;
  if (normals.name == "recomputed") return Normals::Recomputed;
  throw std::invalid_argument("normals: 'none', 'transformed' or 'recomputed'");
}

OutsideRule valueOf(const Choice<OutsideRule>& outside) {
  if (outside.name == "nearest") return OutsideRule::Nearest;
  if (outside.name == "barycentric") return OutsideRule::Barycentric;
  throw std::invalid_argument("outside: 'nearest' or 'barycentric'");
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
