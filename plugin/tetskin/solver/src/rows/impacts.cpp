// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <tetskin/bullet/src/base/world_stream.h>
#include <tetskin/solver/src/forces/node_vectors.h>
#include <tetskin/solver/src/rows/impacts.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tetskin::bullet_detail {
namespace {

/// Steps without a push that is felt after which an impact is over, if the pair has not parted.
constexpr int kQuietSteps = 8;

/// The change of velocity in a step from which on contacts count as an impact: twice what a body at rest takes.
btScalar leastImpact(const SolvedBody& body, btScalar seconds) {
  constexpr btScalar kGravities = 2;
  constexpr btScalar kLeastWay = btScalar(1e-3);  // without gravity: of the body's size, within a step
  const btDiscreteDynamicsWorld* world = body.world();
  const btScalar falls = world ? world->getGravity().length() * seconds : btScalar(0);
  return falls > 0 ? kGravities * falls : kLeastWay * sizeOf(*body.body) / seconds;
}

/// False for joints, loads, rows between rigid bodies, and bodies that nothing elastic moves.
bool isElasticContact(const ContactRow& row, const RowOrigin& origin, const SolverBodies& bodies) {
  const auto isElastic = [&](const RowEnd& end) { return bodies.bodies()[end.body].elastic != nullptr; };
  return !row.joined && !row.constant && row.ends[0].isSoft() && origin.object && isElastic(row.ends[0]) &&
         (!row.ends[1].isSoft() || isElastic(row.ends[1]));
}

ImpactPair pairOf(const ContactRow& row, const RowOrigin& origin, const SolverBodies& bodies) {
  const auto componentAt = [&](std::size_t end) -> std::uint64_t {
    if (!row.ends[end].isSoft()) return 0;
    const SolvedBody& body = bodies.bodies()[row.ends[end].body];
    return body.dynamics->componentOf(static_cast<std::size_t>(origin.points[end].nodes[0]));
  };
  const SolvedBody& first = bodies.bodies()[row.ends[0].body];
  const btCollisionObject* second = row.ends[1].isSoft() ? bodies.bodies()[row.ends[1].body].body : origin.object;
  return {first.body, second, componentAt(0), componentAt(1)};
}

/// A component that touches itself cannot part from itself.
bool isOne(const ImpactPair& pair) {
  return pair.body == pair.object && pair.component == pair.otherComponent;
}

using Sides = std::array<ImpactSide, 2>;

/// Some soft body may be asleep, or gone from the solver: see `isComplete`.
Sides sidesOf(const ImpactPair& pair, SolverBodies& bodies, RigidUnknowns& rigids) {
  const btSoftBody* other = btSoftBody::upcast(pair.object);
  return {ImpactSide(bodies.find(btSoftBody::upcast(pair.body)), pair.component, *pair.body, rigids),
          ImpactSide(other ? bodies.find(other) : nullptr, pair.otherComponent, *pair.object, rigids)};
}

bool isComplete(const ImpactPair& pair, const Sides& sides) {
  return sides[0].soft() && (sides[1].soft() || !btSoftBody::upcast(pair.object));
}

/// The velocity of a soft end beside its rigid motion, at the beginning of the step.
btVector3 deviationAt(const SolvedBody& body, const CarriedPoint& point) {
  return point.sum([&](int n) {
    return fromWide(body.dynamics->deviation() + body.dynamics->matrix().wideOf(static_cast<std::size_t>(n)));
  });
}

/// What a contact takes from the pair's energy in the step.
double lossOf(const ContactRow& row, const RowOrigin& origin, const SolverBodies& bodies) {
  const btScalar impulse = row.normal.dot(row.impulse);
  assert(impulse > 0 && row.stiffness > 0);
  btVector3 u = row.relative;
  for (std::size_t e = 0; e < 2; ++e) {
    if (!row.ends[e].isSoft()) continue;
    u += btScalar(signOf(e)) * deviationAt(bodies.bodies()[row.ends[e].body], origin.points[e]);
  }
  const btScalar before = row.normal.dot(u), after = -row.gapVelocity - impulse / row.stiffness;
  return static_cast<double>(-impulse * (before + after) / 2);
}

/// How a pair meets and parts, as two rigid bodies.
struct Meeting {
  btVector3 at, along;         ///< the mean place and direction of the pushes on the first one, world space
  double in = 0.0, out = 0.0;  ///< speeds of approach and of parting; below 0: the other way
  double compliance = 0.0;     ///< of both
  double energyAt(double speed) const { return 0.5 * speed * speed / compliance; }
};

Meeting meetingOf(const Impact& impact, const Sides& sides) {
  assert(impact.weight > 0);
  Meeting meeting;
  meeting.along = impact.push.normalized();
  meeting.at = sides[0].centre() + impact.arm / impact.weight;
  const auto parting = [&](const SideMotion& first, const SideMotion& second) {
    return static_cast<double>(sides[0].speed(first, meeting.at, meeting.along) -
                               sides[1].speed(second, meeting.at, meeting.along));
  };
  // The step in which it began has added the whole of its gravity, which acted until they met alone.
  const auto fallen = static_cast<double>(std::max(-impact.fallen.dot(meeting.along), btScalar(0)));
  meeting.in = -parting(impact.before[0], impact.before[1]) - fallen;
  meeting.out = parting(sides[0].motion(meeting.at, true), sides[1].motion(meeting.at, true));
  for (const ImpactSide& side : sides)
    meeting.compliance += static_cast<double>(side.compliance(meeting.at, meeting.along));
  return meeting;
}

/// The energy with which the pair is to part, if its vibrations leave it as much.
double partingEnergy(const Impact& impact, const Sides& sides, const Meeting& meeting) {
  const double came = meeting.energyAt(meeting.in), parts = meeting.energyAt(meeting.out);
  const double lost = std::max(std::min(impact.lost, came), 0.0);
  const double kept = std::min(sides[0].kept(), sides[1].kept());
  const double elastic = parts + lost * std::min((std::sqrt(std::sqrt(kept)) * parts + kept * lost) / came, 1.0);
  const double e = static_cast<double>(impact.pair.body->getRestitution() * impact.pair.object->getRestitution());
  return std::min(std::max(elastic, e * e * came), came);
}

/// By how much faster the pair is to part.
double missingSpeed(const Impact& impact, const Sides& sides, const Meeting& meeting) {
  if (!(meeting.in > 0.0) || !(meeting.out > 0.0) || !(meeting.compliance > 0.0)) return 0.0;
  return std::max(std::sqrt(2.0 * meeting.compliance * partingEnergy(impact, sides, meeting)) - meeting.out, 0.0);
}

/// At the beginning of a step.
btScalar partingSpeed(const DueImpulse& due, const Sides& sides) {
  const auto speed = [&](const ImpactSide& side) {
    return side.speed(side.motion(due.at, false), due.at, due.along);
  };
  return speed(sides[0]) - speed(sides[1]);
}

}  // namespace

