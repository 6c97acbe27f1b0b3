// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/bullet/src/shared/bodies/body_trees.h>
#include <tetskin/bullet/src/shared/solver/required_solver.h>
#include <tetskin/contact/src/rigid/contact_points.h>
#include <tetskin/contact/src/rigid/surface_algorithm.h>
#include <tetskin/contact/surface_contact.h>

#include <algorithm>
#include <cmath>

namespace tetskin {
namespace {

/// Default margin over the body's size.
constexpr double kSurfaceMargin = 0.002;
/// How deep in a mesh a point still belongs to it, over the body's size: deeper than contact ever lets it come.
constexpr double kMeshThickness = 0.03;
/// How far around the surface a search looks, over the body's size, to remember what is clear: nodes move less in some
/// steps.
constexpr double kSearchSlack = 0.005;
/// Of the weights of a vertex outside, their absolute values added up: more is of a cage that does not fit.
constexpr btScalar kLargestSpread = btScalar(1.2);

/// Of the triangles: with some hundred bytes each, more would be a mistake in the spacing.
constexpr double kMostSamples = 10'000'000;

Status refused(StatusCode code, const char* message) {
  return {code, message};
}

Status checkContactOptions(const SurfaceContactOptions& options) {
  if (std::isnan(options.margin) || std::isinf(options.margin)) {
    return refused(StatusCode::InvalidOption, "the margin of surface contact must be finite, or below 0 for a default");
  }
  if (!(options.sampleSpacing >= 0.0) || std::isinf(options.sampleSpacing)) {
    return refused(StatusCode::InvalidOption, "the sample spacing of surface contact must be finite, 0 for no samples");
  }
  return {};
}

Status checkFit(const btSoftBody& body, const Embedding& embedding, const TriangleMesh& mesh) {
  if (embedding.empty()) return refused(StatusCode::Empty, "the binding is of no vertices: nothing can touch");
  if (Status status = checkTriangleMesh(mesh); !status.ok()) return status;
  if (embedding.vertexCount() != mesh.vertexCount()) {
    return refused(StatusCode::SizeMismatch, "the binding is of another mesh: it has another number of vertices");
  }
  if (embedding.nodeCount() != static_cast<std::size_t>(body.m_nodes.size())) {
    return refused(StatusCode::SizeMismatch, "the binding is of another cage: the body has another number of nodes");
  }
  return {};
}

Status checkSpacing(const TriangleMesh& mesh, double spacing) {
  if (!(spacing > 0.0) || countOfSamples(mesh, spacing) <= kMostSamples) return {};
  return refused(StatusCode::InvalidOption,
                 "the sample spacing of surface contact is so small that the mesh would get more than 10,000,000 "
                 "samples; make it larger, in the unit of the mesh at rest");
}

Status checkWorld(btDeformableMultiBodyDynamicsWorld& world, btSoftBody& body) {
  if (!bodyWithTrees(body)) {
    return refused(StatusCode::InvalidOption,
                   "surface contact needs a body made by makeSoftBody, or a DeformableBody's");
  }
  if (world.getSoftBodyArray().findLinearSearch(&body) == world.getSoftBodyArray().size()) {
    return refused(StatusCode::InvalidOption, "the body is not in this world: add it there first");
  }
  std::vector<std::string> changes;
  if (!deformableSolverOf(body)) changes.emplace_back(kUseDeformableSolver);
  if (!dynamic_cast<const btCollisionDispatcher*>(world.getDispatcher()))
    changes.emplace_back("make the world with a btCollisionDispatcher");
  if (Status status = refusal("surface contact", changes); !status.ok()) return status;
  if (contactsOf(body)) {
    return refused(StatusCode::InvalidOption, "the body has surface contact already: destroy that first");
  }
  return {};
}

/// How far vertices outside may be from the nodes' box, over its size.
btScalar beyondNodes(const ContactPatches& patches) {
  btScalar spread = 1;
  for (const PatchCluster& cluster : patches.clusters) spread = std::max(spread, cluster.spread);
  return (std::min(spread, kLargestSpread) - 1) / 2;
}

double largestSide(const btSoftBody& body) {
  return boundingBox(nodePositions(body)).sizes().maxCoeff();
}

/// So that the next step makes the body's pairs, and their algorithms, anew.
void forgetPairs(btSoftBody& body, btDeformableMultiBodyDynamicsWorld& world) {
  if (btBroadphaseProxy* proxy = body.getBroadphaseHandle()) {
    world.getPairCache()->cleanProxyFromPairs(proxy, world.getDispatcher());
  }
}

}  // namespace

struct SurfaceContact::Parts {
  Parts(const btDispatcher& dispatcher, btSoftBody& body, TouchSearch search, btScalar thickness)
      : contacts(std::make_shared<BodyContacts>(dispatcher, *bodyWithTrees(body), std::move(search), thickness)) {}

