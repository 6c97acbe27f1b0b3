// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The contents of a SurfacePoint.
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

/// The contents of a point, valid as long as the point.
inline const PointData& dataOf(const SurfacePoint& point) {
  return Access<SurfacePoint>::data(point);
}

}  // namespace touch_detail
}  // namespace tetskin