Impact* Impacts::find(const ImpactPair& pair) {
  const auto found = std::find_if(list_.begin(), list_.end(), [&](const Impact& one) { return one.pair == pair; });
  return found == list_.end() ? nullptr : &*found;
}

bool Impacts::includes(const btSoftBody& body) const {
  const auto isOf = [&](const Impact& one) { return one.pair.body == &body || one.pair.object == &body; };
  return std::any_of(list_.begin(), list_.end(), isOf);
}

void Impacts::giveBack(SolverBodies& bodies, RigidUnknowns& rigids) {
  if (due_.empty()) return;
  rigids.clear();  // those of the last step
  std::vector<btScalar> before;
  for (const DueImpulse& due : due_) {
    const Sides sides = sidesOf(due.pair, bodies, rigids);
    const bool complete = isComplete(due.pair, sides);
    for (const ImpactSide& side : sides) {
      if (complete && side.soft()) side.soft()->dynamics->findMotion();
    }
    before.push_back(complete ? partingSpeed(due, sides) : 0);
  }
  for (std::size_t k = 0; k < due_.size(); ++k) {
    const DueImpulse& due = due_[k];
    const Sides sides = sidesOf(due.pair, bodies, rigids);
    if (!isComplete(due.pair, sides)) continue;
    const btScalar compliance = sides[0].compliance(due.at, due.along) + sides[1].compliance(due.at, due.along);
    const double left = std::max(due.energy - sides[0].vibration() - sides[1].vibration(), 0.0);
    const auto fastest = static_cast<btScalar>(std::sqrt(2.0 * static_cast<double>(compliance) * left));
    const btScalar speed = partingSpeed(due, sides), missing = std::min(before[k] + due.speed, fastest) - speed;
    if (!(missing > 0 && compliance > 0)) continue;
    sides[0].push(due.at, missing / compliance * due.along);
    sides[1].push(due.at, -missing / compliance * due.along);
  }
  due_.clear();
}

