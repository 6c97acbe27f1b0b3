// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/disjoint_sets.h>
#include <tetskin/core/src/base/instantiate.h>
#include <tetskin/elastic/src/dynamics/body_components.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tetskin::elastic_detail {
namespace {

/// The way of a pressure wave through what hits something, in radii of gyration: a ball has 2.6, a bar 3.5.
constexpr double kImpactLength = 3.0;

using kernels::kGroup;

/// The component of each slot.
template <class S>
std::vector<std::uint32_t> componentsOf(const RestTets& rest, const BlockMatrix<S>& matrix) {
  DisjointSets sets(matrix.nodeCount());
  const auto connect = [&](const auto& nodes) {
    for (const int n : nodes) sets.unite(nodes[0], n);
  };
  for (const Tet& tet : rest.tets) connect(tet);
  for (const RestQuadraticTet& tet : rest.quadratic) connect(tet.nodes);
  std::vector<std::uint32_t> partOf(std::max<std::size_t>(matrix.slotCount(), 1), 0);
  const std::vector<int> numbers = sets.numbers();
  for (std::size_t n = 0; n < numbers.size(); ++n) partOf[matrix.slotOf(n)] = static_cast<std::uint32_t>(numbers[n]);
  return partOf;
}

template <class S>
Eigen::Vector3d placeOf(const NodeStates<S>& nodes, const HeldPoint<S>& point) {
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < point.nodeCount; ++k) {
    const double* x = nodes.places.at(nodes.matrix.slotOf(static_cast<std::size_t>(point.nodes[k])));
    place += static_cast<double>(point.weights[k]) * Eigen::Vector3d(x[0], x[1], x[2]);
  }
  return place;
}

/// The rigid motion of a component, as `BodyComponents::move` reads it for each node.
template <class S>
struct RoundedMotion {
  RoundedMotion(const ComponentMotion& motion, double seconds) {
    const RigidVelocity exact = motion.velocities(seconds);
    for (int k = 0; k < 3; ++k) {
      about[k] = exact.about[k];
      velocity[k] = static_cast<S>(exact.velocity[k]);
    }
    for (int k = 0; k < 9; ++k) field[k] = static_cast<S>(exact.field[k]);
  }
  void turn(const S* from, S* to) const {
    for (std::size_t k = 0; k < 3; ++k) {
      const S* row = field + 3 * k;
      to[k] = row[0] * from[0] + row[1] * from[1] + row[2] * from[2];
    }
  }

  double about[3];
  S velocity[3], field[9];
};

}  // namespace

template <class S>
BodyComponents<S>::BodyComponents(const RestTets& rest, const BlockMatrix<S>& matrix)
    : partOf_(componentsOf(rest, matrix)),
      motions_(1 + *std::max_element(partOf_.begin(), partOf_.end())),
      stiffness_(motions_.size(), 0.0) {}

template <class S>
void BodyComponents<S>::setStiffness(const RestTets& rest, const Lame& lame, const BlockMatrix<S>& matrix) {
  std::fill(stiffness_.begin(), stiffness_.end(), 0.0);
  const auto add = [&](int node, double volume) {
    stiffness_[partOf_[matrix.slotOf(static_cast<std::size_t>(node))]] += volume * (2.0 * lame.mu + lame.lambda);
  };
  for (std::size_t t = 0; t < rest.count(); ++t) add(rest.tets[t][0], rest.volumes[t]);
  for (const RestQuadraticTet& tet : rest.quadratic) add(tet.nodes[0], tet.volume);
}

template <class S>
bool BodyComponents<S>::areHeld(const BlockMatrix<S>& matrix) const {
  std::vector<bool> held(count(), false);
  for (std::size_t n = 0; n < matrix.nodeCount(); ++n) {
    const std::size_t slot = matrix.slotOf(n);
    if (matrix.massAt(slot) == S(0)) held[partOf_[slot]] = true;
  }
  return std::find(held.begin(), held.end(), false) == held.end();
}

