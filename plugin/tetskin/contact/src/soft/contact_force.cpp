// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/bullet/src/shared/bodies/contact_filter.h>
#include <tetskin/contact/src/soft/body_pairs.h>
#include <tetskin/contact/src/soft/contact_force.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tetskin::contact_detail {
namespace {

/// Contacts that the step will not close are left out, but for so many cubes.
constexpr btScalar kNearCubes = btScalar(0.1);
/// A body at this speed, in lengths a second, wakes what sleeps where it touches; Bullet's own threshold of sleep.
constexpr btScalar kWakingSpeed = btScalar(0.04);
/// Deeper than this, in sizes of the smaller one, two bodies overlap.
constexpr btScalar kDeep = btScalar(0.03);
/// Of the normals of what is inside, the least sum that has a direction: what is within another has none.
constexpr btScalar kLeastGradient = btScalar(0.05);
/// Of a body's samples, the part that is at another's surface, or beneath, and looks as that does, where the two are
/// in one place.
constexpr double kInOnePlace = 0.3;
/// Numbers of points begin here: others than those of contacts with rigid bodies.
constexpr std::uint32_t kFirstPoint = 0x40000000U;

btVector3 velocityOf(const SoftPointContact& contact) {
  btVector3 v(0, 0, 0);
  for (std::uint32_t k = 0; k < contact.nodeCount; ++k) {
    v += contact.weights[k] * contact.body->m_nodes[contact.nodes[k]].m_v;
  }
  const btSoftBody& object = *btSoftBody::upcast(contact.object);
  if (!object.isActive()) return v;
  for (std::size_t k = 0; k < 4; ++k) v -= contact.objectWeights[k] * object.m_nodes[contact.objectNodes[k]].m_v;
  return v;
}

/// The same contact of the other body: what is asleep has no rows of its own.
SoftPointContact turned(const SoftPointContact& from) {
  SoftPointContact contact = from;
  contact.body = const_cast<btSoftBody*>(btSoftBody::upcast(from.object));
  contact.object = from.body;
  std::copy(from.objectNodes.begin(), from.objectNodes.end(), contact.nodes.begin());
  std::copy(from.objectWeights.begin(), from.objectWeights.end(), contact.weights.begin());
  std::copy_n(from.nodes.begin(), 4, contact.objectNodes.begin());
  std::copy_n(from.weights.begin(), 4, contact.objectWeights.begin());
  contact.normal = -from.normal;
  return contact;
}

bool liesWithin(const ContactBody& body, const Overlap& overlap) {
  return overlap.inside > 0 && static_cast<std::size_t>(overlap.inside) == body.data().samples.size();
}

bool isMostlyWithin(const ContactBody& body, const Overlap& overlap) {
  return overlap.agreeing > kInOnePlace * static_cast<double>(body.data().samples.size());
}

/// Each body's own, spread over the sphere by the golden angle.
btVector3 directionOf(int id) {
  constexpr double kGoldenAngle = 2.39996322972865332, kGoldenPart = 0.61803398874989485;
  const double y = 2.0 * std::fmod(kGoldenPart * id, 1.0) - 1.0, angle = kGoldenAngle * id;
  const double radius = std::sqrt(1.0 - y * y);
  return {static_cast<btScalar>(radius * std::cos(angle)), static_cast<btScalar>(y),
          static_cast<btScalar>(radius * std::sin(angle))};
}

}  // namespace

ContactBody* ContactForce::find(const btSoftBody& body) const {
  for (const auto& of : bodies_) {
    if (of->body == &body) return of.get();
  }
  return nullptr;
}

bool ContactForce::isGone(const btSoftBody& body) const {
  return std::find(gone_.begin(), gone_.end(), &body) != gone_.end();
}

bool ContactForce::isWithin(const ContactBody& body) const {
  return std::any_of(meetings_.begin(), meetings_.end(), [&](const auto& of) { return of.second.within == &body; });
}

void ContactForce::include(btSoftBody& body, std::shared_ptr<const ContactShape> shape, bool self) {
  exclude(body);
  bodies_.push_back(std::make_unique<ContactBody>(body, std::move(shape), self, nextId_++));
}

void ContactForce::exclude(const btSoftBody& body) {
  gone_.erase(std::remove(gone_.begin(), gone_.end(), &body), gone_.end());
  const ContactBody* of = find(body);
  if (!of) return;
  // Nothing of the step before may name the body.
  const int id = of->id;
  contacts_.erase(std::remove_if(contacts_.begin(), contacts_.end(),
                                 [&](const auto& contact) { return contact.body == &body || contact.object == &body; }),
                  contacts_.end());
  for (auto kept = meetings_.begin(); kept != meetings_.end();) {
    kept = kept->first.first == id || kept->first.second == id ? meetings_.erase(kept) : std::next(kept);
  }
  bodies_.erase(std::find_if(bodies_.begin(), bodies_.end(), [&](const auto& b) { return b.get() == of; }));
}

void ContactForce::removeSoftBody(btSoftBody* body) {
  if (!find(*body)) return;
  exclude(*body);
  gone_.push_back(body);
}

std::vector<SoftPointContact>* ContactForce::contacts(btScalar seconds) {
  contacts_.clear();
  for (const auto& of : bodies_) {
    of->readable = false;
    if (of->fits()) of->read();
  }
  for (const auto& [first, second] : pairsThatMeet()) {
    if (first->awake || second->awake) findInPair(*first, *second, seconds);
  }
  return &contacts_;
}

