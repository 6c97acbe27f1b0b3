// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/mesh_skin.h>
#include <tetskin/core/src/skinning/linear_skinning.h>
#include <tetskin/core/src/skinning/skin_tasks.h>

namespace tetskin {
namespace {

Status checkAttributes(const TriangleMesh& mesh) {
  const auto check = [&](std::size_t count, const char* what) -> Status {
    if (count == 0 || count == mesh.vertexCount()) return {};
    return {StatusCode::SizeMismatch, "the mesh has " + std::to_string(count) + " " + what + ", but " +
                                          std::to_string(mesh.vertexCount()) + " vertices"};
  };
  if (Status status = check(mesh.normals.size(), "normals"); !status.ok()) return status;
  return check(mesh.tangents.size(), "tangents");
}

std::vector<Eigen::Vector3d> directionsOf(const std::vector<Tangent>& tangents) {
  std::vector<Eigen::Vector3d> directions;
  directions.reserve(tangents.size());
  for (const Tangent& t : tangents) directions.push_back(t.head<3>().cast<double>());
  return directions;
}

/// By vertex, its slot.
std::vector<std::uint32_t> slotsOf(const Embedding& embedding) {
  std::vector<std::uint32_t> slots(embedding.vertexCount());
  for (std::uint32_t s = 0; s < slots.size(); ++s) slots[embedding.slotVertices()[s]] = s;
  return slots;
}

bool isUsable(const Eigen::Vector3d& origin) {
  return firstUnusable(PointView<const double>(origin.data(), 1)) == 1;
}

/// All that can be known of them before anything is embedded.
Status checkOptions(const SkinOptions& options, std::size_t vertexCount) {
  if (!isUsable(options.origin)) {
    return {StatusCode::InvalidOption, "the origin is not finite, or farther than 1e18 from the world's"};
  }
  if (!(options.hardEdgeDegrees >= 0.0)) {
    return {StatusCode::InvalidOption, "hardEdgeDegrees is " + std::to_string(options.hardEdgeDegrees) +
                                           "; give an angle of 0 or more, in degrees"};
  }
  if (options.previousPositions && !std::holds_alternative<std::monostate>(options.target)) {
    return {StatusCode::InvalidOption,
            "previous positions are kept of the skin's own array only; leave out the target, or keep them yourself"};
  }
  if (options.skipStill && (options.bounds || options.previousPositions)) {
    return {StatusCode::InvalidOption,
            "bounds and previous positions need all positions; leave them out, or do not skip what is still"};
  }
  const auto check = [&](std::size_t size, const char* what) -> Status {
    if (size == vertexCount) return {};
    return {StatusCode::SizeMismatch, "the " + std::string(what) + " holds " + std::to_string(size) +
                                          " points, but the mesh has " + std::to_string(vertexCount) + " vertices"};
  };
  Status status;
  if (const auto* single = std::get_if<PointView<float>>(&options.target)) status = check(single->size(), "target");
  if (const auto* twice = std::get_if<PointView<double>>(&options.target)) status = check(twice->size(), "target");
  if (!status.ok()) return status;
  if (!options.normalTarget.empty()) status = check(options.normalTarget.size(), "target for normals");
  if (!status.ok() || options.tangentTarget.empty()) return status;
  return check(options.tangentTarget.size(), "target for tangents");
}

template <class Scalar>
Status checkParts(const SkinBinding<Scalar>& binding, const SkinOptions& options) {
  const auto missing = [](const char* what) -> Status {
    return {StatusCode::InvalidOption,
            std::string("the binding was made without ") + what + "; make it with the same options"};
  };
  if (options.interpolation == Interpolation::Quadratic && !binding.quadratic) return missing("quadratic skinning");
  if (options.normals == Normals::Transformed && !binding.normals) return missing("transformed normals");
  if (options.normals == Normals::Recomputed && !binding.recomputed) return missing("recomputed normals");
  if (options.normals == Normals::Recomputed && binding.order != options.order) return missing("this vertex order");
  return {};
}

void fill(PointView<float> points, const Eigen::Vector3f& value) {
  for (std::size_t k = 0; k < points.size(); ++k) std::copy_n(value.data(), 3, points[k]);
}

/// What the options ask for beyond the embedding that is there.
template <class Scalar>
void addParts(const TetMesh& cage, const TriangleMesh& mesh, const SkinOptions& options, SkinBinding<Scalar>& made,
              QuadraticReport* quadratic) {
  if (options.interpolation == Interpolation::Quadratic) made.quadratic.emplace(cage, made.embedding, quadratic);
  if (options.normals == Normals::Transformed) {
    made.normals = DirectionFactors::ofNormals(cage, made.embedding, restNormals(mesh));
    if (!mesh.tangents.empty()) {
      made.tangents = DirectionFactors::ofTangents(cage, made.embedding, directionsOf(mesh.tangents));
    }
  } else if (options.normals == Normals::Recomputed) {
    const bool sorted = options.order == VertexOrder::Sorted;
    made.order = options.order;
    made.recomputed.emplace(mesh, sorted ? slotsOf(made.embedding) : std::vector<std::uint32_t>(),
                            options.hardEdgeDegrees);
  }
}

Status checkEmbedded(const TetMesh& cage, const TriangleMesh& mesh, const Embedding& embedding) {
  const auto check = [](std::size_t count, std::size_t embedded, const char* what) -> Status {
    if (count == embedded) return {};
    return {StatusCode::SizeMismatch, "there are " + std::to_string(count) + " " + what + ", but " +
                                          std::to_string(embedded) + " when the embedding was made; embed again"};
  };
  if (Status s = check(mesh.vertexCount(), embedding.vertexCount(), "vertices"); !s.ok()) return s;
  if (Status s = check(cage.nodeCount(), embedding.nodeCount(), "nodes"); !s.ok()) return s;
  return check(cage.tetCount(), embedding.tetCount(), "tets");
}

}  // namespace

EmbedReport refused(const TriangleMesh& mesh, Status status) {
  assert(!status.ok());
  EmbedReport report;
  report.vertexCount = report.unbound = mesh.vertexCount();
  report.status = std::move(status);
  return report;
}

template <class Scalar>
Status checkNodes(PointView<const Scalar> nodes) {
  const std::size_t bad = firstUnusable(nodes);
  if (bad == nodes.size()) return {};
  return {StatusCode::NonFinite, "node " + std::to_string(bad) +
                                     " is not finite, or farther than 1e18 from the origin; bind before the body "
                                     "explodes"};
}

template <class Scalar>
EmbedReport makeSkinBinding(const TetMesh& cage, const TriangleMesh& mesh, const SkinOptions& options,
                            std::shared_ptr<const SkinBinding<Scalar>>& binding, QuadraticReport* quadratic) {
  if (Status status = checkAttributes(mesh); !status.ok()) return refused(mesh, std::move(status));
  if (Status status = checkOptions(options, mesh.vertexCount()); !status.ok()) return refused(mesh, std::move(status));
  auto made = std::make_shared<SkinBinding<Scalar>>();
  EmbedOptions embedOptions;
  embedOptions.outside = options.outside;
  embedOptions.maxDistance = options.maxDistance;
  EmbedReport report = embed(cage, mesh, embedOptions, made->embedding);
  if (!report.ok()) return report;
  addParts(cage, mesh, options, *made, quadratic);
  binding = std::move(made);
  return report;
}

template <class Scalar>
Status makeSkinBinding(const TetMesh& cage, const TriangleMesh& mesh, const SkinOptions& options,
                       const Embedding& embedding, std::shared_ptr<const SkinBinding<Scalar>>& binding,
                       QuadraticReport* quadratic) {
  if (Status status = checkAttributes(mesh); !status.ok()) return status;
  if (Status status = checkOptions(options, mesh.vertexCount()); !status.ok()) return status;
  if (Status status = checkTriangleMesh(mesh); !status.ok()) return status;
  if (Status status = checkEmbedded(cage, mesh, embedding); !status.ok()) return status;
  auto made = std::make_shared<SkinBinding<Scalar>>();
  made->embedding = embedding;
  addParts(cage, mesh, options, *made, quadratic);
  binding = std::move(made);
  return {};
}

template <class Scalar>
EmbedReport MeshSkin<Scalar>::bind(const TetMesh& cage, const TriangleMesh& mesh, const SkinOptions& options) {
  std::shared_ptr<const SkinBinding<Scalar>> binding;
  EmbedReport report = makeSkinBinding(cage, mesh, options, binding);
  if (!report.ok()) return report;
  std::vector<Eigen::Matrix<Scalar, 3, 1>> nodes;
  nodes.reserve(cage.nodeCount());
  for (const Eigen::Vector3d& p : cage.nodes) nodes.push_back(p.cast<Scalar>());
  Status status = bind(std::move(binding), viewOf(std::as_const(nodes)), options);
  return status.ok() ? report : refused(mesh, std::move(status));
}

template <class Scalar>
Status MeshSkin<Scalar>::bind(std::shared_ptr<const SkinBinding<Scalar>> binding, PointView<const Scalar> nodes,
                              const SkinOptions& options) {
  if (!binding || binding->embedding.empty()) return {StatusCode::Empty, "there is no embedding to bind with"};
  const std::size_t vertexCount = binding->embedding.vertexCount();
  if (nodes.size() != binding->embedding.nodeCount()) {
    return {StatusCode::SizeMismatch, "there are " + std::to_string(nodes.size()) + " nodes, but the cage has " +
                                          std::to_string(binding->embedding.nodeCount())};
  }
  if (Status status = checkParts(*binding, options); !status.ok()) return status;
  if (Status status = checkOptions(options, vertexCount); !status.ok()) return status;
  if (Status status = checkNodes(nodes); !status.ok()) return status;

  MeshSkin made;
  made.options_ = options;
  made.nodes_ = PackedNodes<Scalar>(nodes.size());
  made.binding_ = std::move(binding);
  made.prepareArrays(vertexCount);
  *this = std::move(made);
  const std::size_t updated = update(nodes);
  assert(updated == nodes.size());
  (void)updated;
  hold();
  return {};
}

/// Allocates what the options ask for, and nothing else.
template <class Scalar>
void MeshSkin<Scalar>::prepareArrays(std::size_t vertexCount) {
  const auto direct = [&](auto points) { return skin_tasks::isDirect<Scalar>(points, options_.order); };
  bool positionsDirect = false;
  const bool readAgain = options_.normals == Normals::Recomputed;  // which the caller's memory must not be
  if (const auto* single = std::get_if<PointView<float>>(&options_.target)) {
    positionsDirect = direct(*single) && !readAgain;
  } else if (const auto* twice = std::get_if<PointView<double>>(&options_.target)) {
    positionsDirect = direct(*twice) && !readAgain;
  } else {
    positions_.resize(vertexCount);
    positionsDirect = direct(viewOf(positions_));
  }
  if (!positionsDirect) scratch_.resize(scratchSize(vertexCount));
  if (options_.previousPositions) previous_.resize(vertexCount);
  if (options_.interpolation == Interpolation::Quadratic) edges_ = EdgeVectors<Scalar>(*binding_->quadratic);
  if (options_.skipStill) moved_ = MovedParts<Scalar>(binding_->embedding, stencils());

  if (options_.normals == Normals::None) return;
  if (options_.normalTarget.empty()) normals_.resize(vertexCount);
  fill(normalsOut(), Eigen::Vector3f::UnitY());  // unit vectors to begin with: see transformDirections
  if (options_.normals == Normals::Recomputed) {
    padded_.resize(4 * vertexCount);
    return;
  }
  const auto scratchFor = [&](PointView<float> out, const Eigen::Vector3f& unit,
                              std::vector<Eigen::Vector3f>& scratch) {
    if (!skin_tasks::isDirect<float>(out, options_.order)) scratch.assign(vertexCount + 1, unit);
  };
  scratchFor(normalsOut(), Eigen::Vector3f::UnitY(), normalScratch_);
  if (!binding_->tangents) return;
  if (options_.tangentTarget.empty()) tangents_.resize(vertexCount);
  fill(tangentsOut(), Eigen::Vector3f::UnitX());
  scratchFor(tangentsOut(), Eigen::Vector3f::UnitX(), tangentScratch_);
}

template <class Scalar>
std::size_t MeshSkin<Scalar>::update(PointView<const Scalar> nodes) {
  assert(bound() && nodes.size() == nodeCount());
  held_ = true;
  // Compared before they are packed, which may be in place. Where none has moved, none has become bad.
  if (options_.skipStill && !moved_.update(binding_->embedding, stencils(), nodes)) return nodeCount();
  if (const std::size_t bad = nodes_.pack(nodes); bad < nodeCount()) {
    moved_.forget();  // the surface is not that of these nodes
    return bad;
  }
  if (stencils()) edges_.update(*stencils(), nodes_, options_.threads, moved_.gradients());
  if (const auto* single = std::get_if<PointView<float>>(&options_.target)) {
    skinTo(*single);
  } else if (const auto* twice = std::get_if<PointView<double>>(&options_.target)) {
    skinTo(*twice);
  } else {
    if (options_.previousPositions) positions_.swap(previous_);
    skinTo(viewOf(positions_));
    held_ = false;
  }
  return nodeCount();
}

template <class Scalar>
std::size_t MeshSkin<Scalar>::update(const KeptSteps<Scalar>& steps, Scalar alpha) {
  assert(bound() && steps.size() == nodeCount());
  steps.nodesAt(alpha, nodes_.memory());
  return update(PointView<const Scalar>(nodes_.memory()));
}

template <class Scalar>
bool MeshSkin<Scalar>::setOrigin(const Eigen::Vector3d& origin) {
  if (!isUsable(origin)) return false;
  options_.origin = origin;
  moved_.forget();
  return true;
}

template <class Scalar>
template <class Out>
void MeshSkin<Scalar>::skinTo(PointView<Out> out) {
  const bool recomputed = options_.normals == Normals::Recomputed, byScratch = !scratch_.empty();
  const SkinOutput<Scalar, Out> output{out,
                                       options_.order,
                                       options_.origin.template cast<Scalar>(),
                                       byScratch ? scratch_.data() : nullptr,
                                       moved_.runs(),
                                       recomputed && byScratch ? padded_.data() : nullptr};
  Box3* bounds = options_.bounds ? &bounds_ : nullptr;
  const Embedding& embedding = binding_->embedding;
  if (stencils()) {
    skinQuadratic(embedding, *stencils(), edges_, nodes_, output, bounds, options_.threads);
  } else {
    skinLinear(embedding, nodes_, output, bounds, options_.threads);
  }
  if (options_.normals == Normals::Transformed) skinDirections();
  if (!recomputed) return;
  if (!byScratch) padPoints(positions(), padded_, options_.threads);
  recomputeNormals(*binding_->recomputed, padded_, normalsOut(), options_.threads);
}

template <class Scalar>
void MeshSkin<Scalar>::skinDirections() {
  const auto carry = [&](const DirectionFactors& factors, PointView<float> out, std::vector<Eigen::Vector3f>& scratch) {
    transformDirections(binding_->embedding, factors, stencils(), stencils() ? &edges_ : nullptr, nodes_, out,
                        options_.order, scratch.empty() ? nullptr : scratch.front().data(), options_.threads,
                        moved_.runs());
  };
  carry(*binding_->normals, normalsOut(), normalScratch_);
  if (binding_->tangents) carry(*binding_->tangents, tangentsOut(), tangentScratch_);
}

/// Those of a quadratic surface; null for a linear one.
template <class Scalar>
const QuadraticStencils<Scalar>* MeshSkin<Scalar>::stencils() const {
  return options_.interpolation == Interpolation::Quadratic ? &*binding_->quadratic : nullptr;
}

template <class Scalar>
PointView<float> MeshSkin<Scalar>::normalsOut() {
  return options_.normalTarget.empty() ? viewOf(normals_) : options_.normalTarget;
}

template <class Scalar>
PointView<float> MeshSkin<Scalar>::tangentsOut() {
  return options_.tangentTarget.empty() ? viewOf(tangents_) : options_.tangentTarget;
}

template Status checkNodes(PointView<const float>);
template Status checkNodes(PointView<const double>);
template EmbedReport makeSkinBinding(const TetMesh&, const TriangleMesh&, const SkinOptions&,
                                     std::shared_ptr<const SkinBinding<float>>&, QuadraticReport*);
template EmbedReport makeSkinBinding(const TetMesh&, const TriangleMesh&, const SkinOptions&,
                                     std::shared_ptr<const SkinBinding<double>>&, QuadraticReport*);
template Status makeSkinBinding(const TetMesh&, const TriangleMesh&, const SkinOptions&, const Embedding&,
                                std::shared_ptr<const SkinBinding<float>>&, QuadraticReport*);
template Status makeSkinBinding(const TetMesh&, const TriangleMesh&, const SkinOptions&, const Embedding&,
                                std::shared_ptr<const SkinBinding<double>>&, QuadraticReport*);
template class MeshSkin<float>;
template class MeshSkin<double>;

}  // namespace tetskin