/// Moments about the components' previous positions: this needs one pass only, and keeps the digits far from the
/// origin.
template <class S>
std::vector<ComponentMoments> BodyComponents<S>::momentsOf(const NodeStates<S>& nodes) const {
  const std::size_t slots = nodes.matrix.slotCount();
  std::vector<ComponentMoments> moments(count());
  const auto add = [&](std::size_t slot, ComponentMoments& sums, const Eigen::Vector3d& about) {
    sums.add(nodes.matrix.massAt(slot), nodes.places.at(slot), &nodes.velocities[4 * slot], about.data());
  };
  if (count() == 1) {  // nearly always: its sums stay in registers
    ComponentMoments sums;
    const Eigen::Vector3d about = motions_.front().about();
    for (std::size_t slot = 0; slot < slots; ++slot) add(slot, sums, about);
    moments.front() = sums;
  } else {
    for (std::size_t slot = 0; slot < slots; ++slot) add(slot, moments[partOf_[slot]], motions_[partOf_[slot]].about());
  }
  return moments;
}

template <class S>
void BodyComponents<S>::find(const NodeStates<S>& nodes, bool pinned, double seconds) {
  assert(!motions_.empty() && nodes.velocities.size() == 4 * nodes.matrix.slotCount());
  std::vector<PinnedNodes> pins(count());
  for (std::size_t n = 0; pinned && n < nodes.matrix.nodeCount(); ++n) {
    const std::size_t slot = nodes.matrix.slotOf(n);
    if (nodes.matrix.massAt(slot) != S(0)) continue;
    const double* x = nodes.places.at(slot);
    const S* v = &nodes.velocities[4 * slot];
    pins[partOf_[slot]].add(Eigen::Vector3d(x[0], x[1], x[2]), Eigen::Vector3d(v[0], v[1], v[2]));
  }
  const std::vector<ComponentMoments> moments = momentsOf(nodes);
  for (std::size_t k = 0; k < count(); ++k) {
    pins[k].finish(seconds);
    const Eigen::Vector3d near = motions_[k].about();
    motions_[k].find(moments[k], near, pins[k], seconds);
  }
}

/// Forces do not depend on the position of a component: without its translation, points have the same rounding in each
/// step, and differences in rounding are not taken for strain. A displacement is turned with its frame.
template <class S>
void BodyComponents<S>::move(const BlockMatrix<S>& matrix, double seconds, NodePlaces<S>& places,
                             AlignedVector<S>& velocities, AlignedVector<S>& moved, AlignedVector<S>& relative) const {
  assert(seconds > 0.0 && partOf_.size() >= matrix.slotCount());
  std::vector<RoundedMotion<S>> components;
  std::vector<Eigen::Vector3d> anchors;
  std::vector<Eigen::Matrix3d> turns;
  for (const ComponentMotion& motion : motions_) {
    anchors.push_back(motion.anchor());
    turns.push_back(motion.turn());
    components.emplace_back(motion, seconds);
  }
  places.displace(anchors, moved);
  const bool framed = places.hasFrames();
  const auto dt = static_cast<S>(seconds);
  for (std::size_t slot = 0; slot < matrix.slotCount(); ++slot) {
    const RoundedMotion<S>& component = components[partOf_[slot]];
    const double* x = places.at(slot);
    S *v = &velocities[4 * slot], *to = &moved[4 * slot], *beside = &relative[4 * slot];
    S arm[3], turning[3], turned[3];
    for (std::size_t k = 0; k < 3; ++k) arm[k] = static_cast<S>(x[k] - component.about[k]);
    component.turn(arm, turning);
    component.turn(framed ? to : arm, turned);
    for (std::size_t k = 0; k < 3; ++k) {
      to[k] += dt * turned[k];
      const S rigid = component.velocity[k] + turning[k];
      beside[k] = v[k] - rigid;
      v[k] = rigid;
    }
  }
  places.turnFrames(turns);
}

template <class S>
double BodyComponents<S>::stiffnessOverInertia() const {
  double largest = 0.0;
  for (std::size_t k = 0; k < count(); ++k) {
    const double inertia = motions_[k].minInertia();
    if (inertia > 0.0) largest = std::max(largest, stiffness_[k] / inertia);
  }
  return largest;
}

