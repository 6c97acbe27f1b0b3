// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/embedding.h>
#include <tetskin/core/parallel_for.h>
#include <tetskin/core/triangle_mesh.h>
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
  Quadratic,  ///< smooth to the eye, an order more accurate, at 2.4 to 3 times the cost of an update
};

/// Where a skin's normals come from.
enum class Normals {
  None,         ///< nowhere: no memory, no time
  Transformed,  ///< the rest normals, carried by the gradient of the map: keeps all detail of authored normals
  Recomputed,   ///< the deformed triangles, weighted by area: also right where the surface folds within a tet
};

/// Normals that differ by more than this at one position make a hard edge. Below, they are a smooth normal's rounding,
/// or that of a file; a facet of a smooth surface turns more.
constexpr double kHardEdgeDegrees = 5.0;

/// What shapes the surface: told once, when the binding is made. What is not asked for is neither allocated nor
/// computed.
struct BindingOptions {
  Interpolation interpolation = Interpolation::Linear;  ///< how the surface follows the nodes
  Normals normals = Normals::None;                      ///< which normals there are
  OutsideRule outside = OutsideRule::Nearest;           ///< which tet carries a vertex outside the cage
  /// A vertex farther than this from every tet is refused: nothing is bound, and the message says which one, and where.
  double maxDistance = std::numeric_limits<double>::infinity();
  /// Of positions, normals and tangents.
  VertexOrder order = VertexOrder::Mesh;
  /// Angle between rest normals at one position above which recomputed normals keep a hard edge; not below 0.
  double hardEdgeDegrees = kHardEdgeDegrees;
};

/// Where the positions go: nowhere else (the skin's own array, the default), or to the caller's buffer of float or
/// double points, which must hold vertexCount points and outlive the skin's last update.
using SkinTarget = std::variant<std::monostate, PointView<float>, PointView<double>>;

/// What one skin does with a binding. It may leave out what the binding has, never add to it.
struct InstanceOptions {
  bool leaveOutQuadratic = false;  ///< linear in spite of a quadratic binding
  bool leaveOutNormals = false;    ///< neither normals nor tangents
  /// Keep the box of the positions up to date.
  bool bounds = true;
  /// Keep the positions of the update before, for motion vectors. Of the skin's own array only: not with `target`.
  bool previousPositions = false;
  /// Instead of the skin's own array.
  SkinTarget target;
  /// These two instead of the skin's own arrays; each must hold vertexCount points. `tangentTarget` gets three floats a
  /// vertex; the sign that belongs to them (TriangleMesh::tangents) does not change. No target is ever read. `bind`
  /// fills these two with unit vectors, and where a direction collapses to nothing, an update may leave what it last
  /// wrote there. The target of what there is not, as of normals that the binding lacks, is left alone.
  PointView<float> normalTarget;
  PointView<float> tangentTarget;  ///< see `normalTarget`
  /// World space, within kLargestCoordinate; subtracted from every position. Near the body, it keeps float positions
  /// exact far from the origin.
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  /// Lends its threads to updates of large meshes; must outlive the skin's last update.
  ParallelFor* threads = nullptr;
};

/// Both, to bind in one call.
struct SkinOptions : BindingOptions, InstanceOptions {};

/// How well the cage supports a quadratic surface. Where the neighbourhood of a node does not tell some second
/// derivatives apart (a cage one cell thick, a fin, a single tet), the surface is linear in those directions.
struct TETSKIN_CORE_API QuadraticReport {
  std::size_t nodes = 0;        ///< nodes that need a gradient: those of the tets that carry vertices
  std::size_t thinNodes = 0;    ///< of these, with a neighbourhood too thin for all second derivatives
  std::size_t plainNodes = 0;   ///< of these, without even a linear fit: the mean of the tets' gradients instead
  std::size_t edges = 0;        ///< cage edges that carry a vector
  double meanNeighbours = 0.0;  ///< others that a node's gradient is fitted to
  double milliseconds = 0.0;    ///< wall time of the build

  /// One line for people.
  std::string describe() const;
};

