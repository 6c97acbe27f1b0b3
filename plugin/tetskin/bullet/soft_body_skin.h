// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/bullet/soft_body_adapter.h>
#include <tetskin/core/embedding.h>
#include <tetskin/core/linear_skinning.h>
#include <tetskin/core/triangle_mesh.h>
#include <tetskin/core/types.h>

#include <memory>
#include <variant>
#include <vector>

namespace tetskin {

/// What an update did. Only after `Updated` are there new positions; otherwise the last good surface stands.
enum class UpdateStatus {
  Updated,
  Asleep,           ///< skipped: the body sleeps and no node has moved since the last update
  NonFinite,        ///< skipped: a node position is infinite or not a number; the simulation has exploded
  TopologyChanged,  ///< skipped: the body has gained or lost nodes or tets since bind; bind again
  Unbound,          ///< skipped: no successful bind yet
};

const char* toString(UpdateStatus status);

/// Where the positions go: nowhere else (the skin's own array, the default), or to the caller's buffer of float or
/// double points, which must hold vertexCount points and outlive the binding.
using SkinTarget = std::variant<std::monostate, PointView<float>, PointView<double>>;

struct SkinOptions {
  OutsideRule outside = OutsideRule::Nearest;
  SkinTarget target;
  /// World space; subtracted from every position. Near the body, it keeps float positions exact far from the origin.
  btVector3 origin = btVector3(0, 0, 0);
};

/// A render mesh carried by a soft body: bind once at rest, update after each step.
///
///     SoftBodySkin skin;
///     EmbedReport fit = skin.bind(*body, cage, mesh);
///     ...
///     if (world->stepSimulation(dt, 4, dt / 4) > 0) skin.update();
///
/// Works in every Bullet world and for a body in none; a skin only reads its body. Update after stepSimulation, not in
/// a tick callback: there is no callback at which the positions are final in all worlds. A body that was moved, scaled
/// or teleported by hand simply needs the next update. Several skins may share a body, and several bodies an embedding.
/// The body must outlive the skin's last update; a skin may be moved, not copied.
class SoftBodySkin {
 public:
  SoftBodySkin() = default;
  SoftBodySkin(SoftBodySkin&&) = default;
  SoftBodySkin& operator=(SoftBodySkin&&) = default;

  /// Embeds the mesh in the rest cage and updates once.
  ///
  /// body      has the cage's nodes, in the cage's order, wherever they are now
  /// restCage  rest space, near the origin best; its tets count, not the body's
  /// vertices  vertexCount x 3, the cage's rest space
  /// Returns   the fit; if its status is not ok, this skin is left as it was
  /// Cost      see `embed`; allocates
  [[nodiscard]] EmbedReport bind(const btSoftBody& body, const TetMesh& restCage, PointView<const double> vertices,
                                 const SkinOptions& options = {});
  [[nodiscard]] EmbedReport bind(const btSoftBody& body, const TetMesh& restCage, const TriangleMesh& mesh,
                                 const SkinOptions& options = {});
  /// The same with the body's nodes as they are now for rest: the mesh must fit the body where it is.
  [[nodiscard]] EmbedReport bind(const btSoftBody& body, const TriangleMesh& mesh, const SkinOptions& options = {});
  /// The same with an embedding made before, such as another skin's.
  Status bind(const btSoftBody& body, std::shared_ptr<const Embedding> embedding, const SkinOptions& options = {});

  /// Computes the current positions. Cost O(vertexCount + nodeCount); allocates nothing. A sleeping body whose nodes
  /// have not moved costs one comparison of its nodes.
  UpdateStatus update();

  /// vertexCount current positions, world space minus origin, in the mesh's order: the skin's own array. Empty where
  /// the target is the caller's.
  PointView<const btScalar> positions() const { return viewOf(positions_); }
  /// Box of the positions, for culling. An extrapolated vertex may lie outside the soft body's own box.
  const Box3& bounds() const { return bounds_; }
  /// The binding, to share; null before a successful bind.
  const std::shared_ptr<const Embedding>& embedding() const { return embedding_; }
  /// Moves the origin for the updates to come.
  void setOrigin(const btVector3& origin);

 private:
  bool nodesUnmoved() const;
  void skin();

  const btSoftBody* body_ = nullptr;
  int nodeCount_ = 0;
  int tetCount_ = 0;
  std::shared_ptr<const Embedding> embedding_;
  SkinTarget target_;
  Eigen::Matrix<btScalar, 3, 1> origin_ = Eigen::Matrix<btScalar, 3, 1>::Zero();
  bool originMoved_ = false;
  PackedNodes<btScalar> nodes_;
  std::vector<Eigen::Matrix<btScalar, 3, 1>> positions_;
  Box3 bounds_;
};

}  // namespace tetskin
