// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/cage.h>
#include <tetskin/core/mesh.h>
#include <tetskin/core/types.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <type_traits>
#include <vector>

namespace tetskin {

/// A point of a cage, given by barycentric weights of its tet's nodes. A value of some 60 bytes (90 in double) that
/// owns nothing; returned by `Embedding::at`.
///
/// The functions read node data through a callable, so that nodes may be stored in any way: it takes a node index (int)
/// and returns a vector (an `Eigen::Matrix<Scalar, 3, 1>` or a `btVector3`, by value or by reference) or a scalar. Node
/// data and results are in world space, in the units of the data. No function allocates, each calls the callable at
/// most a few times per node, and none can fail: values that are not finite propagate.
template <class Scalar>
struct EmbeddedPoint {
  Tet nodes{};                      ///< the tet's nodes, in its order
  std::array<Scalar, 4> weights{};  ///< sum to 1, the fourth being 1 minus the others; outside the tet they extrapolate
  /// Weights at which forces act: those of the tet's point that is closest at rest. None is below 0, and their sum is 1
  /// within rounding. Extrapolating weights could accelerate single nodes excessively.
  std::array<Scalar, 4> clampedWeights{};
  int tet = -1;         ///< index of the tet in the cage
  bool inside = false;  ///< the point lies in the tet; if not, `clampedWeights` and `weights` describe different points

  /// Current position of the point, as linear skinning draws it. Computed relative to the last node, so that the
  /// rounding of weights costs no accuracy far from the origin.
  template <class PositionOf>
  auto position(const PositionOf& positionOf) const {
    using Vector = std::decay_t<decltype(positionOf(0))>;
    const Vector last = positionOf(nodes[3]);
    Vector sum = weights[0] * (positionOf(nodes[0]) - last);
    for (std::size_t k = 1; k < 3; ++k) sum += weights[k] * (positionOf(nodes[k]) - last);
    return Vector(last + sum);
  }

  /// Velocity of the point at `weights`.
  template <class VelocityOf>
  auto velocity(const VelocityOf& velocityOf) const {
    return weightedSum(weights, velocityOf);
  }

  /// Velocity of the point at `clampedWeights`, where forces act: the velocity on which an impulse does work.
  template <class VelocityOf>
  auto clampedVelocity(const VelocityOf& velocityOf) const {
    return weightedSum(clampedWeights, velocityOf);
  }

  /// Inverse effective mass at `clampedWeights`: the change of `clampedVelocity` by a unit impulse in any direction,
  /// from the nodes' own masses alone; 0 if all nodes are pinned.
  /// inverseMassOf  callable: node index to inverse mass, 0 for a pinned node
  template <class InverseMassOf>
  Scalar inverseMass(const InverseMassOf& inverseMassOf) const {
    Scalar sum = 0;
    for (std::size_t k = 0; k < 4; ++k) sum += clampedWeights[k] * clampedWeights[k] * inverseMassOf(nodes[k]);
    return sum;
  }

  /// Distributes an impulse to the nodes by the clamped weights. The nodes' linear momentum grows by the impulse and
  /// their angular momentum by its moment about the point of application, except for the part that pinned nodes absorb.
  /// impulse        mass times velocity, world space
  /// inverseMassOf  callable: node index to inverse mass, 0 for a pinned node
  /// change         called as change(node, velocityChange) for each of the 4 nodes
  template <class Vector, class InverseMassOf, class Change>
  void applyImpulse(const Vector& impulse, const InverseMassOf& inverseMassOf, Change&& change) const {
    for (std::size_t k = 0; k < 4; ++k) {
      change(nodes[k], Vector((clampedWeights[k] * inverseMassOf(nodes[k])) * impulse));
    }
  }

