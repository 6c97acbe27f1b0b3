// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <gtest/gtest.h>
#include <tetskin/elastic/src/dynamics/component_motion.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <vector>

#include "elastic_fixtures.h"
#include "support/odd_meshes.h"

namespace tetskin::test {
namespace {

constexpr double kSeconds = 1.0 / 60;

/// Nodes with masses and velocities; nodes of mass 0 are pinned.
struct Component {
  Points nodes, velocities;
  std::vector<double> masses;

  ComponentMotion motion() const {
    PinnedNodes pinned;
    ComponentMoments moments;
    const Vector3d near(0.3, -0.2, 0.1);
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      if (masses[n] == 0.0) pinned.add(nodes[n], velocities[n]);
      moments.add(masses[n], nodes[n].data(), velocities[n].data(), near.data());
    }
    pinned.finish(kSeconds);
    ComponentMotion found;
    found.find(moments, near, pinned, kSeconds);
    return found;
  }
  /// The positions to which the rigid motion takes the nodes.
  Points moved(const ComponentMotion& motion) const {
    const auto rigid = motion.velocities(kSeconds);
    Points to = nodes;
    for (Vector3d& p : to) {
      double v[3];
      rigid.at(p.data(), v);
      p += kSeconds * Vector3d(v[0], v[1], v[2]);
    }
    return to;
  }
  Vector3d momentumOf(const Points& rates) const {
    Vector3d sum = Vector3d::Zero();
    for (std::size_t n = 0; n < nodes.size(); ++n) sum += masses[n] * rates[n];
    return sum;
  }
  Vector3d spinOf(const Points& rates, const Vector3d& about) const {
    Vector3d sum = Vector3d::Zero();
    for (std::size_t n = 0; n < nodes.size(); ++n) sum += masses[n] * (nodes[n] - about).cross(rates[n]);
    return sum;
  }
  Points ratesTo(const Points& to) const {
    Points rates;
    for (std::size_t n = 0; n < nodes.size(); ++n) rates.push_back((to[n] - nodes[n]) / kSeconds);
    return rates;
  }
};

Component spinning(double rate, unsigned seed) {
  Random random(seed);
  Component part;
  part.nodes = jittered(latticeCage(3, 2, 1), 0.3, seed).nodes;
  const Vector3d omega = rate * random.vector().normalized(), drift = random.vector();
  for (const Vector3d& p : part.nodes) {
    part.masses.push_back(1.5 + random());
    part.velocities.push_back(drift + omega.cross(p) + 0.2 * rate * random.vector());
  }
  return part;
}

void expectRigid(const Points& before, const Points& after) {
  for (std::size_t a = 0; a < before.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      EXPECT_NEAR((after[a] - after[b]).norm(), (before[a] - before[b]).norm(), 1e-12);
    }
  }
}

TEST(ComponentMotion, OfAFreePartKeepsItsShapeItsMomentumAndItsAngularMomentum) {
  for (const double rate : {0.0, 0.1, 1.0, 10.0, 30.0}) {
    for (const unsigned seed : {1u, 2u, 3u, 4u}) {
      const Component part = spinning(rate, seed);
      const Points to = part.moved(part.motion()), rates = part.ratesTo(to);
      expectRigid(part.nodes, to);
      EXPECT_LT((part.momentumOf(rates) - part.momentumOf(part.velocities)).norm(), 1e-10 * (1.0 + rate));
      EXPECT_LT((part.spinOf(rates, {0, 0, 0}) - part.spinOf(part.velocities, {0, 0, 0})).norm(), 1e-9 * (1.0 + rate));
    }
  }
}

