// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/bullet/soft_body.h>
#include <tetskin/core/mesh_skin.h>

#include <array>
#include <memory>

namespace tetskin {

/// What skins of several bodies with one cage may share: see `SoftBodySkin::binding`.
using SoftBodyBinding = SkinBinding<btScalar>;

/// A render mesh carried by a soft body: bind once at rest, update after each step.
///
///     SoftBodySkin skin;
///     Result<EmbedReport> fit = skin.bind(*body, cage, mesh);
///     ...
///     if (world->stepSimulation(dt, 4, dt / 4) > 0) status = skin.update();
///
/// Works in every Bullet world and for a body in none; a skin only reads its body. Update after stepSimulation, not in
/// a tick callback: there is no callback at which the positions are final in all worlds. A body that was moved, scaled
/// or teleported by hand simply needs the next update. Several skins may share a body, and several bodies a binding.
/// The body must outlive the skin's last update: once it is gone, `update`, `keepStep`, `markTeleported` and
/// `setVisible(true)` would read freed memory, while all else may be called, `bind` to another body included. A skin
/// may be moved, not copied.
///
/// An application that draws at another rate than it steps keeps each step, and draws between the last two; the time
/// is its own, and the surface is then a step behind it:
///
///     if (world->stepSimulation(step, 4, step / 4) > 0) skin.keepStep();   // as often as time asks for
///     status = skin.update(alpha);                                                // each frame
class TETSKIN_BULLET_API SoftBodySkin {
 public:
  /// Bound to nothing.
  SoftBodySkin() = default;
  SoftBodySkin(SoftBodySkin&&) = default;
  SoftBodySkin& operator=(SoftBodySkin&&) = default;

  /// Embeds the mesh in the rest cage and updates once.
  ///
  /// body      has the cage's nodes, in the cage's order, wherever they are now
  /// restCage  rest space, near the origin best; its tets count, not the body's
  /// mesh      in the cage's rest space
  /// Returns   the fit; on an error this skin is left as it was
  /// Cost      see `embed`; 20 to 50 microseconds more a node that carries vertices for quadratic skinning; allocates
  Result<EmbedReport> bind(const btSoftBody& body, const Cage& restCage, const TriangleMesh& mesh,
                           const SkinOptions& options = {});
  /// The same for vertices alone: no triangles, hence no recomputed normals.
  Result<EmbedReport> bind(const btSoftBody& body, const Cage& restCage, PointView<const double> vertices,
                           const SkinOptions& options = {});
  /// The same with the body's nodes as they are now for rest: the mesh must fit the body where it is. Refused once
  /// Bullet's own tets dangle: see `checkDangling`.
  Result<EmbedReport> bind(const btSoftBody& body, const TriangleMesh& mesh, const SkinOptions& options = {});
  /// The same with a binding made before, such as another skin's.
  Status bind(const btSoftBody& body, std::shared_ptr<const SoftBodyBinding> binding,
              const InstanceOptions& options = {});
  /// What shapes the surface is the binding's, and was told when it was made: give InstanceOptions.
  template <class Options, class = std::enable_if_t<std::is_same_v<Options, SkinOptions>>>
  Status bind(const btSoftBody& body, std::shared_ptr<const SoftBodyBinding> binding, const Options& options) = delete;

  /// Computes the current positions, and normals if asked for. Cost O(vertexCount + nodeCount); allocates nothing. A
  /// sleeping body costs a look at a few of its nodes, a hidden skin nothing.
  /// alpha  how far between the last two steps kept: from 0, the one before, to 1, the body's nodes as they are now.
  ///        Counts as the nearer of the two beyond them, and as 1 if it is not a number, or if nothing is in between:
  ///        see `keepStep`
  UpdateStatus update(btScalar alpha = 1);

  /// `update` for several skins in turn, which asks memory early for what the next ones will read: with many sleeping
  /// bodies, waiting for that is most of the cost. Returns how many were updated.
  /// skins     `count` of them, not null, of any bodies
  /// statuses  if given, receives as many: what `update` did
  static std::size_t updateAll(SoftBodySkin* const* skins, std::size_t count, UpdateStatus* statuses = nullptr,
                               btScalar alpha = 1);

