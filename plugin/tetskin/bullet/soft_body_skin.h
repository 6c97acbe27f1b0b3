// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/bullet/soft_body.h>
#include <tetskin/core/mesh_skin.h>

#include <array>
#include <cstdint>
#include <memory>

namespace tetskin {

namespace bullet_detail {
struct NodeMoves;
}

/// Data that skins of several bodies with the same cage can share: see `SoftBodySkin::binding`.
using SoftBodyBinding = SkinBinding<btScalar>;

/// A render mesh carried by a soft body: bind once at rest, update after each step.
///
///     SoftBodySkin skin;
///     Result<EmbedReport> fit = skin.bind(*body, cage, mesh);
///     ...
///     if (world->stepSimulation(dt, 4, dt / 4) > 0) status = skin.update();
///
/// Works in every Bullet world and for a body in none; a skin only reads its body. Update after stepSimulation, not in
/// a tick callback: no callback sees final positions in all worlds. A body that was moved, scaled or teleported by hand
/// needs only the next update. Several skins may share a body, and several bodies a binding. The body must outlive the
/// skin's last update: once it is destroyed, `update`, `recordStep`, `markTeleported` and `setVisible(true)` read freed
/// memory, unless the body was made by `createSoftBody` or `DeformableBody`, which skins notice. All other functions
/// may still be called, including `bind` to another body. A skin can be moved, not copied.
///
/// An application whose frame rate differs from its step rate records each step, and draws between the last two; it
/// manages the time itself, and the surface is then one step behind:
///
///     if (world->stepSimulation(step, 4, step / 4) > 0) skin.recordStep();  // as often as the time requires
///     status = skin.update(alpha);                                          // each frame
class TETSKIN_BULLET_API SoftBodySkin {
 public:
  /// An unbound skin.
  SoftBodySkin() = default;
  SoftBodySkin(SoftBodySkin&&) = default;
  SoftBodySkin& operator=(SoftBodySkin&&) = default;

  /// Embeds the mesh in the rest cage, and updates once.
  ///
  /// body      has the cage's nodes, in the cage's order, at any positions; not owned
  /// restCage  rest space, preferably near the origin; its tets are used, not the body's; not kept
  /// mesh      in the cage's rest space; not kept
  /// Returns   the fit; on an error this skin is left unchanged
  /// Cost      see `embed`; 20 to 50 microseconds more per node that carries vertices for quadratic skinning; allocates
  /// Errors    those of `MeshSkin::bind`; SizeMismatch if body and cage differ in the number of nodes
  Result<EmbedReport> bind(const btSoftBody& body, const Cage& restCage, const TriangleMesh& mesh,
                           const SkinOptions& options = {});
  /// Overload for vertices alone, vertexCount x 3, rest space: no triangles, hence no recomputed normals.
  Result<EmbedReport> bind(const btSoftBody& body, const Cage& restCage, PointView<const double> vertices,
                           const SkinOptions& options = {});
  /// Overload that uses the body's current nodes as rest shape: the mesh must fit the body in world space. Error:
  /// IndexOutOfRange if Bullet's tets have dangling pointers, as they do after nodes were appended.
  Result<EmbedReport> bind(const btSoftBody& body, const TriangleMesh& mesh, const SkinOptions& options = {});
  /// Shares an existing binding, such as another skin's. Errors: those of `MeshSkin::bind` for a binding.
  Status bind(const btSoftBody& body, std::shared_ptr<const SoftBodyBinding> binding,
              const InstanceOptions& options = {});
  /// Deleted: the options of the surface were fixed when the binding was created; pass InstanceOptions.
  template <class Options, class = std::enable_if_t<std::is_same_v<Options, SkinOptions>>>
  Status bind(const btSoftBody& body, std::shared_ptr<const SoftBodyBinding> binding, const Options& options) = delete;

  /// Computes the current positions, and normals if requested. Cost O(vertexCount + nodeCount); allocates nothing. A
  /// sleeping body costs only a few nodes in a world of `DeformableSolver`; in other worlds, and in none, all nodes are
  /// read, and a body that has fallen asleep is updated once more. A hidden skin reads nothing.
  /// alpha    interpolation between the last two recorded steps: 0 is the previous one, 1 the body's current nodes;
  ///          clamped to this range. NaN counts as 1, as does any value if there is nothing to interpolate: see
  ///          `recordStep`
  /// Returns  Ok, Asleep, Hidden; or, without any change, Unbound, BodyDeleted (only for bodies of `createSoftBody` and
  ///          `DeformableBody`), TopologyChanged, NonFinite
  StatusCode update(btScalar alpha = 1);

  /// Updates several skins, prefetching the data of the next ones: with many sleeping bodies, waiting for memory is
  /// most of the cost. Returns how many were updated.
  /// skins     `count` skins, not null, of any bodies
  /// statuses  `count` results of `update`; or null
  /// alpha     as for `update`
  /// threads   divide the skins among themselves; or null. No skin may then have been bound with the same `threads`, as
  ///           they would divide one skin from within a task. Results are the same with any number of threads
  static std::size_t updateAll(SoftBodySkin* const* skins, std::size_t count, StatusCode* statuses = nullptr,
                               btScalar alpha = 1, ParallelFor* threads = nullptr);

