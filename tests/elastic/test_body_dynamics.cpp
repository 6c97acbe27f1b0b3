// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/elastic/src/exported/body_dynamics.h>

#include <limits>

#include "elastic_fixtures.h"
#include "gradient_fixtures.h"
#include "support/odd_meshes.h"

namespace tetskin::test {
namespace {

TetMesh cageForDynamics() {
  return jittered(latticeCage(3, 2, 1), 0.15, 3);
}

constexpr double kSeconds = 0.2, kDamping = 0.3, kAlpha = kSeconds * kDamping;

/// Dynamics for a reference body, with velocities.
template <class S>
BodyDynamics<S> dynamicsOf(const AssembledBody<S>& body, const VectorXd& velocities) {
  BodyDynamics<S> dynamics(body.restTets(), body.nodes.size());
  dynamics.setMaterial(body.lame);
  dynamics.setDamping(kDamping);
  for (std::size_t n = 0; n < body.nodes.size(); ++n) {
    dynamics.setMass(n, static_cast<S>(body.masses[n]));
    for (std::size_t k = 0; k < 3; ++k) {
      dynamics.point(n)[k] = static_cast<S>(body.nodes[n][static_cast<Eigen::Index>(k)]);
      dynamics.velocity(n)[k] = static_cast<S>(velocities[static_cast<Eigen::Index>(3 * n + k)]);
    }
  }
  return dynamics;
}

template <class S>
class BodyDynamicsOf : public WithScalar<S> {};
TYPED_TEST_SUITE(BodyDynamicsOf, Scalars);

TYPED_TEST(BodyDynamicsOf, StartsAStepWithTheForcesWhereRigidMotionLeadsAndWhatDeviatesFromIt) {
  onEachInstructionSet([&] {
    AssembledBody<TypeParam> body(cageForDynamics(), 0.1, kAlpha);
    // The drift is so fast that rounding errors in its stiffness forces would be noticed.
    const auto size = static_cast<Eigen::Index>(3 * body.nodes.size());
    const VectorXd v = Random(51).vector(3 * body.nodes.size()) + VectorXd::Constant(size, 100.0);
    BodyDynamics<TypeParam> dynamics = dynamicsOf(body, v);
    dynamics.predict({kSeconds}, nullptr);
    EXPECT_NEAR(dynamics.alpha(), kAlpha, 1e-15);
    dynamics.findResidual(nullptr);
    VectorXd rigid(size), forces(size), right(size), masses(size);
    for (std::size_t n = 0; n < body.nodes.size(); ++n) {
      TypeParam r[3];
      dynamics.rightSide(n, r);
      for (std::size_t k = 0; k < 3; ++k) {
        const auto i = static_cast<Eigen::Index>(3 * n + k);
        rigid[i] = dynamics.velocity(n)[k];
        forces[i] = dynamics.force(n)[k];
        right[i] = r[k];
        masses[i] = body.masses[n];
      }
    }
    const double tolerance = 300.0 * this->kEpsilon * (kSeconds * forces.norm() + masses.norm() * 100.0);
    EXPECT_LT((right - kSeconds * forces - masses.cwiseProduct(v - rigid)).norm(), tolerance);
    EXPECT_LT((body.fromWide(dynamics.matrix().solution()) - (v - rigid)).norm(), 1e4 * this->kEpsilon);
    for (std::size_t n = 0; n < body.nodes.size(); ++n) {
      body.nodes[n] += kSeconds * rigid.segment<3>(static_cast<Eigen::Index>(3 * n));
    }
    const VectorXd residual = right - body.dense() * (v - rigid);
    EXPECT_LT((body.fromWide(dynamics.matrix().residual()) - residual).norm(), tolerance);
    BodyDynamics<TypeParam> there = dynamicsOf(body, v);
    BodyProbe<TypeParam> probe(there.matrix());
    for (std::size_t n = 0; n < body.nodes.size(); ++n) std::copy_n(there.point(n), 3, probe.point(n));
    there.findForces(probe, nullptr);
    for (std::size_t n = 0; n < body.nodes.size(); ++n) {
      for (int k = 0; k < 3; ++k) EXPECT_NEAR(dynamics.force(n)[k], probe.force(n)[k], 0.1 * tolerance);
    }
  });
}

TYPED_TEST(BodyDynamicsOf, StartsStiffBodiesWhereRigidMotionLeads) {
  AssembledBody<TypeParam> body(cageForDynamics(), 0.0, kAlpha);
  body.lame = {1e6, 1e6};
  const VectorXd v = Random(51).vector(3 * body.nodes.size());
  for (const bool pinned : {false, true}) {
    if (pinned) body.hold(3);
    BodyDynamics<TypeParam> dynamics = dynamicsOf(body, v);
    dynamics.predict({kSeconds}, nullptr);
    dynamics.findResidual(nullptr);
    const VectorXd solution = body.fromWide(dynamics.matrix().solution());
    for (std::size_t n = 0; n < body.nodes.size(); ++n) {
      const auto at = static_cast<Eigen::Index>(3 * n);
      Vector3d beside = v.segment<3>(at);
      for (int k = 0; k < 3; ++k) beside[k] -= dynamics.velocity(n)[k];
      if (body.masses[n] > 0.0) {
        EXPECT_TRUE(solution.segment<3>(at).isZero(0.0)) << n;
      } else {
        EXPECT_LT((solution.segment<3>(at) - beside).norm(), 10.0 * this->kEpsilon) << "it goes where it is led";
      }
    }
  }
}

TYPED_TEST(BodyDynamicsOf, StartsAgainFromASolution) {
  onEachInstructionSet([&] {
    AssembledBody<TypeParam> body(cageForDynamics(), 0.1, kAlpha);
    const VectorXd still = VectorXd::Zero(static_cast<Eigen::Index>(3 * body.nodes.size()));
    BodyDynamics<TypeParam> dynamics = dynamicsOf(body, still);
    dynamics.predict({kSeconds}, nullptr);
    Random random(51);
    for (std::size_t n = 0; n < body.nodes.size(); ++n) {
      for (int k = 0; k < 3; ++k) dynamics.velocity(n)[k] = static_cast<TypeParam>(1e-3 * random());
    }
    dynamics.predict({kSeconds}, nullptr);  // the matrix is the previous one: it has hardly turned
    dynamics.findResidual(nullptr);
    VectorXd right(static_cast<Eigen::Index>(3 * body.nodes.size()));
    for (std::size_t n = 0; n < body.nodes.size(); ++n) {
      TypeParam r[3];
      dynamics.rightSide(n, r);
      for (std::size_t k = 0; k < 3; ++k) right[static_cast<Eigen::Index>(3 * n + k)] = r[k];
    }
    const VectorXd x = Random(52).vector(3 * body.nodes.size());
    body.toWide(x, dynamics.matrix().solution());
    dynamics.findResidual(nullptr);
    const VectorXd image = body.dense() * x;
    EXPECT_LT((body.fromWide(dynamics.matrix().residual()) - (right - image)).norm(),
              20.0 * this->kEpsilon * (right.norm() + image.norm()));
  });
}

/// A history after some steps of 0.1 s with the same impulses; all but a fifth of these is damping.
ImpulseHistory<double> historyOf(const BlockMatrix<double>& matrix, const AlignedVector<double>& impulses, int steps) {
  ImpulseHistory<double> history;
  for (int k = 0; k < steps; ++k) {
    history.clear(matrix.wideSize());
    history.keep(matrix, impulses, {0.0, 0.5}, 0.1, 0.1);
  }
  return history;
}

TEST(ImpulseHistory, TurnsWithItsComponentAndGrowsWithTheTimeForWhichForcesAct) {
  const AssembledBody<double> body(cageForDynamics(), 0.0, kAlpha);
  auto dynamics = dynamicsOf(body, VectorXd::Zero(static_cast<Eigen::Index>(3 * body.nodes.size())));
  const BlockMatrix<double>& matrix = dynamics.matrix();
  const VectorXd before = Random(55).vector(3 * body.nodes.size());
  AlignedVector<double> impulses(matrix.wideSize(), 0.0), right = impulses;
  body.toWide(before, impulses.data());
  EXPECT_FALSE(historyOf(matrix, impulses, 4).fits(0.1)) << "the first one has followed nothing";
  ImpulseHistory<double> history = historyOf(matrix, impulses, 5);
  EXPECT_TRUE(history.fits(0.2));
  EXPECT_FALSE(history.fits(0.3));
  EXPECT_FALSE(history.fits(0.03));
  const Matrix3d turn = turnBy(70.0, {1, 2, 3});
  std::array<double, 9> rows{};
  for (int k = 0; k < 9; ++k) rows[static_cast<std::size_t>(k)] = turn(k / 3, k % 3);
  history.turn({rows}, std::vector<std::uint32_t>(matrix.slotCount(), 0));
  history.addTo(right, {0.25, 0.5}, 0.2);
  const VectorXd added = body.fromWide(right.data());
  for (std::size_t n = 0; n < body.nodes.size(); ++n) {
    const auto at = static_cast<Eigen::Index>(3 * n);
    const Vector3d expected = 0.25 * 2.0 * -0.8 * (turn * before.segment<3>(at));
    EXPECT_LT((added.segment<3>(at) - expected).norm(), 1e-12) << n;
  }
  history.takeFrom(right);
  EXPECT_LT(body.fromWide(right.data()).norm(), 1e-12);
}

TEST(ImpulseHistory, DoesNotFitWhereImpulsesChangeByMoreThanTheVelocitiesAllow) {
  const AssembledBody<double> body(cageForDynamics(), 0.0, kAlpha);
  auto dynamics = dynamicsOf(body, VectorXd::Zero(static_cast<Eigen::Index>(3 * body.nodes.size())));
  BlockMatrix<double>& matrix = dynamics.matrix();
  AlignedVector<double> impulses(matrix.wideSize(), 0.0);
  body.toWide(Random(55).vector(3 * body.nodes.size()), impulses.data());
  for (const double speed : {0.0, 100.0}) {
    ImpulseHistory<double> history = historyOf(matrix, impulses, 9);
    std::fill_n(matrix.solution(), matrix.wideSize(), speed);
    AlignedVector<double> others = impulses;
    for (double& impulse : others) impulse *= 1.5;
    for (std::size_t n = 0; n < body.nodes.size(); ++n) {
      for (std::size_t k = 0; k < 3; ++k) others[matrix.wideOf(n) + k * kernels::kGroup] += body.masses[n] * speed;
    }
    history.clear(matrix.wideSize());
    history.keep(matrix, others, {0.0, 0.5}, 0.1, 0.1);
    EXPECT_EQ(history.fits(0.1), speed > 0.0);
  }
}

/// A body that trembles, at the beginning of its step of this number.
BodyDynamics<double> stepsOf(const AssembledBody<double>& body, int steps) {
  const VectorXd v = 0.1 * Random(51).vector(3 * body.nodes.size());
  BodyDynamics<double> dynamics = dynamicsOf(body, v);
  ConjugateGradient<double> gradient;
  SolveLimits limits;
  limits.tolerance = 1e-8;
  for (int k = 1; k < steps; ++k) {
    dynamics.predict({kSeconds}, nullptr);
    dynamics.findResidual(nullptr);
    dynamics.solve(gradient, limits, 100, nullptr);
    dynamics.remember(SolvedWith::ElasticityAlone, nullptr);
    const VectorXd deviation = body.fromWide(dynamics.matrix().solution());
    for (std::size_t n = 0; n < body.nodes.size(); ++n) {
      for (std::size_t i = 0; i < 3; ++i) {
        dynamics.velocity(n)[i] += deviation[static_cast<Eigen::Index>(3 * n + i)];
        dynamics.point(n)[i] += kSeconds * dynamics.velocity(n)[i];
      }
    }
  }
  dynamics.predict({kSeconds}, nullptr);
  dynamics.findResidual(nullptr);
  return dynamics;
}

/// What the right side has beside the momentum and the elastic forces, node by node.
VectorXd carriedBy(const AssembledBody<double>& body, const BodyDynamics<double>& dynamics) {
  VectorXd carried(static_cast<Eigen::Index>(3 * body.nodes.size()));
  for (std::size_t n = 0; n < body.nodes.size(); ++n) {
    double right[3];
    dynamics.rightSide(n, right);
    for (std::size_t k = 0; k < 3; ++k) {
      const double deviation = dynamics.deviation()[dynamics.matrix().wideOf(n) + k * kernels::kGroup];
      carried[static_cast<Eigen::Index>(3 * n + k)] =
          right[k] - kSeconds * dynamics.force(n)[k] - body.masses[n] * deviation;
    }
  }
  return carried;
}

/// (A - M) u of the velocities u with which the step has begun.
VectorXd stiffnessTimesDeviation(const AssembledBody<double>& body, const BodyDynamics<double>& dynamics) {
  const VectorXd began = body.fromWide(dynamics.deviation());
  AlignedVector<double> points(4 * dynamics.matrix().slotCount(), 0.0), product(dynamics.matrix().wideSize(), 0.0);
  VectorXd momentum(began.size());
  for (std::size_t n = 0; n < body.nodes.size(); ++n) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto at = static_cast<Eigen::Index>(3 * n + k);
      points[4 * dynamics.matrix().slotOf(n) + k] = began[at];
      momentum[at] = body.masses[n] * began[at];
    }
  }
  dynamics.matrix().multiply(points.data(), product.data(), nullptr);
  return body.fromWide(product.data()) - momentum;
}

