// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Bullet's soft bodies: a btSoftBody's nodes and tets as tetskin's types, a btSoftBody from a cage, the binding of
// Bullet's own render nodes, and Bullet's threads.
#pragma once

#include <BulletSoftBody/btSoftBody.h>
#include <BulletSoftBody/btSoftBodySolverVertexBuffer.h>
#include <LinearMath/btThreads.h>
#include <tetskin/core/cage.h>
#include <tetskin/core/embedding.h>
#include <tetskin/core/types.h>

#include <cassert>
#include <functional>
#include <limits>
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

/// View of the current node positions, world space, without a copy: valid until nodes are appended to the body or it is
/// destroyed.
TETSKIN_BULLET_API PointView<const btScalar> nodePositions(const btSoftBody& body);

/// The body's tets with its current nodes (world space), by index: node i is `body.m_nodes[i]`, tet t is
/// `body.m_tetras[t]`. Nothing is repaired. If a tet's node pointer does not point into the node array (Bullet leaves
/// it dangling when nodes are appended after tets), its index is -1, which every check reports. Cost O(nodes + tets).
TETSKIN_BULLET_API TetMesh readTetMesh(const btSoftBody& body);

/// View of the positions in a Bullet vertex buffer, as a target for skinning: vertexCount points, owned by the buffer's
/// owner.
TETSKIN_BULLET_API PointView<float> positionView(const btCPUVertexBufferDescriptor& buffer, std::size_t vertexCount);

/// Converts one of Bullet's vectors, to double.
inline Eigen::Vector3d toEigen(const btVector3& v) {
  return {static_cast<double>(v.x()), static_cast<double>(v.y()), static_cast<double>(v.z())};
}
/// Converts to one of Bullet's vectors, rounded to its precision.
inline btVector3 toBullet(const Eigen::Vector3d& v) {
  return {static_cast<btScalar>(v.x()), static_cast<btScalar>(v.y()), static_cast<btScalar>(v.z())};
}

/// Callable for the functions of `EmbeddedPoint`: node index to position, world space. Valid as long as the body
/// exists.
inline auto positionsIn(const btSoftBody& body) {
  return [&body](int node) -> const btVector3& { return body.m_nodes[node].m_x; };
}
/// Callable for the functions of `EmbeddedPoint`: node index to velocity, world length per second. Valid as long as the
/// body exists. For instance `embedding.at<btScalar>(vertex).velocity(velocitiesIn(body))`.
inline auto velocitiesIn(const btSoftBody& body) {
  return [&body](int node) -> const btVector3& { return body.m_nodes[node].m_v; };
}
/// Callable for the functions of `EmbeddedPoint`: node index to inverse mass, 0 for a pinned node. Valid as long as the
/// body exists.
inline auto inverseMassesIn(const btSoftBody& body) {
  return [&body](int node) { return body.m_nodes[node].m_im; };
}

/// Elastic model of a body.
enum class ForceModel {
  Corotated,         ///< tetskin's own, in a deformable world with a `DeformableSolver`: any rotation, keeps spin
  NeoHookean,        ///< Bullet's, in a deformable world: large deformations, loses all spin
  LinearElasticity,  ///< Bullet's, in a deformable world: cheaper, loses some spin
  MassSpring,        ///< Bullet's, in the classic worlds: the body's links, solved as constraints
};

/// Material and settings of a soft body. Lengths are world lengths. The defaults are stable in Bullet's deformable
/// world at 60 Hz with 4 substeps.
struct SoftBodyOptions {
  std::optional<double> mass;  ///< total, above 0, 1e-15 to 1e15 in float; not given: from density
  /// Mass per volume: of the mesh if the cage stores its volume, otherwise of the cage. The default, in kg / m^3, is
  /// that of foam, which is closer to most soft everyday objects than water. If lengths are not in metres, give a mass.
  double density = 100.0;
  /// nodeCount node masses, above 0. They replace mass and density, and also the lower limit for the nodes of slivers.
  /// Empty: computed from mass or density, distributed like the cage's masses if it has any.
  std::vector<double> nodeMasses;
  /// Collision margin, world length, 0 or more; not given: 2 % of the body's size (largest side of the cage's box).
  std::optional<double> margin;
  double friction = 0.5;  ///< Bullet's m_cfg.kDF, 0 to 1
  /// Bullet's getRestitution, 0 to 1. The product of both objects' is the least share of the speed of approach with
  /// which Corotated bodies part, in a world with a `DeformableSolver`. An elastic body bounces without.
  double restitution = 0.0;
  /// Selects the nodes to pin by their rest position; these get infinite mass. Empty: none. See `pinnedIn`.
  std::function<bool(const Eigen::Vector3d& restPosition)> pinned;

