// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/bullet/src/base/world_stream.h>
#include <tetskin/solver/src/forces/node_vectors.h>
#include <tetskin/solver/src/rows/impacts.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tetskin::bullet_detail {
namespace {

/// Steps without a push that is felt after which an impact is over, if the pair still approaches.
constexpr int kQuietSteps = 8;

/// The most that is given back of what stops have taken: it would be all, in steps that resolve nothing of an impact.
/// In fine steps, balls, cubes on an edge or a corner, bars and rings have 0.75 to 0.95 of their energy afterwards.
constexpr double kMostGivenBack = 0.9;

btScalar leastImpact(const SolvedBody& body, btScalar seconds) {
  return bullet_detail::leastImpact(body.gravity, sizeOf(*body.body), seconds);
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

/// False if a soft body takes no part in the step, or has been cut since.
bool isComplete(const ImpactPair& pair, const Sides& sides) {
  const auto has = [](const SolvedBody* body, std::uint64_t component) {
    return body && body->elastic && component < body->dynamics->componentCount();
  };
  return has(sides[0].soft(), pair.component) &&
         (has(sides[1].soft(), pair.otherComponent) || !btSoftBody::upcast(pair.object));
}

/// Of both, in joules; two parts of one body count once.
template <class Energy>
double sumOfBodies(const ImpactPair& pair, const Sides& sides, Energy&& energy) {
  return energy(sides[0]) + (pair.object == pair.body ? 0.0 : energy(sides[1]));
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

/// Of the first one's point beside the second one's.
btVector3 relativeVelocity(const Sides& sides, const std::array<SideMotion, 2>& motions, const btVector3& at) {
  return sides[0].velocity(motions[0], at) - sides[1].velocity(motions[1], at);
}

/// How a pair meets and parts, as two rigid bodies.
struct Meeting {
  btVector3 at, along;         ///< the mean place and direction of the pushes on the first one, world space
  btVector3 came;              ///< relative velocity before
  double in = 0.0, out = 0.0;  ///< speeds of approach and of parting; below 0: the other way
  double compliance = 0.0;     ///< of both
  double energyAt(double speed) const { return 0.5 * speed * speed / compliance; }
};

Meeting meetingOf(const Impact& impact, const Sides& sides) {
  assert(impact.weight > 0);
  Meeting meeting;
  meeting.along = impact.push.normalized();
  meeting.at = sides[0].centre() + impact.arm / impact.weight;
  // The step in which it began has added the whole of its gravity, which acted until they met alone.
  const btVector3 fallen = std::max(-impact.fallen.dot(meeting.along), btScalar(0)) * meeting.along;
  meeting.came = relativeVelocity(sides, impact.before, meeting.at) + fallen;
  const std::array<SideMotion, 2> now = {sides[0].motion(meeting.at, true), sides[1].motion(meeting.at, true)};
  meeting.in = static_cast<double>(-meeting.along.dot(meeting.came));
  meeting.out = static_cast<double>(meeting.along.dot(relativeVelocity(sides, now, meeting.at)));
  for (const ImpactSide& side : sides)
    meeting.compliance += static_cast<double>(side.compliance(meeting.at, meeting.along));
  return meeting;
}

/// The energy with which the pair is to part, if its vibrations leave it as much.
double partingEnergy(const Impact& impact, const Sides& sides, const Meeting& meeting) {
  const double came = meeting.energyAt(meeting.in), parts = meeting.energyAt(std::max(meeting.out, 0.0));
  const double lost = std::max(std::min(impact.lost, came), 0.0);
  const double kept = std::min(sides[0].kept(came), sides[1].kept(came));
  const double share = std::min((std::sqrt(std::sqrt(kept)) * parts + kept * lost) / came, kMostGivenBack);
  const double elastic = parts + share * lost;
  const auto ofBoth = impact.pair.body->getRestitution() * impact.pair.object->getRestitution();
  const double e = std::max(static_cast<double>(ofBoth), 0.0);
  return std::min(std::max(elastic, e * e * came), came);
}

/// By how much faster the pair is to part.
double missingSpeed(const Impact& impact, const Sides& sides, const Meeting& meeting) {
  if (!(meeting.in > 0.0) || !(meeting.compliance > 0.0)) return 0.0;
  const double wanted = std::sqrt(2.0 * meeting.compliance * partingEnergy(impact, sides, meeting));
  return std::max(wanted - std::max(meeting.out, 0.0), 0.0);
}

/// At the beginning of a step.
btVector3 velocityNow(const DueImpulse& due, const Sides& sides) {
  return relativeVelocity(sides, {sides[0].motion(due.at, false), sides[1].motion(due.at, false)}, due.at);
}

/// The pair's change of velocity at a point per unit impulse there, of all directions.
btMatrix3x3 complianceOf(const Sides& sides, const btVector3& at) {
  const auto along = [&](const btVector3& direction) {
    return sides[0].compliance(at, direction) + sides[1].compliance(at, direction);
  };
  btMatrix3x3 all;
  for (int i = 0; i < 3; ++i) {
    for (int j = i; j < 3; ++j) {
      btVector3 first(0, 0, 0), second(0, 0, 0);
      first[i] = second[j] = 1;
      all[i][j] = all[j][i] = (along(first + second) - along(first - second)) / 4;
    }
  }
  return all;
}

/// The largest impulse by which the pair has no more energy than when it came. Impacts of a body with several objects
/// are given back one after the other, along directions that may differ. Where pins leave the pair less than three
/// directions, only the motion along the impulse counts.
double largestImpulse(const DueImpulse& due, const Sides& sides, const btVector3& now) {
  constexpr btScalar kSingular = btScalar(1e-4);
  const btMatrix3x3 compliance = complianceOf(sides, due.at);
  const auto along = static_cast<double>(due.along.dot(compliance * due.along)),
             speed = static_cast<double>(due.along.dot(now)), came = static_cast<double>(due.along.dot(due.came));
  if (!(along > 0.0)) return 0.0;
  const btScalar mean = (compliance[0][0] + compliance[1][1] + compliance[2][2]) / 3;
  double left = 0.5 * (came * came - speed * speed) / along;
  if (compliance.determinant() > kSingular * mean * mean * mean) {
    const btMatrix3x3 inverse = compliance.inverse();
    left = 0.5 * static_cast<double>(due.came.dot(inverse * due.came) - now.dot(inverse * now));
  }
  left -= sumOfBodies(due.pair, sides, [](const ImpactSide& side) { return side.vibration(); }) - due.vibrations;
  return left > 0.0 ? (std::sqrt(speed * speed + 2.0 * along * left) - speed) / along : 0.0;
}

/// True if the pair's contacts have pushed by more than at rest. What is pinched between two objects is pushed by both,
/// for as long as it lies there, but not on the whole.
bool isFelt(const ImpactPair& pair, const btVector3& push, const PushSums& sums, const Sides& sides, btScalar least) {
  const btScalar mass = sides[1].moves() ? std::min(sides[0].mass(), sides[1].mass()) : sides[0].mass();
  const auto isPushed = [&](const ImpactSide& side, const btCollisionObject* body, std::uint64_t component) {
    return side.soft() && sums.of(body, component).length() > side.mass() * least;
  };
  return push.length() > mass * least &&
         (isPushed(sides[0], pair.body, pair.component) || isPushed(sides[1], pair.object, pair.otherComponent));
}

}  // namespace

btScalar leastImpact(const btVector3& gravity, btScalar size, btScalar seconds) {
  constexpr btScalar kGravities = 2;              // steps of falling: a body at rest takes one
  constexpr btScalar kLeastWay = btScalar(1e-3);  // without gravity: of the body's size, within a step
  const btScalar falls = gravity.length() * seconds;
  return falls > 0 ? kGravities * falls : kLeastWay * size / seconds;
}

Impact* Impacts::find(const ImpactPair& pair) {
  const auto found = std::find_if(list_.begin(), list_.end(), [&](const Impact& one) { return one.pair == pair; });
  return found == list_.end() ? nullptr : &*found;
}

bool Impacts::includes(const btSoftBody& body) const {
  const auto isOf = [&](const Impact& one) { return one.pair.body == &body || one.pair.object == &body; };
  return std::any_of(list_.begin(), list_.end(), isOf);
}

void Impacts::giveBack(SolverBodies& bodies, RigidUnknowns& rigids) {
  given_.clear();
  if (due_.empty()) return;
  rigids.clear();  // those of the last step
  std::vector<btScalar> wanted;
  for (const DueImpulse& due : due_) {
    const Sides sides = sidesOf(due.pair, bodies, rigids);
    const bool complete = isComplete(due.pair, sides);
    for (const ImpactSide& side : sides) {
      if (complete && side.soft()) side.soft()->dynamics->findMotion();
    }
    wanted.push_back(complete ? due.along.dot(velocityNow(due, sides)) + due.speed : 0);
  }
  for (std::size_t k = 0; k < due_.size(); ++k) {
    const DueImpulse& due = due_[k];
    const Sides sides = sidesOf(due.pair, bodies, rigids);
    if (!isComplete(due.pair, sides)) continue;
    const btVector3 now = velocityNow(due, sides);
    const btScalar compliance = sides[0].compliance(due.at, due.along) + sides[1].compliance(due.at, due.along);
    const auto impulse = static_cast<btScalar>(
        std::min(static_cast<double>((wanted[k] - due.along.dot(now)) / compliance), largestImpulse(due, sides, now)));
    if (!(impulse > 0)) continue;
    given_.push_back({due.pair, due.at, impulse * due.along});
    sides[0].push(due.at, impulse * due.along);
    sides[1].push(due.at, -impulse * due.along);
  }
  due_.clear();
}

void Impacts::begin(const ContactRows& rows, SolverBodies& bodies, RigidUnknowns& rigids, btScalar seconds) {
  assert(seconds > 0);
  for (const ContactRow& row : rows.rows()) {
    const RowOrigin& origin = rows.originOf(row);
    const bool isNew = !(row.normalBound > 0);  // it has not pushed in the step before
    if (!isNew || !isElasticContact(row, origin, bodies)) continue;
    const SolvedBody& body = bodies.bodies()[row.ends[0].body];
    const btScalar stopped = -row.normal.dot(row.relative) - std::max(row.gapVelocity, btScalar(0));
    if (!(stopped > leastImpact(body, seconds))) continue;
    const ImpactPair pair = pairOf(row, origin, bodies);
    if (isOne(pair) || find(pair)) continue;
    Impact impact;
    impact.pair = pair;
    const Sides sides = sidesOf(pair, bodies, rigids);
    for (std::size_t k = 0; k < 2; ++k) impact.before[k] = sides[k].motion(origin.position, false);
    if (!sides[1].moves()) impact.fallen = seconds * body.gravity;
    impact.vibrations = sumOfBodies(pair, sides, [](const ImpactSide& side) { return side.vibrationBefore(); });
    list_.push_back(impact);
  }
}

void Impacts::finish(const ContactRows& rows, SolverBodies& bodies, RigidUnknowns& rigids, btScalar seconds) {
  if (list_.empty()) return;
  const PushSums sums = addPushes(rows, bodies, rigids);
  std::vector<Impact> left;
  for (std::size_t k = 0; k < list_.size(); ++k) {
    Impact& impact = list_[k];
    const Sides sides = sidesOf(impact.pair, bodies, rigids);
    if (!isComplete(impact.pair, sides)) continue;
    const btScalar least = leastImpact(*sides[0].soft(), seconds);
    impact.quiet = isFelt(impact.pair, sums.ofPairs[k], sums, sides, least) ? 0 : impact.quiet + 1;
    if (impact.quiet == 0) {
      left.push_back(impact);
      continue;
    }
    const bool met = impact.weight > 0 && !impact.push.fuzzyZero();
    const Meeting meeting = met ? meetingOf(impact, sides) : Meeting();
    const bool stopped = meeting.out > -static_cast<double>(least);  // light touches may come before the impact itself
    if (!stopped && impact.quiet < kQuietSteps) left.push_back(impact);
    if (!met || !stopped || !(meeting.in > static_cast<double>(least))) continue;
    const auto speed = static_cast<btScalar>(missingSpeed(impact, sides, meeting));
    const btVector3 carried = seconds * sides[0].motion(meeting.at, true).linear;
    if (!(speed > 0)) continue;
    due_.push_back({impact.pair, meeting.at + carried, meeting.along, speed, meeting.came, impact.vibrations});
  }
  list_ = std::move(left);
}

PushSums Impacts::addPushes(const ContactRows& rows, SolverBodies& bodies, RigidUnknowns& rigids) {
  PushSums sums;
  sums.ofPairs.resize(list_.size(), btVector3(0, 0, 0));
  for (const ContactRow& row : rows.rows()) {
    const RowOrigin& origin = rows.originOf(row);
    const btScalar impulse = row.normal.dot(row.impulse);
    if (!(impulse > 0) || !isElasticContact(row, origin, bodies)) continue;
    SolvedBody& first = bodies.bodies()[row.ends[0].body];
    const ImpactPair pair = pairOf(row, origin, bodies);
    sums.on(pair.body, pair.component) += impulse * row.normal;
    if (row.ends[1].isSoft()) sums.on(pair.object, pair.otherComponent) -= impulse * row.normal;
    Impact* impact = find(pair);
    if (!impact) continue;
    const ImpactSide side(&first, pair.component, *first.body, rigids);
    impact->push += impulse * row.normal;
    impact->arm += impulse * (origin.position - side.centre());
    impact->weight += impulse;
    impact->lost += lossOf(row, origin, bodies);
    sums.ofPairs[static_cast<std::size_t>(impact - list_.data())] += impulse * row.normal;
  }
  return sums;
}

void Impacts::forget(const btCollisionObject& gone) {
  const auto isOf = [&](const auto& one) { return one.pair.body == &gone || one.pair.object == &gone; };
  list_.erase(std::remove_if(list_.begin(), list_.end(), isOf), list_.end());
  due_.erase(std::remove_if(due_.begin(), due_.end(), isOf), due_.end());
  given_.erase(std::remove_if(given_.begin(), given_.end(), isOf), given_.end());
}

void Impacts::shift(const btVector3& by) {
  for (DueImpulse& due : due_) due.at += by;
}

void Impacts::serialize(WorldStream& stream) {
  const auto serializePair = [&](ImpactPair& pair) {
    stream.object(pair.body);
    stream.object(pair.object);
    stream(pair.component, pair.otherComponent);
    if (!btSoftBody::upcast(pair.body) || !pair.object) stream.fail();
  };
  stream.each(due_, [&](DueImpulse& due) {
    serializePair(due.pair);
    stream(due.at, due.along, due.speed, due.came, due.vibrations);
  });
  stream.each(list_, [&](Impact& impact) {
    serializePair(impact.pair);
    for (SideMotion& motion : impact.before) stream(motion.linear, motion.field[0], motion.field[1], motion.field[2]);
    stream(impact.fallen, impact.push, impact.arm, impact.weight, impact.lost, impact.vibrations, impact.quiet);
  });
}

}  // namespace tetskin::bullet_detail