TEST(BodyDynamics, ABodyThatTurnsOutToBeTouchedCarriesOnWhatItBeginsWith) {
  const AssembledBody<double> body(cageForDynamics(), 0.0, kAlpha);
  EXPECT_FALSE(stepsOf(body, 1).isSecondOrder());
  for (const bool impact : {false, true}) {
    BodyDynamics<double> touched = stepsOf(body, 40);
    ASSERT_TRUE(touched.isSecondOrder());
    EXPECT_GT(carriedBy(body, touched).norm(), 1e-6) << "of the steps before";
    touched.beTouched(impact, nullptr);
    EXPECT_TRUE(touched.isSecondOrder());
    EXPECT_EQ(touched.isImpact(), impact);
    const double half = 0.5 * kSeconds, share = (impact ? 1.0 : 0.5) * half / (kDamping + half);
    EXPECT_DOUBLE_EQ(touched.alpha(), kSeconds * (kDamping + half));
    const VectorXd expected = share * stiffnessTimesDeviation(body, touched);
    EXPECT_GT(expected.norm(), 1e-6);
    EXPECT_LT((carriedBy(body, touched) - expected).norm(), 0.02 * expected.norm()) << "but for what turns";
    touched.findResidual(nullptr);
    touched.remember(SolvedWith::ElasticityAlone, nullptr);
    EXPECT_TRUE(touched.remembers());
    for (int k = 0; k < 7; ++k) {
      touched.predict({kSeconds}, nullptr);
      EXPECT_DOUBLE_EQ(touched.alpha(), kSeconds * (kDamping + half)) << k << " steps later";
    }
    touched.predict({kSeconds}, nullptr);
    EXPECT_DOUBLE_EQ(touched.alpha(), kSeconds * kDamping);
  }
}

