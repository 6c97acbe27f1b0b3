// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A beam's behaviour must follow from its numbers: stiffness, damping, step, size, and place. Its sag times its
// stiffness is the same for all of them, and the same for linear tets as for quadratic ones, each by its own mesh.
#include <tetskin/core/cage.h>
#include <tetskin/solver/deformable_world.h>

#include <cstdlib>

#include "deformable_test.h"
#include "support/odd_meshes.h"

namespace tetskin::test {
namespace {

constexpr double kEarth = 9.81, kBeamDensity = 100.0;
constexpr int kLong = 8;  // edges of a beam of one edge's thickness

struct Numbers {
  double stiffness = 3e4;  ///< Young's modulus over density, gravity and length
  double damping = 0.02;
  double seconds = 1.0 / 240.0;
  double length = 1.0;
  double place = 0.0;
};

/// Cells along a beam and across it, and its length over its thickness, which is that of a cell.
struct Shape {
  int along = kLong, across = 1;
  double aspect = kLong, width = 1.0 / kLong;  ///< width: over the length
};

enum class Held { Pinned, Anchored };

/// A beam, or a plate, that is held at its left end.
class Beam {
 public:
  Beam(const Numbers& numbers, bool quadratic, double gravity = kEarth, const Shape& shape = {},
       Held held = Held::Pinned)
      : numbers_(numbers) {
    const double edge = numbers.length / shape.along;
    cage_.mesh = latticeCage(shape.along, 1, shape.across, edge);
    for (Eigen::Vector3d& node : cage_.mesh.nodes) {
      node.y() *= shape.along / shape.aspect;
      node.z() *= shape.width * shape.along / shape.across;
    }
    if (quadratic) cage_ = refineQuadratic(cage_.mesh).value();
    world_.setGravity(btVector3(0, static_cast<btScalar>(-gravity), 0));
    SoftBodyOptions options;
    options.youngsModulus = numbers.stiffness * kBeamDensity * kEarth * numbers.length;
    options.density = kBeamDensity;
    options.stiffnessDamping = numbers.damping;
    const auto isHeld = [edge](const Eigen::Vector3d& rest) { return rest.x() < 1e-6 * edge; };
    if (held == Held::Pinned) options.pinned = isHeld;
    body_ = DeformableBody::add(world_, cage_, options).value();
    for (int n = 0; n < body().m_nodes.size() && held == Held::Anchored; ++n) {
      if (isHeld(cage_.mesh.nodes[static_cast<std::size_t>(n)])) body().appendDeformableAnchor(n, &wall_);
    }
    const auto place = static_cast<btScalar>(numbers.place);
    body().translate(btVector3(place, 0, place));
  }
  btSoftBody& body() { return body_->body(); }
  void step() {
    const auto seconds = static_cast<btScalar>(numbers_.seconds);
    world_.stepSimulation(seconds, 1, seconds);
  }
  /// Steps until the body sleeps, at most so long. Returns the number of steps.
  int settle(double seconds) {
    int steps = 0;
    for (; steps * numbers_.seconds < seconds && body().isActive(); ++steps) step();
    return steps;
  }
  /// By how much the nodes at the right end are lower than at rest, on average.
  double sag() {
    double sum = 0.0;
    int count = 0;
    for (int n = 0; n < body().m_nodes.size(); ++n) {
      const Eigen::Vector3d& rest = cage_.mesh.nodes[static_cast<std::size_t>(n)];
      if (rest.x() < numbers_.length * (1.0 - 1e-6)) continue;
      sum += rest.y() - static_cast<double>(body().m_nodes[n].m_x.y());
      ++count;
    }
    return sum / count;
  }
  /// Sag times stiffness, both over the length.
  double scaledSag() { return sag() / numbers_.length * numbers_.stiffness; }
  const Cage& cage() const { return cage_; }

 private:
  /// Damped beams creep: after half a second at rest, they would fall asleep with some percent of their sag to come.
  static DeformableWorldOptions patient() {
    DeformableWorldOptions options;
    options.sleepAfter = 2;
    return options;
  }

