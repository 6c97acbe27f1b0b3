// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/bullet/src/base/own_objects.h>
#include <tetskin/contact/src/exported/contact_options.h>
#include <tetskin/contact/src/rigid/surface_patches.h>
#include <tetskin/contact/surface_contact.h>
#include <tetskin/core/src/exported/skin_binding.h>
#include <tetskin/solver/src/base/required_solver.h>
#include <tetskin/solver/src/exported/point_search.h>

#include <algorithm>
#include <cmath>

namespace tetskin {

using namespace bullet_detail;

namespace {

/// Default margin, relative to the body's size.
constexpr double kSurfaceMargin = 0.002;
/// Depth up to which a point behind a mesh's surface still belongs to it, relative to the body's size: larger than any
/// depth that contact allows.
constexpr double kMeshThickness = 0.03;
/// Distance around the surface within which a search finds clearances, relative to the body's size: nodes move by less
/// in a few steps.
constexpr double kSearchSlack = 0.005;
/// Largest sum of the absolute weights of an outside vertex: a larger sum means that the cage does not fit.
constexpr btScalar kMaxSpread = btScalar(1.2);

Status refused(StatusCode code, const char* message) {
  return {code, message};
}

Status checkFit(const btSoftBody& body, const Embedding& embedding, const TriangleMesh& mesh) {
  if (embedding.empty()) return refused(StatusCode::Empty, "the binding has no vertices; surface contact needs some");
  if (Status status = validate(mesh); !status.ok()) return status;
  if (embedding.vertexCount() != mesh.vertexCount()) {
    return refused(StatusCode::SizeMismatch, "the binding belongs to another mesh; it has another number of vertices");
  }
  if (embedding.nodeCount() != static_cast<std::size_t>(body.m_nodes.size())) {
    return refused(StatusCode::SizeMismatch,
                   "the binding belongs to another cage; the body has another number of nodes");
  }
  return {};
}

Status checkWorld(btDeformableMultiBodyDynamicsWorld& world, btSoftBody& body) {
  if (!bodyWithTrees(body)) {
    return refused(StatusCode::InvalidOption,
                   "surface contact needs a body created by createSoftBody, or that of a DeformableBody");
  }
  if (world.getSoftBodyArray().findLinearSearch(&body) == world.getSoftBodyArray().size()) {
    return refused(StatusCode::InvalidOption, "the body is not in this world; add it first");
  }
  if (!deformableSolverOf(body)) return refusal("surface contact", {kUseDeformableSolver});
  if (isKnownNotToBe<btCollisionDispatcher>(*world.getDispatcher())) {
    return refused(StatusCode::InvalidOption,
                   "surface contact needs a btCollisionDispatcher, or a dispatcher derived from it");
  }
  if (PointSearch::exists(body)) {
    return refused(StatusCode::InvalidOption, "the body already has surface contact; destroy that first");
  }
  return {};
}

/// How far vertices outside may be from the nodes' box, relative to its size.
btScalar beyondNodes(const ContactPatches& patches) {
  btScalar spread = 1;
  for (const PatchCluster& cluster : patches.clusters) spread = std::max(spread, cluster.spread);
  return (std::min(spread, kMaxSpread) - 1) / 2;
}

double largestSide(const btSoftBody& body) {
  return boundingBox(nodePositions(body)).sizes().maxCoeff();
}

}  // namespace

Status checkContactOptions(const SurfaceContactOptions& options, const TriangleMesh& mesh) {
  if (options.margin && !(*options.margin >= 0.0 && std::isfinite(*options.margin))) {
    return refused(StatusCode::InvalidOption, "the margin of surface contact must be finite and not negative");
  }
  if (!options.sampleSpacing) return {};
  if (!(*options.sampleSpacing > 0.0)) {
    return refused(StatusCode::InvalidOption,
                   "the sample spacing of surface contact must be above 0; for no samples, give "
                   "SurfaceContactOptions::kNoSamples");
  }
  const contact_detail::Divisions divisions = contact_detail::divisionsFor(mesh, *options.sampleSpacing);
  if (contact_detail::countOfSamples(divisions) <= kMaxSamples) return {};
  return refused(StatusCode::InvalidOption,
                 "the sample spacing of surface contact is so small that the mesh would need more than 10,000,000 "
                 "samples; make it larger, in the unit of the mesh at rest");
}

struct SurfaceContact::Impl {
  Impl(btDeformableMultiBodyDynamicsWorld& world, btSoftBody& body, ContactPatches patches,
       const SearchDistances& distances)
      : search(world, *bodyWithTrees(body), std::move(patches), distances) {}

  PointSearch search;
  std::vector<SurfaceContactPoint> points;  ///< as last reported
};

SurfaceContact::SurfaceContact(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
SurfaceContact::~SurfaceContact() = default;

Result<std::unique_ptr<SurfaceContact>> SurfaceContact::add(btDeformableMultiBodyDynamicsWorld& world, btSoftBody& body,
                                                            const SoftBodyBinding& binding, const TriangleMesh& mesh,
                                                            const SurfaceContactOptions& options) {
  for (Status status : {checkWorld(world, body), checkFit(body, binding.embedding(), mesh)}) {
    if (!status.ok()) return status;
  }
  if (Status status = checkContactOptions(options, mesh); !status.ok()) return status;
  const contact_detail::Divisions divisions =
      options.sampleSpacing ? contact_detail::divisionsFor(mesh, *options.sampleSpacing)
                            : contact_detail::defaultDivisions(binding.embedding(), mesh, dataOf(binding).restNodes);
  const double size = largestSide(body);
  ContactPatches patches = contact_detail::makeContactPatches(binding.embedding(), mesh, divisions);
  SearchDistances distances;
  distances.margin = static_cast<btScalar>(options.margin.value_or(kSurfaceMargin * size));
  distances.slack = static_cast<btScalar>(kSearchSlack * size);
  distances.thickness = static_cast<btScalar>(kMeshThickness * size);
  distances.beyondNodes = beyondNodes(patches) * static_cast<btScalar>(size);
  Access<DeformableSolver>::requireOwnSolve(*deformableSolverOf(body), world);
  return std::unique_ptr<SurfaceContact>(
      new SurfaceContact(std::make_unique<Impl>(world, body, std::move(patches), distances)));
}

const std::vector<SurfaceContactPoint>& SurfaceContact::contacts() const {
  impl_->points.clear();
  if (const PointContacts* contacts = impl_->search.contacts()) {
    for (const PointContact& contact : *contacts) {
      if (!contact.object) continue;
      impl_->points.push_back({contact.position, contact.normal, contact.distance, contact.object, contact.impulse});
    }
  }
  return impl_->points;
}

std::size_t SurfaceContact::sampleCount() const {
  return impl_->search.patches().pointCount;
}

}  // namespace tetskin