/// The nodes of a tet's first corner are moved through the opposite face.
TEST(BodyDynamics, FlatTetsCarryOnNothingAndWhereABodyIsHeldFlatNothingDoes) {
  const AssembledBody<double> body(cageForDynamics(), 0.0, kAlpha);
  for (const bool impact : {false, true}) {
    BodyDynamics<double> dynamics = stepsOf(body, 10);
    dynamics.remember(SolvedWith::ElasticityAlone, nullptr);
    const Tet tet = body.restTets().tets.front();
    double centre[3] = {};
    for (std::size_t corner = 1; corner < 4; ++corner) {
      for (std::size_t k = 0; k < 3; ++k) centre[k] += dynamics.point(static_cast<std::size_t>(tet[corner]))[k] / 3.0;
    }
    for (std::size_t k = 0; k < 3; ++k) {
      double& x = dynamics.point(static_cast<std::size_t>(tet[0]))[k];
      x += 1.1 * (centre[k] - x);
    }
    StepStart start{kSeconds};
    start.touched = true;
    start.impact = impact;
    dynamics.predict(start, nullptr);
    const VectorXd carried = carriedBy(body, dynamics);
    const double all = (0.5 * kSeconds / (kDamping + 0.5 * kSeconds)) * stiffnessTimesDeviation(body, dynamics).norm();
    EXPECT_EQ(dynamics.isSecondOrder(), impact);
    if (!impact) {
      EXPECT_LT(carried.norm(), 1e-10);
      continue;
    }
    EXPECT_GT(carried.norm(), 0.01 * all);
    VectorXd sum = VectorXd::Zero(3);
    for (Eigen::Index n = 0; n < carried.size() / 3; ++n) sum += carried.segment<3>(3 * n);
    EXPECT_LT(sum.norm(), 1e-10 * carried.norm()) << "internal forces";
  }
}