  /// Records the nodes, for updates between this step and the next. Call it once after each stepSimulation that
  /// returned above 0, before any update. Any number of updates may follow, with alphas in any order.
  ///
  /// In these cases updates show the body's current state, whatever alpha is: after the first recorded step; after
  /// `bind`, `markTeleported` and `setVisible(true)`, until the next recorded step; after the recorded step that finds
  /// a sleeping body awake, as its motion in between was not observed; after an update has returned TopologyChanged,
  /// until two more steps are recorded; and if the nodes of this step, or of the previous one, are not finite. A body
  /// that falls asleep is drawn interpolated until the next step is recorded, and is skipped as soon as an update has
  /// shown it at its final position.
  ///
  /// Cost  O(nodeCount), and two copies of the nodes from the first call on; nothing for a body that stays asleep, nor
  ///       for a hidden skin. Without calls nothing is stored, and alpha has no effect
  void recordStep();

  /// The next update will not skip a sleeping body. Needed only if the application has written the m_x of single nodes
  /// of a body in a world of `DeformableSolver`, and wants to see it before the next step, which would notice it and
  /// wake the body. In such a world, steps, `translate`, `rotate`, `transform`, `scale` and snapshots are counted; to
  /// detect anything else, four nodes that are not in one plane are compared: every affine motion of the whole body
  /// moves one of them.
  void markMoved() { moved_ = true; }
  /// Call this after moving a body by hand, asleep or awake, to a position where it should appear at once: updates then
  /// do not interpolate to it, and the next one has no motion (see `previousPositions`). Without it, the next recorded
  /// step is drawn as if the body had moved there in that step. Cost O(nodeCount).
  void markTeleported();
  /// Shows or hides the skin. A hidden skin is not updated; showing it again updates it at once. Visible by default.
  void setVisible(bool visible);
  /// True if the skin is visible, see `setVisible`.
  bool visible() const { return visible_; }

  /// vertexCount current positions, world space minus the origin, in the binding's order. Owned by the skin; empty if
  /// `InstanceOptions::target` is set.
  PointView<const btScalar> positions() const { return skin_.positions(); }
  /// vertexCount positions of the previous update, whatever its alpha; empty if not requested: see MeshSkin. They equal
  /// the current ones after `bind`, after any update that was skipped (a sleeping body has no motion), after the update
  /// that follows a teleport, and when shown again. Frames without a call of `update` have no motion either.
  PointView<const btScalar> previousPositions() const { return skin_.previousPositions(); }
  /// vertexCount current unit normals in the binding's order; empty if not requested, or if `normalTarget` is set.
  PointView<const float> normals() const { return skin_.normals(); }
  /// vertexCount current unit tangents in the binding's order; empty if not requested, or if `tangentTarget` is set.
  PointView<const float> tangents() const { return skin_.tangents(); }
  /// Bounding box of the positions, for culling. An extrapolated vertex may lie outside the soft body's own box.
  const Box3& bounds() const { return skin_.bounds(); }
  /// The binding, for sharing; null before a successful bind.
  std::shared_ptr<const SoftBodyBinding> binding() const { return skin_.binding(); }
  /// The body that carries the skin; null before a successful bind.
  const btSoftBody* body() const { return body_; }
  /// The interpolation in use: Linear also if `disableQuadratic` was set, and before a successful bind.
  Interpolation interpolation() const { return skin_.interpolation(); }
  /// Position of a node as used by `update(alpha)`, world space. The body must exist, with the same nodes.
  btVector3 nodeAt(int node, btScalar alpha = 1) const;
  /// Index of the first node that was not finite, or beyond Limits::kMaxCoordinate, in the last update that returned
  /// NonFinite.
  std::size_t firstNonFiniteNode() const { return skin_.firstNonFiniteNode(); }
  /// Sets the origin, world space, for later updates. Error: InvalidOption if it is not finite or beyond 1e18; the
  /// origin is then unchanged.
  Status setOrigin(const btVector3& origin);

 private:
  /// A node's position at the last update, for a body whose moves are counted.
  struct Sample {
    int node = 0;
    btScalar position[3] = {};
  };

  bool isBetween(btScalar alpha) const { return between_ && alpha < 1; }
  bool bodyLives() const { return !moves_ || !life_.expired(); }
  StatusCode decide(btScalar alpha);
  static void decideAll(SoftBodySkin* const* skins, std::size_t count, StatusCode* statuses, btScalar alpha);
  StatusCode compute(btScalar alpha);
  StatusCode topologyChanged();
  void restart();
  bool movesCounted() const;
  void remember(bool hashes);
  bool unmoved() const;
  bool samplesUnmoved() const;
  void fetch() const;
  void fetchBody() const;
  void fetchNodes() const;

  // The data of a sleeping or hidden body comes first and side by side: its cost is that of fetching it from memory.
  const btSoftBody* body_ = nullptr;
  int nodeCount_ = 0;
  int tetCount_ = 0;
  bool visible_ = true;
  bool counted_ = false;                             ///< `seen_` is a number of moves, not a hash
  bool moved_ = false;                               ///< nodes have moved, or may have: the next update does not skip
  bool between_ = false;                             ///< there are two recorded steps to interpolate between
  bool sleeps_ = false;                              ///< the body slept when the last step was recorded
  bool teleported_ = false;                          ///< the next update counts as no motion
  const bullet_detail::NodeMoves* moves_ = nullptr;  ///< null if the body's destruction cannot be noticed
  std::weak_ptr<const bullet_detail::NodeMoves> life_;  ///< of `moves_`
  std::uint64_t seen_ = 0;                              ///< at the last update: number of moves, or hash of all nodes
  std::array<Sample, 4> samples_;
  MeshSkin<btScalar> skin_;
  StepHistory<btScalar> steps_;
};

}  // namespace tetskin
