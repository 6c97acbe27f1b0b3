// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to SoftContacts: what of a body is near to what at rest, but not by way of the body.
#pragma once

#include <tetskin/contact/src/soft/shape_data.h>

namespace tetskin::contact_detail {

/// Edges along which a tet's neighbours are sought, and middles of tets that are near: within both, parts of a body are
/// one, and do not meet.
constexpr btScalar kEdgesApart = 2, kEdgesAlong = btScalar(2.5);

/// By run, ascending: the tets that are near its own at rest, but farther along the cage's edges: fingers side by side,
/// copies of a tet. Needs nodes, tets, middles, edge and runs. Cost O(T) Dijkstra searches of a few edges each, and
/// O(T^2) for a cage all of whose middles are in one plane
std::vector<std::vector<int>> tetsOfOtherParts(const ShapeData& data);

}  // namespace tetskin::contact_detail
