// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to tetskin::solver: conversion between Bullet's vectors and the elastic library's, which store a point in 3
// contiguous scalars or in 3 wide ones.
#pragma once

#include <LinearMath/btMatrix3x3.h>
#include <tetskin/core/src/base/arithmetic/small_matrix.h>
#include <tetskin/elastic/src/base/elastic_kernels.h>

#include <cmath>

namespace tetskin::bullet_detail {

/// True if any of the three is NaN.
inline bool isNaN(const btVector3& v) {
  return std::isnan(v.x()) || std::isnan(v.y()) || std::isnan(v.z());
}

inline void toPoint(const btVector3& v, btScalar* point) {
  for (int k = 0; k < 3; ++k) point[k] = v[k];
}
inline btVector3 fromPoint(const btScalar* point) {
  return {point[0], point[1], point[2]};
}

inline void toWide(const btVector3& v, btScalar* wide) {
  for (int k = 0; k < 3; ++k) wide[k * kernels::kGroup] = v[k];
}
inline btVector3 fromWide(const btScalar* wide) {
  return {wide[0], wide[kernels::kGroup], wide[2 * kernels::kGroup]};
}

inline Small3 toSmall(const btVector3& v) {
  return {{static_cast<double>(v.x()), static_cast<double>(v.y()), static_cast<double>(v.z())}};
}
inline btVector3 fromSmall(const Small3& v) {
  return {static_cast<btScalar>(v[0]), static_cast<btScalar>(v[1]), static_cast<btScalar>(v[2])};
}

/// A velocity without the components that are too small to move a position within the step: far from the origin,
/// contacts at rounded positions would keep such velocities forever.
inline btVector3 movingComponent(const btVector3& from, btVector3 velocity, btScalar dt) {
  for (int k = 0; k < 3; ++k) {
    if (from[k] + dt * velocity[k] == from[k]) velocity[k] = 0;
  }
  return velocity;
}

/// A symmetric matrix from its upper triangle, row by row.
inline btMatrix3x3 symmetricMatrix(const btScalar d[6]) {
  return {d[0], d[1], d[2], d[1], d[3], d[4], d[2], d[4], d[5]};
}

}  // namespace tetskin::bullet_detail
