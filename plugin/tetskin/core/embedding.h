// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/cage.h>
#include <tetskin/core/embedded_point.h>
#include <tetskin/core/tet_mesh.h>
#include <tetskin/core/triangle_mesh.h>
#include <tetskin/core/types.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

namespace tetskin {

/// What becomes of vertices outside the cage.
struct EmbedOptions {
  OutsideRule outside = OutsideRule::Nearest;  ///< which tet carries them
  /// In rest units, 0 or more: a vertex farther than this from every tet (under Barycentric, from its own) is refused,
  /// with a message, and nothing is embedded.
  double maxDistance = std::numeric_limits<double>::infinity();
};

/// How well a mesh fits its cage; of a mesh that was refused, as much as was known by then. All lengths and boxes are
/// in rest space.
struct TETSKIN_CORE_API EmbedReport {
  std::size_t vertexCount = 0;  ///< inside + outside + unbound
  std::size_t inside = 0;       ///< vertices in some tet
  std::size_t outside = 0;      ///< vertices in no tet, carried by one nevertheless
  std::size_t unbound = 0;      ///< vertices without a tet: all if there is no embedding, otherwise none
  std::size_t mapped = 0;       ///< vertices whose tet the cage's map told: all or none
  std::size_t overlapping = 0;  ///< vertices with weights above 1e-6 in two tets or more, and no map: the cage overlaps
                                ///< itself, and which of the tets is the vertex's own is a guess
  std::size_t coincident = 0;   ///< vertices at the position of an earlier one: embedded once, weights copied
  std::size_t flatTets = 0;     ///< tets without volume, never used
  double worstDistance = 0.0;   ///< longest distance from a vertex to the nearest tet; under Barycentric, to its own
  std::size_t worstVertex = 0;  ///< which vertex that is
  Eigen::Vector3d worstPosition = Eigen::Vector3d::Zero();  ///< where it is
  std::size_t keptWithNeighbours = 0;  ///< vertices outside that another part of the cage is nearer to than their own
  std::size_t rescued = 0;             ///< places of vertices that their nearest tet would have extrapolated too far
  double largestWeight = 1.0;  ///< largest absolute weight of a vertex, or 1: how much a node's motion is amplified
  double worstBarycentric =
      0.0;       ///< largest barycentric distance, dimensionless; above 0 by rounding only if all are inside
  Box3 meshBox;  ///< of the vertices
  Box3 cageBox;  ///< of the nodes
  double restErrorMax = 0.0;   ///< longest distance of a skinned rest vertex to the vertex, in diagonals of meshBox
  std::size_t candidates = 0;  ///< pairs of vertex and tet that were tested
  double milliseconds = 0.0;   ///< wall time of the whole embedding

  /// Mesh and cage apart from each other, or one more than kUnitRatio times the size of the other: they are most
  /// likely in different units. Known before any search; the embedding is made all the same.
  bool unitsDiffer() const;
  /// That in words, the latter half of a sentence; empty if they do not.
  std::string unitsFault() const;
  /// One line a fact, for people.
  std::string describe() const;
};

/// Ratio of the diagonals of mesh and cage from which different units are presumed: inches against metres are 39, and
/// a cage 30 times as large as its mesh would leave the mesh in a handful of tets anyway.
constexpr double kUnitRatio = 30.0;
/// Barycentric distance beyond which a mesh is refused: times nodes as far as kLargestCoordinate, weights would leave
/// float's range; at rest they would keep no digit long before.
constexpr double kLargestBarycentric = 1e15;

/// Tet and weights of one vertex.
struct VertexBinding {
  int tet = -1;                    ///< index of the tet in the cage
  std::array<float, 4> weights{};  ///< of the tet's nodes in its order; the fourth is 1 minus the others
  bool inside = false;             ///< the vertex lies in the tet; if not, the weights extrapolate
};

/// The order in which vertices are written.
enum class VertexOrder {
  Mesh,    ///< the mesh's own
  Sorted,  ///< by tet, `Embedding::slotVertices()`: faster, if the application permutes its mesh once
};

struct EmbeddingData;

/// For every vertex a tet and its weights: made once, never changed, shared by its copies, which cost nothing, and so
/// by any number of bodies with the same cage. Vertices are stored tet by tet, so that a tet's nodes are read once: a
/// *slot* is a place in that order, first those of the vertices inside, then those of the vertices outside.
/// Memory: 20 bytes a vertex, 12 more a vertex outside, 24 bytes an occupied tet.
class TETSKIN_CORE_API Embedding {
 public:
  /// Empty: of no vertices.
  Embedding();
  /// For the library's own use, as is `data`.
  explicit Embedding(std::shared_ptr<const EmbeddingData> data);
  /// Also where it is moved from: what is left is the same embedding, never nothing.
  Embedding(const Embedding&) = default;
  Embedding& operator=(const Embedding&) = default;