#ifndef NDEBUG
TEST(BodyDynamicsDeathTest, CallsInAnotherOrderAreAsserted) {
  const AssembledBody<double> body(cageForDynamics(), 0.0, kAlpha);
  ConjugateGradient<double> gradient;
  const double still[3] = {};
  BodyDynamics<double> dynamics = dynamicsOf(body, VectorXd::Zero(static_cast<Eigen::Index>(3 * body.nodes.size())));
  EXPECT_DEATH(dynamics.findResidual(nullptr), "stage_");
  EXPECT_DEATH(dynamics.advance(0, kSeconds, still), "stage_");
  dynamics.predict({kSeconds}, nullptr);
  EXPECT_DEATH(dynamics.solve(gradient, {}, 1, nullptr), "stage_");
  dynamics.findResidual(nullptr);
  dynamics.beTouched(false, nullptr);
  EXPECT_DEATH(dynamics.remember(SolvedWith::ElasticityAlone, nullptr), "stage_") << "the right side is another one";
  dynamics.findResidual(nullptr);
  dynamics.remember(SolvedWith::ElasticityAlone, nullptr);
  EXPECT_DEATH(dynamics.remember(SolvedWith::ElasticityAlone, nullptr), "stage_") << "once is enough";
}
#endif

TYPED_TEST(BodyDynamicsOf, GivesASolutionTheMomentumThatTheStepBeganWithAndChangesNothingElse) {
  AssembledBody<TypeParam> body(cageForDynamics());
  for (const double speed : {0.0, 1.0, 20.0}) {  // the last is beyond a turn of 90 degrees per step
    const VectorXd v = speed * Random(51).vector(3 * body.nodes.size());
    BodyDynamics<TypeParam> dynamics = dynamicsOf(body, v);
    dynamics.predict({kSeconds}, nullptr);
    dynamics.findResidual(nullptr);
    const VectorXd some = Random(53).vector(3 * body.nodes.size());
    const Vector3d impulse(0.3, -0.2, 0.5);
    body.toWide(some, dynamics.matrix().solution());
    dynamics.removeMomentum([&](std::size_t) { return std::array<double, 3>{impulse.x(), impulse.y(), impulse.z()}; });
    const VectorXd free = body.fromWide(dynamics.matrix().solution());
    Vector3d push = Vector3d::Zero(), turn = Vector3d::Zero();
    for (std::size_t n = 0; n < body.nodes.size(); ++n) {
      const auto at = static_cast<Eigen::Index>(3 * n);
      Vector3d after = free.segment<3>(at) - v.segment<3>(at);
      for (int k = 0; k < 3; ++k) after[k] += dynamics.velocity(n)[k];
      const Vector3d momentum = body.masses[n] * after - impulse;
      push += momentum;
      turn += body.nodes[n].cross(momentum);
    }
    EXPECT_LT(push.norm(), 200.0 * (1.0 + speed) * this->kEpsilon);
    EXPECT_LT(turn.norm(), 200.0 * (1.0 + speed) * this->kEpsilon);
    // An additional rigid motion of the moved body changes nothing.
    VectorXd more = free;
    for (std::size_t n = 0; n < body.nodes.size(); ++n) {
      Vector3d moved = body.nodes[n];
      for (int k = 0; k < 3; ++k) moved[k] += kSeconds * dynamics.velocity(n)[k];
      more.segment<3>(static_cast<Eigen::Index>(3 * n)) += Vector3d(1, -2, 3) + Vector3d(0.5, 2, -1).cross(moved);
    }
    body.toWide(more, dynamics.matrix().solution());
    dynamics.removeMomentum([&](std::size_t) { return std::array<double, 3>{impulse.x(), impulse.y(), impulse.z()}; });
    EXPECT_LT((body.fromWide(dynamics.matrix().solution()) - free).norm(), 500.0 * (1.0 + speed) * this->kEpsilon);
  }
}

