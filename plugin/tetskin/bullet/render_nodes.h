// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <BulletSoftBody/btSoftBody.h>
#include <tetskin/core/embedding.h>

namespace tetskin {

/// A drop-in for `btSoftBodyHelpers::interpolateBarycentricWeights`: binds the body's render nodes to its tets, for
/// applications that leave the update to Bullet's own `interpolateRenderMesh`. The same tets, except where the
/// barycentric distances of two agree to about 1e-6, so that Bullet's rounding decides. The same weights, but computed
/// in double and summing to 1; and for every render node: none is left without a tet, which Bullet draws at the world's
/// origin, with weights that were never set, or bound to a flat tet.
///
/// body      its tets, with its nodes and render nodes where they are now, world space: they must fit each other.
///           Written on success: m_renderNodesParents and m_renderNodesInterpolationWeights, four of each a render
///           node; m_z is emptied, which is how Bullet knows that the parents are those of tets. As the parents are
///           pointers to the body's nodes, bind again after appending nodes.
/// Returns   the fit, render nodes as vertices. On an error the body is as it was: no render nodes, no usable tets, a
///           coordinate that is not finite
TETSKIN_BULLET_API Result<EmbedReport> bindRenderNodes(btSoftBody& body);

}  // namespace tetskin