template <class S>
double BodyComponents<S>::largestRadius() const {
  double radius = 0.0;
  for (const ComponentMotion& motion : motions_) radius = std::max(radius, motion.radius());
  return radius;
}

template <class S>
double BodyComponents<S>::impactFrequency(std::size_t component) const {
  constexpr double kPi = 3.14159265358979324;  // half a period is a phase of it
  const ComponentMotion& motion = motions_[component];
  const double length = kImpactLength * motion.radius();
  if (!(length > 0.0)) return 0.0;
  return kPi * std::sqrt(stiffness_[component] / motion.mass()) / (2.0 * length);
}

template <class S>
double BodyComponents<S>::impactSeconds(double mass, double radius) const {
  double stiffness = 0.0;
  for (const double one : stiffness_) stiffness += one;
  return stiffness > 0.0 ? 2.0 * kImpactLength * radius * std::sqrt(mass / stiffness) : 0.0;
}

template <class S>
std::vector<std::array<double, 9>> BodyComponents<S>::turns() const {
  std::vector<std::array<double, 9>> turns(count());
  for (std::size_t part = 0; part < turns.size(); ++part) {
    const Eigen::Matrix3d& turn = motions_[part].turn();
    for (std::size_t k = 0; k < 9; ++k) turns[part][k] = turn(static_cast<int>(k) / 3, static_cast<int>(k) % 3);
  }
  return turns;
}

template <class S>
double BodyComponents<S>::compliance(std::size_t component, const std::array<double, 3>& point,
                                     const std::array<double, 3>& direction) const {
  return motions_[component].compliance(Eigen::Vector3d(point[0], point[1], point[2]),
                                        Eigen::Vector3d(direction[0], direction[1], direction[2]));
}

template <class S>
bool BodyComponents<S>::rigidMotions(const NodeStates<S>& nodes, std::size_t component, const AlignedVector<S>& moved,
                                     AlignedVector<S> (&motions)[6]) const {
  assert(component < count());
  const BlockMatrix<S>& matrix = nodes.matrix;
  double mass = 0.0, centroid[3] = {};
  S x[3];
  for (std::size_t n = 0; n < matrix.nodeCount(); ++n) {
    const std::size_t slot = matrix.slotOf(n);
    if (partOf_[slot] != component) continue;
    if (matrix.massAt(slot) == S(0)) return false;
    const auto m = static_cast<double>(matrix.massAt(slot));
    mass += m;
    nodes.places.fromDisplacement(slot, &moved[4 * slot], x);
    for (std::size_t k = 0; k < 3; ++k) centroid[k] += m * static_cast<double>(x[k]);
  }
  if (!(mass > 0.0)) return false;
  for (AlignedVector<S>& motion : motions) motion.resize(4 * matrix.slotCount(), S(0));
  for (std::size_t n = 0; n < matrix.nodeCount(); ++n) {
    const std::size_t slot = matrix.slotOf(n);
    if (partOf_[slot] != component) continue;
    S arm[3];
    nodes.places.fromDisplacement(slot, &moved[4 * slot], x);
    for (std::size_t k = 0; k < 3; ++k) {
      arm[k] = x[k] - static_cast<S>(centroid[k] / mass);
      motions[k][4 * slot + k] = S(1);
    }
    for (std::size_t k = 0; k < 3; ++k) {  // about axis k
      motions[3 + k][4 * slot + (k + 1) % 3] = -arm[(k + 2) % 3];
      motions[3 + k][4 * slot + (k + 2) % 3] = arm[(k + 1) % 3];
    }
  }
  return true;
}

// ---- solutions

/// Moments of the solution's velocities, with those of the rigid motion or without.
template <class S>
std::vector<ComponentMomentum> BodyComponents<S>::momenta(const NodeStates<S>& nodes, const S* solution,
                                                          bool withRigid) const {
  std::vector<ComponentMomentum> now(count());
  bySlots(nodes.matrix.slotCount(), [&](std::size_t slot, std::size_t wide) {
    double velocity[3];
    for (std::size_t k = 0; k < 3; ++k) {
      velocity[k] = solution[wide + k * kGroup];
      if (withRigid) velocity[k] += static_cast<double>(nodes.velocities[4 * slot + k]);
    }
    const std::uint32_t component = partOf_[slot];
    now[component].add(nodes.matrix.massAt(slot), nodes.places.at(slot), velocity, motions_[component].about().data());
  });
  return now;
}

