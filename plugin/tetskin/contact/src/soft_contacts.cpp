// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/bullet/src/shared/forces/body_forces.h>
#include <tetskin/bullet/src/shared/solver/required_solver.h>
#include <tetskin/contact/soft_contacts.h>
#include <tetskin/contact/src/soft/contact_force.h>

#include <cmath>

namespace tetskin {
namespace {

using contact_detail::ContactForce;

Status invalidContact(const char* message) {
  return {StatusCode::InvalidOption, message};
}

Status checkSoftOptions(const SoftContactOptions& options) {
  if (!std::isfinite(options.friction)) return invalidContact("the friction of soft contacts must be a number");
  return {};
}

/// Whether contacts of the world, but these, have the body: each would push it as if it were alone.
bool isInOthers(const btAlignedObjectArray<btDeformableLagrangianForce*>& list, const ContactForce& own,
                const btSoftBody& body) {
  for (int i = 0; i < list.size(); ++i) {
    const auto* contacts = dynamic_cast<const ContactForce*>(list[i]);
    if (contacts && contacts != &own && contacts->find(body)) return true;
  }
  return false;
}

}  // namespace

struct SoftContacts::Parts {
  Parts(btDeformableMultiBodyDynamicsWorld& ofWorld, DeformableSolver& ofSolver, const SoftContactOptions& options)
      : world(ofWorld), solver(ofSolver), force(options) {}

  btDeformableMultiBodyDynamicsWorld& world;
  DeformableSolver& solver;
  ContactForce force;
};

SoftContacts::SoftContacts(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}

SoftContacts::~SoftContacts() {
  removeFromList(*parts_->solver.getLagrangianForceArray(), &parts_->force);
}

Result<std::unique_ptr<SoftContacts>> SoftContacts::add(btDeformableMultiBodyDynamicsWorld& world,
                                                        const SoftContactOptions& options) {
  if (Status status = checkSoftOptions(options); !status.ok()) return status;
  DeformableSolver* solver = deformableSolverOf(world);
  if (!solver) return refusal("contact among soft bodies", {kUseDeformableSolver});
  solver->solveAlways();
  auto parts = std::make_unique<Parts>(world, *solver, options);
  parts->force.setIndices(solver->getIndices());
  solver->getLagrangianForceArray()->push_back(&parts->force);
  return std::unique_ptr<SoftContacts>(new SoftContacts(std::move(parts)));
}

Status SoftContacts::include(btSoftBody& body, std::shared_ptr<const ContactShape> shape, bool self) {
  if (!shape) return {StatusCode::Empty, "a body needs a contact shape; see makeContactShape"};
  const auto& inWorld = parts_->world.getSoftBodyArray();
  if (inWorld.findLinearSearch(&body) == inWorld.size()) {
    return invalidContact("add the body to the world of the contacts before including it");
  }
  if (isInOthers(*parts_->solver.getLagrangianForceArray(), parts_->force, body)) {
    return invalidContact("the body is included in other soft contacts of the world: exclude it there first");
  }
  const auto nodes = static_cast<std::size_t>(body.m_nodes.size());
  const auto tets = static_cast<std::size_t>(body.m_tetras.size());
  if (nodes != shape->nodeCount() || tets != shape->tetCount()) {
    return {StatusCode::SizeMismatch, "the body has " + std::to_string(nodes) + " nodes and " + std::to_string(tets) +
                                          " tets, the shape " + std::to_string(shape->nodeCount()) + " and " +
                                          std::to_string(shape->tetCount()) +
                                          "; include it with the shape of its own cage"};
  }
  parts_->force.include(body, std::move(shape), self);
  return {};
}

void SoftContacts::exclude(const btSoftBody& body) {
  parts_->force.exclude(body);
}

IncludedBody SoftContacts::statusOf(const btSoftBody& body) const {
  if (const contact_detail::ContactBody* of = parts_->force.find(body)) {
    if (!of->fits()) return IncludedBody::Changed;
    return parts_->force.isWithin(*of) ? IncludedBody::Within : IncludedBody::Active;
  }
  return parts_->force.isGone(body) ? IncludedBody::Gone : IncludedBody::Unknown;
}

std::vector<SoftContact> SoftContacts::contacts() const {
  std::vector<SoftContact> contacts;
  for (const SoftPointContact& from : parts_->force.lastContacts()) {
    const btScalar impulse = from.normal.dot(from.impulse);
    if (!(impulse > 0)) continue;
    contacts.push_back(
        {from.body, btSoftBody::upcast(from.object), from.position, from.normal, from.distance, impulse});
  }
  return contacts;
}

}  // namespace tetskin
