// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/mesh_skin.h>
#include <tetskin/core/src/shared/base/instantiate.h>
#include <tetskin/core/src/shared/skin_binding.h>
#include <tetskin/core/src/skinning/linear_skinning.h>
#include <tetskin/core/src/skinning/skin_tasks.h>

namespace tetskin {
namespace {

void fill(PointView<float> points, const Eigen::Vector3f& value) {
  for (std::size_t k = 0; k < points.size(); ++k) std::copy_n(value.data(), 3, points[k]);
}

}  // namespace

const char* toString(UpdateStatus status) {
  switch (status) {
    case UpdateStatus::Updated:
      return "updated";
    case UpdateStatus::Asleep:
      return "asleep";
    case UpdateStatus::Hidden:
      return "hidden";
    case UpdateStatus::NonFinite:
      return "not finite";
    case UpdateStatus::TopologyChanged:
      return "topology changed";
    case UpdateStatus::Unbound:
      return "unbound";
  }
  return "unknown update status";
}

/// What a bound skin has, and its steps of an update.
template <class Scalar>
struct MeshSkin<Scalar>::Parts {
  Binding binding;
  InstanceOptions options;
  PackedNodes<Scalar> nodes;
  EdgeVectors<Scalar> edges;
  std::vector<Eigen::Matrix<Scalar, 3, 1>> positions, previous;
  std::vector<Eigen::Vector3f> normals, tangents;
  std::vector<Scalar> padded;   ///< positions, for recomputed normals
  std::vector<Scalar> scratch;  ///< of positions, where they are not written directly
  std::vector<Eigen::Vector3f> normalScratch, tangentScratch;
  Box3 bounds;
  std::size_t firstBadNode = 0;

  /// Allocates what the options ask for, and nothing else.
  Parts(Binding made, const InstanceOptions& wanted);
  void skin();
  /// Those of a quadratic surface; null for a linear one.
  const QuadraticStencils<Scalar>* stencils() const {
    return bound().quadratic && !options.leaveOutQuadratic ? &*bound().quadratic : nullptr;
  }

