// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/src/base/point_reader.h>
#include <tetskin/core/src/kernels/skinning_kernels.h>
#include <tetskin/core/tet_mesh.h>
#include <tetskin/core/triangle_mesh.h>
#include <tetskin/core/types.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace tetskin {

struct BarycentricMap;

/// Which tet carries a vertex that lies in none. Vertices inside are bound the same under both.
enum class OutsideRule {
  Nearest,      ///< the tet closest in distance, but for slivers: a thin layer of tets keeps the vertices just above it
  Barycentric,  ///< the tet of the smallest barycentric distance: the tutorial's rule, and Bullet's
};

struct EmbedOptions {
  OutsideRule outside = OutsideRule::Nearest;
  /// In rest units, 0 or more: a vertex farther than this from every tet (under Barycentric, from its own) is refused,
  /// with a message, and nothing is embedded.
  double maxDistance = std::numeric_limits<double>::infinity();
};

/// How well a mesh fits its cage. All lengths and boxes are in rest space.
struct EmbedReport {
  Status status;                ///< not ok: nothing was embedded, and the message says why
  std::size_t vertexCount = 0;  ///< inside + outside + unbound
  std::size_t inside = 0;       ///< vertices in some tet
  std::size_t outside = 0;      ///< vertices in no tet, carried by one nevertheless
  std::size_t unbound = 0;      ///< vertices without a tet: all if status is not ok, otherwise none
  std::size_t overlapping = 0;  ///< vertices deeper than kOverlapDepth in two tets or more: the cage overlaps itself
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

  bool ok() const { return status.ok(); }
  /// Mesh and cage apart from each other, or one more than kUnitRatio times the size of the other: they are most
  /// likely in different units. Known before any search; the embedding is made all the same.
  bool unitsDiffer() const;
  /// One line a fact, for people.
  std::string describe() const;
};

/// Weight above which a vertex counts as deep inside a tet: keeps shared faces from counting as overlap.
constexpr double kOverlapDepth = 1e-6;
/// Ratio of the diagonals of mesh and cage from which different units are presumed: inches against metres are 39, and
/// a cage 30 times as large as its mesh would leave the mesh in a handful of tets anyway.
constexpr double kUnitRatio = 30.0;
/// Barycentric distance beyond which a mesh is refused: times nodes as far as kLargestCoordinate, weights would leave
/// float's range; at rest they would keep no digit long before.
constexpr double kLargestBarycentric = 1e15;
/// Tets whose distances differ by less than this fraction of their size are equally near.
constexpr double kNearestTie = 1e-6;
/// A vertex whose distance to the nearest tet is at most this fraction of the cage's largest coordinate (4 to 8 units
/// in its last place) is inside: one computed to lie on a face is as far off.
constexpr double kInsideTolerance = 0x1p-49;
/// Absolute weight above which a vertex outside looks for a better tet than the nearest, which is thin or far away.
constexpr double kLargestWeight = 4.0;

/// Tet and weights of one vertex.
struct VertexBinding {
  int tet = -1;
  std::array<float, 4> weights{};  ///< of the tet's nodes in its order; the fourth is 1 minus the others
  bool inside = false;
};

/// For every vertex a tet and three weights: built once, immutable, shared by any number of bodies with the same cage.
/// Vertices are stored tet by tet, so that a tet's nodes are read once: a *slot* is a place in that order. The slots
/// [0, insideCount()) are those of the vertices inside, the others those of the vertices outside.
/// Memory: 20 bytes a vertex, 12 more a vertex outside, 24 bytes an occupied tet.
class Embedding {
 public:
  /// The slots [firstSlot, the next run's firstSlot) belong to the tet of these nodes.
  using Run = kernels::Run;
  /// Weights come in planes of one float a slot, so that kernels take several vertices at a time; each is followed by
  /// this many zeros, which they may read.
  static constexpr std::size_t kPadding = 16;

  std::size_t vertexCount() const { return slotVertices_.size(); }
  std::size_t insideCount() const { return insideCount_; }
  std::size_t nodeCount() const { return nodeCount_; }
  std::size_t tetCount() const { return tetCount_; }
  bool empty() const { return slotVertices_.empty(); }

  /// The runs of the tets with vertices inside, ascending by tet; then those of the tets with vertices outside,
  /// likewise; and one more that closes the list.
  const std::vector<Run>& runs() const { return runs_; }
  std::size_t insideRunCount() const { return insideRunCount_; }
  /// vertexCount + kPadding, by slot: weight of node k < 3 of the slot's tet
  const float* weights(int k) const { return weights_[static_cast<std::size_t>(k)].data(); }
  /// vertexCount - insideCount + kPadding, by slot - insideCount: weight of node k < 3 at the point of the slot's tet
  /// closest to the vertex, at rest
  const float* closestWeights(int k) const { return closestWeights_[static_cast<std::size_t>(k)].data(); }
  /// vertexCount, by slot: which vertex it is; ascending within a run
  const std::vector<std::uint32_t>& slotVertices() const { return slotVertices_; }
  /// vertexCount, by vertex: its slot
  const std::vector<std::uint32_t>& vertexSlots() const { return vertexSlots_; }