TEST(ComponentMotion, BeyondARightAngleInAStepLeavesTheRestToTheSolve) {
  for (const double rate : {60.0, 100.0, 1e4}) {
    const Component part = spinning(rate, 1);
    const Points to = part.moved(part.motion());
    expectRigid(part.nodes, to);
    const Vector3d wanted = part.spinOf(part.velocities, {0, 0, 0}), has = part.spinOf(part.ratesTo(to), {0, 0, 0});
    EXPECT_LT(has.norm(), wanted.norm());
    EXPECT_GT(has.norm(), 0.5 * std::min(wanted.norm(), 1.0 / kSeconds));
    // By sums about the centre of mass, where the motion of that centre has no part.
    const Vector3d centre = part.motion().about(), all = part.spinOf(part.velocities, centre);
    const Vector3d share = rigidMass(part.nodes, part.masses, centre).bottomRightCorner<3, 3>().inverse() * all;
    const Vector3d kept = all * (0.8 / (kSeconds * share.norm()));
    EXPECT_LT((part.spinOf(part.ratesTo(to), centre) - kept).norm(), 1e-9 * kept.norm()) << "the sine is 0.8";
  }
}

TEST(ComponentMotion, OfAHeldNodeTurnsAboutItAndKeepsTheAngularMomentumAboutIt) {
  Component part = spinning(10.0, 2);
  part.masses[5] = 0.0;
  for (const Vector3d& led : {Vector3d(0, 0, 0), Vector3d(1, -2, 0.5)}) {
    part.velocities[5] = led;
    const Points to = part.moved(part.motion());
    expectRigid(part.nodes, to);
    EXPECT_LT((to[5] - part.nodes[5] - kSeconds * led).norm(), 1e-14);
    EXPECT_LT((part.spinOf(part.ratesTo(to), part.nodes[5]) - part.spinOf(part.velocities, part.nodes[5])).norm(),
              1e-9);
  }
}

TEST(ComponentMotion, OfAHeldLineTurnsAboutItAndFollowsIt) {
  Component part = spinning(10.0, 3);
  part.nodes[0] = {0, 0, 0};
  part.nodes[1] = {0, 1, 0};
  part.nodes[2] = {0, 3, 0};
  for (int k = 0; k < 3; ++k) part.masses[static_cast<std::size_t>(k)] = 0.0;
  for (const double tilt : {0.0, 0.3}) {  // in radians per second, about x
    for (int k = 0; k < 3; ++k) {
      const Vector3d& p = part.nodes[static_cast<std::size_t>(k)];
      part.velocities[static_cast<std::size_t>(k)] = Vector3d(tilt, 0, 0).cross(p) + Vector3d(tilt, 0, tilt);
    }
    const Points to = part.moved(part.motion()), rates = part.ratesTo(to);
    expectRigid(part.nodes, to);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_LT((to[k] - part.nodes[k] - kSeconds * part.velocities[k]).norm(), 1e-14 + 1e-4 * tilt) << k;
    }
    const double wanted = part.spinOf(part.velocities, {0, 0, 0}).y();
    EXPECT_NEAR(part.spinOf(rates, {0, 0, 0}).y(), wanted, 1e-9 + 0.02 * tilt * std::abs(wanted));
  }
}

TEST(ComponentMotion, OfWhatIsHeldByMoreGoesWhereItIsLed) {
  Component part = spinning(10.0, 4);
  const Matrix3d turn = turnBy(3.0, {1, 2, 3});
  const Vector3d shift(0.01, -0.02, 0.03);
  Points led;
  for (const Vector3d& p : part.nodes) led.push_back(turn * p + shift);
  for (std::size_t k = 0; k < 5; ++k) {
    part.masses[k] = 0.0;
    part.velocities[k] = (led[k] - part.nodes[k]) / kSeconds;
  }
  const Points to = part.moved(part.motion());
  for (std::size_t n = 0; n < to.size(); ++n) EXPECT_LT((to[n] - led[n]).norm(), 1e-13) << n;
  for (std::size_t k = 0; k < 5; ++k) part.velocities[k].setZero();
  const Points stays = part.moved(part.motion());
  for (std::size_t n = 0; n < to.size(); ++n) EXPECT_EQ(stays[n], part.nodes[n]) << n;
}

/// The change in velocity at a point, in a direction, for a unit impulse there, by sums over all nodes.
double freeCompliance(const Component& part, const Vector3d& point, const Vector3d& direction) {
  const Eigen::Matrix<double, 6, 1> push = rigidVelocityAt(point, {0, 0, 0}).transpose() * direction;
  return push.dot(solved(rigidMass(part.nodes, part.masses, {0, 0, 0}), push));
}