  Numbers numbers_;
  Cage cage_;
  btBoxShape shape_{btVector3(1, 1, 1)};
  btRigidBody wall_{0, nullptr, &shape_};  // only anchors are attached to it
  tetskin::DeformableWorld world_{patient()};
  std::unique_ptr<DeformableBody> body_;
};

/// All cells with the environment variable TETSKIN_TEST_WHOLE_TABLES; otherwise some, and fewer in builds that are not
/// optimized.
bool isSkipped(int cell) {
#ifdef NDEBUG
  constexpr int kEach = 13;
#else
  constexpr int kEach = 31;
#endif
  return std::getenv("TETSKIN_TEST_WHOLE_TABLES") == nullptr && cell % kEach != 0;
}

TEST(EveryNumber, SagTimesStiffnessIsOneNumber) {
  int cell = 0;
  for (const bool quadratic : {false, true}) {
    Numbers reference;
    reference.stiffness = 3e5;
    Beam beam(reference, quadratic);
    (void)beam.settle(3.0);
    const double expected = beam.scaledSag();
    for (const double stiffness : {3e3, 3e4, 3e5, 3e6, 1e7}) {
      for (const double damping : {0.01, 0.02, 0.1, 0.3}) {
        for (const double seconds : {1.0 / 1000.0, 1.0 / 240.0, 1.0 / 60.0}) {
          for (const double length : {0.1, 1.0, 10.0}) {
            if (isSkipped(cell++)) continue;
            Beam other({stiffness, damping, seconds, length, 0.0}, quadratic);
            const double squaredRate = stiffness * kEarth / length / 62.0;  // of the first vibration of such a beam
            (void)other.settle(std::max({2.5, 12.0 * damping, 20.0 / (damping * squaredRate)}));
            // A creeping beam is put to sleep before it ends; a swinging one, while it still swings; 3e3 bends visibly.
            const double left = 0.002 + std::exp(-2.0 / std::max(damping, 1e-3)) + 100.0 / stiffness;
            EXPECT_NEAR(other.scaledSag() / expected, 1.0, left)
                << stiffness << ' ' << damping << ' ' << seconds << ' ' << length << ' ' << quadratic;
          }
        }
      }
    }
  }
}

/// Float has seven digits: a kilometre away, the last one of a position is a twentieth of this beam's sag.
TEST(EveryNumber, ABeamSagsAndFallsAsleepInTheSameWayFarFromTheOrigin) {
  for (const bool quadratic : {false, true}) {
    Beam here({3e4, 0.02, 1.0 / 240.0, 1.0, 0.0}, quadratic);
    const int steps = here.settle(10.0);
    ASSERT_FALSE(here.body().isActive());
    for (const double place : {100.0, 1000.0, 10000.0}) {
      Beam there({3e4, 0.02, 1.0 / 240.0, 1.0, place}, quadratic);
      EXPECT_EQ(there.settle(10.0), steps) << place;
      EXPECT_NEAR(there.sag() / here.sag(), 1.0, 2e-4) << place;
    }
  }
}

/// Bending resists less than the last digit of the matrix does where a body is thin enough: in float, such a body would
/// creep. Beams by Euler and Bernoulli; the plate is as broad as long, and stiffer by its contraction.
TEST(EveryNumber, SlenderBeamsAndThinPlatesSagByTheory) {
  struct Case {
    Shape shape;
    double expected;  ///< over the theory of slender beams
  };
  int cell = 0;
  for (const Case& c : {Case{{25, 1, 50.0, 0.02}, 0.989}, Case{{8, 4, 100.0, 0.5}, 0.92}}) {
    const double theory = 1.5 * c.shape.aspect * c.shape.aspect;
    for (const double sag : {1e-2, 1e-4}) {
      for (const double damping : {0.02, 0.1}) {
        if (isSkipped(cell++ % 4)) continue;
        Beam beam({theory / sag, damping, 1.0 / 240.0, 1.0, 0.0}, true, kEarth, c.shape);
        (void)beam.settle(6.0);
        EXPECT_NEAR(beam.scaledSag() / theory, c.expected, 0.012) << c.shape.aspect << ' ' << sag << ' ' << damping;
      }
    }
  }
}

TEST(EveryNumber, ABeamOnAnchorsSagsLikeAPinnedOne) {
  for (const double damping : {0.02, 0.3}) {
    for (const double stiffness : {3e4, 1e5}) {
      Beam pinned({stiffness, damping}, true), anchored({stiffness, damping}, true, kEarth, {}, Held::Anchored);
      (void)pinned.settle(4.0);
      (void)anchored.settle(4.0);
      EXPECT_NEAR(anchored.sag() / pinned.sag(), 1.0, 0.01) << damping << ' ' << stiffness;
    }
  }
}

/// The largest deflection, up and down in turn, until it has swung five times; each as a share of the first.
std::vector<double> swings(double stiffness, double damping, double amplitude, double& period) {
  Numbers numbers{stiffness, damping, 0.0, 1.0, 0.0};
  // The first vibration of a slender beam, and this one is stiffer by its mesh.
  period = 2.0 * 3.14159 / (3.516 * std::sqrt(stiffness * kEarth / 12.0) / kLong);
  numbers.seconds = period / 100.0;
  Beam beam(numbers, true, 0.0);
  btSoftBody& body = beam.body();
  body.setActivationState(DISABLE_DEACTIVATION);
  for (int n = 0; n < body.m_nodes.size(); ++n) {
    const double x = beam.cage().mesh.nodes[static_cast<std::size_t>(n)].x();
    body.m_nodes[n].m_x[1] += static_cast<btScalar>(amplitude * x * x * (6.0 - 4.0 * x + x * x) / 3.0);
    body.m_nodes[n].m_q = body.m_nodes[n].m_x;
  }
  std::vector<double> peaks;
  std::vector<double> crossings;
  double before = 1.0, peak = 0.0;
  for (int k = 0; peaks.size() < 5 && k < 600; ++k) {
    beam.step();
    const double now = -beam.sag() / amplitude;
    peak = std::max(peak, std::abs(now));
    if (before * now < 0.0) {
      crossings.push_back(numbers.seconds * (k + before / (before - now)));
      peaks.push_back(peak);
      peak = 0.0;
    }
    before = now;
  }
  if (crossings.size() > 1) period = 2.0 * (crossings.back() - crossings.front()) / (crossings.size() - 1.0);
  return peaks;
}

TEST(EveryNumber, SmallSwingsKeepThePeriodAndTheDecayOfLargeOnes) {
  for (const double stiffness : {3e3, 3e5, 3e7}) {
    const double natural = 1.0 / std::sqrt(stiffness);  // in proportion to the period
    for (const double damping : {0.0, 0.02}) {
      double period = 0.0;
      const std::vector<double> expected = swings(stiffness, damping * natural, 1e-3, period);
      ASSERT_EQ(expected.size(), 5U) << stiffness;
      for (const double amplitude : {1e-4, 1e-5}) {
        double other = 0.0;
        const std::vector<double> found = swings(stiffness, damping * natural, amplitude, other);
        ASSERT_EQ(found.size(), 5U) << stiffness << ' ' << amplitude;
        EXPECT_NEAR(other / period, 1.0, 0.01) << stiffness << ' ' << amplitude;
        for (std::size_t k = 0; k < 5; ++k) {
          EXPECT_NEAR(found[k] / expected[k], 1.0, 0.05) << stiffness << ' ' << damping << ' ' << amplitude;
        }
      }
    }
  }
}

TEST(EveryNumber, ASolveThatStopsAtItsBoundIsReported) {
  for (const int bound : {1, 1000}) {
    TetskinWorld world;
    const TetMesh cage = latticeCage(kLong, 1, 1, 0.125);
    SoftBodyOptions options;
    options.youngsModulus = 1e7;
    options.density = kBeamDensity;
    options.maxIterations = bound;
    options.pinned = [](const Eigen::Vector3d& rest) { return rest.x() < 1e-6; };
    const auto body = DeformableBody::add(world.deformable(), Cage(cage), options).value();
    step(world, 1);
    EXPECT_EQ(world.bodySolver().unconvergedSystems(), bound == 1 ? 1 : 0);
  }
}

/// Poisson's ratios that are taken are simulated.
TEST(EveryNumber, ABodyOfTheLargestPoissonRatioLandsLikeOthers) {
  const double most = sizeof(btScalar) == sizeof(float) ? 0.4999 : 0.499999;
  TetskinWorld world;
  SoftBodyOptions options;
  options.poissonRatio = most + 0.5 * (0.5 - most);
  EXPECT_EQ(DeformableBody::add(world.deformable(), Cage(latticeCage(3, 3, 3, 0.1)), options).status().code,
            StatusCode::InvalidOption);
  options.poissonRatio = most;
  const auto body = DeformableBody::add(world.deformable(), Cage(latticeCage(3, 3, 3, 0.1)), options).value();
  body->body().translate(btVector3(0, btScalar(0.3), 0));
  double fastest = 0;
  for (int frame = 0; frame < 90; ++frame) {
    step(world, 1);
    fastest = std::max(fastest, fastestOf(body->body()));
  }
  EXPECT_LT(fastest, 4) << "it has fallen by 0.3 m, at 2.4 m/s";
}

}  // namespace
}  // namespace tetskin::test
