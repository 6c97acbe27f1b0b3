// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Projected Gauss-Seidel on the nodes' own masses. What elasticity makes of these impulses, the step's solve finds out:
// there touching points are held, and what that takes is carried over into the next step.
#include <tetskin/contact/src/soft/contact_estimate.h>

#include <algorithm>
#include <tuple>

namespace tetskin::contact_detail {
namespace {

constexpr int kVelocityPasses = 10;
constexpr int kPositionPasses = 4;
/// Of an impulse, what the next step begins with: it forgets contacts that have ended by halves.
constexpr btScalar kCarriedOver = btScalar(0.9);
/// Cosine between a contact's normals in two steps from which it is the same.
constexpr btScalar kSameWay = btScalar(0.7);
/// Friction beyond this share of what Coulomb allows makes a contact slide.
constexpr btScalar kSlips = btScalar(1.05);

auto keyOf(const ContactMemory& m) {
  return std::make_tuple(m.first, m.second, m.node);
}

/// Of the node's contacts the one that pushed most nearly the same way.
const ContactMemory* find(const std::vector<ContactMemory>& memory, const ContactRow& row) {
  ContactMemory key;
  key.first = row.sides[0].of->id;
  key.second = row.sides[1].of->id;
  key.node = row.node;
  const ContactMemory* best = nullptr;
  btScalar alike = kSameWay;
  const auto before = [](const ContactMemory& a, const ContactMemory& b) { return keyOf(a) < keyOf(b); };
  const auto [first, last] = std::equal_range(memory.begin(), memory.end(), key, before);
  for (auto m = first; m != last; ++m) {
    const btScalar cosine = m->normal.dot(row.normal);
    if (cosine > alike) best = &*m;
    alike = std::max(alike, cosine);
  }
  return best;
}

template <class Value>
void addByMass(const ContactRow& row, const btVector3& impulse, Value&& value) {
  for (const ContactNodes& side : row.sides) {
    for (int k = 0; k < 4; ++k) {
      value(side, side.nodes[k]) += side.weights[k] * side.of->inverseMass(side.nodes[k]) * impulse;
    }
  }
}

btVector3& velocityAt(const ContactNodes& side, int node) {
  return side.of->velocities[static_cast<std::size_t>(node)];
}

btVector3 relativeVelocity(const ContactRow& row) {
  return row.relative([](const ContactNodes& side, int k) { return velocityAt(side, side.nodes[k]); });
}

void clampTo(btVector3& v, btScalar most) {
  const btScalar length = v.length();
  if (length > most) v *= most / length;
}

/// The friction that the row begins the solve with.
void startFriction(ContactRow& row, const ContactMemory* before) {
  const btScalar most = row.roughness * row.impulse;
  btVector3 slip = relativeVelocity(row);
  slip -= slip.dot(row.normal) * row.normal;
  const btScalar speed = slip.length();
  row.friction.setZero();
  if (before) row.friction = before->friction - before->friction.dot(row.normal) * row.normal;
  clampTo(row.friction, most);
  const bool slid = before && before->sliding == Sliding::Yes && slip.dot(row.friction) < 0;
  row.sliding = slid || speed > most * row.inverseMass ? Sliding::Yes : Sliding::No;
  if (row.sliding == Sliding::Yes && speed > 0) row.friction = slip * (-most / speed);
}

}  // namespace

void correctPositions(std::vector<ContactRow>& rows, btScalar part, btScalar slop) {
  std::vector<btScalar> pushed(rows.size(), 0), wanted(rows.size(), 0);
  std::vector<btVector3> start;
  start.reserve(rows.size());
  for (std::size_t r = 0; r < rows.size(); ++r) wanted[r] = part * std::max(-rows[r].distance - slop, btScalar(0));
  const auto place = [](const ContactNodes& side, int node) -> btVector3& {
    return side.of->positions[static_cast<std::size_t>(node)];
  };
  const auto placed = [&](const ContactRow& row) {
    return row.relative([&](const ContactNodes& side, int k) { return place(side, side.nodes[k]); });
  };
  for (const ContactRow& row : rows) start.push_back(placed(row));
  for (int pass = 0; pass < kPositionPasses; ++pass) {
    for (std::size_t r = 0; r < rows.size(); ++r) {
      if (!(wanted[r] > 0) || !(rows[r].inverseMass > 0)) continue;
      const btScalar gone = (placed(rows[r]) - start[r]).dot(rows[r].normal);
      const btScalar now = std::max(pushed[r] + (wanted[r] - gone) / rows[r].inverseMass, btScalar(0));
      addByMass(rows[r], (now - pushed[r]) * rows[r].normal, place);
      pushed[r] = now;
    }
  }
  for (std::size_t r = 0; r < rows.size(); ++r) rows[r].distance += (placed(rows[r]) - start[r]).dot(rows[r].normal);
}

void estimateImpulses(std::vector<ContactRow>& rows, const std::vector<ContactMemory>& memory, btScalar dt) {
  std::vector<btScalar> added(rows.size(), 0);
  for (ContactRow& row : rows) row.target = row.distance > 0 ? -row.distance / dt : btScalar(0);
  for (int pass = 0; pass < kVelocityPasses; ++pass) {
    for (std::size_t r = 0; r < rows.size(); ++r) {
      if (!(rows[r].inverseMass > 0)) continue;
      const btScalar speed = relativeVelocity(rows[r]).dot(rows[r].normal);
      const btScalar now = std::max(added[r] + (rows[r].target - speed) / rows[r].inverseMass, btScalar(0));
      addByMass(rows[r], (now - added[r]) * rows[r].normal, velocityAt);
      added[r] = now;
    }
  }
  for (std::size_t r = 0; r < rows.size(); ++r) {
    ContactRow& row = rows[r];
    const ContactMemory* before = find(memory, row);
    row.impulse = added[r] + (before ? kCarriedOver * before->impulse : 0);
    if (row.live()) startFriction(row, before);
  }
}

std::vector<ContactMemory> memoryOf(const std::vector<ContactRow>& rows, btScalar hold) {
  std::vector<ContactMemory> memory;
  for (const ContactRow& row : rows) {
    if (!row.live()) continue;
    const btVector3 velocity = row.relativeNow();
    const btScalar firmness = hold / row.inverseMass;
    const btScalar along = velocity.dot(row.normal);
    ContactMemory m;
    m.first = row.sides[0].of->id;
    m.second = row.sides[1].of->id;
    m.node = row.node;
    m.normal = row.normal;
    m.impulse = row.impulse + firmness * (row.target - along);
    if (!(m.impulse > 0)) continue;
    m.friction = row.friction;
    m.sliding = row.sliding;
    const btScalar most = row.roughness * m.impulse;
    if (row.sliding == Sliding::No) m.friction -= firmness * (velocity - along * row.normal);
    if (m.friction.length() > kSlips * most) m.sliding = Sliding::Yes;
    clampTo(m.friction, most);
    memory.push_back(m);
  }
  std::stable_sort(memory.begin(), memory.end(),
                   [](const ContactMemory& a, const ContactMemory& b) { return keyOf(a) < keyOf(b); });
  return memory;
}

}  // namespace tetskin::contact_detail