/// Whether the matrix takes account of a change of the body at the next `predict`.
template <class Change>
bool changesTheMatrix(Change&& change) {
  AssembledBody<double> body(cageForDynamics(), 0.0, kAlpha);
  BodyDynamics<double> dynamics = dynamicsOf(body, VectorXd::Zero(static_cast<Eigen::Index>(3 * body.nodes.size())));
  for (int k = 0; k < 3; ++k) dynamics.predict({kSeconds}, nullptr);
  const std::vector<double> x = body.toPoints(Random(54).vector(3 * body.nodes.size()));
  std::vector<double> image(dynamics.matrix().wideSize());
  const auto product = [&] {
    dynamics.matrix().multiply(x.data(), image.data(), nullptr);
    return body.fromWide(image.data());
  };
  const VectorXd before = product();
  const double seconds = change(dynamics, body);
  dynamics.predict({seconds}, nullptr);
  return (product() - before).norm() > 1e-6 * before.norm();
}

double turned(BodyDynamics<double>& dynamics, const AssembledBody<double>& body, double degrees) {
  const Points nodes = mapped(body.nodes, turnBy(degrees, {1, 2, 3}), {0, 0, 0});
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    for (std::size_t k = 0; k < 3; ++k) dynamics.point(n)[k] = nodes[n][static_cast<Eigen::Index>(k)];
  }
  return kSeconds;
}

TEST(BodyDynamics, AssemblesItsMatrixWhenSomethingHasChanged) {
  using Dynamics = BodyDynamics<double>;
  using Body = AssembledBody<double>;
  EXPECT_FALSE(changesTheMatrix([](Dynamics&, const Body&) { return kSeconds; }));
  EXPECT_TRUE(changesTheMatrix([](Dynamics&, const Body&) { return 0.5 * kSeconds; }));
  EXPECT_TRUE(changesTheMatrix([](Dynamics& dynamics, const Body&) {
    dynamics.setDamping(2.0 * kDamping);
    return kSeconds;
  }));
  EXPECT_TRUE(changesTheMatrix([](Dynamics& dynamics, const Body&) {
    dynamics.setMass(4, 9.0);
    return kSeconds;
  }));
  EXPECT_TRUE(changesTheMatrix([](Dynamics& dynamics, const Body&) {
    dynamics.setMaterial({5.0, 5.0});
    return kSeconds;
  }));
  EXPECT_FALSE(changesTheMatrix([](Dynamics& d, const Body& body) { return turned(d, body, 0.3); })) << "hardly";
  EXPECT_TRUE(changesTheMatrix([](Dynamics& d, const Body& body) { return turned(d, body, 3.0); }));
}

