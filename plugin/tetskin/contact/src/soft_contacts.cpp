// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/contact/soft_contacts.h>
#include <tetskin/contact/src/soft/soft_contact_rows.h>
#include <tetskin/solver/src/base/body_forces.h>
#include <tetskin/solver/src/base/required_solver.h>

#include <cassert>
#include <cmath>

namespace tetskin {

using namespace bullet_detail;

namespace {

using contact_detail::SoftContactRows;

Status invalidContact(const char* message) {
  return {StatusCode::InvalidOption, message};
}

Status checkSoftOptions(const SoftContactOptions& options) {
  if (options.friction && !(*options.friction >= 0.0 && std::isfinite(*options.friction))) {
    return invalidContact("the friction of soft contacts must be finite and not negative");
  }
  return {};
}

/// True if other SoftContacts of the world contain the body: both would push it.
bool isInOthers(const btAlignedObjectArray<btDeformableLagrangianForce*>& list, const SoftContactRows& own,
                const btSoftBody& body) {
  for (int i = 0; i < list.size(); ++i) {
    auto* contacts = dynamic_cast<SoftContactRows*>(inactiveForce(list[i]));
    if (!contacts || contacts == &own) continue;
    contacts->updateBodies();
    if (contacts->find(body)) return true;
  }
  return false;
}

}  // namespace

struct SoftContacts::Impl {
  Impl(btDeformableMultiBodyDynamicsWorld& ofWorld, DeformableSolver& ofSolver, const SoftContactOptions& options)
      : world(ofWorld), solver(&ofSolver), force(options) {}

  /// The world's solver; null once it has been destroyed.
  DeformableSolver* liveSolver() const { return deformableSolver(solver); }

  btDeformableMultiBodyDynamicsWorld& world;
  btSoftBodySolver* solver;  ///< may have been destroyed
  SoftContactRows force;
  std::vector<SoftContact> contacts;  ///< as last reported
};

SoftContacts::SoftContacts(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

SoftContacts::~SoftContacts() {
  if (DeformableSolver* solver = impl_->liveSolver()) removeFromList(*solver->getLagrangianForceArray(), &impl_->force);
}

Result<std::unique_ptr<SoftContacts>> SoftContacts::add(btDeformableMultiBodyDynamicsWorld& world,
                                                        const SoftContactOptions& options) {
  if (Status status = checkSoftOptions(options); !status.ok()) return status;
  DeformableSolver* solver = deformableSolverOf(world);
  if (!solver) return refusal("contact between soft bodies", {kUseDeformableSolver});
  Access<DeformableSolver>::requireOwnSolve(*solver, world);
  std::unique_ptr<SoftContacts> made(new SoftContacts(std::make_unique<Impl>(world, *solver, options)));
  made->impl_->force.setIndices(solver->getIndices());
  solver->getLagrangianForceArray()->push_back(&made->impl_->force);
  return made;
}

Status SoftContacts::add(btSoftBody& body, std::shared_ptr<const ContactShape> shape, bool self) {
  if (!shape) return {StatusCode::Empty, "the contact shape is null; create it with ContactShape::create"};
  DeformableSolver* solver = impl_->liveSolver();
  if (!solver) return invalidContact("the world of the contacts has been destroyed");
  const auto& inWorld = impl_->world.getSoftBodyArray();
  if (inWorld.findLinearSearch(&body) == inWorld.size()) {
    return invalidContact("the body is not in the world of the contacts; add it there first");
  }
  if (isInOthers(*solver->getLagrangianForceArray(), impl_->force, body)) {
    return invalidContact("the body is in other soft contacts of this world; remove it from them first");
  }
  const auto nodes = static_cast<std::size_t>(body.m_nodes.size());
  const auto tets = static_cast<std::size_t>(body.m_tetras.size());
  if (nodes != shape->nodeCount() || tets != shape->tetCount()) {
    return {StatusCode::SizeMismatch, "the body has " + std::to_string(nodes) + " nodes and " + std::to_string(tets) +
                                          " tets, but the shape has " + std::to_string(shape->nodeCount()) + " and " +
                                          std::to_string(shape->tetCount()) +
                                          "; add it with a shape made from its own cage"};
  }
  impl_->force.include(body, std::move(shape), self);
  return {};
}

void SoftContacts::remove(const btSoftBody& body) {
  impl_->force.exclude(body);
}

StatusCode SoftContacts::status(const btSoftBody& body) const {
  impl_->force.updateBodies();
  if (const contact_detail::ContactBody* solved = impl_->force.find(body)) {
    if (!solved->fits()) return StatusCode::TopologyChanged;
    return impl_->force.isWithin(*solved) ? StatusCode::Enclosed : StatusCode::Ok;
  }
  return impl_->force.isGone(body) ? StatusCode::NotInWorld : StatusCode::NotAdded;
}

const std::vector<SoftContact>& SoftContacts::contacts() const {
  std::vector<SoftContact>& contacts = impl_->contacts;
  contacts.clear();
  impl_->force.updateBodies();
  for (const auto* list : {&impl_->force.lastContacts(), &impl_->force.sleepingContacts()}) {
    for (const PointContact& from : *list) {
      assert(from.body && btSoftBody::upcast(from.object));
      const btScalar impulse = from.normal.dot(from.impulse);
      if (!(impulse > 0)) continue;
      contacts.push_back(
          {from.body, btSoftBody::upcast(from.object), from.position, from.normal, from.distance, impulse});
    }
  }
  return contacts;
}

}  // namespace tetskin
