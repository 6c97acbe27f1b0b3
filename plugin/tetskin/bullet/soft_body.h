// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Soft bodies in and out: a btSoftBody's nodes and tets as tetskin's types, and a btSoftBody of a cage.
#pragma once

#include <BulletSoftBody/btSoftBody.h>
#include <BulletSoftBody/btSoftBodySolverVertexBuffer.h>
#include <tetskin/core/cage.h>
#include <tetskin/core/types.h>

#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace tetskin {

// tetskin::bullet was configured for one precision; code that includes this in the other would corrupt memory silently.
#ifdef TETSKIN_BULLET_DOUBLE
static_assert(sizeof(btScalar) == 8, "tetskin was built for Bullet in double; compile with BT_USE_DOUBLE_PRECISION");
#else
static_assert(sizeof(btScalar) == 4, "tetskin was built for Bullet in float; compile without BT_USE_DOUBLE_PRECISION");
#endif

/// The current node positions, world space, in place: valid until the body's nodes are appended to or it is destroyed.
TETSKIN_BULLET_API PointView<const btScalar> nodePositions(const btSoftBody& body);

/// The body's tets with its nodes as they are now, by index: node i is `body.m_nodes[i]`, tet t is `body.m_tetras[t]`.
/// Nothing is repaired. A tet whose node pointers do not point into the node array (Bullet leaves them dangling when
/// nodes are appended after tets) gets the index -1, which every check reports. Cost O(nodes + tets).
TETSKIN_BULLET_API TetMesh tetMeshOf(const btSoftBody& body);

/// IndexOutOfRange if there are such tets in what `tetMeshOf` has read: how many, why, and what to do.
TETSKIN_BULLET_API Status checkDangling(const TetMesh& read);

/// The positions of a Bullet vertex buffer, as a target for skinning: vertexCount points, owned by the buffer's owner.
TETSKIN_BULLET_API PointView<float> positionsOf(const btCPUVertexBufferDescriptor& buffer, std::size_t vertexCount);

/// A vector of Bullet's, in double.
inline Eigen::Vector3d toEigen(const btVector3& v) {
  return {static_cast<double>(v.x()), static_cast<double>(v.y()), static_cast<double>(v.z())};
}
/// A vector for Bullet, rounded to its precision.
inline btVector3 toBullet(const Eigen::Vector3d& v) {
  return {static_cast<btScalar>(v.x()), static_cast<btScalar>(v.y()), static_cast<btScalar>(v.z())};
}

/// A body's nodes as the functions of `EmbeddedPoint` ask for them, world space: valid as long as the body is there.
/// For instance `embedding.at<btScalar>(vertex).velocity(velocitiesIn(body))`.
inline auto positionsIn(const btSoftBody& body) {
  return [&body](int node) -> const btVector3& { return body.m_nodes[node].m_x; };
}
/// The same for velocities.
inline auto velocitiesIn(const btSoftBody& body) {
  return [&body](int node) -> const btVector3& { return body.m_nodes[node].m_v; };
}
/// The same for inverse masses, 0 where a node is pinned.
inline auto inverseMassesIn(const btSoftBody& body) {
  return [&body](int node) { return body.m_nodes[node].m_im; };
}

/// What holds a body together.
enum class ForceModel {
  Corotated,         ///< deformable world with a `DeformableSolver`: tetskin's own; any rotation, keeps spin
  NeoHookean,        ///< deformable world: Bullet's; large deformations, loses all spin
  LinearElasticity,  ///< deformable world: Bullet's; cheaper, loses some
  MassSpring,        ///< the classic worlds: the body's links, solved as constraints
};

/// What a soft body is made of, beside its shape. Lengths are world lengths. The defaults are stable in Bullet's
/// deformable world at 60 Hz with 4 substeps.
struct SoftBodyOptions {
  double mass = 0.0;  ///< total, in kg; 0: from density
  /// Mass per volume, of the mesh if the cage knows it, else of the cage. The default, in kg / m^3, is that of foam,
  /// which most of what is soft and of one's own size is nearer to than to water; where lengths are not metres, give a
  /// mass.
  double density = 100.0;
  /// nodeCount, above 0: instead of the two above, and of the floor under the masses of slivers' nodes. Empty: from
  /// those, distributed as the cage's masses are if it has any.
  std::vector<double> nodeMasses;
  double margin = -1.0;   ///< collision margin; below 0: 2 % of the largest side of the cage's box
  double friction = 0.5;  ///< Bullet's m_cfg.kDF, 0 to 1
  /// Nodes to hold in place, by their rest position: given infinite mass. Empty: none. See `pinnedIn`.
  std::function<bool(const Eigen::Vector3d& restPosition)> pinned;

