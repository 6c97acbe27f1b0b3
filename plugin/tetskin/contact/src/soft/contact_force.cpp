// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <BulletSoftBody/btDeformableBodySolver.h>
#include <tetskin/contact/src/soft/body_pairs.h>
#include <tetskin/contact/src/soft/contact_force.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tetskin::contact_detail {
namespace {

/// Contacts that the step will not close are left out, but for so many cubes.
constexpr btScalar kNearCubes = btScalar(0.1);
/// Penetrations up to this, in cubes, are left: what rests must be in touch.
constexpr btScalar kSlopCubes = btScalar(0.02);
/// A body at this speed, in lengths a second, wakes what sleeps where it touches; Bullet's own threshold of sleep.
constexpr btScalar kWakingSpeed = btScalar(0.04);

bool isSame(const ContactMemory& m, int id) {
  return m.first == id || m.second == id;
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

void ContactForce::include(btSoftBody& body, std::shared_ptr<const ContactShape> shape, bool self) {
  exclude(body);
  bodies_.push_back(std::make_unique<ContactBody>(body, std::move(shape), self, nextId_++));
}

void ContactForce::exclude(const btSoftBody& body) {
  gone_.erase(std::remove(gone_.begin(), gone_.end(), &body), gone_.end());
  const ContactBody* of = find(body);
  if (!of) return;
  // Nothing of the step before may name the body, nor any row.
  const int id = of->id;
  rows_.erase(std::remove_if(rows_.begin(), rows_.end(),
                             [&](const ContactRow& row) { return row.sides[0].of == of || row.sides[1].of == of; }),
              rows_.end());
  memory_.erase(std::remove_if(memory_.begin(), memory_.end(), [&](const ContactMemory& m) { return isSame(m, id); }),
                memory_.end());
  for (auto kept = pairMemory_.begin(); kept != pairMemory_.end();) {
    kept = kept->first.first == id || kept->first.second == id ? pairMemory_.erase(kept) : std::next(kept);
  }
  pairs_.erase(std::remove_if(pairs_.begin(), pairs_.end(),
                              [&](const auto& pair) { return pair[0] == &body || pair[1] == &body; }),
               pairs_.end());
  bodies_.erase(std::find_if(bodies_.begin(), bodies_.end(), [&](const auto& b) { return b.get() == of; }));
}

void ContactForce::removeSoftBody(btSoftBody* body) {
  removal_ = true;
  if (!find(*body)) return;
  exclude(*body);
  gone_.push_back(body);
}

void ContactForce::reinitialize(bool) {
  const bool removal = removal_;
  removal_ = false;
  // The step before may have had no solve, or been of another length: what it has left is read first.
  if (!removal) memory_ = memoryOf(rows_, static_cast<btScalar>(options_.hold));
  rows_.clear();
  pairs_.clear();
  dt_ = solver_.m_objective->m_dt;
  if (removal || !(dt_ > 0)) return;
  readBodies();
  detect();
  wakeTouched();
  nameBodies();
}

void ContactForce::readBodies() {
  for (const auto& of : bodies_) {
    of->readable = false;
    if (of->fits()) of->read();
  }
}

void ContactForce::detect() {
  std::vector<ContactBody*> readable;
  std::vector<ContactBox> boxes;
  for (const auto& of : bodies_) {
    if (!of->readable) continue;
    readable.push_back(of.get());
    boxes.push_back(of->box);
  }
  BodyPairs near;
  for (const auto& [a, b] : pairsOfBoxesThatMeet(boxes)) {
    if (a != b || readable[a]->self) near.emplace_back(readable[a], readable[b]);
  }
  forgetAllBut(near);
  for (const auto& [first, second] : near) {
    if (first->awake || second->awake) detectPair(*first, *second);
  }
  if (rows_.empty()) return;
  correctPositions(rows_, static_cast<btScalar>(options_.correction),
                   kSlopCubes * rows_.front().sides[1].of->data().grid.spacing());
  for (const auto& of : bodies_) {
    if (of->readable && of->awake) of->writePositions();
  }
  predictVelocities();
  keepNear();
  estimateImpulses(rows_, memory_, dt_);
}

/// near  in the order of their ids
void ContactForce::forgetAllBut(const BodyPairs& near) {
  auto pair = near.begin();
  for (auto known = pairMemory_.begin(); known != pairMemory_.end();) {
    const auto idsOf = [](const auto& of) { return std::make_pair(of.first->id, of.second->id); };
    while (pair != near.end() && idsOf(*pair) < known->first) ++pair;
    const bool isNear = pair != near.end() && idsOf(*pair) == known->first;
    known = isNear ? std::next(known) : pairMemory_.erase(known);
  }
}

void ContactForce::detectPair(ContactBody& first, ContactBody& second) {
  touches_.clear();
  const btScalar reach = kReachCubes * second.data().grid.spacing();
  search_.find(first, second, reach, dt_, pairMemory_[{first.id, second.id}], touches_);
  for (const Touch& touch : touches_) addRow(first, second, touch);
}

void ContactForce::addRow(ContactBody& first, ContactBody& second, const Touch& touch) {
  const EmbeddedPoint<btScalar>& sample = first.data().samples[static_cast<std::size_t>(touch.sample)];
  ContactRow row;
  row.sides[0].take(first, sample.nodes, sample.clamped.data(), 1);
  row.sides[1].take(second, second.data().tets[static_cast<std::size_t>(touch.tet)], touch.weights, -1);
  row.node = first.data().sampleNodes[static_cast<std::size_t>(touch.sample)];
  row.point = first.sampleAt(touch.sample);
  row.normal = touch.normal;
  row.distance = touch.distance;
  row.inverseMass = row.sides[0].inverseMass() + row.sides[1].inverseMass();
  row.roughness = options_.friction < 0 ? btSqrt(first.body->m_cfg.kDF * second.body->m_cfg.kDF)
                                        : static_cast<btScalar>(options_.friction);
  if (row.inverseMass > 0) rows_.push_back(row);
}

/// As they will be by gravity alone: what elasticity does, contacts resist in the solve.
void ContactForce::predictVelocities() {
  for (const auto& of : bodies_) {
    if (!of->readable) continue;
    of->velocities.resize(of->positions.size());
    const btVector3 gained = dt_ * of->body->m_gravityFactor * worldInfo_.m_gravity;
    for (std::size_t n = 0; n < of->velocities.size(); ++n) {
      const btSoftBody::Node& node = of->body->m_nodes[static_cast<int>(n)];
      of->velocities[n] = of->awake ? btVector3(node.m_im > 0 ? node.m_v + gained : node.m_v) : btVector3(0, 0, 0);
    }
  }
}

/// Drops the rows that this step will not close.
void ContactForce::keepNear() {
  const auto isFar = [&](const ContactRow& row) {
    const btVector3 v = row.relative(
        [](const ContactNodes& side, int k) { return side.of->velocities[static_cast<std::size_t>(side.nodes[k])]; });
    return row.distance + dt_ * v.dot(row.normal) > kNearCubes * row.sides[1].of->data().grid.spacing();
  };
  rows_.erase(std::remove_if(rows_.begin(), rows_.end(), isFar), rows_.end());
}

void ContactForce::wakeTouched() {
  for (const ContactRow& row : rows_) {
    if (!row.live() || row.sides[0].of->awake == row.sides[1].of->awake) continue;
    if (row.relativeNow().length2() < kWakingSpeed * kWakingSpeed) continue;
    for (const ContactNodes& side : row.sides) side.of->body->activate();
  }
}

void ContactForce::nameBodies() {
  for (const ContactRow& row : rows_) {
    if (!row.live()) continue;
    const std::array<btSoftBody*, 2> pair{row.sides[0].of->body, row.sides[1].of->body};
    if (pairs_.empty() || pairs_.back() != pair) pairs_.push_back(pair);
  }
}

btScalar ContactForce::firmness(const ContactRow& row) const {
  return static_cast<btScalar>(options_.hold) / row.inverseMass;
}

void ContactForce::addScaledExplicitForce(btScalar, TVStack& force) {
  for (const ContactRow& row : rows_) {
    if (row.live()) row.addTo(force, row.impulse * row.normal + row.friction);
  }
}

void ContactForce::addScaledDampingForce(btScalar, TVStack& force) {
  for (const ContactRow& row : rows_) {
    if (!row.live()) continue;
    const btVector3 missed = row.held(row.relativeNow() - row.target * row.normal);
    row.addTo(force, -firmness(row) * missed);
  }
}

void ContactForce::addScaledDampingForceDifferential(btScalar, const TVStack& dv, TVStack& df) {
  for (const ContactRow& row : rows_) {
    if (row.live()) row.addTo(df, firmness(row) * row.held(row.relativeOf(dv)));
  }
}

}  // namespace tetskin::contact_detail
