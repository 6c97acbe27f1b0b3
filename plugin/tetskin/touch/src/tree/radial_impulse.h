// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to SurfaceTree: the effect of an explosion on the nodes.
#pragma once

#include <tetskin/touch/src/rows/node_pushes.h>
#include <tetskin/touch/surface_point.h>

#include <vector>

namespace tetskin::touch_detail {

/// By vertex: a third of the sum of its triangles' areas.
std::vector<double> vertexAreas(const TriangleMesh& mesh);

/// The pushes on the nodes of a body of the embedding's cage, for the current linear surface; none unless the status is
/// Ok.
/// Errors  NonFinite; InvalidOption for a radius that is not above 0; Miss
ImpulseResult pushesOf(const RadialImpulse& impulse, const Embedding& embedding, const std::vector<double>& areas,
                       const btSoftBody& body, NodePushes& pushes);

}  // namespace tetskin::touch_detail
