// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/embedding.h>
#include <tetskin/core/mesh.h>
#include <tetskin/core/types.h>

#include <limits>
#include <memory>
#include <string>
#include <variant>
#include <vector>

namespace tetskin {

/// How the surface follows the nodes.
enum class Interpolation {
  Linear,     ///< barycentric in each tet: continuous, but bent surfaces show the cage's faces
  Quadratic,  ///< visually smooth, one order more accurate, at 2.4 to 3 times the cost of an update; the map itself
              ///< within quadratic tets (see `Cage::quadraticTet`)
};

/// How a skin's normals are computed.
enum class Normals {
  None,         ///< no normals: no memory, no time
  Transformed,  ///< rest normals transformed by the deformation gradient: keeps all detail of authored normals
  Recomputed,   ///< from the deformed triangles, weighted by area: also correct where the surface folds within a tet
};

/// Default of `BindingOptions::hardEdgeDegrees`. Smaller angles between normals at one position come from rounding, in
/// the file or of a smooth normal; between facets of a smooth surface the angle is larger.
constexpr double kHardEdgeDegrees = 5.0;

/// Options that determine the surface, fixed when the binding is created. Data that is not requested is neither
/// allocated nor computed.
struct BindingOptions {
  Interpolation interpolation = Interpolation::Linear;  ///< how the surface follows the nodes
  Normals normals = Normals::None;                      ///< how normals are computed
  OutsideRule outside = OutsideRule::Nearest;           ///< which tet carries a vertex outside the cage
  /// Rest units, 0 or more. If a vertex is farther than this from every tet, the mesh is refused with OutsideCage:
  /// nothing is bound, and the message names the vertex and its position.
  double maxDistance = std::numeric_limits<double>::infinity();
  /// Order of positions, normals and tangents.
  VertexOrder order = VertexOrder::Mesh;
  /// Degrees, not below 0: angle between rest normals at one position above which recomputed normals keep a hard edge.
  double hardEdgeDegrees = kHardEdgeDegrees;
};

/// Where positions are written: only to the skin's own array (the default), or to the caller's buffer of float or
/// double points, which must have vertexCount points and outlive the skin's last update.
using SkinTarget = std::variant<std::monostate, PointView<float>, PointView<double>>;

/// Options of one skin. They can leave out parts of the binding, but not add to it.
struct InstanceOptions {
  bool disableQuadratic = false;  ///< use linear skinning with a quadratic binding
  bool disableNormals = false;    ///< compute neither normals nor tangents
  /// Keep the box of the positions up to date.
  bool bounds = true;
  /// Keep the positions of the previous update, for motion vectors. Available for the skin's own array only, not with
  /// `target`.
  bool previousPositions = false;
  /// Destination of the positions; by default the skin's own array.
  SkinTarget target;
  /// Destination of the normals, instead of the skin's own array: vertexCount points, owned by the caller. The skin
  /// never reads a target. `bind` fills it with unit vectors; if a direction collapses to zero length, an update may
  /// leave the value written last. If the binding has no such data, a target is left untouched.
  PointView<float> normalTarget;
  PointView<float> tangentTarget;  ///< destination of the tangents, with the same rules: three floats per vertex; the
                                   ///< sign in TriangleMesh::tangents does not change
  /// World space, within Limits::kMaxCoordinate; subtracted from every position. An origin near the body keeps float
  /// positions accurate far from the world's origin.
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  /// Threads for updates of large meshes; not owned, must outlive the skin's last update. Null: none.
  ParallelFor* threads = nullptr;
};

/// Options of a binding and a skin, to create both in one call.
struct SkinOptions : BindingOptions, InstanceOptions {};

/// How well the cage supports a quadratic surface. If the neighbourhood of a node does not determine some second
/// derivatives (a cage one cell thick, a fin, a single tet), the surface is linear in those directions.
struct TETSKIN_CORE_API QuadraticReport {
  std::size_t nodes = 0;                 ///< nodes of tets that carry vertices: each needs a gradient
  std::size_t underdeterminedNodes = 0;  ///< of these, nodes whose neighbourhood is too thin for all second derivatives
  std::size_t averagedNodes =
      0;                  ///< of these, nodes without even a linear fit, which use the mean of the tets' gradients
  std::size_t edges = 0;  ///< cage edges that carry a vector
  double meanNeighbours = 0.0;  ///< mean number of other nodes that a node's gradient is fitted to
  double milliseconds = 0.0;    ///< wall time of the build

