// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to tetskin::touch: what the world of a body supports.
#pragma once

#include <tetskin/touch/surface_point.h>

namespace tetskin::touch_detail {

/// Reduced bodies have velocities of modes, not of nodes.
bool isReduced(const btSoftBody& body);

inline bool isFiniteVector(const btVector3& v) {
  return v.x() * 0 + v.y() * 0 + v.z() * 0 == 0;
}

}  // namespace tetskin::touch_detail