  std::size_t vertexCount() const { return slotVertices().size(); }  ///< of the mesh
  std::size_t insideCount() const;                                   ///< vertices in some tet
  std::size_t nodeCount() const;                                     ///< of the cage
  std::size_t tetCount() const;                                      ///< of the cage
  bool empty() const { return slotVertices().empty(); }              ///< of no vertices

  /// vertexCount, by slot: which vertex it is; ascending within a tet
  const std::vector<std::uint32_t>& slotVertices() const;
  /// vertexCount, by vertex: its slot
  const std::vector<std::uint32_t>& vertexSlots() const;
  /// Tets and weights by vertex, in the mesh's order. Cost O(vertexCount), allocates the result.
  std::vector<VertexBinding> bindings() const;
  /// How one vertex moves with the nodes of its tet.
  /// In float or double, whichever the nodes are in that it is to be used with.
  /// vertex  of the mesh, below vertexCount(), whatever the order of its slots
  /// Cost    O(log tetCount), no allocation
  template <class Scalar = double>
  EmbeddedPoint<Scalar> at(std::size_t vertex) const;

  /// All of it as bytes, the same on every machine, so that an application may embed once and keep the result with its
  /// models. About 16 bytes a vertex, 12 more a vertex outside, 8 an occupied tet. Must not be empty.
  /// cage  the one it was made with: a hash of its rest nodes and tets goes with the bytes
  /// Cost  O(vertexCount + nodeCount + tetCount)
  std::vector<unsigned char> save(const TetMesh& cage) const;
  /// What `save` wrote, equal to the bit. Never crashes, whatever the bytes. Which mesh it was made for the embedding
  /// does not know: compare vertexCount() with the mesh's, and keep the two together.
  /// bytes   `count` of them, read here only
  /// cage    the one it was saved with: every node in its place to the bit
  /// Cost    that of `save`
  /// Errors  UnsupportedFormat: bytes of something else, or of another version; Malformed: too few, too many or
  ///         damaged; CageMismatch: of another cage
  static Result<Embedding> load(const unsigned char* bytes, std::size_t count, const TetMesh& cage);

  /// For the library's own use.
  const EmbeddingData& data() const { return *data_; }

 private:
  std::shared_ptr<const EmbeddingData> data_;  ///< never null
};

/// Finds the tet and the weights of every vertex, exactly as testing all pairs would:
/// - a vertex in one tet or more belongs to the one with the lowest index;
/// - any other to the nearest under `options.outside`. `Nearest`: of the tets whose distance is within 1e-6 of their
///   size of the shortest, the one of smallest barycentric distance, then of lowest index. `Barycentric`: of
///   smallest barycentric distance, then of lowest index. Its weights extrapolate, so rest is reproduced. Within
///   2^-49 of the cage's largest coordinate, it counts as inside;
/// - under `Nearest`, a vertex outside with an absolute weight above 4 is rescued: of the tets no farther
///   than the shortest distance plus one mean edge of the cage, it takes the one of smallest largest absolute
///   weight, then of lowest index: slivers carry no vertex that another tet near it carries well.
/// Vertices at the same position get identical weights. Decisions are made in double; nothing depends on the unit.
///
/// cage       usable (see `usable`), rest space; orientation does not matter
/// vertices   vertexCount x 3, rest space; float or double
/// report     written if not null, on failure too
/// Cost       about proportional to vertexCount + tetCount; some tens of tested pairs a vertex, most of them in float
/// Memory     at most 64 bytes a vertex beyond the input while it works, the result included, and about 40 a tet
/// Errors     an empty or non-finite mesh, an unusable cage, coordinates beyond
///            kLargestCoordinate, a maxDistance below 0 or NaN, a vertex beyond it
TETSKIN_CORE_API Result<Embedding> embed(const TetMesh& cage, PointView<const double> vertices,
                                         const EmbedOptions& options = {}, EmbedReport* report = nullptr);
/// The same.
TETSKIN_CORE_API Result<Embedding> embed(const TetMesh& cage, PointView<const float> vertices,
                                         const EmbedOptions& options = {}, EmbedReport* report = nullptr);
/// The same, and under `OutsideRule::Nearest` a vertex outside whose neighbours in the mesh belong to another part of
/// the cage stays with them, unless that part is farther away by more than an edge of its tet: legs are not sewn
/// together. It does not stay where all tets of that part would extrapolate it: its largest weight may be no more than
/// 4 times what it is otherwise, or times 1. Takes some 150 bytes more for each vertex outside while it works.
/// A cage with a map, `Cage::vertexTets`, is believed: every vertex belongs to the tet that it names, and nothing is
/// searched. Error: CageMismatch if the vertices are others, or not in their tets.
TETSKIN_CORE_API Result<Embedding> embed(const Cage& cage, const TriangleMesh& mesh, const EmbedOptions& options = {},
                                         EmbedReport* report = nullptr);

}  // namespace tetskin
