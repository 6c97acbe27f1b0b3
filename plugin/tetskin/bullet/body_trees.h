// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to tetskin::bullet: the bounding-volume trees of a body's faces and nodes (btSoftBody::m_fdbvt, m_fdbvnt,
// m_ndbvt), which rays and collisions by faces search.
//
// Bullet's own builder, btSoftBody::initializeFaceTree, compares all pairs of faces, and joins neighbours until one
// tree is left: for a surface of two parts that share no edge it never ends. Bullet calls it from a ray test of a body
// without a tree, and from the first step after anything that sets m_bUpdateRtCst, such as setMass.
#pragma once

#include <BulletSoftBody/btSoftBody.h>

namespace tetskin {

/// Builds all three trees by median splits, for any number of parts, with boxes that fit the nodes where they are.
/// Whatever trees there were are deleted; the new ones are the body's. Cost O(n log n) for n faces and nodes.
void buildTrees(btSoftBody& body);

/// Instead of the trees of faces a single leaf that no ray hits and no node touches, whatever moves the body: a ray
/// misses, refits cost nothing, and Bullet's builder, which only looks whether there is a tree, is not called.
void leaveOutFaceTree(btSoftBody& body);

/// What Bullet would do in the next step where m_bUpdateRtCst is set, but with our trees; of faces only where they were
/// not left out, and anew only if nodes or faces have been added or moved in memory. Cost O(links + faces + nodes)
/// without that; nothing where the flag is not set.
void updateConstants(btSoftBody& body);

/// A soft body whose trees follow when it is moved or scaled by hand. In Bullet only that of the nodes does: until the
/// next step, and for a sleeping body for good, a ray looks for the faces where they were.
class BodyWithTrees : public btSoftBody {
 public:
  using btSoftBody::btSoftBody;
  /// Also called by transformTo, translate and rotate.
  void transform(const btTransform& transform) override;
  void scale(const btVector3& factors) override;
};

}  // namespace tetskin
