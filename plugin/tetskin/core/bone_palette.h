// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/mesh_skin.h>
#include <tetskin/core/types.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace tetskin {

/// Four bones and weights for every vertex, in the form that engines use: computed once, for `BonePalette` or for any
/// other bones that the nodes drive. Bone i follows node i.
struct TETSKIN_CORE_API SkinnedMesh {
  /// Number of bones that 16-bit indices can address.
  static constexpr std::size_t kMaxBones = 65536;

  std::vector<std::array<std::uint16_t, 4>> bones;  ///< vertexCount, in the binding's order: the nodes of its tet
  /// vertexCount, by bone; they sum to 1. For a vertex outside the cage, some are below 0 or above 1: they extrapolate.
  std::vector<std::array<float, 4>> weights;

  std::size_t vertexCount() const { return bones.size(); }  ///< number of vertices
  /// vertexCount, by bone: the weights in 65535ths, which sum to exactly 65535. In a cage twisted by 1.5 radians over
  /// its length, this moves a vertex inside by at most 3e-5 of its tet's edge. Weights below 0 become 0, and the others
  /// are scaled to compensate, so a vertex outside is off by up to about its distance from the cage.
  std::vector<std::array<std::uint16_t, 4>> normalisedWeights() const;
};

/// The bones and weights of the vertices that a binding carries. Cost O(vertexCount); allocates the result.
/// Error: TooLarge if the cage has more than SkinnedMesh::kMaxBones nodes.
template <class Scalar>
TETSKIN_CORE_API Result<SkinnedMesh> skinnedMeshOf(const SkinBinding<Scalar>& binding);

/// Layout of a bone [ A | t ], a 3x4 matrix of floats, in memory.
enum class BoneLayout {
  Rows,     ///< 12 floats: the 3 rows of 4, one after the other
  Columns,  ///< 16 floats: the 4 columns of a 4x4 matrix whose last row is 0 0 0 1, as in OpenGL, glTF and three.js
};

/// Number of floats of a bone in this layout.
constexpr std::size_t boneFloats(BoneLayout layout) {
  return layout == BoneLayout::Rows ? 12 : 16;
}

/// Memory that `BonePalette::update` writes and never reads: an array, or a mapped buffer. Not owned.
struct BoneView {
  float* data = nullptr;        ///< first float of the first bone
  std::size_t count = 0;        ///< number of bones
  std::size_t strideBytes = 0;  ///< from one bone to the next, a multiple of 4; 0: side by side
};

/// Options of a palette.
struct PaletteOptions {
  bool disableQuadratic = false;  ///< bones of the linear surface, even if the binding is quadratic
  /// Bones of the linear surface carry the gradients of the nodes, for normals in your own shader: see BonePalette. The
  /// binding must be quadratic; without `disableQuadratic` this option changes nothing.
  bool gradients = false;
  BoneLayout layout = BoneLayout::Rows;  ///< of the matrices
  /// World space, within Limits::kMaxCoordinate; subtracted from every position.
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  ParallelFor* threads = nullptr;  ///< for large cages; not owned, must outlive the last update. Null: none.
};

/// Affine bones, one per node, with which an engine's own linear blend skinning draws the surface of a MeshSkin, for
/// instance on a GPU. A vertex at the rest position X, with the bones and weights b of `skinnedMeshOf`, gets the
/// position sum of b_i (A_i X + t_i). With X_i the rest and x_i the current nodes, and F_i the gradient at node i:
/// - quadratic: A_i = F_i / 2, t_i = x_i - F_i X_i / 2. In a tet, where X is the sum of b_i X_i, the position is the
///   sum of b_i x_i + sum of b_i b_j (F_i - F_j) (X_j - X_i) / 2 over pairs i < j, which is the skin's surface.
/// - linear: A_i = 1, t_i = x_i - X_i.
/// - linear with `gradients`: A_i = F_i, t_i = x_i - X_i, for a shader that computes X + sum of b_i t_i.
///
/// Multiply rest normals by the inverse transpose, or the cofactors, of the sum of b_i A_i, and normalise them; bones
/// with A = 1 do not turn them. Rest positions are those of the mesh that was bound; inverse bind matrices are 1.
///
/// Apart from rounding, this differs from the skin in three ways. An edge's vector is not limited to half its rest
/// length, which matters where a cage is crumpled. In a quadratic surface, a vertex outside the cage is continued from
/// the closest point of its tet to second order, not to first, and without limits. And within quadratic tets of the
/// cage, where the skin uses the tet's own map, bones use the gradients fitted at nodes, as elsewhere.
///
/// Independent of any body: one palette serves all bodies with the same binding, one after the other. Can be moved, not
/// copied.
template <class Scalar>
class TETSKIN_CORE_API BonePalette {
 public:
  using Binding = typename SkinBinding<Scalar>::Pointer;  ///< a binding, shared

  /// A palette without bones.
  BonePalette() = default;
  BonePalette(BonePalette&& other) noexcept = default;             ///< the other one is unbound afterwards
  BonePalette& operator=(BonePalette&& other) noexcept = default;  ///< the other one is unbound afterwards

  /// Allocates what updates need: some 100 bytes per node, in double twice as many.
  /// Errors: Empty without a binding; InvalidOption for `gradients` with a linear binding, or an origin that is not
  /// finite or beyond Limits::kMaxCoordinate.
  static Result<BonePalette> create(Binding binding, const PaletteOptions& options = {});

  /// Writes the bones for these node positions, nodeCount x 3, world space. Cost O(nodes x neighbours), for a linear
  /// surface without gradients O(nodes); allocates nothing. Writes nothing on an error.
  /// bones   boneCount() matrices; see BoneView. The bone of a node without vertices is a translation
  /// Errors  NonFinite, see `firstNonFiniteNode`; TopologyChanged: wrong number of nodes; SizeMismatch: wrong number of
  ///         bones; Unbound: no binding
  StatusCode update(PointView<const Scalar> nodes, BoneView bones);
  /// Index of the first node that was not finite, or beyond Limits::kMaxCoordinate, in the last update that returned
  /// NonFinite.
  std::size_t firstNonFiniteNode() const;

  std::size_t boneCount() const;  ///< number of nodes: each has a bone
  BoneLayout layout() const;      ///< of the matrices
  /// Linear, or Quadratic if the bones belong to a quadratic surface.
  Interpolation interpolation() const;
  /// Sets the origin, world space, for later updates. Error: InvalidOption if it is not finite or beyond
  /// Limits::kMaxCoordinate; the origin is then unchanged.
  Status setOrigin(const Eigen::Vector3d& origin);

 private:
  struct Impl;
  std::shared_ptr<Impl> impl_;  ///< null: without a binding; never shared
};

}  // namespace tetskin
