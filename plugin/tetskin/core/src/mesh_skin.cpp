// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/mesh_skin.h>
#include <tetskin/core/src/base/instantiate.h>
#include <tetskin/core/src/exported/skin_binding.h>
#include <tetskin/core/src/skinning/skin_tasks.h>

#include <cassert>

namespace tetskin {
namespace {

void fill(PointView<float> points, const Eigen::Vector3f& value) {
  for (std::size_t k = 0; k < points.size(); ++k) std::copy_n(value.data(), 3, points[k]);
}

}  // namespace

/// The data of a bound skin, and the steps of an update.
template <class Scalar>
struct MeshSkin<Scalar>::Impl {
  Binding binding;
  InstanceOptions options;
  PackedNodes<Scalar> nodes;
  EdgeVectors<Scalar> edges;
  std::vector<Eigen::Matrix<Scalar, 3, 1>> positions, previous;
  std::vector<Eigen::Vector3f> normals, tangents;
  std::vector<Scalar> padded;   ///< positions, needed for recomputed normals
  std::vector<Scalar> scratch;  ///< used for positions that are not written directly
  std::vector<Eigen::Vector3f> normalScratch, tangentScratch;
  Box3 bounds;
  std::size_t firstBadNode = 0;

  /// Allocates only what the options request.
  Impl(Binding made, const InstanceOptions& wanted)
      : binding(std::move(made)), options(wanted), nodes(bound().embedding.nodeCount()) {
    const std::size_t vertexCount = bound().embedding.vertexCount();
    const auto direct = [&](auto points) { return skin_tasks::isDirect<Scalar>(points, order()); };
    bool positionsDirect = false;
    const bool readAgain = normalsKind() == Normals::Recomputed;  // since the caller's memory must not be read
    if (const auto* single = std::get_if<PointView<float>>(&options.target)) {
      positionsDirect = direct(*single) && !readAgain;
    } else if (const auto* twice = std::get_if<PointView<double>>(&options.target)) {
      positionsDirect = direct(*twice) && !readAgain;
    } else {
      positions.resize(vertexCount);
      positionsDirect = direct(viewOf(positions));
    }
    if (!positionsDirect) scratch.resize(scratchSize(vertexCount));
    if (options.previousPositions) previous.resize(vertexCount);
    if (stencils()) edges = EdgeVectors<Scalar>(*stencils());
    if (normalsKind() != Normals::None) prepareNormals();
  }

  /// Updates from the packed nodes.
  void skin() {
    if (stencils()) edges.update(*stencils(), nodes, options.threads);
    if (const auto* single = std::get_if<PointView<float>>(&options.target)) return skinTo(*single);
    if (const auto* twice = std::get_if<PointView<double>>(&options.target)) return skinTo(*twice);
    if (options.previousPositions) positions.swap(previous);
    skinTo(viewOf(positions));
  }

  /// The stencils of a quadratic surface; null for a linear one.
  const QuadraticStencils<Scalar>* stencils() const {
    return bound().quadratic && !options.disableQuadratic ? &*bound().quadratic : nullptr;
  }

 private:
  const SkinData<Scalar>& bound() const { return dataOf(*binding); }
  Bends<Scalar> bends() const { return {stencils(), stencils() ? &edges : nullptr}; }
  VertexOrder order() const { return bound().options.order; }
  Normals normalsKind() const { return options.disableNormals ? Normals::None : bound().options.normals; }
  PointView<float> normalsOut() { return options.normalTarget.empty() ? viewOf(normals) : options.normalTarget; }
  PointView<float> tangentsOut() { return options.tangentTarget.empty() ? viewOf(tangents) : options.tangentTarget; }

  void prepareNormals() {
    assert(normalsOut().empty() || normalsOut().size() == bound().embedding.vertexCount());
    const std::size_t vertexCount = bound().embedding.vertexCount();
    if (options.normalTarget.empty()) normals.resize(vertexCount);
    fill(normalsOut(), Eigen::Vector3f::UnitY());  // unit vectors initially: see transformDirections
    if (normalsKind() == Normals::Recomputed) {
      padded.resize(4 * vertexCount);
      return;
    }
    const auto scratchFor = [&](PointView<float> out, const Eigen::Vector3f& unit, std::vector<Eigen::Vector3f>& room) {
      if (!skin_tasks::isDirect<float>(out, order())) room.assign(vertexCount + 1, unit);
    };
    scratchFor(normalsOut(), Eigen::Vector3f::UnitY(), normalScratch);
    if (!bound().tangents) return;
    if (options.tangentTarget.empty()) tangents.resize(vertexCount);
    fill(tangentsOut(), Eigen::Vector3f::UnitX());
    scratchFor(tangentsOut(), Eigen::Vector3f::UnitX(), tangentScratch);
  }

  template <class Out>
  void skinTo(PointView<Out> out) {
    assert(out.size() == bound().embedding.vertexCount());
    const bool recomputed = normalsKind() == Normals::Recomputed, byScratch = !scratch.empty();
    const SkinOutput<Scalar, Out> output{out, order(), options.origin.template cast<Scalar>(),
                                         byScratch ? scratch.data() : nullptr,
                                         recomputed && byScratch ? padded.data() : nullptr};
    Box3* box = options.bounds ? &bounds : nullptr;
    skinPoints(bound().embedding, nodes, bends(), output, box, options.threads);
    if (normalsKind() == Normals::Transformed) skinDirections();
    if (!recomputed) return;
    if (!byScratch) padPoints(viewOf(std::as_const(positions)), padded, options.threads);
    recomputeNormals(*bound().recomputed, padded, normalsOut(), options.threads);
  }

