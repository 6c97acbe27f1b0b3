// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to SurfaceTree: what an explosion does to the nodes.
#pragma once

#include <tetskin/touch/src/forces/node_pushes.h>
#include <tetskin/touch/surface_tree.h>

#include <vector>

namespace tetskin::touch_detail {

/// By vertex: a third of its triangles' areas.
std::vector<double> vertexAreas(const TriangleMesh& mesh);

/// The pushes on the nodes of a body of the embedding's cage, where the linear surface is now; none unless Ok.
/// Errors  NonFinite; InvalidOption for a radius that is not above 0; Miss
SurfacePush pushesOf(const SurfaceBlast& blast, const Embedding& embedding, const std::vector<double>& areas,
                     const btSoftBody& body, NodePushes& pushes);

}  // namespace tetskin::touch_detail