 private:
  const SkinParts<Scalar>& bound() const { return binding->parts(); }
  VertexOrder order() const { return bound().options.order; }
  Normals normalsKind() const { return options.leaveOutNormals ? Normals::None : bound().options.normals; }
  PointView<float> normalsOut() { return options.normalTarget.empty() ? viewOf(normals) : options.normalTarget; }
  PointView<float> tangentsOut() { return options.tangentTarget.empty() ? viewOf(tangents) : options.tangentTarget; }
  void prepareNormals();
  template <class Out>
  void skinTo(PointView<Out> out);
  void skinDirections();
};

template <class Scalar>
MeshSkin<Scalar>::Parts::Parts(Binding made, const InstanceOptions& wanted)
    : binding(std::move(made)), options(wanted), nodes(bound().embedding.nodeCount()) {
  const std::size_t vertexCount = bound().embedding.vertexCount();
  const auto direct = [&](auto points) { return skin_tasks::isDirect<Scalar>(points, order()); };
  bool positionsDirect = false;
  const bool readAgain = normalsKind() == Normals::Recomputed;  // which the caller's memory must not be
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

template <class Scalar>
void MeshSkin<Scalar>::Parts::prepareNormals() {
  const std::size_t vertexCount = bound().embedding.vertexCount();
  if (options.normalTarget.empty()) normals.resize(vertexCount);
  fill(normalsOut(), Eigen::Vector3f::UnitY());  // unit vectors to begin with: see transformDirections
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

/// For the nodes as they are packed.
template <class Scalar>
void MeshSkin<Scalar>::Parts::skin() {
  if (stencils()) edges.update(*stencils(), nodes, options.threads);
  if (const auto* single = std::get_if<PointView<float>>(&options.target)) return skinTo(*single);
  if (const auto* twice = std::get_if<PointView<double>>(&options.target)) return skinTo(*twice);
  if (options.previousPositions) positions.swap(previous);
  skinTo(viewOf(positions));
}

template <class Scalar>
template <class Out>
void MeshSkin<Scalar>::Parts::skinTo(PointView<Out> out) {
  const bool recomputed = normalsKind() == Normals::Recomputed, byScratch = !scratch.empty();
  const SkinOutput<Scalar, Out> output{out, order(), options.origin.template cast<Scalar>(),
                                       byScratch ? scratch.data() : nullptr,
                                       recomputed && byScratch ? padded.data() : nullptr};
  Box3* box = options.bounds ? &bounds : nullptr;
  if (stencils()) {
    skinQuadratic(bound().embedding, *stencils(), edges, nodes, output, box, options.threads);
  } else {
    skinLinear(bound().embedding, nodes, output, box, options.threads);
  }
  if (normalsKind() == Normals::Transformed) skinDirections();
  if (!recomputed) return;
  if (!byScratch) padPoints(viewOf(std::as_const(positions)), padded, options.threads);
  recomputeNormals(*bound().recomputed, padded, normalsOut(), options.threads);
}

template <class Scalar>
void MeshSkin<Scalar>::Parts::skinDirections() {
  const auto carry = [&](const DirectionFactors& factors, PointView<float> out, std::vector<Eigen::Vector3f>& room) {
    transformDirections(bound().embedding, factors, stencils(), stencils() ? &edges : nullptr, nodes, out, order(),
                        room.empty() ? nullptr : room.front().data(), options.threads);
  };
  carry(*bound().normals, normalsOut(), normalScratch);
  if (bound().tangents) carry(*bound().tangents, tangentsOut(), tangentScratch);
}

template <class Scalar>
MeshSkin<Scalar>::MeshSkin() = default;
template <class Scalar>
MeshSkin<Scalar>::~MeshSkin() = default;
template <class Scalar>
MeshSkin<Scalar>::MeshSkin(MeshSkin&& other) noexcept = default;
template <class Scalar>
MeshSkin<Scalar>& MeshSkin<Scalar>::operator=(MeshSkin&& other) noexcept = default;

template <class Scalar>
Result<EmbedReport> MeshSkin<Scalar>::bind(const Cage& cage, const TriangleMesh& mesh, const SkinOptions& options) {
  if (Status status = checkInstance(options, mesh.vertexCount()); !status.ok()) return status;
  EmbedReport report;
  Result<Binding> made = SkinBinding<Scalar>::make(cage, mesh, options, &report);
  if (!made.ok()) return made.status();
  std::vector<Eigen::Matrix<Scalar, 3, 1>> nodes;
  nodes.reserve(cage.nodeCount());
  for (const Eigen::Vector3d& p : cage.nodes) nodes.push_back(p.cast<Scalar>());
  const InstanceOptions& instance = options;
  if (Status status = bind(made.value(), viewOf(std::as_const(nodes)), instance); !status.ok()) return status;
  return report;
}

template <class Scalar>
Status MeshSkin<Scalar>::bind(Binding binding, PointView<const Scalar> nodes, const InstanceOptions& options) {
  if (!binding || binding->embedding().empty()) return {StatusCode::Empty, "there is no embedding to bind with"};
  const Embedding& embedding = binding->embedding();
  if (nodes.size() != embedding.nodeCount()) {
    return {StatusCode::SizeMismatch, "there are " + std::to_string(nodes.size()) + " nodes, but the cage has " +
                                          std::to_string(embedding.nodeCount())};
  }
  if (Status status = checkInstance(options, embedding.vertexCount()); !status.ok()) return status;
  if (Status status = checkNodes(nodes); !status.ok()) return status;
  parts_ = std::make_unique<Parts>(std::move(binding), options);
  const UpdateStatus updated = update(nodes);
  assert(updated == UpdateStatus::Updated);
  (void)updated;
  hold();
  return {};
}

template <class Scalar>
UpdateStatus MeshSkin<Scalar>::update(PointView<const Scalar> nodes) {
  held_ = true;
  if (!bound()) return UpdateStatus::Unbound;
  if (nodes.size() != nodeCount()) return UpdateStatus::TopologyChanged;
  if (const std::size_t bad = parts_->nodes.pack(nodes); bad < nodes.size()) {
    parts_->firstBadNode = bad;
    return UpdateStatus::NonFinite;
  }
  parts_->skin();
  held_ = false;
  return UpdateStatus::Updated;
}

template <class Scalar>
UpdateStatus MeshSkin<Scalar>::update(const KeptSteps<Scalar>& steps, Scalar alpha) {
  held_ = true;
  if (!bound()) return UpdateStatus::Unbound;
  if (steps.size() != nodeCount()) return UpdateStatus::TopologyChanged;
  const PointView<Scalar> memory = parts_->nodes.memory();
  steps.nodesAt(alpha, memory);
  return update(PointView<const Scalar>(memory));
}

template <class Scalar>
std::size_t MeshSkin<Scalar>::firstBadNode() const {
  return bound() ? parts_->firstBadNode : 0;
}

template <class Scalar>
std::size_t MeshSkin<Scalar>::nodeCount() const {
  return bound() ? parts_->nodes.size() : 0;
}

template <class Scalar>
Interpolation MeshSkin<Scalar>::interpolation() const {
  return bound() && parts_->stencils() ? Interpolation::Quadratic : Interpolation::Linear;
}

template <class Scalar>
PointView<const Scalar> MeshSkin<Scalar>::positions() const {
  if (!bound()) return {};
  return viewOf(std::as_const(parts_->positions));
}

template <class Scalar>
PointView<const Scalar> MeshSkin<Scalar>::previousPositions() const {
  if (!bound() || !parts_->options.previousPositions) return {};
  return viewOf(std::as_const(held_ ? parts_->positions : parts_->previous));
}

template <class Scalar>
PointView<const float> MeshSkin<Scalar>::normals() const {
  if (!bound()) return {};
  return viewOf(std::as_const(parts_->normals));
}

template <class Scalar>
PointView<const float> MeshSkin<Scalar>::tangents() const {
  if (!bound()) return {};
  return viewOf(std::as_const(parts_->tangents));
}

template <class Scalar>
const Box3& MeshSkin<Scalar>::bounds() const {
  static const Box3 empty;
  return bound() ? parts_->bounds : empty;
}

template <class Scalar>
auto MeshSkin<Scalar>::binding() const -> Binding {
  return bound() ? parts_->binding : nullptr;
}

template <class Scalar>
Status MeshSkin<Scalar>::setOrigin(const Eigen::Vector3d& origin) {
  if (Status status = checkOrigin(origin); !status.ok()) return status;
  if (bound()) parts_->options.origin = origin;
  return {};
}

#define TETSKIN_INSTANTIATE(Scalar) template class MeshSkin<Scalar>;
TETSKIN_FOR_SCALARS(TETSKIN_INSTANTIATE)
#undef TETSKIN_INSTANTIATE

}  // namespace tetskin
