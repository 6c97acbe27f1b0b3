// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/embedding.h>
#include <tetskin/core/parallel_for.h>
#include <tetskin/core/src/normals/normals.h>
#include <tetskin/core/src/normals/recomputed_normals.h>
#include <tetskin/core/src/skinning/kept_steps.h>
#include <tetskin/core/src/skinning/moved_parts.h>
#include <tetskin/core/src/skinning/quadratic_skinning.h>
#include <tetskin/core/src/skinning/skinning.h>
#include <tetskin/core/triangle_mesh.h>
#include <tetskin/core/types.h>

#include <limits>
#include <memory>
#include <optional>
#include <variant>
#include <vector>

namespace tetskin {

/// How the surface follows the nodes.
enum class Interpolation {
  Linear,     ///< barycentric in each tet: continuous, but bent surfaces show the cage's faces
  Quadratic,  ///< smooth to the eye, an order more accurate, at 2.4 to 3 times the cost of an update
};

/// Where the positions go: nowhere else (the skin's own array, the default), or to the caller's buffer of float or
/// double points, which must hold vertexCount points and outlive the binding.
using SkinTarget = std::variant<std::monostate, PointView<float>, PointView<double>>;

/// What a scene does not ask for is neither allocated nor computed.
struct SkinOptions {
  Interpolation interpolation = Interpolation::Linear;
  Normals normals = Normals::None;
  OutsideRule outside = OutsideRule::Nearest;
  /// A vertex farther than this from every tet is refused: nothing is bound, and the report says which one, and where.
  double maxDistance = std::numeric_limits<double>::infinity();
  /// Of positions, normals and tangents.
  VertexOrder order = VertexOrder::Mesh;
  /// Angle between rest normals at one position above which recomputed normals keep a hard edge; not below 0.
  double hardEdgeDegrees = kHardEdgeDegrees;
  /// Keep the box of the positions up to date.
  bool bounds = true;
  /// Keep the positions of the update before, for motion vectors. Of the skin's own array only: not with `target`.
  bool previousPositions = false;
  /// Leave out the parts of the mesh whose nodes have not moved since the last update, such as those around pinned
  /// nodes; recomputed normals only if none has. The targets must then keep what was last written to them. Pays where
  /// much of a body stays in place to the last bit. Not with `bounds` or `previousPositions`, which need all positions.
  bool skipStill = false;
  SkinTarget target;
  /// Instead of the skin's own arrays; each must hold vertexCount points. `tangentTarget` gets three floats a vertex;
  /// the sign that belongs to them (TriangleMesh::tangents) does not change. No target is ever read. `bind` fills these
  /// two with unit vectors, and where a direction collapses to nothing, an update may leave what it last wrote there.
  PointView<float> normalTarget;
  PointView<float> tangentTarget;
  /// World space, within kLargestCoordinate; subtracted from every position. Near the body, it keeps float positions
  /// exact far from the origin.
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  /// Lends its threads to updates of large meshes; must outlive the binding.
  ParallelFor* threads = nullptr;
};

/// All that skins of one mesh in one cage have in common, whatever body carries them: made once, immutable, shared.
template <class Scalar>
struct SkinBinding {
  Embedding embedding;
  VertexOrder order = VertexOrder::Mesh;  ///< of `recomputed`
  std::optional<QuadraticStencils<Scalar>> quadratic;
  std::optional<DirectionFactors> normals;   ///< of transformed normals
  std::optional<DirectionFactors> tangents;  ///< likewise, if the mesh has tangents
  std::optional<NormalTopology> recomputed;  ///< of recomputed normals
};

/// The report of a mesh that could not be bound: the status says why, and no vertex is.
EmbedReport refused(const TriangleMesh& mesh, Status status);

/// Ok if a surface can follow these nodes: NonFinite names the first that is not finite, or beyond kLargestCoordinate.
template <class Scalar>
Status checkNodes(PointView<const Scalar> nodes);

/// Embeds the mesh in the cage at rest, with all that the options' interpolation, normals and order need.
/// Errors in the report's status, as `embed`'s; before anything is embedded, SizeMismatch if the mesh's normals or
/// tangents, or the points of a target, are not one a vertex, and InvalidOption for options that make no sense, or do
/// not go together.
template <class Scalar>
[[nodiscard]] EmbedReport makeSkinBinding(const TetMesh& cage, const TriangleMesh& mesh, const SkinOptions& options,
                                          std::shared_ptr<const SkinBinding<Scalar>>& binding,
                                          QuadraticReport* quadratic = nullptr);
/// The same with a copy of an embedding made before, such as a loaded one; the options' rule for vertices outside, and
/// how far they may be, were its maker's to choose. Errors: SizeMismatch if mesh or cage differ in count from what was
/// embedded; those of the mesh as above.
template <class Scalar>
Status makeSkinBinding(const TetMesh& cage, const TriangleMesh& mesh, const SkinOptions& options,
                       const Embedding& embedding, std::shared_ptr<const SkinBinding<Scalar>>& binding,
                       QuadraticReport* quadratic = nullptr);

/// A render mesh carried by the nodes of a cage, whoever moves them: bind once at rest, update with their positions.
/// For Bullet's soft bodies there is `SoftBodySkin`, which does just this with their nodes.
template <class Scalar>
class MeshSkin {
 public:
  /// Embeds the mesh, and updates once with the cage's rest nodes. On an error this skin is left as it was.
  [[nodiscard]] EmbedReport bind(const TetMesh& cage, const TriangleMesh& mesh, const SkinOptions& options = {});
  /// Takes a binding made before; `nodes` are the current ones, finite.
  /// Errors: InvalidOption if it lacks what the options ask for, or they make no sense, or do not go together;
  /// SizeMismatch for a target, or nodes, of another size; NonFinite as `checkNodes`.
  Status bind(std::shared_ptr<const SkinBinding<Scalar>> binding, PointView<const Scalar> nodes,
              const SkinOptions& options = {});

