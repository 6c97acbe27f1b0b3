// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/bone_palette.h>
#include <tetskin/core/src/base/instantiate.h>
#include <tetskin/core/src/exported/skin_binding.h>
#include <tetskin/core/src/skinning/skin_tasks.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

namespace tetskin {
namespace {

/// A bone costs about as much as two vertices; gradients have their own tasks.
constexpr std::size_t kBonesPerTask = 8192;

/// The weights in 65535ths. The rounding error of the sum goes to the largest weight, where it matters least.
std::array<std::uint16_t, 4> normalised(const std::array<float, 4>& weights) {
  constexpr int kOne = 65535;
  double sum = 0.0;
  for (const float w : weights) sum += std::max(static_cast<double>(w), 0.0);
  assert(sum > 0.0);
  std::array<int, 4> parts{};
  for (std::size_t k = 0; k < 4; ++k) {
    parts[k] = static_cast<int>(std::lround(std::max(static_cast<double>(weights[k]), 0.0) / sum * kOne));
  }
  *std::max_element(parts.begin(), parts.end()) += kOne - std::accumulate(parts.begin(), parts.end(), 0);
  std::array<std::uint16_t, 4> result{};
  for (std::size_t k = 0; k < 4; ++k) result[k] = static_cast<std::uint16_t>(parts[k]);
  return result;
}

}  // namespace

std::vector<std::array<std::uint16_t, 4>> SkinnedMesh::normalisedWeights() const {
  std::vector<std::array<std::uint16_t, 4>> result;
  result.reserve(weights.size());
  for (const std::array<float, 4>& w : weights) result.push_back(normalised(w));
  return result;
}

template <class Scalar>
Result<SkinnedMesh> skinnedMeshOf(const SkinBinding<Scalar>& binding) {
  const EmbeddingData& embedding = dataOf(binding.embedding());
  if (embedding.nodeCount > SkinnedMesh::kMaxBones) {
    return Status{StatusCode::TooLarge, "the cage has " + std::to_string(embedding.nodeCount) +
                                            " nodes, but 16-bit indices number no more than " +
                                            std::to_string(SkinnedMesh::kMaxBones) + " bones; use a coarser cage"};
  }
  const bool sorted = binding.options().order == VertexOrder::Sorted;
  SkinnedMesh mesh;
  mesh.bones.resize(embedding.vertexCount());
  mesh.weights.resize(embedding.vertexCount());
  for (std::size_t r = 0; r + 1 < embedding.runs.size(); ++r) {
    const EmbeddingData::Run& run = embedding.runs[r];
    std::array<std::uint16_t, 4> bones{};
    for (std::size_t k = 0; k < 4; ++k) bones[k] = static_cast<std::uint16_t>(run.nodes[k]);
    for (std::uint32_t slot = run.firstSlot; slot < embedding.runs[r + 1].firstSlot; ++slot) {
      const std::size_t v = sorted ? slot : embedding.slotVertices[slot];
      const float b0 = embedding.weights[0][slot], b1 = embedding.weights[1][slot], b2 = embedding.weights[2][slot];
      mesh.bones[v] = bones;
      mesh.weights[v] = {b0, b1, b2, 1.0f - b0 - b1 - b2};
    }
  }
  return mesh;
}

/// The data of a palette with a binding.
template <class Scalar>
struct BonePalette<Scalar>::Impl {
  Binding binding;
  PaletteOptions options;
  PackedNodes<Scalar> nodes;
  std::vector<std::uint32_t> gradientOf;  ///< by node: the last gradient, the identity, for nodes without one
  NodeGradients<Scalar> gradients;
  std::size_t firstBadNode = 0;

  Impl(Binding made, const PaletteOptions& wanted)
      : binding(std::move(made)), options(wanted), nodes(bound().embedding.nodeCount()) {
    assert(bound().restNodes.size() == 4 * nodes.size());
    if (!hasGradients()) {
      gradients = NodeGradients<Scalar>(0);
      gradientOf.assign(nodes.size(), 0);
      return;
    }
    const std::vector<std::uint32_t>& gradientNodes = bound().quadratic->gradientNodes();
    gradients = NodeGradients<Scalar>(gradientNodes.size());
    gradientOf.assign(nodes.size(), static_cast<std::uint32_t>(gradientNodes.size()));
    for (std::size_t g = 0; g < gradientNodes.size(); ++g) gradientOf[gradientNodes[g]] = static_cast<std::uint32_t>(g);
  }