  /// Keeps the nodes for updates between this step and the next: call it once after each stepSimulation that returned
  /// above 0, before any update. Any number of updates may follow, in any order of their alphas.
  ///
  /// Whatever alpha is, updates show the body as it is now: after the first step kept; from `bind`, `markTeleported`
  /// and `setVisible(true)` on, until the next; after the one that finds a sleeping body awake, as nobody has watched
  /// it meanwhile; once an update has returned TopologyChanged, until two more; and where the nodes of this step, or of
  /// the one before, are not finite. A body that falls asleep is drawn on its way there until the next step is kept,
  /// and is skipped as soon as an update has shown it where it lies.
  ///
  /// Cost: O(nodeCount), and two copies of the nodes from the first call on; nothing for a body that sleeps on, nor for
  /// a hidden skin. Without it, nothing is kept, and alpha does not matter.
  void keepStep();

  /// A sleeping body is looked at in four nodes only, not in one plane, one of which at least moves in every teleport,
  /// turn, stretch or other affine motion of the whole body. After moving other nodes by hand, say so: the next update
  /// will not skip.
  void markMoved() { moved_ = true; }
  /// After moving a body by hand to where it shall appear at once, asleep or awake: updates do not show it on the way,
  /// and the next one's motion is none (see `previousPositions`). Without it, the next step kept is drawn as if the
  /// body had gone there in that step. Cost that of `keepStep`.
  void markTeleported();
  /// A skin that is not visible is not updated; shown again, it is at once. Visible to begin with.
  void setVisible(bool visible);
  /// As it was set.
  bool visible() const { return visible_; }

  /// vertexCount current positions, world space minus origin, in the binding's order: the skin's own array. Empty where
  /// the target is the caller's.
  PointView<const btScalar> positions() const { return skin_.positions(); }
  /// Of the update before, whatever its alpha, if asked for: see MeshSkin. The current ones after bind, after any
  /// update that was skipped (a sleeping body has no motion), after the one that follows a teleport, and when shown
  /// again; on frames without a call of `update`, nothing has moved either.
  PointView<const btScalar> previousPositions() const { return skin_.previousPositions(); }
  /// vertexCount current unit normals, likewise; empty if not asked for.
  PointView<const float> normals() const { return skin_.normals(); }
  /// vertexCount current unit tangents, likewise.
  PointView<const float> tangents() const { return skin_.tangents(); }
  /// Box of the positions, for culling. An extrapolated vertex may lie outside the soft body's own box.
  const Box3& bounds() const { return skin_.bounds(); }
  /// To share; null before a successful bind.
  std::shared_ptr<const SoftBodyBinding> binding() const { return skin_.binding(); }
  /// Whose surface it is; null before a successful bind.
  const btSoftBody* body() const { return body_; }
  /// What is drawn: Linear also where the quadratic surface was left out, and before a successful bind.
  Interpolation interpolation() const { return skin_.interpolation(); }
  /// A node of the body as `update(alpha)` takes it, world space. The body must be there, with the nodes it had.
  btVector3 nodeAt(int node, btScalar alpha = 1) const;
  /// The first such node when `update` last returned NonFinite.
  std::size_t firstBadNode() const { return skin_.firstBadNode(); }
  /// Moves the origin for the updates to come. Errors: InvalidOption if it is not finite or beyond 1e18, and it stays.
  Status setOrigin(const btVector3& origin);

 private:
  /// A node of the last update.
  struct Sample {
    int node = 0;
    btScalar position[3] = {};
  };

  bool isBetween(btScalar alpha) const { return between_ && alpha < 1; }
  UpdateStatus decide(btScalar alpha);
  static void decideAll(SoftBodySkin* const* skins, std::size_t count, UpdateStatus* statuses, btScalar alpha);
  UpdateStatus compute(btScalar alpha);
  UpdateStatus topologyChanged();
  void beginAnew();
  void sample();
  bool samplesUnmoved() const;
  void fetch() const;
  void fetchBody() const;
  void fetchNodes() const;

  // What a sleeping or hidden body needs comes first and side by side: its cost is that of fetching it from memory.
  const btSoftBody* body_ = nullptr;
  int nodeCount_ = 0;
  int tetCount_ = 0;
  bool visible_ = true;
  bool moved_ = false;       ///< or, for all that samples_ tell, may have: the next update does not skip
  bool between_ = false;     ///< there is something between the steps kept
  bool sleeps_ = false;      ///< did when the last step was kept
  bool teleported_ = false;  ///< the next update is no motion
  std::array<Sample, 4> samples_;
  MeshSkin<btScalar> skin_;
  KeptSteps<btScalar> steps_;
};

}  // namespace tetskin
