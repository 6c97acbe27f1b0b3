// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to tetskin::contact: by which triangles are cut into samples.
#pragma once

#include <tetskin/core/triangle_mesh.h>

#include <algorithm>
#include <array>

namespace tetskin::contact_detail {

inline double longestEdge(const TriangleMesh& mesh, const std::array<int, 3>& t) {
  const auto edge = [&](int a, int b) {
    return (mesh.positions[static_cast<std::size_t>(a)] - mesh.positions[static_cast<std::size_t>(b)]).norm();
  };
  return std::max({edge(t[0], t[1]), edge(t[1], t[2]), edge(t[2], t[0])});
}

}  // namespace tetskin::contact_detail
