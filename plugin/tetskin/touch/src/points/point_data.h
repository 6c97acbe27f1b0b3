// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// What a SurfacePoint holds.
#pragma once

#include <tetskin/touch/surface_point.h>

namespace tetskin {

template <>
struct Access<SurfacePoint> {
  using Data = SurfacePoint::Data;
  static const Data& data(const SurfacePoint& point) { return point.data_; }
  static SurfacePoint create(btSoftBody& body, const Data& data) { return SurfacePoint(body, data); }
};

namespace touch_detail {

using PointData = Access<SurfacePoint>::Data;

/// What a point holds, valid as long as it.
inline const PointData& dataOf(const SurfacePoint& point) {
  return Access<SurfacePoint>::data(point);
}

}  // namespace touch_detail
}  // namespace tetskin