template <class Scalar>
struct SkinParts;

/// All that skins of one mesh in one cage have in common, whatever body carries them: made once, immutable, shared.
template <class Scalar>
class TETSKIN_CORE_API SkinBinding {
 public:
  using Pointer = std::shared_ptr<const SkinBinding>;  ///< shared by all skins that have it

  /// Embeds the mesh in the cage at rest, with all that the options need.
  /// report  of the fit, written if not null, on failure too
  /// Errors  `embed`'s; before anything is embedded, SizeMismatch if the mesh's normals or tangents are not one a
  ///         vertex, and InvalidOption for a hardEdgeDegrees below 0 or NaN
  static Result<Pointer> make(const Cage& cage, const TriangleMesh& mesh, const BindingOptions& options = {},
                              EmbedReport* report = nullptr);
  /// The same with an embedding made before, such as a loaded one; the options' rule for vertices outside, and how far
  /// they may be, were its maker's to choose. Errors: SizeMismatch if mesh or cage differ in count from what was
  /// embedded; those of `usable`; those of the mesh and the options as above.
  static Result<Pointer> make(const Cage& cage, const TriangleMesh& mesh, const BindingOptions& options,
                              const Embedding& embedding);
  ~SkinBinding();

  /// As they were given; what an embedding made before was made with, it does not tell.
  const BindingOptions& options() const;
  const Embedding& embedding() const;  ///< which tet carries which vertex, and how
  /// How well the cage supports a quadratic surface; all 0 for a linear one.
  const QuadraticReport& quadraticReport() const;
  /// For the library's own use.
  const SkinParts<Scalar>& parts() const { return *parts_; }

 private:
  explicit SkinBinding(std::unique_ptr<const SkinParts<Scalar>> parts);
  std::unique_ptr<const SkinParts<Scalar>> parts_;
};

/// What an update did. Only after `Updated` are there new positions; otherwise the last good surface stands.
enum class [[nodiscard]] UpdateStatus{
    Updated,
    Asleep,           ///< skipped: the body sleeps and has not been moved since the last update
    Hidden,           ///< skipped: the skin is not visible
    NonFinite,        ///< skipped: a node is infinite, not a number or beyond 1e18; the simulation has exploded
    TopologyChanged,  ///< skipped: the body has gained or lost nodes or tets since bind; bind again
    Unbound,          ///< skipped: no successful bind yet
};

/// Name of a status, for messages and logs. Never null.
TETSKIN_CORE_API const char* toString(UpdateStatus status);

/// The nodes of a body after its last two steps, for an application that draws frames between them. No memory until a
/// step is kept, then six scalars a node; each skin has its own.
template <class Scalar>
class TETSKIN_CORE_API KeptSteps {
 public:
  /// Keeps the nodes as they are after a step, world space, and lets those kept last be the step before. Returns
  /// whether there are both, so that there is something between them: not the first time, nor after `forget`, nor while
  /// a node of either is not finite or beyond kLargestCoordinate. Allocates the first time, or for another number of
  /// nodes, which begins anew. Cost O(nodes).
  bool keep(PointView<const Scalar> nodes);
  /// The next step does not begin where the last one ended: after a teleport, say.
  void forget() { usable_ = between_ = false; }

  std::size_t size() const { return last_.size(); }  ///< nodes that are kept
  bool empty() const { return last_.empty(); }       ///< no step was kept
  /// Writes the step before plus alpha times the way to the last one; the last one where there is none before.
  /// alpha  from 0 to 1, where the result is the last step's to the bit; counts as the nearer of the two beyond them,
  ///        and as 1 if it is not a number
  /// out    size() x 3, of the caller's, any stride
  void nodesAt(Scalar alpha, PointView<Scalar> out) const;
  /// The same of one node, below size().
  Eigen::Matrix<Scalar, 3, 1> nodeAt(std::size_t node, Scalar alpha) const;

 private:
  std::vector<Eigen::Matrix<Scalar, 3, 1>> before_, last_;
  bool usable_ = false;   ///< last_ is where the next step begins
  bool between_ = false;  ///< so was before_ for last_
};