/// Makes change(solution, velocity) of the solution where a node is not pinned, with the velocity of its component.
template <class S>
template <class Change>
void BodyComponents<S>::changeSolution(const NodeStates<S>& nodes, const std::vector<RigidVelocity>& velocities,
                                       S* solution, Change&& change) const {
  assert(velocities.size() == count());
  bySlots(nodes.matrix.slotCount(), [&](std::size_t slot, std::size_t wide) {
    if (nodes.matrix.massAt(slot) == S(0)) return;
    double v[3];
    velocities[partOf_[slot]].at(nodes.places.at(slot), v);
    for (std::size_t k = 0; k < 3; ++k) {
      S& own = solution[wide + k * kGroup];
      own = change(own, static_cast<S>(v[k]));
    }
  });
}

template <class S>
void BodyComponents<S>::bendTurns(const NodeStates<S>& nodes, double seconds, S* solution) const {
  const std::vector<ComponentMomentum> now = momenta(nodes, solution, true);
  std::vector<ComponentMoments> moments(count());
  bySlots(nodes.matrix.slotCount(), [&](std::size_t slot, std::size_t wide) {
    S v[3];
    for (std::size_t k = 0; k < 3; ++k) v[k] = nodes.velocities[4 * slot + k] + solution[wide + k * kGroup];
    const std::uint32_t component = partOf_[slot];
    moments[component].add(nodes.matrix.massAt(slot), nodes.places.at(slot), v, motions_[component].about().data());
  });
  std::vector<RigidVelocity> chords;
  for (std::size_t k = 0; k < count(); ++k) {
    chords.push_back(motions_[k].chord(now[k], moments[k], motions_[k].about(), seconds));
  }
  changeSolution(nodes, chords, solution, [](S own, S chord) { return own + chord; });
}

template <class S>
void BodyComponents<S>::projectToRigidMotion(const NodeStates<S>& nodes, S* solution) const {
  const std::vector<ComponentMomentum> own = momenta(nodes, solution, false);
  std::vector<RigidVelocity> rigid;
  for (std::size_t k = 0; k < count(); ++k) rigid.push_back(motions_[k].withMomentum(own[k]));
  changeSolution(nodes, rigid, solution, [](S, S motion) { return motion; });
}

template <class S>
RigidVelocity BodyComponents<S>::solvedVelocity(const NodeStates<S>& nodes, std::size_t component,
                                                const S* solution) const {
  assert(component < count());
  return motions_[component].withMomentum(momenta(nodes, solution, true)[component]);
}

template <class S>
double BodyComponents<S>::energyBesideRigid(const NodeStates<S>& nodes) const {
  std::vector<RigidVelocity> own;
  for (const ComponentMotion& motion : motions_) own.push_back(motion.own());
  double sum = 0.0;
  for (std::size_t slot = 0; slot < nodes.matrix.slotCount(); ++slot) {
    double rigid[3];
    own[partOf_[slot]].at(nodes.places.at(slot), rigid);
    for (std::size_t k = 0; k < 3; ++k) {
      const double v = static_cast<double>(nodes.velocities[4 * slot + k]) - rigid[k];
      sum += static_cast<double>(nodes.matrix.massAt(slot)) * v * v;
    }
  }
  return 0.5 * sum;
}