  /// Readable summary in one line.
  std::string describe() const;
};

template <class Scalar>
struct SkinData;

/// The common data of all skins of one mesh in one cage, whichever body carries them: created once, immutable, shared.
template <class Scalar>
class TETSKIN_CORE_API SkinBinding {
 public:
  using Pointer = std::shared_ptr<const SkinBinding>;  ///< shared ownership by all skins that use the binding

  /// Embeds the mesh in the cage at rest, and precomputes what the options need; of the cage it keeps only the rest
  /// nodes.
  /// report  of the fit, written if not null, also on failure
  /// Errors  those of `embed`; before anything is embedded, SizeMismatch if the mesh's normals or tangents are not one
  ///         per vertex, and InvalidOption for a hardEdgeDegrees below 0 or NaN
  static Result<Pointer> create(const Cage& cage, const TriangleMesh& mesh, const BindingOptions& options = {},
                                EmbedReport* report = nullptr);
  /// Uses an existing embedding, such as a loaded one; `options.outside` and `options.maxDistance` have no effect,
  /// because they were applied when the embedding was made.
  /// Errors  SizeMismatch if mesh or cage differ in count from those of the embedding; those of `validate(const
  ///         TetMesh&)`, and of `quadraticTets` for a quadratic surface; for mesh and options, those of the other
  ///         overload
  static Result<Pointer> create(const Cage& cage, const TriangleMesh& mesh, const BindingOptions& options,
                                const Embedding& embedding);
  ~SkinBinding();

  /// The options given to `create`. For a binding of an existing embedding, `outside` and `maxDistance` may differ from
  /// those with which the embedding was made.
  const BindingOptions& options() const;
  const Embedding& embedding() const;  ///< which tet carries which vertex, with its weights
  /// How well the cage supports a quadratic surface; all 0 for a linear one.
  const QuadraticReport& quadraticReport() const;

 private:
  friend struct Access<SkinBinding>;
  explicit SkinBinding(std::unique_ptr<const SkinData<Scalar>> data);
  std::unique_ptr<const SkinData<Scalar>> data_;  ///< never null
};

/// The nodes of a body after its last two steps, for an application that draws frames between steps. Takes no memory
/// until a step is recorded, then six scalars per node; each skin has its own history.
template <class Scalar>
class TETSKIN_CORE_API StepHistory {
 public:
  /// Records the nodes after a step (nodeCount x 3, world space); those recorded before become the previous step.
  /// Returns true if there are two steps to interpolate between: not at the first call, nor after `clear`, nor if a
  /// node of either step is not finite or beyond Limits::kMaxCoordinate. Allocates at the first call, and when the
  /// number of nodes changes, which starts a new history. Cost O(nodes).
  bool record(PointView<const Scalar> nodes);
  /// Starts a new history: the next recorded step does not continue the last one, for instance after a teleport.
  void clear() { usable_ = between_ = false; }

  std::size_t size() const { return last_.size(); }  ///< number of nodes recorded
  bool empty() const { return last_.empty(); }       ///< true if no step is recorded
  /// Writes the nodes interpolated linearly between the previous step and the last one; those of the last step if there
  /// is no previous one. World space.
  /// alpha  0: the previous step, 1: the last step, bit-identical; clamped to this range; NaN counts as 1
  /// out    size() x 3, owned by the caller, any stride
  void nodesAt(Scalar alpha, PointView<Scalar> out) const;
  /// One node, below size(), interpolated as by `nodesAt`; world space.
  Eigen::Matrix<Scalar, 3, 1> nodeAt(std::size_t node, Scalar alpha) const;

 private:
  std::vector<Eigen::Matrix<Scalar, 3, 1>> before_, last_;
  bool usable_ = false;   ///< the next step can continue from last_
  bool between_ = false;  ///< last_ has continued from before_
};

/// A render mesh carried by the nodes of a cage, however they are moved: bind once at rest, update with the node
/// positions. For Bullet's soft bodies use `SoftBodySkin`. Can be moved, not copied.
template <class Scalar>
class TETSKIN_CORE_API MeshSkin {
 public:
  using Binding = typename SkinBinding<Scalar>::Pointer;  ///< a binding, shared

