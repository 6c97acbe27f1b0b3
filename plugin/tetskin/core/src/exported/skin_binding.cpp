// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/cage.h>
#include <tetskin/core/src/base/embedding/embedding_data.h>
#include <tetskin/core/src/base/instantiate.h>
#include <tetskin/core/src/base/mesh/mesh_checks.h>
#include <tetskin/core/src/exported/skin_binding.h>

#include <cassert>
#include <chrono>
#include <cstdio>

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

Status checkBinding(const TriangleMesh& mesh, const BindingOptions& options) {
  if (Status status = checkAttributes(mesh); !status.ok()) return status;
  if (options.hardEdgeDegrees >= 0.0) return {};
  return {StatusCode::InvalidOption, "hardEdgeDegrees is " + std::to_string(options.hardEdgeDegrees) +
                                         "; it must be an angle of 0 or more, in degrees"};
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

template <class Scalar>
Status addQuadratic(const Cage& cage, SkinData<Scalar>& data) {
  const auto start = std::chrono::steady_clock::now();
  const Result<std::vector<QuadraticTet>> tets = quadraticTets(cage);
  if (!tets.ok()) return tets.status();
  const QuadraticStencils<Scalar>& made =
      data.quadratic.emplace(cage.mesh, data.embedding, cage.sourceTet, tets.value());
  QuadraticReport& report = data.quadraticReport;
  report.nodes = made.gradientCount();
  report.underdeterminedNodes = made.thinCount();
  report.averagedNodes = made.plainCount();
  report.edges = made.edgeCount();
  if (report.nodes > 0) {
    report.meanNeighbours = static_cast<double>(made.entryNodes().size()) / static_cast<double>(report.nodes) - 1.0;
  }
  report.milliseconds = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  return {};
}

/// Computes what the options request in addition to the embedding.
template <class Scalar>
Result<std::unique_ptr<const SkinData<Scalar>>> makeSkinData(const Cage& cage, const TriangleMesh& mesh,
                                                             const BindingOptions& options,
                                                             const Embedding& embedding) {
  assert(embedding.vertexCount() == mesh.vertexCount() && embedding.tetCount() == cage.mesh.tetCount());
  auto made = std::make_unique<SkinData<Scalar>>();
  made->options = options;
  made->embedding = embedding;
  made->restNodes.reserve(4 * cage.mesh.nodeCount());
  for (const Eigen::Vector3d& p : cage.mesh.nodes) {
    for (const double x : {p.x(), p.y(), p.z(), 0.0}) made->restNodes.push_back(static_cast<Scalar>(x));
  }
  if (options.interpolation == Interpolation::Quadratic) {
    if (Status status = addQuadratic(cage, *made); !status.ok()) return status;
  }
  if (options.normals == Normals::Transformed) {
    made->normals = DirectionFactors::ofNormals(cage.mesh, made->embedding, restNormals(mesh));
    if (!mesh.tangents.empty()) {
      made->tangents = DirectionFactors::ofTangents(cage.mesh, made->embedding, directionsOf(mesh.tangents));
    }
  } else if (options.normals == Normals::Recomputed) {
    const bool sorted = options.order == VertexOrder::Sorted;
    made->recomputed.emplace(mesh, sorted ? made->embedding.vertexSlots() : std::vector<std::uint32_t>(),
                             options.hardEdgeDegrees);
  }
  return std::unique_ptr<const SkinData<Scalar>>(std::move(made));
}

}  // namespace

std::string QuadraticReport::describe() const {
  char text[256];
  std::snprintf(
      text, sizeof text,
      "quadratic: %zu nodes with %.1f neighbours on average, %zu edges; %zu nodes in thin regions, %zu without "
      "a fit; %.1f ms",
      nodes, meanNeighbours, edges, underdeterminedNodes, averagedNodes, milliseconds);
  return text;
}

template <class Scalar>
Status checkNodes(PointView<const Scalar> nodes) {
  const std::size_t bad = firstUnusable(nodes);
  if (bad == nodes.size()) return {};
  return {StatusCode::NonFinite, "node " + std::to_string(bad) +
                                     " is not finite, or farther than 1e18 from the origin; bind before the body "
                                     "explodes"};
}

Status checkOrigin(const Eigen::Vector3d& origin) {
  if (firstUnusable(PointView<const double>(origin.data(), 1)) == 1) return {};
  return {StatusCode::InvalidOption, "the origin is not finite, or farther than 1e18 from that of the world"};
}

Status checkInstance(const InstanceOptions& options, std::size_t vertexCount) {
  if (Status status = checkOrigin(options.origin); !status.ok()) return status;
  if (options.previousPositions && !std::holds_alternative<std::monostate>(options.target)) {
    return {StatusCode::InvalidOption,
            "previous positions are available only in the skin's own array; remove the target, or keep them yourself"};
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
SkinBinding<Scalar>::SkinBinding(std::unique_ptr<const SkinData<Scalar>> data) : data_(std::move(data)) {}

template <class Scalar>
SkinBinding<Scalar>::~SkinBinding() = default;

template <class Scalar>
auto SkinBinding<Scalar>::create(const Cage& cage, const TriangleMesh& mesh, const BindingOptions& options,
                                 EmbedReport* report) -> Result<Pointer> {
  if (Status status = checkBinding(mesh, options); !status.ok()) {
    if (report) *report = notEmbedded(mesh);
    return status;
  }
  EmbedOptions embedOptions;
  embedOptions.outside = options.outside;
  embedOptions.maxDistance = options.maxDistance;
  const Result<Embedding> embedding = embed(cage, mesh, embedOptions, report);
  if (!embedding.ok()) return embedding.status();
  auto data = makeSkinData<Scalar>(cage, mesh, options, embedding.value());
  if (!data.ok()) return data.status();
  return Pointer(new SkinBinding(std::move(data).value()));
}

template <class Scalar>
auto SkinBinding<Scalar>::create(const Cage& cage, const TriangleMesh& mesh, const BindingOptions& options,
                                 const Embedding& embedding) -> Result<Pointer> {
  if (Status status = validate(mesh); !status.ok()) return status;
  if (Status status = checkBinding(mesh, options); !status.ok()) return status;
  if (Status status = validate(cage.mesh); !status.ok()) return status;
  if (Status status = checkEmbedded(cage.mesh, mesh, embedding); !status.ok()) return status;
  auto data = makeSkinData<Scalar>(cage, mesh, options, embedding);
  if (!data.ok()) return data.status();
  return Pointer(new SkinBinding(std::move(data).value()));
}

template <class Scalar>
const BindingOptions& SkinBinding<Scalar>::options() const {
  return data_->options;
}
template <class Scalar>
const Embedding& SkinBinding<Scalar>::embedding() const {
  return data_->embedding;
}
template <class Scalar>
const QuadraticReport& SkinBinding<Scalar>::quadraticReport() const {
  return data_->quadraticReport;
}

#define TETSKIN_INSTANTIATE(Scalar)   \
  template class SkinBinding<Scalar>; \
  template Status checkNodes<Scalar>(PointView<const Scalar>);
TETSKIN_FOR_SCALARS(TETSKIN_INSTANTIATE)
#undef TETSKIN_INSTANTIATE

}  // namespace tetskin
