// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Creates the elements of bodies of any kind.
#pragma once

#include <tetskin/bullet/soft_body.h>
#include <tetskin/core/src/base/mesh/mesh_checks.h>

#include <memory>
#include <vector>

namespace tetskin::bullet_detail {

/// A body that is not yet in a world, with the data from its cage.
struct BuiltBody {
  std::unique_ptr<btSoftBody> body;
  std::vector<double> masses;  ///< by node: its mass when it is not pinned
};

/// The part of `createSoftBody` after the checks of the cage.
/// cage     `validateAttributes(cage)` is ok
/// options  including the data of the cage: see `withCageDefaults`
/// Errors   those of `createSoftBody`
TETSKIN_BULLET_API Result<BuiltBody> buildBody(const Cage& cage, btSoftBodyWorldInfo& worldInfo,
                                               const SoftBodyOptions& options);

/// Ok, or an error: the cage is unusable, or has flat tets.
TETSKIN_BULLET_API Status checkCage(const TetMesh& cage, const TetMeshReport& report);

/// Appends a tet for every tet, in order; each edge once as a link and each boundary face once, in the order of
/// btSoftBodyHelpers::CreateFromVtkFile; rest volumes and inverse rest matrices. The body has the cage's nodes.
/// cage  of positive tets
TETSKIN_BULLET_API void appendElements(const TetMesh& cage, btSoftBody& body);

/// Sets up contacts at nodes, as the deformable world expects.
/// margin  not given: a default from the cage's size
TETSKIN_BULLET_API void collideWithRigidBodies(const TetMesh& cage, std::optional<double> margin, double friction,
                                               btSoftBody& body);

}  // namespace tetskin::bullet_detail
