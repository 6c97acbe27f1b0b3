// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to ContactShape: how thick a body is, which determines how fine its grid must be.
#pragma once

#include <tetskin/core/mesh.h>
#include <tetskin/core/src/base/mesh/triangle_bvh.h>

#include <vector>

namespace tetskin::contact_detail {

/// The thickness that a body reaches behind half of its surface, up to a bound.
/// triangles  those of the surface; surface: their hierarchy
/// most       rest length, above 0
/// Cost       some thousand searches for nearest points
double usualThickness(const TriangleMesh& mesh, const std::vector<int>& triangles, const TriangleBvh& surface,
                      double most);

}  // namespace tetskin::contact_detail