TEST(BodyDynamics, SolvesWithAMassThatChangesAsIfItHadAlwaysBeenSo) {
  AssembledBody<double> body(cageForDynamics(), 0.0, kAlpha);
  const VectorXd still = VectorXd::Zero(static_cast<Eigen::Index>(3 * body.nodes.size()));
  const VectorXd impulses = Random(56).vector(3 * body.nodes.size());
  const auto response = [&](BodyDynamics<double>& dynamics) {
    AlignedVector<double> wide(dynamics.matrix().wideSize(), 0.0), velocities = wide;
    dynamics.predict({kSeconds}, nullptr);
    body.toWide(impulses, wide.data());
    dynamics.matrix().precondition(wide.data(), velocities.data(), nullptr);
    return body.fromWide(velocities.data());
  };
  BodyDynamics<double> dynamics = dynamicsOf(body, still);
  for (const double mass : {9.0, 0.0, 2.0}) {
    EXPECT_GT(response(dynamics).norm(), 0.0);
    dynamics.setMass(4, body.masses[4] = mass);
    BodyDynamics<double> always = dynamicsOf(body, still);
    EXPECT_LT(apart(response(dynamics), response(always)), 1e-9) << mass;
    EXPECT_NEAR(dynamics.squaredImpulses(1.0), always.squaredImpulses(1.0), 1e-9) << mass;
  }
}

/// By the damping that gives all tets of a body as large a factor of their stiffness.
TEST(BodyDynamics, FlatTetsOfAPressedBodyAreDampedByTwoHundredSquaredSteps) {
  AssembledBody<double> body(cageForDynamics(), 0.0, kAlpha);
  for (Vector3d& node : body.nodes) node.z() *= 0.01;
  const VectorXd still = VectorXd::Zero(static_cast<Eigen::Index>(3 * body.nodes.size()));
  const std::vector<double> x = body.toPoints(Random(54).vector(3 * body.nodes.size()));
  const auto product = [&](bool pressed, double damping) {
    BodyDynamics<double> dynamics = dynamicsOf(body, still);
    StepStart start{kSeconds};
    start.pressed = pressed;
    dynamics.setDamping(damping);
    for (int k = 0; k < 3; ++k) dynamics.predict(start, nullptr);
    std::vector<double> image(dynamics.matrix().wideSize());
    dynamics.matrix().multiply(x.data(), image.data(), nullptr);
    return body.fromWide(image.data());
  };
  EXPECT_LT(apart(product(true, kDamping), product(false, 200.0 * kSeconds)), 1e-9);
  EXPECT_GT(apart(product(false, kDamping), product(false, 200.0 * kSeconds)), 0.1);
}

/// One tet that turns, besides a thousand that do not: the mean turn is small.
struct SingleTetBesideMany {
  explicit SingleTetBesideMany(double stiffness)
      : cage(withTet()), dynamics(elastic_detail::restTets(cage), cage.nodeCount()) {
    dynamics.setMaterial({stiffness, stiffness});
    dynamics.setDamping(kDamping);
    for (std::size_t n = 0; n < cage.nodeCount(); ++n) {
      dynamics.setMass(n, 1.0);
      place(n, cage.nodes[n]);
    }
  }

  /// Whether the matrix is reassembled for a step in which the single tet has been turned about an oblique axis.
  bool isMadeAnewFor(double degrees) {
    const std::vector<double> before = block();
    for (std::size_t n = cage.nodeCount() - 4; n < cage.nodeCount(); ++n) {
      place(n, turnBy(degrees, {1, 2, 3}) * cage.nodes[n]);
    }
    return block() != before;
  }

 private:
  static TetMesh withTet() {
    TetMesh cage = latticeCage(6, 6, 6);
    const auto first = static_cast<int>(cage.nodeCount());
    for (const Vector3d& p : singleTet().nodes) cage.nodes.push_back(p + Vector3d(20, 0, 0));
    cage.tets.push_back({first, first + 1, first + 2, first + 3});
    return cage;
  }
  void place(std::size_t n, const Vector3d& p) {
    for (std::size_t k = 0; k < 3; ++k) dynamics.point(n)[k] = p[static_cast<Eigen::Index>(k)];
  }
  std::vector<double> block() {
    double d[6];
    dynamics.predict({kSeconds}, nullptr);
    dynamics.matrix().diagonal(cage.nodeCount() - 2, d);  // block of the single tet, different along all axes
    return std::vector<double>(d, d + 6);
  }

