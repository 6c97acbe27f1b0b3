// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/io/src/animation/affine_bone.h>

namespace tetskin::io {
namespace {

void expectHolds(const AffineBone& bone, const Eigen::Matrix3d& map) {
  const double size = map.norm();
  EXPECT_LE((bone.upper * bone.scale.asDiagonal() * bone.lower.transpose() - map).norm(), 1e-11 * size) << map;
  for (const Eigen::Matrix3d& rotation : {bone.upper, bone.lower}) {
    EXPECT_NEAR((rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).norm(), 0.0, 1e-12) << map;
    EXPECT_NEAR(rotation.determinant(), 1.0, 1e-12) << map;
  }
}

TEST(AffineBone, HoldsAnyMap) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const auto any = [&] { return Eigen::Matrix3d::NullaryExpr([&] { return normal(random); }); };
  AffineBone bone;
  for (int k = 0; k < 1000; ++k) {
    const Eigen::Matrix3d map = any();
    bone.set(map);
    expectHolds(bone, map);
    AffineBone anew;
    anew.set(map);
    expectHolds(anew, map);
  }
  // Matrices of rank 2, 1 and 0; mirrored; with factors of very different size.
  const Eigen::Vector3d a(1, 2, 3), b(-1, 0.5, 2), c(0.2, -1, 1), d(2, 1, -1);
  for (const double small : {0.0, 1e-12, 1e-6}) {
    for (const double size : {1e-8, 1.0, 1e8}) {
      const Eigen::Matrix3d map = size * (a * b.transpose() + small * c * d.transpose());
      bone.set(map);
      expectHolds(bone, map);
      bone.set(-map);
      expectHolds(bone, -map);
    }
  }
  bone.set(Eigen::Matrix3d::Zero());
  EXPECT_EQ(bone.scale, Eigen::Vector3d::Zero());
  const Eigen::Matrix3d mirror = Eigen::Vector3d(1, -1, 1).asDiagonal();
  bone.set(mirror);
  expectHolds(bone, mirror);
}

TEST(AffineBone, BothRotationsFollowASlowlyChangingMap) {
  AffineBone bone;
  const auto mapAt = [](double t) {
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(3.0 * t, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
    const Eigen::Vector3d factors(1.0 + 0.2 * std::sin(5.0 * t), 1.0 + 0.1 * std::cos(7.0 * t), 1.0);
    const Eigen::Matrix3d axes = Eigen::AngleAxisd(t, Eigen::Vector3d(2, -1, 1).normalized()).toRotationMatrix();
    return Eigen::Matrix3d(0.5 * turn * axes * factors.asDiagonal() * axes.transpose());
  };
  bone.set(mapAt(0.0));
  double farthest = 0.0;
  for (int k = 1; k <= 600; ++k) {
    const AffineBone before = bone;
    bone.set(mapAt(k / 60.0));
    expectHolds(bone, mapAt(k / 60.0));
    // Halfway, as players interpolate: the product is near the map there.
    const auto between = [](const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
      return Eigen::Quaterniond(a).slerp(0.5, Eigen::Quaterniond(b)).toRotationMatrix();
    };
    const Eigen::Matrix3d halfway = between(before.upper, bone.upper) *
                                    (0.5 * (before.scale + bone.scale)).asDiagonal() *
                                    between(before.lower, bone.lower).transpose();
    farthest = std::max(farthest, (halfway - mapAt((k - 0.5) / 60.0)).norm());
  }
  EXPECT_LT(farthest, 0.02);
}

}  // namespace
}  // namespace tetskin::io
