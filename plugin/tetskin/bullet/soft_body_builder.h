// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/bullet/soft_body_adapter.h>
#include <tetskin/core/tet_mesh.h>
#include <tetskin/core/types.h>

#include <functional>

namespace tetskin {

/// What a soft body is made of, beside its shape. Lengths are world lengths. The defaults suit Bullet's deformable
/// world at 60 Hz with 4 substeps.
struct SoftBodyOptions {
  double mass = 1.0;      ///< total, in kg; ignored where density is given
  double density = 0.0;   ///< mass per volume; 0: from mass
  double margin = -1.0;   ///< collision margin; below 0: 2 % of the largest side of the cage's box
  double friction = 0.5;  ///< Bullet's m_cfg.kDF, 0 to 1
  /// How the body meets rigid bodies. The default is for the deformable world; the two classic worlds want
  /// btSoftBody::fCollision::SDF_RS.
  int collisions = btSoftBody::fCollision::SDF_RD | btSoftBody::fCollision::SDF_RDN;
  /// Nodes to hold in place, by their rest position: given infinite mass. Empty: none.
  std::function<bool(const Eigen::Vector3d& restPosition)> pinned;
};

/// Makes a soft body of a cage: a node for every node, in order; a tet for every tet, in order; each edge once as a
/// link and each boundary face once, in the order of btSoftBodyHelpers::CreateFromVtkFile; rest volumes and inverse
/// rest matrices. Negative tets are reoriented, flat ones refused. Node masses are a quarter of each tet's around the
/// node, but at least 0.3 of the mean: slivers' nodes would otherwise be too light to be stable.
///
/// worldInfo  of the world that the body will be added to; must outlive the body
/// Returns    the body, owned by the caller and in no world yet; null on error
/// Cost       O(T log T) for T tets
/// Errors     an unusable cage (see `usable`), flat tets, options out of range
Result<btSoftBody*> makeSoftBody(const TetMesh& cage, btSoftBodyWorldInfo& worldInfo,
                                 const SoftBodyOptions& options = {});

/// Node masses as `makeSoftBody` gives them, nodeCount, adding up to totalMass.
std::vector<double> lumpedMasses(const TetMesh& cage, double totalMass);

}  // namespace tetskin
