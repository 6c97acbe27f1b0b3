// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The state of contacts among soft bodies from step to step, in a snapshot.
#include <tetskin/bullet/src/base/world_stream.h>
#include <tetskin/contact/src/soft/soft_contact_rows.h>

#include <algorithm>
#include <vector>

namespace tetskin::contact_detail {

using namespace bullet_detail;

namespace {

void serializePoint(WorldStream& stream, CarriedPoint& point) {
  stream(point.count);
  if (point.count > kMaxPointNodes) {
    point = {};
    return stream.fail();
  }
  stream.plain(point.nodes.data(), point.count);
  stream.plain(point.weights.data(), point.count);
}

void serializeContact(WorldStream& stream, PointContact& contact) {
  stream.object(contact.body);
  stream.object(contact.object);
  stream(contact.point, contact.sample);
  serializePoint(stream, contact.at);
  serializePoint(stream, contact.onObject);
  stream(contact.position, contact.normal, contact.distance, contact.predicted, contact.friction, contact.impulse);
}

bool isBetweenSleepers(const PointContact& contact) {
  return !contact.body->isActive() && !contact.object->isActive();
}

constexpr const char* kOtherBodies = "contacts among other soft bodies were there";

}  // namespace

/// In the order of the world's objects: they may have been added here in another order.
void SoftContactRows::checkState(WorldStream& stream) {
  updateBodies();
  stream.same(bodies_.size(), kOtherBodies);
  std::vector<const ContactBody*> sorted;
  for (const auto& body : bodies_) sorted.push_back(body.get());
  const auto indexOf = [](const ContactBody* body) { return body->body->getWorldArrayIndex(); };
  std::sort(sorted.begin(), sorted.end(),
            [&](const ContactBody* a, const ContactBody* b) { return indexOf(a) < indexOf(b); });
  for (const ContactBody* body : sorted) {
    stream.same(indexOf(body), kOtherBodies);
    for (const std::size_t count : {body->data().samples.size(), body->data().nodes.size(), body->data().tets.size()}) {
      stream.same(count, "a soft body had another contact shape");
    }
  }
}

void SoftContactRows::serialize(WorldStream& stream) {
  serializeBodies(stream);
  if (stream.failed()) return;
  serializePairs(stream);
  serializeSleeping(stream);
}

/// The bodies get back their order and their ids: pairs are searched in this order, and directions depend on ids.
void SoftContactRows::serializeBodies(WorldStream& stream) {
  updateBodies();
  stream.same(bodies_.size(), kOtherBodies);
  stream(nextId_);
  for (std::size_t k = 0; k < bodies_.size() && !stream.failed(); ++k) {
    btSoftBody* named = bodies_[k]->body;
    stream.object(named);
    const auto found = std::find_if(bodies_.begin() + static_cast<std::ptrdiff_t>(k), bodies_.end(),
                                    [&](const auto& body) { return body->body == named; });
    if (found == bodies_.end()) return stream.refuse(kOtherBodies);
    std::swap(bodies_[k], *found);
    bodies_[k]->serialize(stream, stream.saving() && motionMatters(*bodies_[k]));
  }
}

/// Also for pairs whose contacts are not followed: the next step measures their motion anyway.
bool SoftContactRows::motionMatters(const ContactBody& body) const {
  return std::any_of(pairStates_.begin(), pairStates_.end(), [&](const auto& entry) {
    const auto [a, b] = entry.first;
    if (a != body.id && b != body.id) return false;
    const ContactBody &first = *withId(a), &second = *withId(b);
    const PairMemory(&memories)[2] = entry.second.memories;
    return memories[0].motion.goesOn(first, second) || memories[1].motion.goesOn(second, first);
  });
}

ContactBody* SoftContactRows::withId(int id) const {
  const auto found = std::find_if(bodies_.begin(), bodies_.end(), [&](const auto& body) { return body->id == id; });
  return found == bodies_.end() ? nullptr : found->get();
}

void SoftContactRows::serializePairs(WorldStream& stream) {
  const std::size_t count = stream.length(pairStates_.size());
  if (stream.saving()) {
    for (auto& [key, state] : pairStates_) {
      std::pair<int, int> ids = key;
      stream(ids.first, ids.second);
      serializePair(stream, ids, state);
    }
    return;
  }
  pairStates_.clear();
  for (std::size_t k = 0; k < count && !stream.failed(); ++k) {
    std::pair<int, int> ids;
    stream(ids.first, ids.second);
    serializePair(stream, ids, pairStates_[ids]);
  }
}

void SoftContactRows::serializePair(WorldStream& stream, const std::pair<int, int>& ids, PairState& state) {
  const ContactBody *first = withId(ids.first), *second = withId(ids.second);
  if (!first || !second) return stream.fail();
  stream(state.apart);
  int within = !state.within ? -1 : state.within->id;
  stream(within);
  state.within = within < 0 ? nullptr : withId(within);
  for (int k = 0; k < (first == second ? 1 : 2); ++k) {
    const ContactBody &of = k == 0 ? *first : *second, &in = k == 0 ? *second : *first;
    PairMemory& memory = state.memories[k];
    memory.serialize(stream, state.touches[k], memory.mayFollow(of, in));
    if (!memory.fits(of, in, state.touches[k])) stream.fail();
  }
}

/// Sleeping bodies have no other contacts.
void SoftContactRows::serializeSleeping(WorldStream& stream) {
  PointContacts sleeping;
  if (stream.saving()) {
    for (const PointContacts* contacts : {&sleeping_, &contacts_}) {
      std::copy_if(contacts->begin(), contacts->end(), std::back_inserter(sleeping), isBetweenSleepers);
    }
  }
  stream.each(sleeping, [&](PointContact& contact) { serializeContact(stream, contact); });
  if (!stream.restoring()) return;
  const bool known = std::all_of(sleeping.begin(), sleeping.end(), [](const PointContact& contact) {
    return contact.body && contact.object && btSoftBody::upcast(contact.object);
  });
  contacts_.clear();
  sleeping_.clear();
  if (!known) return stream.fail();
  sleeping_ = sleeping;
}

}  // namespace tetskin::contact_detail
