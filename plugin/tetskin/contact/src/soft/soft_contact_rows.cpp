// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/contact/src/soft/body_pairs.h>
#include <tetskin/contact/src/soft/soft_contact_rows.h>
#include <tetskin/core/src/base/arithmetic/turns.h>
#include <tetskin/solver/src/base/contact_filter.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>

namespace tetskin::contact_detail {

using namespace bullet_detail;

namespace {

/// Depth above which two bodies overlap, in sizes of the smaller body.
constexpr btScalar kDeep = btScalar(0.03);
/// A shorter mean normal of the samples inside has no direction, as for a body that lies wholly inside another one.
constexpr btScalar kMinGradient = btScalar(0.05);
/// Fraction of a body's samples that are at or below another's surface with agreeing normals: above it, the two bodies
/// coincide.
constexpr double kInOnePlace = 0.3;
/// Largest number of tasks among which pairs are divided: several per thread, because pairs differ in cost.
constexpr std::size_t kMaxTasks = 64;
/// Numbers of points begin here, so that they differ from those of contacts with rigid bodies.
constexpr std::uint32_t kFirstPoint = 0x40000000U;
/// First number for points of the other body, if the body that is touched reports the contact.
constexpr std::uint32_t kFirstTurned = 0xC0000000U;

/// The velocity of the point relative to the body that it touches.
btVector3 velocityOf(const PointContact& contact) {
  const btVector3 v = contact.at.velocity(*contact.body);
  const btSoftBody& object = *btSoftBody::upcast(contact.object);
  return object.isActive() ? v - contact.onObject.velocity(object) : v;
}

/// The same contact, as a contact of the other body: a sleeping body has no rows itself.
PointContact swapRoles(const PointContact& from) {
  assert(btSoftBody::upcast(from.object));
  PointContact contact = from;
  contact.body = const_cast<btSoftBody*>(btSoftBody::upcast(from.object));
  contact.object = from.body;
  std::swap(contact.at, contact.onObject);
  contact.normal = -from.normal;
  contact.point = from.point - kFirstPoint + kFirstTurned;
  return contact;
}

bool sleeps(const PointContact& contact) {
  return !contact.body->isActive() && !contact.object->isActive();
}

/// True unless the body is waiting to fall asleep.
bool moves(const btSoftBody& body) {
  return body.isActive() && !(body.getDeactivationTime() > 0);
}

bool liesWithin(const ContactBody& body, const Overlap& overlap) {
  return overlap.inside > 0 && static_cast<std::size_t>(overlap.inside) == body.data().samples.size();
}

bool isMostlyWithin(const ContactBody& body, const Overlap& overlap) {
  return overlap.agreeing > kInOnePlace * static_cast<double>(body.data().samples.size());
}

/// A direction for each body, spread over the sphere by the golden angle.
btVector3 directionOf(int id) {
  // In radians; and the golden section.
  constexpr double kGoldenAngle = 2.39996322972865332, kGoldenPart = 0.61803398874989485;
  const double y = 2.0 * std::fmod(kGoldenPart * id, 1.0) - 1.0, radius = std::sqrt(1.0 - y * y);
  const SineAndCosine turned = sineAndCosine(kGoldenAngle * (id % 100000));
  return {static_cast<btScalar>(radius * turned.cosine), static_cast<btScalar>(y),
          static_cast<btScalar>(radius * turned.sine)};
}

}  // namespace

ContactBody* SoftContactRows::find(const btSoftBody& body) const {
  for (const auto& solved : bodies_) {
    if (solved->body == &body) return solved.get();
  }
  return nullptr;
}

bool SoftContactRows::isGone(const btSoftBody& body) const {
  const auto isIt = [&](const auto& gone) { return gone->body == &body; };
  return std::find(gone_.begin(), gone_.end(), &body) != gone_.end() || std::any_of(away_.begin(), away_.end(), isIt);
}

bool SoftContactRows::isWithin(const ContactBody& body) const {
  return std::any_of(pairStates_.begin(), pairStates_.end(),
                     [&](const auto& entry) { return entry.second.within == &body; });
}

void SoftContactRows::include(btSoftBody& body, std::shared_ptr<const ContactShape> shape, bool self) {
  assert(shape);
  bodies_.reserve(bodies_.size() + 1);
  auto made = std::make_unique<ContactBody>(body, std::move(shape), self, nextId_);
  exclude(body);
  bodies_.push_back(std::move(made));
  ++nextId_;
}

void SoftContactRows::exclude(const btSoftBody& body) {
  gone_.erase(std::remove(gone_.begin(), gone_.end(), &body), gone_.end());
  const auto isIt = [&](const auto& gone) { return gone->body == &body; };
  away_.erase(std::remove_if(away_.begin(), away_.end(), isIt), away_.end());
  (void)take(body);
}

/// Null if it is not there.
std::unique_ptr<ContactBody> SoftContactRows::take(const btSoftBody& body) {
  const ContactBody* solved = find(body);
  if (!solved) return nullptr;
  forgetPairs(*solved);
  const auto found = std::find_if(bodies_.begin(), bodies_.end(), [&](const auto& b) { return b.get() == solved; });
  std::unique_ptr<ContactBody> taken = std::move(*found);
  bodies_.erase(found);
  return taken;
}

/// Afterwards nothing stored in the last step refers to the body.
void SoftContactRows::forgetPairs(const ContactBody& body) {
  for (auto* contacts : {&contacts_, &sleeping_}) {
    const auto isOf = [&](const auto& contact) { return contact.body == body.body || contact.object == body.body; };
    contacts->erase(std::remove_if(contacts->begin(), contacts->end(), isOf), contacts->end());
  }
  for (auto kept = pairStates_.begin(); kept != pairStates_.end();) {
    const auto [first, second] = kept->first;
    kept = first == body.id || second == body.id ? pairStates_.erase(kept) : std::next(kept);
  }
}

/// Bodies that were taken out of the world and are back.
void SoftContactRows::includeReturned() {
  for (std::size_t k = away_.size(); k-- > 0;) {
    if (away_[k]->lives() && !away_[k]->isInWorld()) continue;
    const std::unique_ptr<ContactBody> back = std::move(away_[k]);
    away_.erase(away_.begin() + static_cast<std::ptrdiff_t>(k));
    if (back->lives()) include(*back->body, back->shape, back->self);
  }
}

void SoftContactRows::forget(const btSoftBody& body) {
  ContactBody* solved = find(body);
  if (!solved) return;
  forgetPairs(*solved);
  solved->positions.clear();
}

void SoftContactRows::shift(const btVector3& by) {
  for (const auto& solved : bodies_) {
    for (btVector3& position : solved->positions) position += by;
  }
  for (auto* contacts : {&contacts_, &sleeping_}) {
    for (PointContact& contact : *contacts) contact.position += by;
  }
}

void SoftContactRows::updateBodies() {
  includeReturned();
  for (std::size_t k = bodies_.size(); k-- > 0;) {
    if (!bodies_[k]->lives()) (void)take(*bodies_[k]->body);
  }
}

void SoftContactRows::removeSoftBody(btSoftBody* body) {
  std::unique_ptr<ContactBody> taken = take(*body);
  if (!taken) return;
  if (taken->isWatched()) {
    away_.push_back(std::move(taken));
  } else {
    gone_.push_back(body);
  }
}

void SoftContactRows::dropCandidates() {
  for (auto& [ids, state] : pairStates_) {
    for (PairMemory& memory : state.memories) memory.candidates.drop();
  }
}

PointContacts* SoftContactRows::contacts(btScalar seconds, ParallelFor* threads) {
  assert(seconds > 0);
  includeReturned();
  keepSleeping();
  runTasks(threads, bodies_.size(), [&](std::size_t k) {
    bodies_[k]->readable = false;
    if (bodies_[k]->fits()) bodies_[k]->read();
  });
  std::vector<SearchedPair> pairs;
  for (const auto& [first, second] : overlappingPairs()) {
    if (first->awake || second->awake) pairs.push_back({first, second, &pairStates_[{first->id, second->id}]});
  }
  findInPairs(pairs, seconds, threads);
  // In the order of the pairs: contacts wake bodies, and later contacts depend on that.
  for (const auto& [first, second, state] : pairs) {
    for (const Touch& touch : state->touches[0]) addContact(*first, *second, touch, seconds);
    for (const Touch& touch : state->touches[1]) addContact(*second, *first, touch, seconds);
  }
  return &contacts_;
}

/// Contacts between sleeping bodies stay as they are.
void SoftContactRows::keepSleeping() {
  const auto last = std::remove_if(sleeping_.begin(), sleeping_.end(), [](const auto& c) { return !sleeps(c); });
  sleeping_.erase(last, sleeping_.end());
  std::copy_if(contacts_.begin(), contacts_.end(), std::back_inserter(sleeping_), sleeps);
  contacts_.clear();
}

/// The pairs that may collide. Other pairs are forgotten: if they may collide again, their relative position will
/// differ.
SoftContactRows::BodyPairs SoftContactRows::overlappingPairs() {
  std::vector<ContactBody*> readable;
  std::vector<ContactBox> boxes;
  for (const auto& body : bodies_) {
    if (!body->readable) continue;
    readable.push_back(body.get());
    boxes.push_back(body->box);
  }
  BodyPairs near;
  for (const auto& [a, b] : overlappingBoxPairs(boxes)) {
    const bool asked = a != b || readable[a]->self;
    if (asked && collidesWithSoft(*readable[a]->body, *readable[b]->body)) near.emplace_back(readable[a], readable[b]);
  }
  forgetAllBut(near);
  return near;
}

/// near  pairs in the order of their ids
void SoftContactRows::forgetAllBut(const BodyPairs& near) {
  auto pair = near.begin();
  for (auto known = pairStates_.begin(); known != pairStates_.end();) {
    const auto idsOf = [](const auto& body) { return std::make_pair(body.first->id, body.second->id); };
    while (pair != near.end() && idsOf(*pair) < known->first) ++pair;
    const bool isNear = pair != near.end() && idsOf(*pair) == known->first;
    known = isNear ? std::next(known) : pairStates_.erase(known);
  }
}

/// With n tasks, each one searches in every n-th pair, with its own memory.
void SoftContactRows::findInPairs(const std::vector<SearchedPair>& pairs, btScalar seconds, ParallelFor* threads) {
  const std::size_t tasks = threads ? std::min(kMaxTasks, pairs.size()) : 1;
  if (searches_.size() < tasks) searches_.resize(tasks);
  runTasks(threads, tasks, [&](std::size_t task) {
    for (std::size_t k = task; k < pairs.size(); k += tasks) findInPair(pairs[k], seconds, searches_[task]);
  });
}

void SoftContactRows::findInPair(const SearchedPair& pair, btScalar seconds, PairSearch& finder) {
  assert(pair.first->readable && pair.second->readable);
  const btVector3 before = pair.state->apart;
  pair.state->apart = search(pair, seconds, finder);
  if (before.isZero() && !pair.state->apart.isZero()) search(pair, seconds, finder);
}

/// Returns the direction in which the first body must leave the second, if they overlap: down the gradient of their
/// common volume, which is the integral of either body's normal over the part of its surface within the other.
btVector3 SoftContactRows::search(const SearchedPair& pair, btScalar seconds, PairSearch& finder) {
  ContactBody &first = *pair.first, &second = *pair.second;
  PairState& pairState = *pair.state;
  const btScalar deep = kDeep * std::min(first.box.diagonal(), second.box.diagonal());
  const auto in = [&](ContactBody& a, ContactBody& b, int k) {
    return finder.find(a, b, seconds, k == 0 ? pairState.apart : -pairState.apart, deep, pairState.memories[k],
                       pairState.touches[k]);
  };
  const Overlap own = in(first, second, 0);
  if (&first == &second) return {0, 0, 0};
  const Overlap other = in(second, first, 1);
  const bool firstWithin = liesWithin(first, own), secondWithin = liesWithin(second, other);
  pairState.within = firstWithin == secondWithin ? nullptr : firstWithin ? &first : &second;
  if (pairState.within) return {0, 0, 0};
  const bool inOnePlace = isMostlyWithin(first, own) && isMostlyWithin(second, other);
  if (std::min(own.deepest, other.deepest) > -deep && !inOnePlace) return {0, 0, 0};
  const btVector3 gradient = other.normals - own.normals;
  const btScalar length = gradient.length();
  if (length > kMinGradient * static_cast<btScalar>(own.inside + other.inside)) return gradient / length;
  return inOnePlace ? (directionOf(first.id) - directionOf(second.id)).normalized() : btVector3(0, 0, 0);
}

void SoftContactRows::addContact(const ContactBody& first, const ContactBody& second, const Touch& touch,
                                 btScalar seconds) {
  const auto s = static_cast<std::size_t>(touch.sample);
  assert(touch.sample >= 0 && s < first.data().samples.size());
  assert(touch.tet >= 0 && static_cast<std::size_t>(touch.tet) < second.data().tets.size());
  const EmbeddedPoint<btScalar>& sample = first.data().samples[s];
  PointContact contact;
  contact.body = first.body;
  contact.object = second.body;
  contact.point = kFirstPoint + static_cast<std::uint32_t>(first.data().sampleNodes[s]);
  contact.sample = static_cast<std::uint32_t>(touch.sample);
  contact.at = {4, sample.nodes, sample.weights};
  contact.onObject = {4, second.data().tets[static_cast<std::size_t>(touch.tet)], touch.weights};
  contact.position = touch.point;
  contact.normal = touch.normal;
  contact.distance = touch.distance;
  contact.friction = options_.friction ? static_cast<btScalar>(*options_.friction)
                                       : btSqrt(first.body->m_cfg.kDF * second.body->m_cfg.kDF);
  const btVector3 velocity = velocityOf(contact);
  const btScalar near = kNearCubes * second.data().grid.spacing();
  // Even if it is leaving now: within a step, a stiff body may throw a light node back as fast as it came.
  if (touch.distance - seconds * std::abs(velocity.dot(touch.normal)) > near) return;
  if (first.awake != second.awake && (moves(*first.body) || moves(*second.body))) {
    first.body->activate();
    second.body->activate();
  }
  contacts_.push_back(first.awake ? contact : swapRoles(contact));
}

}  // namespace tetskin::contact_detail