/// A render mesh carried by the nodes of a cage, whoever moves them: bind once at rest, update with their positions.
/// For Bullet's soft bodies there is `SoftBodySkin`, which does just this with their nodes. May be moved, not copied.
template <class Scalar>
class TETSKIN_CORE_API MeshSkin {
 public:
  using Binding = typename SkinBinding<Scalar>::Pointer;  ///< to share

  /// Bound to nothing.
  MeshSkin();
  ~MeshSkin();
  MeshSkin(MeshSkin&& other) noexcept;
  MeshSkin& operator=(MeshSkin&& other) noexcept;

  /// Makes a binding, and updates once with the cage's rest nodes. Returns the fit; on an error this skin is left as it
  /// was, and what was known of the fit by then is told by `SkinBinding::make` alone. Errors: those of
  /// `SkinBinding::make`, and before anything is embedded those of the other `bind`.
  Result<EmbedReport> bind(const Cage& cage, const TriangleMesh& mesh, const SkinOptions& options = {});
  /// Takes a binding made before; `nodes` are the current ones.
  /// Errors: Empty without a binding; InvalidOption for options that make no sense, or do not go together; SizeMismatch
  /// for a target, or nodes, of another size; NonFinite for a node that is not finite or beyond kLargestCoordinate. On
  /// an error this skin is left as it was.
  Status bind(Binding binding, PointView<const Scalar> nodes, const InstanceOptions& options = {});
  /// What shapes the surface is the binding's, and was told when it was made: give InstanceOptions.
  template <class Options, class = std::enable_if_t<std::is_same_v<Options, SkinOptions>>>
  Status bind(Binding binding, PointView<const Scalar> nodes, const Options& options) = delete;

  /// Computes positions, normals and tangents for these node positions, world space, nodeCount x 3. Allocates nothing.
  /// Updated; or nothing has changed: NonFinite, see `firstBadNode`; TopologyChanged for another number of nodes;
  /// Unbound.
  UpdateStatus update(PointView<const Scalar> nodes);
  /// The same for the nodes between two steps: see KeptSteps::nodesAt.
  UpdateStatus update(const KeptSteps<Scalar>& steps, Scalar alpha);
  /// Of the last update that returned NonFinite: the first node that is not finite, or beyond kLargestCoordinate.
  std::size_t firstBadNode() const;

  bool bound() const { return parts_ != nullptr; }  ///< since a `bind` that succeeded
  std::size_t nodeCount() const;                    ///< that an update takes; 0 before
  /// What is drawn: Linear also where the quadratic surface was left out, and before a successful bind.
  Interpolation interpolation() const;
  /// vertexCount current positions, minus the origin, in the binding's order: the skin's own array, empty where the
  /// target is the caller's.
  PointView<const Scalar> positions() const;
  /// vertexCount positions of the update before, minus its origin, in the same order; empty if not asked for. The
  /// current ones after bind, after `hold`, and where an update failed. With this option the two arrays change places
  /// at every update, so ask for both views after it. Costs 3 scalars a vertex, and no time.
  PointView<const Scalar> previousPositions() const;
  /// Nothing has moved since the last update, or is to count as motion: the previous positions are the current ones
  /// until the next update. Free.
  void hold() { held_ = true; }
  /// vertexCount current unit normals, likewise; empty if not asked for.
  PointView<const float> normals() const;
  /// vertexCount current unit tangents, likewise.
  PointView<const float> tangents() const;
  /// Box of the positions, for culling. An extrapolated vertex may lie outside the cage's own box.
  const Box3& bounds() const;
  /// To share; null before a successful bind.
  Binding binding() const;
  /// For the updates to come. Errors: InvalidOption if it is not finite or beyond kLargestCoordinate, and the one there
  /// is stays.
  Status setOrigin(const Eigen::Vector3d& origin);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;  ///< null: not bound
  bool held_ = true;              ///< the previous positions are not to be shown
};

}  // namespace tetskin