  void skinDirections() {
    assert(bound().normals && normalsOut().size() == bound().embedding.vertexCount());
    const auto carry = [&](const DirectionFactors& factors, PointView<float> out, std::vector<Eigen::Vector3f>& room) {
      transformDirections(bound().embedding, factors, bends(), nodes, out, order(),
                          room.empty() ? nullptr : room.front().data(), options.threads);
    };
    carry(*bound().normals, normalsOut(), normalScratch);
    if (bound().tangents) carry(*bound().tangents, tangentsOut(), tangentScratch);
  }
};

template <class Scalar>
Result<EmbedReport> MeshSkin<Scalar>::bind(const Cage& cage, const TriangleMesh& mesh, const SkinOptions& options) {
  if (Status status = checkInstance(options, mesh.vertexCount()); !status.ok()) return status;
  EmbedReport report;
  Result<Binding> made = SkinBinding<Scalar>::create(cage, mesh, options, &report);
  if (!made.ok()) return made.status();
  std::vector<Eigen::Matrix<Scalar, 3, 1>> nodes;
  nodes.reserve(cage.mesh.nodeCount());
  for (const Eigen::Vector3d& p : cage.mesh.nodes) nodes.push_back(p.cast<Scalar>());
  const InstanceOptions& instance = options;
  if (Status status = bind(made.value(), viewOf(std::as_const(nodes)), instance); !status.ok()) return status;
  return report;
}

template <class Scalar>
Status MeshSkin<Scalar>::bind(Binding binding, PointView<const Scalar> nodes, const InstanceOptions& options) {
  if (!binding || binding->embedding().empty())
    return {StatusCode::Empty, "the embedding is empty; embed the mesh before binding"};
  const Embedding& embedding = binding->embedding();
  if (nodes.size() != embedding.nodeCount()) {
    return {StatusCode::SizeMismatch, "there are " + std::to_string(nodes.size()) + " nodes, but the cage has " +
                                          std::to_string(embedding.nodeCount())};
  }
  if (Status status = checkInstance(options, embedding.vertexCount()); !status.ok()) return status;
  if (Status status = checkNodes(nodes); !status.ok()) return status;
  impl_ = std::make_shared<Impl>(std::move(binding), options);
  const StatusCode updated = update(nodes);
  assert(updated == StatusCode::Ok);
  (void)updated;
  clearMotion();
  return {};
}

template <class Scalar>
StatusCode MeshSkin<Scalar>::update(PointView<const Scalar> nodes) {
  motionCleared_ = true;
  if (!bound()) return StatusCode::Unbound;
  if (nodes.size() != nodeCount()) return StatusCode::TopologyChanged;
  if (const std::size_t bad = impl_->nodes.pack(nodes); bad < nodes.size()) {
    impl_->firstBadNode = bad;
    return StatusCode::NonFinite;
  }
  impl_->skin();
  motionCleared_ = false;
  return StatusCode::Ok;
}

template <class Scalar>
StatusCode MeshSkin<Scalar>::update(const StepHistory<Scalar>& steps, Scalar alpha) {
  motionCleared_ = true;
  if (!bound()) return StatusCode::Unbound;
  if (steps.size() != nodeCount()) return StatusCode::TopologyChanged;
  const PointView<Scalar> memory = impl_->nodes.memory();
  steps.nodesAt(alpha, memory);
  return update(PointView<const Scalar>(memory));
}

template <class Scalar>
std::size_t MeshSkin<Scalar>::firstNonFiniteNode() const {
  return bound() ? impl_->firstBadNode : 0;
}

template <class Scalar>
std::size_t MeshSkin<Scalar>::nodeCount() const {
  return bound() ? impl_->nodes.size() : 0;
}

template <class Scalar>
Interpolation MeshSkin<Scalar>::interpolation() const {
  return bound() && impl_->stencils() ? Interpolation::Quadratic : Interpolation::Linear;
}

template <class Scalar>
PointView<const Scalar> MeshSkin<Scalar>::positions() const {
  if (!bound()) return {};
  return viewOf(std::as_const(impl_->positions));
}

template <class Scalar>
PointView<const Scalar> MeshSkin<Scalar>::previousPositions() const {
  if (!bound() || !impl_->options.previousPositions) return {};
  return viewOf(std::as_const(motionCleared_ ? impl_->positions : impl_->previous));
}

template <class Scalar>
PointView<const float> MeshSkin<Scalar>::normals() const {
  if (!bound()) return {};
  return viewOf(std::as_const(impl_->normals));
}

template <class Scalar>
PointView<const float> MeshSkin<Scalar>::tangents() const {
  if (!bound()) return {};
  return viewOf(std::as_const(impl_->tangents));
}

template <class Scalar>
const Box3& MeshSkin<Scalar>::bounds() const {
  static const Box3 empty;
  return bound() ? impl_->bounds : empty;
}

template <class Scalar>
auto MeshSkin<Scalar>::binding() const -> Binding {
  return bound() ? impl_->binding : nullptr;
}

template <class Scalar>
Status MeshSkin<Scalar>::setOrigin(const Eigen::Vector3d& origin) {
  if (Status status = checkOrigin(origin); !status.ok()) return status;
  if (bound()) impl_->options.origin = origin;
  return {};
}

TETSKIN_INSTANTIATE_CLASS(MeshSkin)

}  // namespace tetskin