 private:
  template <class VectorOf>
  auto weightedSum(const std::array<Scalar, 4>& factors, const VectorOf& vectorOf) const {
    using Vector = std::decay_t<decltype(vectorOf(0))>;
    Vector sum = factors[0] * vectorOf(nodes[0]);
    for (std::size_t k = 1; k < 4; ++k) sum += factors[k] * vectorOf(nodes[k]);
    return sum;
  }
};

/// How vertices outside the cage are treated.
struct EmbedOptions {
  OutsideRule outside = OutsideRule::Nearest;  ///< which tet carries them
  /// Rest units, 0 or more. If a vertex is farther than this from every tet (with Barycentric: from its own tet), the
  /// mesh is refused with OutsideCage and a message, and nothing is embedded.
  double maxDistance = std::numeric_limits<double>::infinity();
};

/// How well a mesh fits its cage. For a mesh that was refused, it holds what was known until then. All lengths and
/// boxes are in rest space.
struct TETSKIN_CORE_API EmbedReport {
  std::size_t vertexCount = 0;  ///< inside + outside + unbound
  std::size_t inside = 0;       ///< vertices in some tet
  std::size_t outside = 0;      ///< vertices in no tet, but still bound to one
  std::size_t unbound = 0;      ///< vertices without a tet: all if there is no embedding, otherwise none
  std::size_t mapped = 0;       ///< vertices whose tet was given by `Cage::vertexTets`: all or none
  std::size_t overlapping = 0;  ///< vertices with weights above 1e-6 in two tets or more, without `vertexTets`: the
                                ///< cage overlaps itself, and the choice of the tet is ambiguous
  std::size_t coincident = 0;   ///< vertices at the position of an earlier one: embedded once, weights copied
  std::size_t flatTets = 0;     ///< tets without volume; never used
  /// Longest distance from a vertex to the nearest tet; with Barycentric, to its own. With `Cage::vertexTets`, only
  /// over vertices that triangles use.
  double maxDistance = 0.0;
  std::size_t maxDistanceVertex = 0;                              ///< index of that vertex
  Eigen::Vector3d maxDistancePosition = Eigen::Vector3d::Zero();  ///< rest position of that vertex
  /// Outside vertices bound to the component of their mesh neighbours instead of the nearest one.
  std::size_t reassignedByConnectivity = 0;
  std::size_t reassignedByWeight = 0;  ///< distinct outside positions whose nearest tet would extrapolate too far
  double maxWeight = 1.0;  ///< largest absolute weight of a vertex, at least 1: amplification of a node's motion
  /// Largest barycentric distance, dimensionless; 0 within rounding if all vertices are inside.
  double maxBarycentricDistance = 0.0;
  Box3 meshBox;                ///< bounding box of the vertices; of those that triangles use, if there are triangles
  Box3 cageBox;                ///< bounding box of the nodes
  double restErrorMax = 0.0;   ///< longest distance from a vertex to its skinned rest position, in diagonals of meshBox
  std::size_t candidates = 0;  ///< pairs of a vertex and a tet that were tested
  double milliseconds = 0.0;   ///< wall time of the whole embedding

  /// True if mesh and cage are disjoint, or one is more than Limits::kMaxUnitRatio times the size of the other: most
  /// likely they are in different units. Known before any search; the embedding is still made.
  bool unitsDiffer() const;
  /// The result of `unitsDiffer` as the second half of a sentence; empty if the units do not differ.
  std::string unitsMessage() const;
  /// Readable summary, one line per item.
  std::string describe() const;
};

/// Tet and barycentric weights of one vertex.
struct VertexBinding {
  int tet = -1;                    ///< index of the tet in the cage
  std::array<float, 4> weights{};  ///< of the tet's nodes in its order; the fourth is 1 minus the others
  bool inside = false;             ///< the vertex lies in the tet; if not, the weights extrapolate
};

/// Order in which skinned vertices are written.
enum class VertexOrder {
  Mesh,    ///< the order of the mesh
  Sorted,  ///< grouped by tet, as `Embedding::slotVertices()`: faster, if the application permutes its mesh once
};

struct EmbeddingData;

/// A tet and weights for every vertex. Immutable; copies share the data and cost nothing, so any number of bodies with
/// the same cage can use it. Vertices are stored grouped by tet, so that a tet's nodes are read once. A *slot* is an
/// index in that order: first the vertices inside the cage, then those outside.
/// Memory: 20 bytes per vertex, 12 more per outside vertex, 24 bytes per occupied tet.
class TETSKIN_CORE_API Embedding {
 public:
  /// An empty embedding, without vertices.
  Embedding();
  /// Copies share the data. Moving is copying: the source stays a valid, equal embedding.
  Embedding(const Embedding&) = default;
  Embedding& operator=(const Embedding&) = default;

  std::size_t vertexCount() const { return slotVertices().size(); }  ///< number of vertices of the mesh
  std::size_t insideCount() const;                                   ///< number of vertices that lie in some tet
  std::size_t nodeCount() const;                                     ///< number of nodes of the cage
  std::size_t tetCount() const;                                      ///< number of tets of the cage
  bool empty() const { return slotVertices().empty(); }              ///< true without vertices

  /// vertexCount vertex indices, by slot; ascending within a tet.
  const std::vector<std::uint32_t>& slotVertices() const;
  /// vertexCount slots, by vertex.
  const std::vector<std::uint32_t>& vertexSlots() const;
  /// Tets and weights by vertex, in the order of the mesh. Cost O(vertexCount); allocates the result.
  std::vector<VertexBinding> bindings() const;
  /// The tet and weights of one vertex, in float or double to match the nodes that it will be used with.
  /// vertex  index in the mesh's order, below vertexCount()
  /// Cost    O(log tetCount), no allocation
  template <class Scalar = double>
  EmbeddedPoint<Scalar> at(std::size_t vertex) const;