  TetMesh cage;
  BodyDynamics<double> dynamics;
};

TEST(BodyDynamics, AssemblesItsMatrixWhenASingleTetHasTurnedFar) {
  EXPECT_FALSE(SingleTetBesideMany(1.0).isMadeAnewFor(10.0));
  EXPECT_TRUE(SingleTetBesideMany(1.0).isMadeAnewFor(25.0));
}

TEST(BodyDynamics, AssemblesAStiffMatrixWhenASingleTetHasTurnedALittle) {
  EXPECT_FALSE(SingleTetBesideMany(1e6).isMadeAnewFor(0.001));
  EXPECT_TRUE(SingleTetBesideMany(1e6).isMadeAnewFor(0.1))
      << "its turning would meet what its inertia is little beside";
}

TYPED_TEST(BodyDynamicsOf, ABodyWithoutTetsIsItsMasses) {
  BodyDynamics<TypeParam> dynamics({}, 3);
  for (std::size_t n = 0; n < 3; ++n) {
    dynamics.setMass(n, static_cast<TypeParam>(n + 1));
    dynamics.velocity(n)[0] = 5;
  }
  dynamics.predict({kSeconds}, nullptr);
  dynamics.findResidual(nullptr);
  EXPECT_EQ(dynamics.velocity(0)[0], TypeParam(5));
  EXPECT_EQ(dynamics.alpha(), 0.0);
  EXPECT_EQ(dynamics.energy(BodyProbe<TypeParam>(dynamics.matrix()), nullptr), 0.0);
  std::vector<TypeParam> points(4 * dynamics.matrix().slotCount(), 2), image(dynamics.matrix().wideSize());
  dynamics.matrix().multiply(points.data(), image.data(), nullptr);
  for (std::size_t n = 0; n < 3; ++n) {
    TypeParam right[3];
    dynamics.rightSide(n, right);
    EXPECT_EQ(right[0], TypeParam(0));
    EXPECT_EQ(image[dynamics.matrix().wideOf(n)], static_cast<TypeParam>(2 * (n + 1)));
  }
}

/// The cage twice, with no node in common.
TetMesh twoComponents(TetMesh cage) {
  const std::vector<Tet> tets = cage.tets;
  const int first = static_cast<int>(cage.nodeCount());
  for (int n = 0; n < first; ++n) cage.nodes.push_back(cage.nodes[static_cast<std::size_t>(n)] + Vector3d(5, 1, 0));
  for (const Tet& t : tets) cage.tets.push_back({t[0] + first, t[1] + first, t[2] + first, t[3] + first});
  return cage;
}

TYPED_TEST(BodyDynamicsOf, HasTheRigidMotionsOfPartsThatAreFreeWhereItsForcesAreTaken) {
  AssembledBody<TypeParam> body(twoComponents(cageForDynamics()));
  body.hold(3);  // belongs to the first component
  const VectorXd v = Random(51).vector(3 * body.nodes.size());
  BodyDynamics<TypeParam> dynamics = dynamicsOf(body, v);
  dynamics.predict({kSeconds}, nullptr);
  ASSERT_EQ(dynamics.componentCount(), 2u);
  AlignedVector<TypeParam> motions[BodyDynamics<TypeParam>::kRigidMotions];
  const std::size_t half = body.nodes.size() / 2;
  Points moved = body.nodes;
  Vector3d centroid = Vector3d::Zero();
  double mass = 0.0;
  for (std::size_t n = half; n < moved.size(); ++n) {
    for (int k = 0; k < 3; ++k) moved[n][k] += kSeconds * dynamics.velocity(n)[k];
    centroid += body.masses[n] * moved[n];
    mass += body.masses[n];
  }
  centroid /= mass;
  int found = 0;
  for (std::size_t component = 0; component < 2; ++component) {
    if (!dynamics.rigidMotions(component, motions)) {
      EXPECT_TRUE(motions[0].empty()) << "nothing is written";
      continue;
    }
    ++found;
    for (std::size_t n = 0; n < moved.size(); ++n) {
      const Eigen::Matrix<double, 3, 6> expected = rigidVelocityAt(moved[n], centroid);
      for (Eigen::Index k = 0; k < 6; ++k) {
        const TypeParam* at = &motions[k][4 * dynamics.matrix().slotOf(n)];
        const Vector3d wanted = n < half ? Vector3d::Zero().eval() : expected.col(k).eval();
        EXPECT_LT((Vector3d(at[0], at[1], at[2]) - wanted).norm(), 20.0 * this->kEpsilon) << n << " " << k;
      }
    }
    for (auto& motion : motions) motion.clear();
  }
  EXPECT_EQ(found, 1) << "but not of the one that is held";
}

