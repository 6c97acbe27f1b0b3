// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/mesh.h>
#include <tetskin/core/types.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace tetskin {

/// Number of small tets per tet in `Cage::fineVolumeFraction`: those of two uniform refinements, 8 x 8.
constexpr std::size_t kFineTets = 64;

/// A cage at rest, and what is known about the mesh embedded in it. Where regions of the mesh are nearer to each other
/// than the size of a tet, the cage has duplicate elements: several copies of a tet at the same position, one for each
/// region (the virtual-node method). A vertex's position does not tell which copy carries it; `vertexTets` stores it.
/// Every array may be empty, which means that the property is unknown. A plain TetMesh converts to such a cage.
///
/// To translate or rotate a cage, change `mesh.nodes`; to scale it, use `scaleBy`, because masses are proportional to
/// volumes.
struct TETSKIN_CORE_API Cage {
  /// An empty cage, without tets.
  Cage() = default;
  /// A cage that consists of tets only: nothing is known about a mesh in them.
  Cage(TetMesh tetMesh) : mesh(std::move(tetMesh)) {}  // NOLINT(google-explicit-constructor): nothing is lost

  TetMesh mesh;                        ///< nodes and tets, rest space
  std::vector<int> vertexTets;         ///< vertexCount of the mesh: index of the tet that carries each vertex
  std::vector<double> volumeFraction;  ///< tetCount, 0 to 1: fraction of the tet's volume inside the mesh
  /// tetCount, above 0: multiplies the stiffness, in addition to volumeFraction; see `calibrate`
  std::vector<double> stiffnessFactor;
  /// tetCount, above 0: relative stiffness of the material, also multiplied; see `paintCage`
  std::vector<double> paintedStiffness;
  /// tetCount, above 0: relative density of the material, which `masses` already contain; see `paintCage`
  std::vector<double> paintedDensity;
  /// tetCount, 0 or more: factors of the material's damping; see `paintCage`
  std::vector<double> paintedDamping;
  /// nodeCount, above 0, for a density of 1: their sum is the mesh's volume, or the integral of the painted density
  std::vector<double> masses;
  std::vector<int> component;  ///< tetCount, from 0: component of the cage, connected through shared nodes
  std::vector<int> sourceTet;  ///< tetCount, from 0: equal for all duplicates of one tet
  /// tetCount, from -1: number of the quadratic tet of which the tet is an eighth; -1: the tet is linear. See
  /// `quadraticTets`.
  std::vector<int> quadraticTet;
  /// tetCount x kFineTets, in 255ths: volume fractions after two refinements.
  std::vector<std::uint8_t> fineVolumeFraction;
  /// `positionsHash` of the mesh for which the cage was built, if known.
  std::optional<std::uint64_t> meshHash;

  /// tetCount scale factors of the material's stiffness, from `volumeFraction` (at least Limits::kMinVolumeFraction),
  /// `stiffnessFactor` and `paintedStiffness`. Empty if all are 1.
  std::vector<double> stiffnessScale() const;
  /// The same without `volumeFraction`: the material in a tet. Empty if all are 1.
  std::vector<double> materialStiffness() const;
  /// Multiplies the node positions by the scale, which is above 0, and the masses by its cube.
  void scaleBy(double scale);
  /// True if the cage has duplicate elements.
  bool hasDuplicates() const;
  /// Checks that this is the mesh for which the cage was built, by vertexCount and `meshHash`, if these are known. Pass
  /// the mesh as it was loaded: if it was moved together with its cage, its hash differs. Cost O(vertexCount). Error:
  /// CageMismatch.
  Status checkMesh(const TriangleMesh& surface) const;

  /// Index of the tet that holds a point in rest space; parameters and result as for `CageLocator::locate`. Cost O(T
  /// log T) for T tets: for several points, create one CageLocator.
  int locate(const Eigen::Vector3d& point, const std::array<int, 3>& nearVertices) const;
};

