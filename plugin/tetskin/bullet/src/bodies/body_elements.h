// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// What bodies of any kind are made of.
#pragma once

#include <BulletSoftBody/btSoftBody.h>
#include <tetskin/core/tet_mesh.h>

namespace tetskin {

/// Ok, or that the cage is unusable, or has flat tets.
TETSKIN_BULLET_API Status checkCage(const TetMesh& cage, const TetMeshReport& report);

/// A tet for every tet, in order; each edge once as a link and each boundary face once, in the order of
/// btSoftBodyHelpers::CreateFromVtkFile; rest volumes and inverse rest matrices. The body has the cage's nodes.
/// cage  of positive tets
TETSKIN_BULLET_API void appendElements(const TetMesh& cage, btSoftBody& body);

/// By the nodes, as the deformable world expects; margin  below 0: by the cage's size
TETSKIN_BULLET_API void meetRigidBodies(const TetMesh& cage, double margin, double friction, btSoftBody& body);

}  // namespace tetskin