/// Others forget each other: where they are when they are let meet again is not where they were.
ContactForce::BodyPairs ContactForce::pairsThatMeet() {
  std::vector<ContactBody*> readable;
  std::vector<ContactBox> boxes;
  for (const auto& of : bodies_) {
    if (!of->readable) continue;
    readable.push_back(of.get());
    boxes.push_back(of->box);
  }
  BodyPairs near;
  for (const auto& [a, b] : pairsOfBoxesThatMeet(boxes)) {
    const bool asked = a != b || readable[a]->self;
    if (asked && meetsSoft(*readable[a]->body, *readable[b]->body)) near.emplace_back(readable[a], readable[b]);
  }
  forgetAllBut(near);
  return near;
}

/// near  in the order of their ids
void ContactForce::forgetAllBut(const BodyPairs& near) {
  auto pair = near.begin();
  for (auto known = meetings_.begin(); known != meetings_.end();) {
    const auto idsOf = [](const auto& of) { return std::make_pair(of.first->id, of.second->id); };
    while (pair != near.end() && idsOf(*pair) < known->first) ++pair;
    const bool isNear = pair != near.end() && idsOf(*pair) == known->first;
    known = isNear ? std::next(known) : meetings_.erase(known);
  }
}

void ContactForce::findInPair(ContactBody& first, ContactBody& second, btScalar seconds) {
  Meeting& meeting = meetings_[{first.id, second.id}];
  const btVector3 before = meeting.apart;
  meeting.apart = search(first, second, seconds, meeting);
  if (before.isZero() && !meeting.apart.isZero()) search(first, second, seconds, meeting);
  for (const Touch& touch : touches_[0]) addContact(first, second, touch, seconds);
  for (const Touch& touch : touches_[1]) addContact(second, first, touch, seconds);
}

/// Returns which way the first is to leave the second, if they overlap: down the gradient of the volume that they have
/// in common, the integral of either's normal over what of its surface is within the other.
btVector3 ContactForce::search(ContactBody& first, ContactBody& second, btScalar seconds, Meeting& meeting) {
  const btScalar deep = kDeep * std::min(first.box.diagonal(), second.box.diagonal());
  // No farther than the step may take them.
  const btScalar approach = seconds * (first.fastest + second.fastest + (first.drift - second.drift).length());
  const auto in = [&](ContactBody& a, ContactBody& b, int k) {
    const btScalar cube = b.data().grid.spacing();
    const btScalar reach = std::min(kReachCubes * cube, kNearCubes * cube + approach);
    touches_[k].clear();
    return search_.find(a, b, reach, seconds, k == 0 ? meeting.apart : -meeting.apart, deep, meeting.memories[k],
                        touches_[k]);
  };
  const Overlap own = in(first, second, 0);
  touches_[1].clear();
  if (&first == &second) return {0, 0, 0};
  const Overlap other = in(second, first, 1);
  const bool firstWithin = liesWithin(first, own), secondWithin = liesWithin(second, other);
  meeting.within = firstWithin == secondWithin ? nullptr : firstWithin ? &first : &second;
  if (meeting.within) return {0, 0, 0};
  const bool inOnePlace = isMostlyWithin(first, own) && isMostlyWithin(second, other);
  if (std::min(own.deepest, other.deepest) > -deep && !inOnePlace) return {0, 0, 0};
  const btVector3 gradient = other.normals - own.normals;
  const btScalar length = gradient.length();
  if (length > kLeastGradient * static_cast<btScalar>(own.inside + other.inside)) return gradient / length;
  return inOnePlace ? (directionOf(first.id) - directionOf(second.id)).normalized() : btVector3(0, 0, 0);
}

void ContactForce::addContact(const ContactBody& first, const ContactBody& second, const Touch& touch,
                              btScalar seconds) {
  const auto s = static_cast<std::size_t>(touch.sample);
  const EmbeddedPoint<btScalar>& sample = first.data().samples[s];
  SoftPointContact contact;
  contact.body = first.body;
  contact.object = second.body;
  contact.point = kFirstPoint + static_cast<std::uint32_t>(first.data().sampleNodes[s]);
  contact.nodeCount = 4;
  std::copy(sample.nodes.begin(), sample.nodes.end(), contact.nodes.begin());
  std::copy(sample.weights.begin(), sample.weights.end(), contact.weights.begin());
  const Tet& tet = second.data().tets[static_cast<std::size_t>(touch.tet)];
  std::copy(tet.begin(), tet.end(), contact.objectNodes.begin());
  std::copy(touch.weights, touch.weights + 4, contact.objectWeights.begin());
  contact.position = first.sampleAt(touch.sample);
  contact.normal = touch.normal;
  contact.distance = touch.distance;
  contact.friction = options_.friction < 0 ? btSqrt(first.body->m_cfg.kDF * second.body->m_cfg.kDF)
                                           : static_cast<btScalar>(options_.friction);
  const btVector3 velocity = velocityOf(contact);
  const btScalar near = kNearCubes * second.data().grid.spacing();
  if (touch.distance + seconds * velocity.dot(touch.normal) > near) return;
  if (first.awake != second.awake && velocity.length2() > kWakingSpeed * kWakingSpeed) {
    first.body->activate();
    second.body->activate();
  }
  contacts_.push_back(first.awake ? contact : turned(contact));
}

}  // namespace tetskin::contact_detail