/// Checks a cage: its tet mesh by `validate(const TetMesh&)`, and that each array has the right length and valid
/// values. Cost O(T) for T tets.
/// Errors: those of `validate(const TetMesh&)`; SizeMismatch, InvalidOption, IndexOutOfRange.
TETSKIN_CORE_API Status validate(const Cage& cage);

/// Hash of the bits of the positions, without the triangles. Cost O(vertexCount).
TETSKIN_CORE_API std::uint64_t positionsHash(const std::vector<Eigen::Vector3d>& positions);

/// Finds which of several duplicate tets holds a point on or near the mesh's surface, such as a sample on a triangle or
/// a vertex of a second mesh.
class TETSKIN_CORE_API CageLocator {
 public:
  /// Builds the search structure. Cost O(T log T) for T tets.
  /// cage  valid (see `validate`); not copied, must outlive this object
  explicit CageLocator(const Cage& cage);
  CageLocator(CageLocator&&) noexcept = default;             ///< the other one may only be assigned to, or destroyed
  CageLocator& operator=(CageLocator&&) noexcept = default;  ///< the other one may only be assigned to, or destroyed

  /// Index of the tet that holds the point, among those reached through shared faces from the tets of the given
  /// vertices. If none of them holds it, the visited tet with the smallest barycentric distance. For a cage without
  /// `vertexTets`, the search uses only the point's position.
  /// point         rest space
  /// nearVertices  vertices of the triangle that the point lies on or near; in range
  /// Returns       -1 for a locator that was moved from
  /// Cost          O(k log k) for k tets between them; without `vertexTets`, O(T)
  int locate(const Eigen::Vector3d& point, const std::array<int, 3>& nearVertices) const;

 private:
  struct Impl;
  std::shared_ptr<const Impl> impl_;  ///< null: moved from; never shared
};

// Quadratic tets: ten nodes, whose displacement is interpolated quadratically. They can bend, where linear tets are too
// stiff. A cage holds each as the eight linear tets of its uniform refinement, so that everything that reads tets
// (embedding, contact, picking, Bullet itself) works unchanged.

/// Number of nodes of a quadratic tet.
constexpr std::size_t kQuadraticNodes = 10;
/// Number of linear tets that make up a quadratic one.
constexpr std::size_t kSubTets = 8;

/// A quadratic tet of a cage, with straight edges.
struct QuadraticTet {
  /// Corners 0 to 3, positively oriented, then the midpoints of the edges 01, 02, 03, 12, 13, 23.
  std::array<int, kQuadraticNodes> nodes{};
  std::array<int, kSubTets> tets{};  ///< of the cage, ascending
};

/// The quadratic tets that `Cage::quadraticTet` names, by their number; none if it is empty. Cost O(T) for T tets.
/// cage    its indices must be in range
/// Errors  SizeMismatch: the number of values differs from that of tets; InvalidOption: a number is below -1, or one is
///         left out, or the tets with one number are not eight, or not the uniform refinement of a tet
TETSKIN_CORE_API Result<std::vector<QuadraticTet>> quadraticTets(const Cage& cage);

/// Makes a cage of quadratic tets: each tet becomes one, with nodes at the middles of its edges. For tet meshes that
/// the body fills completely; one with an eighth of the tets then serves as well as a linear one, or better.
/// cage      valid (see `validate`), without flat tets and duplicate elements; rest space, any unit.
///           Pass a cage and not its `mesh`, which has no fractions: a body of it would have the mass of full
///           tets
/// Returns   a cage of 8 T tets for T tets, of the same mass; the cage's nodes come first, in their order. Volume
///           fractions are those of the smaller tets; painted maps are kept, stiffness factors left out
/// Cost      O(T log T)
/// Errors    those of `validate(const Cage&)`; InvalidOption: duplicate elements; Degenerate: flat tets; TooLarge: 8 T
///           tets are too many
TETSKIN_CORE_API Result<Cage> refineQuadratic(const Cage& cage);

}  // namespace tetskin