  /// Serialises the embedding to bytes, identical on every machine, so that an application can embed once and store the
  /// result with its models. About 16 bytes per vertex, 12 more per outside vertex, 8 per occupied tet. The embedding
  /// must not be empty.
  /// cage  the cage that it was made with: a hash of its rest nodes and tets is stored
  /// Cost  O(vertexCount + nodeCount + tetCount)
  std::vector<unsigned char> save(const TetMesh& cage) const;
  /// Reads what `save` wrote, bit-identical. Safe for arbitrary bytes. The embedding does not record its mesh: compare
  /// vertexCount() with the mesh's, and store the two together.
  /// bytes   `count` bytes; not kept
  /// cage    the cage that it was saved with, every node bit-identical
  /// Cost    O(vertexCount + nodeCount + tetCount)
  /// Errors  UnsupportedFormat: other data, or another version; Malformed: too few, too many or damaged bytes;
  ///         CageMismatch: saved with another cage
  static Result<Embedding> load(const unsigned char* bytes, std::size_t count, const TetMesh& cage);

 private:
  friend struct Access<Embedding>;
  explicit Embedding(std::shared_ptr<const EmbeddingData> data);
  std::shared_ptr<const EmbeddingData> data_;  ///< never null
};

/// Finds the tet and the weights of every vertex, exactly as testing all pairs would:
/// - A vertex in one or more tets is bound to the one with the lowest index.
/// - Any other vertex is bound to a tet chosen by `options.outside`; its weights extrapolate, so that the rest shape is
///   reproduced. `Nearest`: among the tets whose distance is within 1e-6 of their size of the shortest, the one with
///   the smallest barycentric distance, then the lowest index. `Barycentric`: the one with the smallest barycentric
///   distance, then the lowest index. A vertex within 2^-49 of the cage's largest coordinate counts as inside.
/// - With `Nearest`, an outside vertex with an absolute weight above 4 is reassigned: among the tets no farther than
///   the shortest distance plus one mean edge of the cage, it takes the one whose largest absolute weight is smallest,
///   then the lowest index. So slivers carry no vertex that a nearby tet carries well.
///
/// Vertices at the same position get identical weights. Decisions are made in double; nothing depends on the unit.
///
/// cage      valid (see `validate`), rest space; either orientation
/// vertices  vertexCount x 3, rest space; float or double
/// report    written if not null, also on failure
/// Cost      about proportional to vertexCount + tetCount; some tens of pairs are tested per vertex, most of them in
///           float
/// Memory    at most 64 bytes per vertex beyond the input while it works, including the result, and about 40 per tet
/// Errors    those of `validate(const TetMesh&)`; Empty: no vertices; NonFinite: a coordinate that is not finite or
///           beyond Limits::kMaxCoordinate; InvalidOption: a maxDistance below 0 or NaN; SizeMismatch: more than 2^32 -
///           2 vertices; OutsideCage: a vertex beyond maxDistance; Degenerate: a vertex so far from its tet that
///           weights would overflow
TETSKIN_CORE_API Result<Embedding> embed(const TetMesh& cage, PointView<const double> vertices,
                                         const EmbedOptions& options = {}, EmbedReport* report = nullptr);
/// Overload for vertices in float; otherwise as `embed(const TetMesh&, PointView<const double>, ...)`.
TETSKIN_CORE_API Result<Embedding> embed(const TetMesh& cage, PointView<const float> vertices,
                                         const EmbedOptions& options = {}, EmbedReport* report = nullptr);
/// Embeds a mesh in a cage like the overload for vertices alone, but also uses the mesh's triangles and the cage's
/// data.
///
/// With `OutsideRule::Nearest`, an outside vertex whose neighbours in the mesh belong to another component of the cage
/// is bound to that component, unless it is farther away by more than an edge of its tet; so legs are not joined to
/// each other. Exception: all tets of that component would extrapolate the vertex too far. Its largest weight may be at
/// most 4 times the larger of 1 and what it would be otherwise. This takes some 150 bytes more per outside vertex while
/// it works.
///
/// If the cage has `vertexTets`, every vertex is bound to the tet named there, without a search. Further errors: those
/// of `validate(const TriangleMesh&)`; CageMismatch if these are other vertices, or they are not in their tets.
/// Vertices that no triangle uses need not be in theirs: they count as outside, whatever `maxDistance` is.
TETSKIN_CORE_API Result<Embedding> embed(const Cage& cage, const TriangleMesh& mesh, const EmbedOptions& options = {},
                                         EmbedReport* report = nullptr);

}  // namespace tetskin
