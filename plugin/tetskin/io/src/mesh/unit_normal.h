// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/types.h>

#include <cmath>

namespace tetskin::io {

/// v / |v|, or 0 if v has no direction.
inline Eigen::Vector3f unitNormal(const Eigen::Vector3d& v) {
  const double length = v.norm();
  return length > 0.0 && std::isfinite(length) ? Eigen::Vector3f((v / length).cast<float>()) : Eigen::Vector3f(0, 0, 0);
}

}  // namespace tetskin::io