  /// Elastic model. It also selects how the body collides with rigid bodies: MassSpring as in the classic worlds, the
  /// others as in the deformable world.
  ForceModel forceModel = ForceModel::Corotated;
  /// Young's modulus in pressure units, above 0; not given: relativeStiffness x density x gravity x size. With Bullet's
  /// own forces the default is limited to what is stable for timeStep: fine cages are then softer by default, and need
  /// shorter steps to be stiff. MassSpring does not use it, because Bullet has no such unit for links: see
  /// `linkStiffness`. For Lame's parameters see `fromLame`.
  std::optional<double> youngsModulus;
  /// Dimensionless stiffness, from 30 (wobbles, sags) to 300 (firm), whatever the body's size; limited with Bullet's
  /// own forces as described for `youngsModulus`.
  double relativeStiffness = 50.0;
  /// tetCount factors above 0 that multiply the stiffness of each tet; not for MassSpring. Bullet's own forces get them
  /// through `Tetra::m_element_measure`, which the body's `scale` resets. Empty: the cage's own, from its volume
  /// fractions and stiffness factors.
  std::vector<double> stiffnessScale;
  double poissonRatio = 0.3;  ///< 0 to 0.4999 in float, to 0.499999 in double
  double stiffnessDamping =
      0.02;  ///< seconds: Rayleigh damping; damping forces are this times the rate of the elastic ones
  double timeStep = 1.0 / 240.0;  ///< seconds: the substep for which the default stiffness must be stable
  double solverTolerance = 5e-3;  ///< Corotated: remaining forces, relative to acting ones; 0 to below 1
  int maxIterations = 100;     ///< Corotated: limit of the conjugate gradient per solve; contact takes several solves
  double linkStiffness = 0.5;  ///< MassSpring only: Bullet's m_kLST, 0 to 1
  /// Whether to build trees of the faces, which ray casts, VF_SS, VF_DD and SDF_RDF use. They cost a refit, and a
  /// search against every other soft body with trees, in each substep. Without them, ray casts miss the body in the
  /// deformable world, hit only its tets in the classic worlds, and the body collides at its nodes alone.
  bool faceTree = true;

  /// For DeformableBody: whether it may change settings of the whole world. If true, it switches on projection, without
  /// which bodies do not land, and applies `implicit`; nothing else. If false, it sets nothing.
  bool configureWorld = true;
  /// For DeformableBody with Bullet's own forces, in a world that has only these: one Newton step per update (true) or
  /// explicit elastic forces (false), both without line search; not given: the world is left as it is. True is refused
  /// for Corotated.
  std::optional<bool> implicit;
};

/// For `SoftBodyOptions::pinned`: selects the nodes in a box, rest space.
inline std::function<bool(const Eigen::Vector3d&)> pinnedIn(const Box3& box) {
  return [box](const Eigen::Vector3d& p) { return box.contains(p); };
}

/// Completes options from the cage, for options that are not set: node masses, and the stiffness of each tet (except
/// for MassSpring, whose links have no such factors). `createSoftBody` and `DeformableBody` do this themselves.
TETSKIN_BULLET_API SoftBodyOptions withCageDefaults(const Cage& cage, SoftBodyOptions options);

