// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to SoftContacts: finds parts of a body that are near to each other at rest, but far apart along the body.
#pragma once

#include <tetskin/contact/src/soft/shape_data.h>

namespace tetskin::contact_detail {

/// Largest distance in edges, and largest path length in edges: parts of a body within both limits are connected, and
/// do not collide.
constexpr btScalar kEdgesApart = 2, kEdgesAlong = btScalar(2.5);

/// By run, ascending: the tets that are near the run's own tet at rest, but farther along the cage's edges, such as
/// fingers side by side, or duplicates of a tet. Needs nodes, tets, middles, edge and runs. Cost O(T) Dijkstra searches
/// of a few edges each, and O(T^2) for a cage whose tets all have their centroids in one plane
std::vector<std::vector<int>> tetsOfOtherComponents(const ShapeData& data);

}  // namespace tetskin::contact_detail
