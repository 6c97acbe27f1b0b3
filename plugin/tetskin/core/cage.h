// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/tet_mesh.h>
#include <tetskin/core/triangle_mesh.h>
#include <tetskin/core/types.h>

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace tetskin {

/// Small tets of a tet in `Cage::fineFill`: those of two uniform refinements.
constexpr std::size_t kFineTets = 64;
/// `calibrate` refines no cage into more: of two refinements, each tet into 64, down to one, into 8, to none.
constexpr std::size_t kMostRefinedTets = 300'000;
/// The least share of its stiffness that a tet keeps, however little of it is filled: less makes light tets so soft
/// that the time step or the solver suffers.
constexpr double kLeastFill = 0.1;

/// A cage at rest, with what is known of the mesh in it. Where parts of the mesh lie nearer to each other than a tet,
/// there are several copies of it, at the same place, one for each part: which of them carries a vertex, its place does
/// not tell, but `vertexTets`. Every array may be empty: then nothing is known. A plain TetMesh converts to that.
///
/// To move or turn a cage, change `nodes`; to scale it, use `scaleBy`, as masses are volumes.
struct TETSKIN_CORE_API Cage : TetMesh {
  /// Of no tets.
  Cage() = default;
  /// Of tets alone: nothing is known of a mesh in them.
  Cage(TetMesh mesh) : TetMesh(std::move(mesh)) {}  // NOLINT(google-explicit-constructor): nothing is lost

  std::vector<int> vertexTets;         ///< vertexCount of the mesh: the tet that holds the vertex
  std::vector<double> fill;            ///< tetCount, 0 to 1: share of the tet's volume within the mesh
  std::vector<double> factor;          ///< tetCount, above 0: of the stiffness, beside that by `fill`: see `calibrate`
  std::vector<double> masses;          ///< nodeCount, above 0, for a density of 1: they add up to the mesh's volume
  std::vector<int> parts;              ///< tetCount, from 0: number of the part, of tets that hang together by nodes
  std::vector<int> latticeTets;        ///< tetCount, from 0: the same for copies of one tet
  std::vector<std::uint8_t> fineFill;  ///< tetCount x kFineTets, in 255ths: of the tets of two refinements
  std::uint64_t meshHash = 0;          ///< `positionsHash` of the mesh as it was; 0: not known

  /// tetCount: share of the material's stiffness that each tet has, by fill and factor. Empty if it is 1 for all.
  std::vector<double> stiffnessScale() const;
  /// Nodes times the scale, and masses times its cube.
  void scaleBy(double scale);
  /// True where some tet has a copy.
  bool split() const;
  /// Ok, or that an array is not as long as it must be, or what it holds makes no sense. Cost O(T)
  Status check() const;
  /// Ok unless the mesh is not the one that the cage was built for: by vertexCount, and `meshHash`. For meshes as they
  /// were loaded: one that was moved with its cage has another hash.
  Status checkMesh(const TriangleMesh& mesh) const;

  /// See CageLocator. Cost O(T log T): for several points, make a CageLocator.
  int locate(const Eigen::Vector3d& point, const std::array<int, 3>& nearVertices) const;
};

/// Of the positions' bits, whatever the triangles. Cost O(vertexCount).
TETSKIN_CORE_API std::uint64_t positionsHash(const std::vector<Eigen::Vector3d>& positions);

/// Finds the copy of a tet that holds a point of the mesh's surface, or near it: samples on triangles, or the vertices
/// of a second mesh.
class TETSKIN_CORE_API CageLocator {
 public:
  /// Looks at the whole cage once. Cost O(T log T)
  /// cage  usable (see `usable`), and must outlive this
  explicit CageLocator(const Cage& cage);
  ~CageLocator();
  CageLocator(CageLocator&&) noexcept;
  CageLocator& operator=(CageLocator&&) noexcept;

  /// The tet that holds the point, reached from the tets of these vertices through faces; where none does, the one of
  /// smallest barycentric distance on the way. Of a cage without `vertexTets`, by the point's place alone.
  /// point         rest space
  /// nearVertices  of the triangle that the point lies on or near; in range
  /// Result        -1 of a locator that was moved from
  /// Cost          O(k log k) for k tets between them; without `vertexTets`, O(T)
  int locate(const Eigen::Vector3d& point, const std::array<int, 3>& nearVertices) const;

 private:
  struct Parts;
  std::unique_ptr<const Parts> parts_;
};

}  // namespace tetskin
