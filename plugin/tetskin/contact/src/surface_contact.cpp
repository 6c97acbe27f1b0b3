// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/bullet/src/shared/bodies/body_trees.h>
#include <tetskin/bullet/src/shared/bodies/own_objects.h>
#include <tetskin/bullet/src/shared/solver/required_solver.h>
#include <tetskin/contact/src/rigid/contact_points.h>
#include <tetskin/contact/src/rigid/surface_algorithm.h>
#include <tetskin/contact/surface_contact.h>
#include <tetskin/core/src/shared/skin_binding.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tetskin {
namespace {

/// Default margin, relative to the body's size.
constexpr double kSurfaceMargin = 0.002;
/// Depth up to which a point behind a mesh's surface still belongs to it, relative to the body's size: larger than any
/// depth that contact allows.
constexpr double kMeshThickness = 0.03;
/// Distance around the surface within which a search finds clearances, relative to the body's size: nodes move by less
/// in a few steps.
constexpr double kSearchSlack = 0.005;
/// Largest sum of the absolute weights of a vertex outside: larger sums come from a cage that does not fit.
constexpr btScalar kMaxSpread = btScalar(1.2);

Status refused(StatusCode code, const char* message) {
  return {code, message};
}

Status checkContactOptions(const SurfaceContactOptions& options) {
  if (options.margin && !(*options.margin >= 0.0 && std::isfinite(*options.margin))) {
    return refused(StatusCode::InvalidOption, "the margin of surface contact must be finite and not negative");
  }
  if (options.sampleSpacing && !(*options.sampleSpacing > 0.0)) {
    return refused(StatusCode::InvalidOption,
                   "the sample spacing of surface contact must be above 0; for no samples, give "
                   "SurfaceContactOptions::kNoSamples");
  }
  return {};
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

Status checkCount(const Divisions& divisions) {
  if (countOfSamples(divisions) <= kMaxSamples) return {};
  return refused(StatusCode::InvalidOption,
                 "the sample spacing of surface contact is so small that the mesh would need more than 10,000,000 "
                 "samples; make it larger, in the unit of the mesh at rest");
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
  if (contactsOf(body)) {
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

/// Removes the body's pairs, so that the next step creates them and their algorithms anew.
void forgetPairs(btSoftBody& body, btDeformableMultiBodyDynamicsWorld& world) {
  if (btBroadphaseProxy* proxy = body.getBroadphaseHandle()) {
    world.getPairCache()->cleanProxyFromPairs(proxy, world.getDispatcher());
  }
}

}  // namespace

struct SurfaceContact::Impl {
  Impl(const btDispatcher& dispatcher, btSoftBody& body, SurfaceCollider search, btScalar thickness)
      : contacts(std::make_shared<BodyContacts>(dispatcher, *bodyWithTrees(body), std::move(search), thickness)) {}

  void begin(btDeformableMultiBodyDynamicsWorld& world, btScalar reach);
  void end();

  std::shared_ptr<BodyContacts> contacts;
  std::vector<SurfaceContactPoint> points;  ///< as last reported
  btScalar marginBefore = 0;
};

void SurfaceContact::Impl::begin(btDeformableMultiBodyDynamicsWorld& world, btScalar reach) {
  assert(contacts->bodyLives() && !(reach < contacts->search().margin()));
  btSoftBody& body = contacts->body();
  marginBefore = body.getCollisionShape()->getMargin();
  body.getCollisionShape()->setMargin(contacts->search().margin());
  bodyWithTrees(body)->setReach(reach);
  bodyWithTrees(body)->setSurfaceContacts(contacts);
  registerSurfaceAlgorithms(static_cast<btCollisionDispatcher&>(*world.getDispatcher()));
  forgetPairs(body, world);
  body.activate();
}

void SurfaceContact::Impl::end() {
  if (!contacts->bodyLives()) return;
  btSoftBody& body = contacts->body();
  body.getCollisionShape()->setMargin(marginBefore);
  bodyWithTrees(body)->setReach(-1);
}

SurfaceContact::SurfaceContact(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

SurfaceContact::~SurfaceContact() {
  impl_->end();
}

Result<std::unique_ptr<SurfaceContact>> SurfaceContact::add(btDeformableMultiBodyDynamicsWorld& world, btSoftBody& body,
                                                            const SoftBodyBinding& binding, const TriangleMesh& mesh,
                                                            const SurfaceContactOptions& options) {
  for (Status status :
       {checkContactOptions(options), checkWorld(world, body), checkFit(body, binding.embedding(), mesh)}) {
    if (!status.ok()) return status;
  }
  const Divisions divisions = options.sampleSpacing
                                  ? divisionsFor(mesh, *options.sampleSpacing)
                                  : defaultDivisions(binding.embedding(), mesh, dataOf(binding).restNodes);
  if (Status status = checkCount(divisions); !status.ok()) return status;
  const double size = largestSide(body);
  const auto margin = static_cast<btScalar>(options.margin.value_or(kSurfaceMargin * size));
  ContactPatches patches = makeContactPatches(binding.embedding(), mesh, divisions);
  const btScalar reach = margin + beyondNodes(patches) * static_cast<btScalar>(size);
  auto impl =
      std::make_unique<Impl>(*world.getDispatcher(), body,
                             SurfaceCollider(std::move(patches), margin, static_cast<btScalar>(kSearchSlack * size)),
                             static_cast<btScalar>(kMeshThickness * size));
  deformableSolverOf(body)->requireOwnSolve();
  impl->begin(world, reach);
  return std::unique_ptr<SurfaceContact>(new SurfaceContact(std::move(impl)));
}

const std::vector<SurfaceContactPoint>& SurfaceContact::contacts() const {
  impl_->points.clear();
  if (impl_->contacts->bodyLives()) addContactPoints(*impl_->contacts, impl_->points);
  return impl_->points;
}

std::size_t SurfaceContact::sampleCount() const {
  return impl_->contacts->search().patches().pointCount;
}

}  // namespace tetskin