  /// Also chooses how the body meets rigid ones: MassSpring as the classic worlds expect, the others as the deformable.
  ForceModel forceModel = ForceModel::Corotated;
  /// Stiffness in pressure units; 0: relativeStiffness x density x gravity x size. Of Bullet's own forces that is no
  /// more than is stable for timeStep: fine cages are softer by default then, and need shorter steps to be stiff.
  /// For MassSpring Bullet has no such unit: there `linkStiffness` counts.
  double youngsModulus = 0.0;
  /// From 30 (wobbles, sags) to 300 (firm), whatever the body's size; bounded as said above.
  double relativeStiffness = 50.0;
  /// tetCount, above 0: times the stiffness, tet by tet; not for MassSpring. Of Bullet's own forces, by
  /// `Tetra::m_element_measure`, which the body's `scale` sets anew. Empty: the cage's, by its fill and factor.
  std::vector<double> stiffnessScale;
  double poissonRatio = 0.3;      ///< 0 to below 0.5
  double damping = 0.02;          ///< seconds: damping forces are this times the rate of the elastic ones
  double timeStep = 1.0 / 240.0;  ///< seconds: the substep that the default stiffness must be stable for
  double solverTolerance = 5e-3;  ///< Corotated: of the residual over that without elasticity, 0 to below 1
  int maxIterations = 100;        ///< Corotated: of the conjugate gradient in a solve, at most; contact takes several
  double linkStiffness = 0.5;     ///< MassSpring only: Bullet's m_kLST, 0 to 1
  /// Trees of the faces, which rays, VF_SS, VF_DD and SDF_RDF search. They cost a refit, and a search against every
  /// other soft body with trees, in each substep. Without them rays in the deformable world miss the body, those in the
  /// classic worlds meet only its tets, and it collides by its nodes alone.
  bool faceTree = true;

  /// For DeformableBody, the next two: may it set what is a property of the whole world? If so, projection is switched
  /// on, without which bodies do not land; and nothing else, except by `implicit`. If not, nothing is set.
  bool configureWorld = true;
  /// Of Bullet's own forces in a world of these alone: one Newton step an update (true) or explicit elastic forces
  /// (false), both without line search; not given: as the world is. True is refused for Corotated.
  std::optional<bool> implicit;
};

/// For `SoftBodyOptions::pinned`: the nodes in a box, rest space.
inline std::function<bool(const Eigen::Vector3d&)> pinnedIn(const Box3& box) {
  return [box](const Eigen::Vector3d& p) { return box.contains(p); };
}

/// The options with what the cage knows, where they leave it to that: node masses, and the stiffness of each tet (but
/// for MassSpring, whose links take none). What `makeSoftBody` and `DeformableBody` do by themselves.
TETSKIN_BULLET_API SoftBodyOptions withCage(const Cage& cage, SoftBodyOptions options);

/// Makes a soft body of a cage: a node for every node, in order; a tet for every tet, in order; each edge once as a
/// link and each boundary face once, in the order of btSoftBodyHelpers::CreateFromVtkFile; rest volumes and inverse
/// rest matrices. Negative tets are reoriented, flat ones refused. Node masses are the cage's, if it has any; otherwise
/// a quarter of each tet's around the node, but at least 0.3 of the mean: slivers' nodes would be too light to be
/// stable.
///
/// The body collides with rigid bodies by its nodes. Its trees of faces and nodes are ready: Bullet would build them in
/// the first step or ray test, in quadratic time, and without end for a body of several parts. In the deformable world,
/// and in the others with VF_SS, it does so again after its own `setMass` and `setTotalMass`: use those below (a
/// `DeformableBody` may be given either).
///
/// worldInfo  of the world that the body will be added to; must outlive the body
/// Returns    the body, in no world yet; take it out of its world before it goes
/// Cost       O(T log T) for T tets
/// Errors     an unusable cage (see `usable`), flat tets, options out of range
TETSKIN_BULLET_API Result<std::unique_ptr<btSoftBody>> makeSoftBody(const Cage& cage, btSoftBodyWorldInfo& worldInfo,
                                                                    const SoftBodyOptions& options = {});

/// As the body's own `setMass` (0 pins the node), but Bullet is left nothing to build: the trees stay. For bodies made
/// by `makeSoftBody` that are in no `DeformableBody`. Cost O(links + faces).
TETSKIN_BULLET_API void setMass(btSoftBody& body, int node, btScalar mass);
/// As `btSoftBody::setTotalMass`, likewise.
TETSKIN_BULLET_API void setTotalMass(btSoftBody& body, btScalar mass, bool fromFaces = false);

/// Node masses as `makeSoftBody` gives them, nodeCount, adding up to totalMass.
TETSKIN_BULLET_API std::vector<double> lumpedMasses(const TetMesh& cage, double totalMass);

}  // namespace tetskin