  /// An unbound skin.
  MeshSkin() = default;
  MeshSkin(MeshSkin&& other) noexcept = default;             ///< the other one is unbound afterwards
  MeshSkin& operator=(MeshSkin&& other) noexcept = default;  ///< the other one is unbound afterwards

  /// Creates a binding, and updates once with the cage's rest nodes. Returns the fit. This skin is left unchanged on an
  /// error; for a report of a failed fit, call `SkinBinding::create`.
  /// Errors: those of `SkinBinding::create`; before anything is embedded, those that the other `bind` reports for
  /// options.
  Result<EmbedReport> bind(const Cage& cage, const TriangleMesh& mesh, const SkinOptions& options = {});
  /// Shares an existing binding; `nodes` are the current ones, nodeCount x 3, world space. This skin is left unchanged
  /// on an error.
  /// Errors: Empty without a binding; InvalidOption for options out of range or in conflict; SizeMismatch for a target,
  /// or nodes, of the wrong size; NonFinite for a node that is not finite or beyond Limits::kMaxCoordinate.
  Status bind(Binding binding, PointView<const Scalar> nodes, const InstanceOptions& options = {});
  /// Deleted: the options of the surface were fixed when the binding was created; pass InstanceOptions.
  template <class Options, class = std::enable_if_t<std::is_same_v<Options, SkinOptions>>>
  Status bind(Binding binding, PointView<const Scalar> nodes, const Options& options) = delete;

  /// Computes positions, normals and tangents for these node positions, nodeCount x 3, world space. Allocates nothing;
  /// cost O(vertexCount + nodeCount). On an error the results of the last update stay.
  /// Errors: NonFinite, see `firstNonFiniteNode`; TopologyChanged for another number of nodes; Unbound.
  StatusCode update(PointView<const Scalar> nodes);
  /// Updates with the nodes between two recorded steps, see StepHistory::nodesAt; errors as for the other `update`.
  StatusCode update(const StepHistory<Scalar>& steps, Scalar alpha);
  /// Index of the first node that was not finite, or beyond Limits::kMaxCoordinate, in the last update that returned
  /// NonFinite.
  std::size_t firstNonFiniteNode() const;

  bool bound() const { return impl_ != nullptr; }  ///< true after a successful `bind`
  std::size_t nodeCount() const;                   ///< number of nodes that an update takes; 0 if unbound
  /// The interpolation in use: Linear also if `disableQuadratic` was set, and before a successful bind.
  Interpolation interpolation() const;
  /// vertexCount current positions, world space minus the origin, in the binding's order. Owned by the skin; empty if
  /// `InstanceOptions::target` is set.
  PointView<const Scalar> positions() const;
  /// vertexCount positions of the previous update, world space minus the origin at that time, in the binding's order;
  /// empty if not requested. They equal the current ones after `bind`, after `clearMotion`, and after a failed update.
  /// With this option the two arrays are exchanged at every update, so get both views again after it. Costs 3 scalars
  /// per vertex, and no time.
  PointView<const Scalar> previousPositions() const;
  /// Declares that there was no motion since the last update: until the next update, the previous positions equal the
  /// current ones. Cost O(1).
  void clearMotion() { motionCleared_ = true; }
  /// vertexCount current unit normals in the binding's order; empty if not requested, or if `normalTarget` is set.
  PointView<const float> normals() const;
  /// vertexCount current unit tangents in the binding's order; empty if not requested, or if `tangentTarget` is set.
  PointView<const float> tangents() const;
  /// Bounding box of the positions, for culling. An extrapolated vertex may lie outside the cage's own box.
  const Box3& bounds() const;
  /// The binding, for sharing; null before a successful bind.
  Binding binding() const;
  /// Sets the origin, world space, for later updates. Error: InvalidOption if it is not finite or beyond
  /// Limits::kMaxCoordinate; the origin is then unchanged.
  Status setOrigin(const Eigen::Vector3d& origin);

 private:
  struct Impl;
  std::shared_ptr<Impl> impl_;  ///< null: not bound; never shared
  bool motionCleared_ = true;   ///< hides the previous positions
};

}  // namespace tetskin