TYPED_TEST(BodyDynamicsOf, KeepsTheRigidPartOfASolution) {
  for (const std::vector<std::size_t>& pinned : std::vector<std::vector<std::size_t>>{{}, {3}, {3, 6}, {0, 3, 6, 9}}) {
    AssembledBody<TypeParam> body(cageForDynamics());
    for (const std::size_t n : pinned) body.hold(n);
    const VectorXd still = VectorXd::Zero(static_cast<Eigen::Index>(3 * body.nodes.size()));
    BodyDynamics<TypeParam> dynamics = dynamicsOf(body, still);
    dynamics.predict({kSeconds}, nullptr);
    VectorXd some = Random(53).vector(3 * body.nodes.size());
    for (const std::size_t n : pinned) some.segment<3>(static_cast<Eigen::Index>(3 * n)).setZero();
    body.toWide(some, dynamics.matrix().solution());
    dynamics.projectToRigidMotion();
    const VectorXd kept = body.fromWide(dynamics.matrix().solution());
    const Vector3d about = pinned.empty() ? Vector3d::Zero().eval() : body.nodes[pinned[0]];
    Vector3d momentum = Vector3d::Zero(), spin = Vector3d::Zero();
    double strain = 0.0;
    for (std::size_t n = 0; n < body.nodes.size(); ++n) {
      const auto at = static_cast<Eigen::Index>(3 * n);
      const Vector3d change = body.masses[n] * (kept - some).segment<3>(at);
      momentum += change;
      spin += (body.nodes[n] - about).cross(change);
      for (std::size_t m = 0; m < n; ++m) {
        const Vector3d relative = kept.segment<3>(at) - kept.segment<3>(static_cast<Eigen::Index>(3 * m));
        strain = std::max(strain, std::abs(relative.dot(body.nodes[n] - body.nodes[m])));
      }
    }
    const double tolerance = 500.0 * this->kEpsilon;
    EXPECT_LT(strain, tolerance);
    if (pinned.empty()) {
      EXPECT_LT(momentum.norm(), tolerance);
    }
    if (pinned.size() < 2) {
      EXPECT_LT(spin.norm(), tolerance);
    }
    if (pinned.size() == 2) {
      EXPECT_LT(std::abs(spin.dot(body.nodes[6] - about)), tolerance);
    }
    if (pinned.size() > 2) {
      EXPECT_EQ(kept, still) << "nothing of it is free";
    }
    if (pinned.size() < 3) {
      EXPECT_GT(kept.norm(), 0.01);
    }
    body.toWide(kept, dynamics.matrix().solution());
    dynamics.projectToRigidMotion();
    EXPECT_LT((body.fromWide(dynamics.matrix().solution()) - kept).norm(), tolerance) << "it is rigid";
  }
}

TYPED_TEST(BodyDynamicsOf, YieldsRigidlyToAnImpulseOnThePartOfANode) {
  const AssembledBody<TypeParam> body(twoComponents(cageForDynamics()));
  const VectorXd still = VectorXd::Zero(static_cast<Eigen::Index>(3 * body.nodes.size()));
  BodyDynamics<TypeParam> dynamics = dynamicsOf(body, still);
  dynamics.predict({kSeconds}, nullptr);
  const std::size_t half = body.nodes.size() / 2;
  for (const std::size_t first : {std::size_t{0}, half}) {
    std::vector<double> masses = body.masses;
    for (std::size_t n = 0; n < masses.size(); ++n) masses[n] *= n / half == first / half ? 1.0 : 0.0;
    const Vector3d point = body.nodes[first + 2] + Vector3d(0.1, 0.4, -0.2), direction = Vector3d(1, 2, -2) / 3.0;
    const Eigen::Matrix<double, 6, 1> push = rigidVelocityAt(point, {0, 0, 0}).transpose() * direction;
    const double expected = push.dot(solved(rigidMass(body.nodes, masses, {0, 0, 0}), push));
    const double found = dynamics.rigidCompliance(dynamics.componentOf(first + 2), {point.x(), point.y(), point.z()},
                                                  {direction.x(), direction.y(), direction.z()});
    EXPECT_NEAR(found, expected, 500.0 * this->kEpsilon * expected);
  }
  BodyDynamics<TypeParam> masses({}, 5);  // nodes that no tet connects
  masses.setMass(2, 1);
  masses.predict({kSeconds}, nullptr);
  EXPECT_EQ(masses.rigidCompliance(0, {1, 2, 3}, {1, 0, 0}), 0.0);
}

}  // namespace
}  // namespace tetskin::test