  /// Uses the packed nodes.
  void write(BoneView bones) {
    assert(bones.count == nodes.size());
    if (hasGradients()) gradients.update(*bound().quadratic, nodes, options.threads);
    kernels::BoneWork<Scalar> work;
    work.content = quadratic() ? kernels::BoneContent::HalfGradient : kernels::BoneContent::Gradient;
    work.columns = options.layout == BoneLayout::Columns;
    work.gradientOf = gradientOf.data();
    work.gradients = gradients.data();
    work.restNodes = bound().restNodes.data();
    work.nodes = nodes.data();
    for (int k = 0; k < 3; ++k) work.shift[k] = nodes.mean()[k] - static_cast<Scalar>(options.origin[k]);
    work.bones = bones.data;
    work.strideBytes = bones.strideBytes;
    const std::size_t tasks = skin_tasks::taskCount(nodes.size(), kBonesPerTask);
    runTasks(options.threads, tasks, [&](std::size_t task) {
      kernels::BoneWork<Scalar> part = work;
      part.firstNode = skin_tasks::firstItem(nodes.size(), tasks, task);
      part.lastNode = skin_tasks::firstItem(nodes.size(), tasks, task + 1);
      kernels::tableInUse<Scalar>().bones(part);
    });
  }

  bool quadratic() const { return bound().quadratic && !options.disableQuadratic; }

 private:
  const SkinData<Scalar>& bound() const { return dataOf(*binding); }
  bool hasGradients() const { return quadratic() || options.gradients; }
};

template <class Scalar>
Result<BonePalette<Scalar>> BonePalette<Scalar>::create(Binding binding, const PaletteOptions& options) {
  if (!binding) return Status{StatusCode::Empty, "there is no binding; create one, or bind a skin and take its own"};
  if (Status status = checkOrigin(options.origin); !status.ok()) return status;
  if (options.gradients && !dataOf(*binding).quadratic) {
    return Status{StatusCode::InvalidOption,
                  "a linear binding has no gradients; make it with Interpolation::Quadratic, and a palette with "
                  "disableQuadratic"};
  }
  BonePalette palette;
  palette.impl_ = std::make_shared<Impl>(std::move(binding), options);
  return palette;
}

template <class Scalar>
StatusCode BonePalette<Scalar>::update(PointView<const Scalar> nodes, BoneView bones) {
  if (!impl_) return StatusCode::Unbound;
  if (nodes.size() != boneCount()) return StatusCode::TopologyChanged;
  if (bones.count != boneCount()) return StatusCode::SizeMismatch;
  const std::size_t boneBytes = boneFloats(layout()) * sizeof(float);
  if (bones.strideBytes == 0) bones.strideBytes = boneBytes;
  assert(bones.data && bones.strideBytes >= boneBytes && bones.strideBytes % sizeof(float) == 0);
  if (const std::size_t bad = impl_->nodes.pack(nodes); bad < nodes.size()) {
    impl_->firstBadNode = bad;
    return StatusCode::NonFinite;
  }
  impl_->write(bones);
  return StatusCode::Ok;
}

template <class Scalar>
std::size_t BonePalette<Scalar>::firstNonFiniteNode() const {
  return impl_ ? impl_->firstBadNode : 0;
}

template <class Scalar>
std::size_t BonePalette<Scalar>::boneCount() const {
  return impl_ ? impl_->nodes.size() : 0;
}

template <class Scalar>
BoneLayout BonePalette<Scalar>::layout() const {
  return impl_ ? impl_->options.layout : BoneLayout::Rows;
}

template <class Scalar>
Interpolation BonePalette<Scalar>::interpolation() const {
  return impl_ && impl_->quadratic() ? Interpolation::Quadratic : Interpolation::Linear;
}

template <class Scalar>
Status BonePalette<Scalar>::setOrigin(const Eigen::Vector3d& origin) {
  if (Status status = checkOrigin(origin); !status.ok()) return status;
  if (impl_) impl_->options.origin = origin;
  return {};
}

#define TETSKIN_INSTANTIATE(Scalar)   \
  template class BonePalette<Scalar>; \
  template TETSKIN_CORE_API Result<SkinnedMesh> skinnedMeshOf(const SkinBinding<Scalar>&);
TETSKIN_FOR_SCALARS(TETSKIN_INSTANTIATE)
#undef TETSKIN_INSTANTIATE

}  // namespace tetskin