/// Creates a soft body from a cage: a node for every node, in order; a tet for every tet, in order; each edge once as a
/// link and each boundary face once, in the order of btSoftBodyHelpers::CreateFromVtkFile; rest volumes and inverse
/// rest matrices. Negative tets are reoriented, flat ones refused. Node masses are the cage's, if it has any. Otherwise
/// each tet gives a quarter of its mass to each of its nodes, and every node gets at least 0.3 of the mean, because the
/// nodes of slivers would be too light to be stable.
///
/// The body collides with rigid bodies at its nodes. Its trees of faces and nodes are built here: Bullet would build
/// them in the first step or ray cast, in quadratic time, and would not terminate for a body of several components. In
/// the deformable world, and in the others with VF_SS, Bullet rebuilds them after its own `setMass` and `setTotalMass`:
/// use the functions below instead (both also accept a `DeformableBody`'s body).
///
/// worldInfo  of the world that the body will be added to; must outlive the body
/// Returns    the body, not yet in a world, owned by the caller; remove it from its world before destroying it
/// Cost       O(T log T) for T tets
/// Errors     those of `validate(const Cage&)`; Degenerate: flat tets; InvalidOption: options out of range;
///            SizeMismatch: an array of the wrong length
TETSKIN_BULLET_API Result<std::unique_ptr<btSoftBody>> createSoftBody(const Cage& cage, btSoftBodyWorldInfo& worldInfo,
                                                                      const SoftBodyOptions& options = {});

/// Sets the mass of a node, like `btSoftBody::setMass` (0 pins it), for any body: from `createSoftBody`, of a
/// `DeformableBody`, or the application's own. A body created here keeps its trees, so that Bullet need not rebuild
/// them. Cost O(links + faces).
/// node  must exist
/// mass  0 or above
TETSKIN_BULLET_API void setMass(btSoftBody& body, int node, btScalar mass);
/// Scales the masses of all nodes to a total, like `btSoftBody::setTotalMass`, for any body: from `createSoftBody`, of
/// a `DeformableBody`, or the application's own. A body created here keeps its trees. Cost O(nodes + links + faces).
TETSKIN_BULLET_API void setTotalMass(btSoftBody& body, btScalar mass, bool fromFaces = false);

/// nodeCount node masses as `createSoftBody` assigns them to a cage without masses; their sum is totalMass.
TETSKIN_BULLET_API std::vector<double> lumpedMasses(const TetMesh& cage, double totalMass);

/// A drop-in for `btSoftBodyHelpers::interpolateBarycentricWeights`: binds the body's render nodes to its tets, for
/// applications that leave the update to Bullet's own `interpolateRenderMesh`. Chooses the same tets, unless the
/// barycentric distances of two agree to about 1e-6, so that Bullet's rounding decides. The weights are the same, but
/// computed in double and summing to 1. Every render node is bound: none is left without a tet (Bullet draws such nodes
/// at the world's origin, with uninitialised weights) or bound to a flat tet.
///
/// body      its tets, with its nodes and render nodes at their current positions, world space: they must fit each
///           other. Written on success: m_renderNodesParents and m_renderNodesInterpolationWeights, four of each per
///           render node; m_z is emptied, which tells Bullet that the parents are those of tets. The parents are
///           pointers to the body's nodes, so bind again after appending nodes
/// Returns   the fit, with render nodes as vertices
/// Errors    Empty: no render nodes; those of `embed`, such as no valid tets or a coordinate that is not finite. The
///           body is unchanged on an error
TETSKIN_BULLET_API Result<EmbedReport> bindRenderNodes(btSoftBody& body);

/// Runs on the threads of Bullet's task scheduler (set by `btSetTaskScheduler`), as `btParallelFor` does.
///
/// Without a scheduler it runs sequentially. This is always the case with a Bullet that was built without
/// BT_THREADSAFE, such as Debian's: `btCreateDefaultTaskScheduler` returns null there. (The application's own scheduler
/// still works: the tasks do not touch Bullet.) `ThreadPool` does not depend on Bullet.
class BulletParallelFor : public ParallelFor {
 public:
  void run(std::size_t count, Task task) override {
    assert(count <= static_cast<std::size_t>((std::numeric_limits<int>::max)()));
    const Body body(task);
    // Not btParallelFor itself: it asserts that there is a scheduler and, without BT_THREADSAFE, that it is never
    // called.
    btITaskScheduler* scheduler = btGetTaskScheduler();
    if (scheduler) {
      scheduler->parallelFor(0, static_cast<int>(count), 1, body);
    } else {
      body.forLoop(0, static_cast<int>(count));
    }
  }

 private:
  class Body : public btIParallelForBody {
   public:
    explicit Body(Task task) : task_(task) {}
    void forLoop(int first, int last) const override {
      for (int k = first; k < last; ++k) task_(static_cast<std::size_t>(k));
    }

   private:
    Task task_;
  };
};

}  // namespace tetskin