  /// Computes positions, normals and tangents for these node positions, world space, nodeCount x 3. Allocates nothing.
  /// Returns the index of the first node that is not finite, or beyond kLargestCoordinate, and changes nothing then;
  /// nodeCount() if all is well.
  [[nodiscard]] std::size_t update(PointView<const Scalar> nodes);
  /// The same for the nodes between two steps: see KeptSteps::nodesAt. `steps` are of nodeCount() nodes.
  [[nodiscard]] std::size_t update(const KeptSteps<Scalar>& steps, Scalar alpha);

  bool bound() const { return binding_ != nullptr; }
  std::size_t nodeCount() const { return nodes_.size(); }
  /// vertexCount current positions, minus the origin, in the options' order: the skin's own array, empty where the
  /// target is the caller's.
  PointView<const Scalar> positions() const { return viewOf(positions_); }
  /// vertexCount positions of the update before, minus its origin, in the same order; empty if not asked for. The
  /// current ones after bind, after `hold`, and where an update failed. With this option the two arrays change places
  /// at every update, so ask for both views after it. Costs 3 scalars a vertex, and no time.
  PointView<const Scalar> previousPositions() const {
    return options_.previousPositions && held_ ? viewOf(positions_) : viewOf(previous_);
  }
  /// Nothing has moved since the last update, or is to count as motion: the previous positions are the current ones
  /// until the next update. Free.
  void hold() { held_ = true; }
  /// vertexCount current unit normals, and tangents, likewise; empty if not asked for.
  PointView<const float> normals() const { return viewOf(normals_); }
  PointView<const float> tangents() const { return viewOf(tangents_); }
  /// Box of the positions, for culling. An extrapolated vertex may lie outside the cage's own box.
  const Box3& bounds() const { return bounds_; }
  const std::shared_ptr<const SkinBinding<Scalar>>& binding() const { return binding_; }
  /// For the updates to come. Returns false, and keeps the one there is, if it is not finite or beyond
  /// kLargestCoordinate.
  bool setOrigin(const Eigen::Vector3d& origin);

 private:
  template <class Out>
  void skinTo(PointView<Out> out);
  void skinDirections();
  const QuadraticStencils<Scalar>* stencils() const;
  PointView<float> normalsOut();
  PointView<float> tangentsOut();
  void prepareArrays(std::size_t vertexCount);

  // What a skin that is skipped needs comes first: see SoftBodySkin.
  std::shared_ptr<const SkinBinding<Scalar>> binding_;
  bool held_ = true;  ///< previous_ is not to be shown
  SkinOptions options_;
  PackedNodes<Scalar> nodes_;
  EdgeVectors<Scalar> edges_;
  MovedParts<Scalar> moved_;  ///< with skipStill
  std::vector<Eigen::Matrix<Scalar, 3, 1>> positions_, previous_;
  std::vector<Eigen::Vector3f> normals_, tangents_;
  std::vector<Scalar> padded_;   ///< positions, for recomputed normals
  std::vector<Scalar> scratch_;  ///< of positions, where they are not written directly
  std::vector<Eigen::Vector3f> normalScratch_, tangentScratch_;
  Box3 bounds_;
};

}  // namespace tetskin
