// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "stress/events.h"

#include <algorithm>
#include <limits>
#include <random>

namespace tetskin::stress {
namespace {

constexpr int kEventFrame = 5;  ///< at which most events happen, or in the last frame of shorter cases
constexpr double kTurnsPerSecond = 100.0;
constexpr double kImpactLengths = 100.0;  ///< a second
constexpr double kPluck = 1.01, kStretch = 10.0, kTeleportLengths = 1000.0, kPullLengths = 3.0;
constexpr double kMassRatio = 1000.0;
constexpr double kTooFar = 1e30;
constexpr double kGap = 0.05;  ///< of the size: from the body to the floor, and to the box
constexpr double kTwoPi = 6.283185307179586;

int endNode(const TetMesh& cage, double direction) {
  const auto further = [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return direction * a.x() < direction * b.x();
  };
  return static_cast<int>(std::max_element(cage.nodes.begin(), cage.nodes.end(), further) - cage.nodes.begin());
}

btScalar scalar(double value) {
  return static_cast<btScalar>(value);
}

}  // namespace

bool hasFloor(Event event) {
  return event == Event::Land || event == Event::Impact || event == Event::HeavyBox;
}

double extentOf(Event event) {
  return event == Event::Stretch ? kStretch : event == Event::Pull ? 1.0 + kPullLengths : 1.0;
}

std::function<bool(const Eigen::Vector3d&)> heldNodes(Event event, const TetMesh& cage) {
  if (event != Event::Pull) return {};
  const Eigen::Vector3d held = cage.nodes[endNode(cage, -1)], pulled = cage.nodes[endNode(cage, 1)];
  return [held, pulled](const Eigen::Vector3d& p) { return p == held || p == pulled; };
}

EventScript::EventScript(const StressCase& stressCase, const StressModel& model, StressWorld& world)
    : case_(stressCase), model_(model), world_(world) {
  btSoftBody& body = world.body();
  const Box3 box = boundingBox(nodePositions(body));
  centre_ = toBullet(box.center());
  if (hasFloor(case_.event)) {
    const double half = 5.0 * model.size, thickness = 0.5 * model.size;
    Eigen::Vector3d floor = box.center();
    floor.y() = box.min().y() - kGap * model.size - thickness;
    world.addBox(toBullet({half, thickness, half}), toBullet(floor), 0);
  }
  if (case_.event == Event::HeavyBox) {
    const double half = 0.5 * model.size;
    Eigen::Vector3d above = box.center();
    above.y() = box.max().y() + kGap * model.size + half;
    world.addBox(btVector3(1, 1, 1) * scalar(half), toBullet(above), scalar(kMassRatio));
  }
  if (case_.event == Event::Pull) pulled_ = endNode(model.cage, 1);
  for (int n = 0; n < body.m_nodes.size(); ++n) start_.push_back(body.m_nodes[n].m_x);
}

bool EventScript::before(int frame) {
  if (case_.event == Event::Pull) pull();
  const int eventFrame = std::min(kEventFrame, case_.frames - 1);
  if (frame == 2 * eventFrame && case_.event == Event::Teleport) {
    world_.body().translate(btVector3(0, scalar(-kTeleportLengths * model_.size), 0));
    return true;
  }
  if (frame != eventFrame) return false;
  const btVector3 c = centre_;
  switch (case_.event) {
    case Event::SquashFlat:
      placeNodes([c](const btVector3& p) { return btVector3(p.x(), c.y(), p.z()); });
      return true;
    case Event::Pluck:
    case Event::Stretch: {
      const btScalar longer = scalar(case_.event == Event::Pluck ? kPluck : kStretch);
      placeNodes([=](const btVector3& p) { return btVector3(c.x() + longer * (p.x() - c.x()), p.y(), p.z()); });
      return true;
    }
    case Event::Mirror:
      placeNodes([c](const btVector3& p) { return btVector3(2 * c.x() - p.x(), p.y(), p.z()); });
      return true;
    case Event::Permute:
      permute();
      return true;
    case Event::Spin:
      startSpinning();
      return false;
    case Event::Teleport:
      world_.body().translate(btVector3(0, scalar(kTeleportLengths * model_.size), 0));
      return true;
    case Event::Impact:
      world_.body().setVelocity(btVector3(0, scalar(-kImpactLengths * model_.size), 0));
      return false;
    case Event::NodeNaN:
    case Event::NodeInfinite:
    case Event::NodeTooFar:
      return spoil();
    case Event::Land:
    case Event::Pull:
    case Event::HeavyBox:
      return false;
  }
  return false;
}

void EventScript::placeNode(int node, const btVector3& where) {
  btSoftBody::Node& n = world_.body().m_nodes[node];
  n.m_x = n.m_q = where;
  n.m_v.setZero();
}

void EventScript::placeNodes(const std::function<btVector3(const btVector3&)>& place) {
  for (int n = 0; n < world_.body().m_nodes.size(); ++n) placeNode(n, place(world_.body().m_nodes[n].m_x));
}

void EventScript::permute() {
  std::mt19937 generator(17);
  std::vector<btVector3> places;
  for (int n = 0; n < world_.body().m_nodes.size(); ++n) places.push_back(world_.body().m_nodes[n].m_x);
  for (std::size_t k = places.size(); k > 1; --k) std::swap(places[k - 1], places[generator() % k]);
  for (std::size_t n = 0; n < places.size(); ++n) placeNode(static_cast<int>(n), places[n]);
}

void EventScript::startSpinning() {
  const btVector3 rate(0, 0, scalar(kTurnsPerSecond * kTwoPi));
  btSoftBody& body = world_.body();
  for (int n = 0; n < body.m_nodes.size(); ++n) {
    body.m_nodes[n].m_v = rate.cross(body.m_nodes[n].m_x - centre_);
  }
}

/// Bullet moves a node without mass by its velocity.
void EventScript::pull() {
  const double seconds = case_.frames * case_.timeStep;
  world_.body().m_nodes[pulled_].m_v = btVector3(scalar(kPullLengths * model_.size / seconds), 0, 0);
}

bool EventScript::spoil() {
  constexpr btScalar kInfinity = std::numeric_limits<btScalar>::infinity();
  constexpr btScalar kNaN = std::numeric_limits<btScalar>::quiet_NaN();
  spoiled_ = world_.body().m_nodes.size() / 3;
  btVector3& position = world_.body().m_nodes[spoiled_].m_x;
  unspoiled_ = position;
  position.setZ(case_.event == Event::NodeNaN        ? kNaN
                : case_.event == Event::NodeInfinite ? -kInfinity
                                                     : scalar(kTooFar));
  return true;
}

bool EventScript::takeBack() {
  if (spoiled_ < 0) return false;
  placeNode(spoiled_, unspoiled_);
  spoiled_ = -1;
  return true;
}

void EventScript::restore() {
  for (std::size_t n = 0; n < start_.size(); ++n) placeNode(static_cast<int>(n), start_[n]);
}

}  // namespace tetskin::stress