  void begin(btDeformableMultiBodyDynamicsWorld& world, btScalar reach);
  void end();

  std::shared_ptr<BodyContacts> contacts;
  std::vector<SurfaceContactPoint> points;  ///< as last told
  btScalar marginBefore = 0;
};

void SurfaceContact::Parts::begin(btDeformableMultiBodyDynamicsWorld& world, btScalar reach) {
  btSoftBody& body = contacts->body();
  marginBefore = body.getCollisionShape()->getMargin();
  body.getCollisionShape()->setMargin(contacts->search().margin());
  bodyWithTrees(body)->setReach(reach);
  bodyWithTrees(body)->setSurfaceContacts(contacts);
  registerSurfaceAlgorithms(static_cast<btCollisionDispatcher&>(*world.getDispatcher()));
  forgetPairs(body, world);
  body.activate();
}

void SurfaceContact::Parts::end() {
  if (!contacts->bodyLives()) return;
  btSoftBody& body = contacts->body();
  body.getCollisionShape()->setMargin(marginBefore);
  bodyWithTrees(body)->setReach(-1);
}

SurfaceContact::SurfaceContact(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}

SurfaceContact::~SurfaceContact() {
  parts_->end();
}

Result<std::unique_ptr<SurfaceContact>> SurfaceContact::add(btDeformableMultiBodyDynamicsWorld& world, btSoftBody& body,
                                                            const SoftBodyBinding& binding, const TriangleMesh& mesh,
                                                            const SurfaceContactOptions& options) {
  for (Status status :
       {checkContactOptions(options), checkWorld(world, body), checkFit(body, binding.embedding(), mesh)}) {
    if (!status.ok()) return status;
  }
  if (Status status = checkSpacing(mesh, options.sampleSpacing); !status.ok()) return status;
  const double size = largestSide(body);
  const auto margin = static_cast<btScalar>(options.margin >= 0.0 ? options.margin : kSurfaceMargin * size);
  ContactPatches patches = makeContactPatches(binding.embedding(), mesh, options.sampleSpacing);
  const btScalar reach = margin + beyondNodes(patches) * static_cast<btScalar>(size);
  auto parts = std::make_unique<Parts>(
      *world.getDispatcher(), body, TouchSearch(std::move(patches), margin, static_cast<btScalar>(kSearchSlack * size)),
      static_cast<btScalar>(kMeshThickness * size));
  deformableSolverOf(body)->solveAlways();
  parts->begin(world, reach);
  return std::unique_ptr<SurfaceContact>(new SurfaceContact(std::move(parts)));
}

const std::vector<SurfaceContactPoint>& SurfaceContact::contacts() const {
  parts_->points.clear();
  if (parts_->contacts->bodyLives()) addContactPoints(*parts_->contacts, parts_->points);
  return parts_->points;
}

std::size_t SurfaceContact::sampleCount() const {
  return parts_->contacts->search().patches().pointCount;
}

}  // namespace tetskin