Matrix3d inertiaAbout(const Component& part, const Vector3d& about) {
  return rigidMass(part.nodes, part.masses, about).bottomRightCorner<3, 3>();
}

TEST(ComponentMotion, YieldsToAnImpulseAsFarAsItIsFree) {
  Random random(71);
  for (int k = 0; k < 10; ++k) {
    const Vector3d point = 2.0 * random.vector(), direction = random.vector().normalized();
    Component part = spinning(3.0, 2);
    double expected = freeCompliance(part, point, direction);
    EXPECT_NEAR(part.motion().compliance(point, direction), expected, 1e-10 * expected);

    part.masses[5] = 0.0;
    Vector3d moment = (point - part.nodes[5]).cross(direction);
    expected = moment.dot(inertiaAbout(part, part.nodes[5]).inverse() * moment);
    EXPECT_NEAR(part.motion().compliance(point, direction), expected, 1e-10 * expected);
    EXPECT_NEAR(part.motion().compliance(part.nodes[5], direction), 0.0, 1e-10) << "it does not turn about it by that";

    part.masses[7] = 0.0;
    const Vector3d axis = (part.nodes[7] - part.nodes[5]).normalized();
    expected = std::pow(axis.dot(moment), 2) / axis.dot(inertiaAbout(part, part.nodes[5]) * axis);
    EXPECT_NEAR(part.motion().compliance(point, direction), expected, 1e-9 * expected);
    EXPECT_NEAR(part.motion().compliance(point, axis), 0.0, 1e-10);

    part.masses[0] = part.masses[9] = 0.0;
    EXPECT_EQ(part.motion().compliance(point, direction), 0.0) << "all of it goes where it is led";
  }
}

TEST(ComponentMotion, WithAMomentumHasItAsFarAsItIsFree) {
  Random random(72);
  elastic_detail::ComponentMomentum own;
  for (int k = 0; k < 3; ++k) own.momentum[k] = random(), own.spin[k] = random();
  const Vector3d momentum(own.momentum[0], own.momentum[1], own.momentum[2]),
      spin(own.spin[0], own.spin[1], own.spin[2]);
  for (const std::vector<std::size_t>& pinned : std::vector<std::vector<std::size_t>>{{}, {5}, {5, 7}, {0, 5, 7, 9}}) {
    Component part = spinning(3.0, 2);
    for (const std::size_t n : pinned) part.masses[n] = 0.0;
    const ComponentMotion motion = part.motion();
    const auto rigid = motion.withMomentum(own);
    Points rates;
    for (const Vector3d& p : part.nodes) {
      double v[3];
      rigid.at(p.data(), v);
      rates.emplace_back(v[0], v[1], v[2]);
    }
    for (const std::size_t n : pinned) EXPECT_LT(rates[n].norm(), 1e-12) << "it is held";
    const Vector3d lost = part.momentumOf(rates) - momentum, lostSpin = part.spinOf(rates, motion.about()) - spin;
    if (pinned.empty()) {
      EXPECT_LT(lost.norm(), 1e-12);
    }
    if (pinned.size() < 2) {
      EXPECT_LT(lostSpin.norm(), 1e-12);
    }
    if (pinned.size() == 2) {
      EXPECT_NEAR(lostSpin.dot(part.nodes[7] - part.nodes[5]), 0.0, 1e-12);
    }
    if (pinned.size() > 2) {
      EXPECT_EQ(rates, Points(rates.size(), Vector3d::Zero()));
    }
  }
}

TEST(ComponentMotion, OfWhatIsNotFiniteIsNone) {
  Component part = spinning(1.0, 5);
  part.velocities[3].x() = std::numeric_limits<double>::quiet_NaN();
  const ComponentMotion motion = part.motion();
  EXPECT_TRUE(motion.about().allFinite());
  EXPECT_EQ(part.moved(motion), part.nodes);
}

}  // namespace
}  // namespace tetskin::test
