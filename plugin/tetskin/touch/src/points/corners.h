// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to tetskin::touch: how the vertices of a mesh hang on their tets, and where nodes put them.
#pragma once

#include <tetskin/touch/surface_point.h>

#include <functional>

namespace tetskin::touch_detail {

/// Where a body's nodes are, world space; another body's, or none: where a skin takes them.
using NodeAt = std::function<btVector3(int node)>;

/// vertex  of the binding's mesh
Corner cornerOf(const Embedding& embedding, std::size_t vertex);

/// By its weights: what a linear skin draws.
btVector3 linearPosition(const Corner& corner, const NodeAt& nodeAt);
/// Of a body's point, now, by its corners' weights: where it is acted at.
btVector3 linearPosition(const PointData& point, const btSoftBody& body);
/// As a quadratic skin of this binding draws it. Cost: some 100 nodes are looked at
btVector3 quadraticPosition(const Corner& corner, const SoftBodyBinding& binding, const NodeAt& nodeAt);

}  // namespace tetskin::touch_detail