  /// The same by vertex, in the mesh's order. Cost O(vertexCount), allocates the result.
  std::vector<VertexBinding> bindings() const;

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
  /// damaged;
  ///         CageMismatch: of another cage
  static Result<Embedding> load(const unsigned char* bytes, std::size_t count, const TetMesh& cage);

  /// How closely the weights of an embedding reproduce the vertices; see EmbedReport.
  struct Fit {
    double largestWeight = 1.0;      ///< absolute
    double worstBarycentric = -1.0;  ///< dimensionless
    double restErrorSquared = 0.0;   ///< rest space; infinite where weights overflow a float
  };

  /// Sorts vertices by tet and computes their weights.
  /// vertices  vertexCount x 3, rest space; float or double
  /// tetOf     by vertex: its tet, or ~tet if it lies outside of it; in [0, tetCount), and not flat
  /// fit       written if not null
  /// Memory    the result, and 8 bytes a tet
  static Embedding fromTets(const TetMesh& cage, PointReader vertices, const std::vector<std::int32_t>& tetOf,
                            Fit* fit = nullptr);

 private:
  bool runsAreSound() const;
  bool orderVertices();
  void sortByTet(const TetMesh& cage, const std::vector<std::int32_t>& tetOf);
  void bindRun(std::size_t run, const std::array<Eigen::Vector3d, 4>& corners, PointReader vertices, Fit& fit);
  void bindOutside(std::uint32_t slot, const std::array<Eigen::Vector3d, 4>& corners, const BarycentricMap& map,
                   const Eigen::Vector3d& vertex, Fit& fit);

  std::size_t nodeCount_ = 0;
  std::size_t tetCount_ = 0;
  std::size_t insideCount_ = 0;
  std::size_t insideRunCount_ = 0;
  std::vector<Run> runs_;
  std::array<std::vector<float>, 3> weights_;
  std::array<std::vector<float>, 3> closestWeights_;
  std::vector<std::uint32_t> slotVertices_;
  std::vector<std::uint32_t> vertexSlots_;
};

/// Finds the tet and the weights of every vertex, exactly as testing all pairs would:
/// - a vertex in one tet or more belongs to the one with the lowest index;
/// - any other to the nearest under `options.outside`. `Nearest`: of the tets whose distance is within kNearestTie of
///   their size of the shortest, the one of smallest barycentric distance, then of lowest index. `Barycentric`: of
///   smallest barycentric distance, then of lowest index. Its weights extrapolate, so rest is reproduced. Within
///   kInsideTolerance, it counts as inside;
/// - under `Nearest`, a vertex outside with an absolute weight above kLargestWeight is rescued: of the tets no farther
///   than the shortest distance plus one mean edge (see `meanEdge`), it takes the one of smallest largest absolute
///   weight, then of lowest index: slivers carry no vertex that another tet near it carries well.
/// Vertices at the same position get identical weights. Decisions are made in double; nothing depends on the unit.
///
/// cage       usable (see `usable`), rest space; orientation does not matter
/// vertices   vertexCount x 3, rest space; float or double
/// embedding  written on success only
/// Cost       about proportional to vertexCount + tetCount; some tens of tested pairs a vertex, most of them in float
/// Memory     at most 64 bytes a vertex beyond the input while it works, the result included, and about 40 a tet
/// Errors     in the report's status: an empty or non-finite mesh, an unusable cage, coordinates beyond
///            kLargestCoordinate, a maxDistance below 0 or NaN, a vertex beyond it
[[nodiscard]] EmbedReport embed(const TetMesh& cage, PointView<const double> vertices, const EmbedOptions& options,
                                Embedding& embedding);
[[nodiscard]] EmbedReport embed(const TetMesh& cage, PointView<const float> vertices, const EmbedOptions& options,
                                Embedding& embedding);
/// The same, and under `OutsideRule::Nearest` a vertex outside whose neighbours in the mesh belong to another part of
/// the cage stays with them, unless that part is farther away by more than an edge of its tet: legs are not sewn
/// together. It does not stay where all tets of that part would extrapolate it: its largest weight may be no more than
/// kLargestWeight times what it is otherwise, or times 1. Takes some 150 bytes more for each vertex outside while it
/// works.
[[nodiscard]] EmbedReport embed(const TetMesh& cage, const TriangleMesh& mesh, const EmbedOptions& options,
                                Embedding& embedding);

}  // namespace tetskin
