// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// What bodies of any kind are made of.
#pragma once

#include <tetskin/bullet/soft_body.h>

#include <memory>
#include <vector>

namespace tetskin {

/// A body that is in no world yet, and what its cage gave it.
struct BuiltBody {
  std::unique_ptr<btSoftBody> body;
  std::vector<double> masses;  ///< by node, of pinned ones, too: what they weigh when they are not
};

/// What `makeSoftBody` does once the cage has been checked.
/// cage     `cage.check()` is ok
/// options  with what the cage knows: see `withCage`
/// Errors   those of `makeSoftBody`
Result<BuiltBody> buildBody(const Cage& cage, btSoftBodyWorldInfo& worldInfo, const SoftBodyOptions& options);

/// Ok, or that the cage is unusable, or has flat tets.
TETSKIN_BULLET_API Status checkCage(const TetMesh& cage, const TetMeshReport& report);

/// A tet for every tet, in order; each edge once as a link and each boundary face once, in the order of
/// btSoftBodyHelpers::CreateFromVtkFile; rest volumes and inverse rest matrices. The body has the cage's nodes.
/// cage  of positive tets
TETSKIN_BULLET_API void appendElements(const TetMesh& cage, btSoftBody& body);

/// By the nodes, as the deformable world expects; margin  below 0: by the cage's size
TETSKIN_BULLET_API void meetRigidBodies(const TetMesh& cage, double margin, double friction, btSoftBody& body);

}  // namespace tetskin
