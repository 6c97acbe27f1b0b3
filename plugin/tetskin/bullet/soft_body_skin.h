// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/bullet/soft_body_adapter.h>
#include <tetskin/core/mesh_skin.h>

#include <array>
#include <memory>

namespace tetskin {

/// What an update did. Only after `Updated` are there new positions; otherwise the last good surface stands.
enum class UpdateStatus {
  Updated,
  Asleep,           ///< skipped: the body sleeps and has not been moved since the last update
  Hidden,           ///< skipped: the skin is not visible
  NonFinite,        ///< skipped: a node is infinite, not a number or beyond 1e18; the simulation has exploded
  TopologyChanged,  ///< skipped: the body has gained or lost nodes or tets since bind; bind again
  Unbound,          ///< skipped: no successful bind yet
};

const char* toString(UpdateStatus status);

/// What skins of several bodies with one cage may share: see `SoftBodySkin::binding`.
using SoftBodyBinding = SkinBinding<btScalar>;

/// A render mesh carried by a soft body: bind once at rest, update after each step.
///
///     SoftBodySkin skin;
///     EmbedReport fit = skin.bind(*body, cage, mesh);
///     ...
///     if (world->stepSimulation(dt, 4, dt / 4) > 0) skin.update();
///
/// Works in every Bullet world and for a body in none; a skin only reads its body. Update after stepSimulation, not in
/// a tick callback: there is no callback at which the positions are final in all worlds. A body that was moved, scaled
/// or teleported by hand simply needs the next update. Several skins may share a body, and several bodies a binding.
/// The body must outlive the skin's last update: once it is gone, `update` and `setVisible(true)` would read freed
/// memory, while all else may be called, `bind` to another body included. A skin may be moved, not copied.
class SoftBodySkin {
 public:
  SoftBodySkin() = default;
  SoftBodySkin(SoftBodySkin&&) = default;
  SoftBodySkin& operator=(SoftBodySkin&&) = default;

  /// Embeds the mesh in the rest cage and updates once.
  ///
  /// body      has the cage's nodes, in the cage's order, wherever they are now
  /// restCage  rest space, near the origin best; its tets count, not the body's
  /// mesh      in the cage's rest space
  /// Returns   the fit; if its status is not ok, this skin is left as it was
  /// Cost      see `embed`, and `QuadraticStencils` for quadratic skinning; allocates
  [[nodiscard]] EmbedReport bind(const btSoftBody& body, const TetMesh& restCage, const TriangleMesh& mesh,
                                 const SkinOptions& options = {});
  /// The same for vertices alone: no triangles, hence no recomputed normals.
  [[nodiscard]] EmbedReport bind(const btSoftBody& body, const TetMesh& restCage, PointView<const double> vertices,
                                 const SkinOptions& options = {});
  /// The same with the body's nodes as they are now for rest: the mesh must fit the body where it is. Refused once
  /// Bullet's own tets dangle: see `checkDangling`.
  [[nodiscard]] EmbedReport bind(const btSoftBody& body, const TriangleMesh& mesh, const SkinOptions& options = {});
  /// The same with a binding made before, such as another skin's, under the same options.
  Status bind(const btSoftBody& body, std::shared_ptr<const SoftBodyBinding> binding, const SkinOptions& options = {});

  /// Computes the current positions, and normals if asked for. Cost O(vertexCount + nodeCount); allocates nothing. A
  /// sleeping body costs a look at a few of its nodes, a hidden skin nothing.
  UpdateStatus update();

  /// `update` for several skins in turn, which asks memory early for what the next ones will read: with many sleeping
  /// bodies, waiting for that is most of the cost. Returns how many were updated.
  /// skins     `count` of them, not null, of any bodies
  /// statuses  if given, receives as many: what `update` did
  static std::size_t updateAll(SoftBodySkin* const* skins, std::size_t count, UpdateStatus* statuses = nullptr);

  /// A sleeping body is looked at in four nodes only, not in one plane, one of which at least moves in every teleport,
  /// turn, stretch or other affine motion of the whole body. After moving other nodes by hand, say so: the next update
  /// will not skip.
  void markMoved() { moved_ = true; }
  /// A skin that is not visible is not updated; shown again, it is at once. Visible to begin with.
  void setVisible(bool visible);
  bool visible() const { return visible_; }

  /// vertexCount current positions, world space minus origin, in the options' order: the skin's own array. Empty where
  /// the target is the caller's.
  PointView<const btScalar> positions() const { return skin_.positions(); }
  /// Of the update before, if asked for: see MeshSkin. The current ones after bind, after any update that was skipped
  /// (a sleeping body has no motion) and when shown again; on frames without a call of `update`, nothing has moved
  /// either.
  PointView<const btScalar> previousPositions() const { return skin_.previousPositions(); }
  /// vertexCount current unit normals, and tangents, likewise; empty if not asked for.
  PointView<const float> normals() const { return skin_.normals(); }
  PointView<const float> tangents() const { return skin_.tangents(); }
  /// Box of the positions, for culling. An extrapolated vertex may lie outside the soft body's own box.
  const Box3& bounds() const { return skin_.bounds(); }
  /// To share; null before a successful bind.
  const std::shared_ptr<const SoftBodyBinding>& binding() const { return skin_.binding(); }
  /// How well the cage supports quadratic skinning; of the last bind that made a binding with it.
  const QuadraticReport& quadraticReport() const { return quadraticReport_; }
  /// The first such node when `update` last returned NonFinite.
  std::size_t firstBadNode() const { return firstBadNode_; }
  /// Moves the origin for the updates to come. Returns false, and leaves it, if it is not finite or beyond 1e18.
  bool setOrigin(const btVector3& origin);

 private:
  /// A node of the last update.
  struct Sample {
    int node = 0;
    btScalar position[3] = {};
  };

  UpdateStatus decide();
  static void decideAll(SoftBodySkin* const* skins, std::size_t count, UpdateStatus* statuses);
  UpdateStatus compute();
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
  bool moved_ = false;
  std::array<Sample, 4> samples_;
  std::size_t firstBadNode_ = 0;
  MeshSkin<btScalar> skin_;
  QuadraticReport quadraticReport_;
};

}  // namespace tetskin