void Impacts::begin(const ContactRows& rows, SolverBodies& bodies, RigidUnknowns& rigids, btScalar seconds) {
  assert(seconds > 0);
  for (const ContactRow& row : rows.rows()) {
    const RowOrigin& origin = rows.originOf(row);
    if (!isElasticContact(row, origin, bodies)) continue;
    const SolvedBody& body = bodies.bodies()[row.ends[0].body];
    const btScalar stopped = -row.normal.dot(row.relative) - row.gapVelocity;
    if (!(stopped > leastImpact(body, seconds))) continue;
    const ImpactPair pair = pairOf(row, origin, bodies);
    if (isOne(pair) || find(pair)) continue;
    Impact impact;
    impact.pair = pair;
    const Sides sides = sidesOf(pair, bodies, rigids);
    for (std::size_t k = 0; k < 2; ++k) impact.before[k] = sides[k].motion(origin.position, false);
    const btDiscreteDynamicsWorld* world = body.world();
    if (world && !sides[1].moves()) impact.fallen = seconds * world->getGravity();
    list_.push_back(impact);
  }
}

void Impacts::finish(const ContactRows& rows, SolverBodies& bodies, RigidUnknowns& rigids, btScalar seconds) {
  if (list_.empty()) return;
  for (Impact& impact : list_) ++impact.quiet;
  std::vector<btScalar> felt(list_.size(), 0);
  for (const ContactRow& row : rows.rows()) {
    const RowOrigin& origin = rows.originOf(row);
    const btScalar impulse = row.normal.dot(row.impulse);
    if (!(impulse > 0) || !isElasticContact(row, origin, bodies)) continue;
    const SolvedBody& first = bodies.bodies()[row.ends[0].body];
    const ImpactPair pair = pairOf(row, origin, bodies);
    Impact* impact = find(pair);
    if (!impact) continue;
    const ImpactSide side(&bodies.bodies()[row.ends[0].body], pair.component, *first.body, rigids);
    impact->push += impulse * row.normal;
    impact->arm += impulse * (origin.position - side.centre());
    impact->weight += impulse;
    impact->lost += lossOf(row, origin, bodies);
    felt[static_cast<std::size_t>(impact - list_.data())] += impulse;
  }
  std::vector<Impact> left;
  for (std::size_t k = 0; k < list_.size(); ++k) {
    Impact& impact = list_[k];
    const Sides sides = sidesOf(impact.pair, bodies, rigids);
    if (!isComplete(impact.pair, sides)) continue;
    const btScalar mass = sides[1].moves() ? std::min(sides[0].mass(), sides[1].mass()) : sides[0].mass();
    if (felt[k] > mass * leastImpact(*sides[0].soft(), seconds)) impact.quiet = 0;
    const bool met = impact.weight > 0 && !impact.push.fuzzyZero();
    const Meeting meeting = met ? meetingOf(impact, sides) : Meeting();
    const bool over = impact.quiet > 0 && (meeting.out > 0.0 || impact.quiet >= kQuietSteps);
    if (!over) left.push_back(impact);
    if (!over || !met) continue;
    const auto speed = static_cast<btScalar>(missingSpeed(impact, sides, meeting));
    const double came = meeting.energyAt(meeting.in);
    const btVector3 carried = seconds * sides[0].motion(meeting.at, true).linear;
    if (speed > 0) due_.push_back({impact.pair, meeting.at + carried, meeting.along, speed, came});
  }
  list_ = std::move(left);
}

void Impacts::forget(const btCollisionObject& gone) {
  const auto isOf = [&](const auto& one) { return one.pair.body == &gone || one.pair.object == &gone; };
  list_.erase(std::remove_if(list_.begin(), list_.end(), isOf), list_.end());
  due_.erase(std::remove_if(due_.begin(), due_.end(), isOf), due_.end());
}

void Impacts::shift(const btVector3& by) {
  for (DueImpulse& due : due_) due.at += by;
}

void Impacts::serialize(WorldStream& stream) {
  const auto serializePair = [&](ImpactPair& pair) {
    stream.object(pair.body);
    stream.object(pair.object);
    stream(pair.component, pair.otherComponent);
  };
  stream.each(due_, [&](DueImpulse& due) {
    serializePair(due.pair);
    stream(due.at, due.along, due.speed, due.energy);
  });
  stream.each(list_, [&](Impact& impact) {
    serializePair(impact.pair);
    for (SideMotion& motion : impact.before) stream(motion.linear, motion.field[0], motion.field[1], motion.field[2]);
    stream(impact.fallen, impact.push, impact.arm, impact.weight, impact.lost, impact.quiet);
  });
}

}  // namespace tetskin::bullet_detail