template <class S>
void BodyComponents<S>::push(const NodeStates<S>& nodes, std::size_t component, const Eigen::Vector3d& point,
                             const Eigen::Vector3d& impulse, AlignedVector<S>& velocities) const {
  assert(component < count());
  const Eigen::Vector3d arm = point - motions_[component].about(),
                        spin(arm[1] * impulse[2] - arm[2] * impulse[1], arm[2] * impulse[0] - arm[0] * impulse[2],
                             arm[0] * impulse[1] - arm[1] * impulse[0]);
  ComponentMomentum given;
  for (int k = 0; k < 3; ++k) {
    given.momentum[k] = impulse[k];
    given.spin[k] = spin[k];
  }
  const RigidVelocity change = motions_[component].withMomentum(given);
  for (std::size_t slot = 0; slot < nodes.matrix.slotCount(); ++slot) {
    if (partOf_[slot] != component || nodes.matrix.massAt(slot) == S(0)) continue;
    double v[3];
    change.at(nodes.places.at(slot), v);
    for (std::size_t k = 0; k < 3; ++k) velocities[4 * slot + k] += static_cast<S>(v[k]);
  }
}

template <class S>
std::size_t BodyComponents<S>::componentOf(const NodeStates<S>& nodes, const HeldPoint<S>& point) const {
  assert(point.nodeCount > 0);
  return partOf_[nodes.matrix.slotOf(static_cast<std::size_t>(point.nodes[0]))];
}

template <class S>
std::vector<Resistance> BodyComponents<S>::resistanceOf(const NodeStates<S>& nodes,
                                                        const std::vector<HeldPoint<S>>& held) const {
  std::vector<Resistance> resistance(count(), Resistance::Zero());
  for (const HeldPoint<S>& point : held) {
    const std::size_t component = componentOf(nodes, point);
    const Eigen::Map<const Eigen::Matrix3d> stiffness(point.stiffness.data());
    motions_[component].addResistance(placeOf(nodes, point), stiffness, resistance[component]);
  }
  return resistance;
}

template <class S>
void BodyComponents<S>::removeMomentum(const NodeStates<S>& nodes, const NodeImpulse& impulse,
                                       const std::vector<std::array<double, 3>>& more, std::vector<HeldPoint<S>>* held,
                                       S* solution) const {
  assert(more.empty() || more.size() == count());
  std::vector<HeldPoint<S>> none;
  std::vector<HeldPoint<S>>& points = held ? *held : none;
  const std::vector<Resistance> resistance = resistanceOf(nodes, points);
  const std::vector<ComponentMomentum> now = momenta(nodes, solution, true);
  std::vector<Eigen::Vector3d> impulses(count(), Eigen::Vector3d::Zero()), torques = impulses;
  for (std::size_t k = 0; k < more.size(); ++k) torques[k] = Eigen::Vector3d(more[k][0], more[k][1], more[k][2]);
  for (std::size_t n = 0; impulse && n < nodes.matrix.nodeCount(); ++n) {
    const std::size_t slot = nodes.matrix.slotOf(n), component = partOf_[slot];
    if (nodes.matrix.massAt(slot) == S(0)) continue;
    const double* x = nodes.places.at(slot);
    const std::array<double, 3> from = impulse(n);
    const Eigen::Vector3d given(from[0], from[1], from[2]);
    impulses[component] += given;
    torques[component] += (Eigen::Vector3d(x[0], x[1], x[2]) - motions_[component].about()).cross(given);
  }
  std::vector<RigidVelocity> excess;
  for (std::size_t k = 0; k < count(); ++k) {
    excess.push_back(motions_[k].excess(now[k], impulses[k], torques[k], resistance[k]));
  }
  for (HeldPoint<S>& point : points) {
    double v[3];
    const Eigen::Vector3d place = placeOf(nodes, point);
    excess[componentOf(nodes, point)].at(place.data(), v);
    for (std::size_t k = 0; k < 3; ++k) point.change[k] = -v[k];
  }
  changeSolution(nodes, excess, solution, [](S own, S wrong) { return own - wrong; });
}

// ---- between steps

template <class S>
void BodyComponents<S>::carry(const Eigen::Matrix3d& turn, const Eigen::Vector3d& by) {
  for (ComponentMotion& motion : motions_) motion.carry(turn, by);
}

template <class S>
void BodyComponents<S>::serialize(StateStream& stream) {
  for (ComponentMotion& motion : motions_) motion.serialize(stream);
}

TETSKIN_INSTANTIATE_CLASS(BodyComponents)

}  // namespace tetskin::elastic_detail
