// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// How the motion of an ElasticBody depends on the length of its steps.
#include <tetskin/elastic/elastic_body.h>

#include <complex>

#include "dense_reference.h"
#include "elastic_motion.h"
#include "support/odd_meshes.h"

namespace tetskin::test {
namespace {

const std::array<double, 3> kDown = {0, -9.81, 0};
/// So small that tets do not turn enough for a new matrix.
const std::array<double, 3> kFaintlyDown = {0, -0.01, 0};

TetMesh beamCage() {
  return latticeCage(6, 1, 1, 0.25);
}

/// The motion of a held beam's free end for a second, at 20 instants.
/// share  by number of the step: its length over `seconds`; two steps add up to 2
Points swing(
    double damping, int steps, const std::function<double(int)>& share = [](int) { return 1.0; },
    double youngsModulus = 1e6) {
  const TetMesh cage = beamCage();
  ElasticOptions options;
  options.youngsModulus = youngsModulus;
  options.density = 1000.0;
  options.stiffnessDamping = damping;
  options.tolerance = 1e-8;
  ElasticBody<double> body = made<double>(cage, options);
  pinTheEnd(body, cage);
  Points path;
  for (int k = 0; k < steps; ++k) {
    body.step(share(k) / steps, youngsModulus > 1e5 ? kFaintlyDown : kDown);
    if ((k + 1) % (steps / 20) == 0) path.push_back(pointsOf(body.positions()).back());
  }
  return path;
}

double difference(const Points& a, const Points& b) {
  double squared = 0.0, way = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    squared += (a[k] - b[k]).squaredNorm();
    way += (b[k] - beamCage().nodes.back()).squaredNorm();
  }
  return std::sqrt(squared / way);
}

TEST(OrderInTime, IsTwoAtEveryDamping) {
  for (const double damping : {0.0, 0.003, 0.02, 0.1}) {
    const Points exact = swing(damping, 8000);
    const double coarse = difference(swing(damping, 120), exact), middle = difference(swing(damping, 240), exact),
                 fine = difference(swing(damping, 480), exact);
    EXPECT_LT(middle, 0.006) << damping;
    EXPECT_LT(fine, 0.6 * middle) << damping;
    EXPECT_LT(fine, 0.18 * coarse) << damping;
  }
}

TEST(OrderInTime, IsTwoForStepsOfVaryingLength) {
  const auto byTurns = [](int step) { return step % 2 == 0 ? 0.6 : 1.4; };
  for (const double damping : {0.0, 0.02}) {
    const Points exact = swing(damping, 8000);
    const double coarse = difference(swing(damping, 120, byTurns), exact),
                 fine = difference(swing(damping, 480, byTurns), exact);
    EXPECT_LT(coarse, 0.05) << damping;
    EXPECT_LT(fine, 0.18 * coarse) << damping;
  }
}

TEST(OrderInTime, StepsThatBecomeMuchLongerOrShorterAreStable) {
  for (const double damping : {0.0, 0.02}) {
    for (const double youngsModulus : {1e4, 1e6, 1e9}) {
      const auto leaps = [](int step) { return step % 10 == 3 ? 6.0 : step % 10 == 7 ? 0.1 : 0.4875; };
      for (const Eigen::Vector3d& tip : swing(damping, 200, leaps, youngsModulus)) {
        EXPECT_LT((tip - beamCage().nodes.back()).norm(), 6.0) << damping << ' ' << youngsModulus;
      }
    }
  }
}

/// Motion so fast and large that the matrix is far from the stiffness of the deformed body: a bar is bent, and
/// released. The energies are those of positions between two steps, with the mean of their velocities.
TEST(OrderInTime, ABodyThatIsBentFarAndLetGoGainsNoEnergy) {
  const TetMesh cage = latticeCage(8, 2, 2, 0.125);
  std::vector<double> masses = lumped(cage);
  for (double& mass : masses) mass *= 1000.0;
  for (const double youngsModulus : {1e4, 3e5, 3e6, 1e8}) {
    for (const double damping : {0.0, 0.003, 0.02}) {
      for (const double bend : {0.1, 0.2, 0.5}) {
        for (const int substeps : {1, 4}) {
          ElasticOptions options;
          options.youngsModulus = youngsModulus;
          options.density = 1000.0;
          options.stiffnessDamping = damping;
          ElasticBody<double> body = made<double>(cage, options);
          for (std::size_t n = 0; n < cage.nodeCount(); ++n) {
            const double x = cage.nodes[n].x() - 0.5;
            body.positions()[n][1] += bend * (1.0 - 8.0 * x * x);
          }
          const double start = body.energy();
          double highest = 0.0;
          for (int k = 0; k < 60 * substeps; ++k) {
            double energy = body.energy();
            const Points last = pointsOf(body.velocities());
            body.step(1.0 / 60.0 / substeps);
            const Points now = pointsOf(body.velocities());
            for (std::size_t n = 0; n < cage.nodeCount(); ++n) {
              energy += 0.125 * masses[n] * (last[n] + now[n]).squaredNorm();
            }
            if (k > 0) highest = std::max(highest, energy / start);
          }
          EXPECT_LT(highest, 1.002) << youngsModulus << ' ' << damping << ' ' << bend << ' ' << substeps;
        }
      }
    }
  }
}

/// Stiffness by differences of forces, and the modes of small vibrations that follow from it.
struct Mode {
  double frequency = 0.0;  ///< 1 / s
  Points shape;
};
Mode modeOf(ElasticBody<double>& body, const TetMesh& cage, const std::vector<double>& masses, Eigen::Index number) {
  const auto size = static_cast<Eigen::Index>(3 * cage.nodeCount());
  constexpr double kShift = 1e-6;
  const auto forces = [&](Eigen::Index changed, double by) {
    body.positions()[static_cast<std::size_t>(changed / 3)][changed % 3] += by;
    VectorXd all(size);
    const auto at = body.forces();
    for (Eigen::Index i = 0; i < size; ++i)
      all[i] = at[static_cast<std::size_t>(i / 3)][static_cast<std::size_t>(i % 3)];
    body.positions()[static_cast<std::size_t>(changed / 3)][changed % 3] -= by;
    return all;
  };
  MatrixXd stiffness(size, size);
  VectorXd massOf(size);
  for (Eigen::Index i = 0; i < size; ++i) {
    stiffness.col(i) = (forces(i, -kShift) - forces(i, kShift)) / (2.0 * kShift);
    massOf[i] = masses[static_cast<std::size_t>(i / 3)];
  }
  const test::Spectrum spectrum = test::spectrumOf((stiffness + stiffness.transpose()) / 2.0, massOf);
  Mode mode;
  mode.frequency = std::sqrt(spectrum.values[6 + number]);  // after the rigid motions
  for (Eigen::Index at = 0; at < size; at += 3) mode.shape.emplace_back(spectrum.vectors.block<3, 1>(at, 6 + number));
  return mode;
}

/// A free body that is deformed by a small multiple of a mode and let go: the multiple after some time, over the first.
double leftOfMode(const TetMesh& cage, const ElasticOptions& options, const Mode& mode,
                  const std::vector<double>& masses, double seconds, int steps) {
  ElasticBody<double> body = made<double>(cage, options);
  constexpr double kAmount = 1e-5;
  for (std::size_t n = 0; n < cage.nodeCount(); ++n) {
    for (int k = 0; k < 3; ++k) body.positions()[n][k] += kAmount * mode.shape[n][k];
  }
  for (int k = 0; k < steps; ++k) body.step(seconds);
  double left = 0.0;
  for (std::size_t n = 0; n < cage.nodeCount(); ++n) {
    left += masses[n] * mode.shape[n].dot(pointsOf(body.positions())[n] - cage.nodes[n]);
  }
  return left / kAmount;
}

/// q'' + damping frequency^2 q' + frequency^2 q = 0 from q = 1 at rest.
double exactlyLeft(double frequency, double damping, double time) {
  const std::complex<double> decay(damping * frequency * frequency / 2.0);
  const auto swing = std::sqrt(std::complex<double>(frequency * frequency) - decay * decay);
  return (std::exp(-decay * time) * (std::cos(swing * time) + decay / swing * std::sin(swing * time))).real();
}

TEST(OrderInTime, AModeDecaysAsTheMaterialSays) {
  const TetMesh cage = latticeCage(3, 1, 1, 0.25);
  ElasticOptions options;
  options.density = 1000.0;
  options.tolerance = 1e-9;
  std::vector<double> masses = lumped(cage);
  for (double& mass : masses) mass *= options.density;
  for (const double youngsModulus : {1e3, 1e5, 1e7}) {
    options.youngsModulus = youngsModulus;
    ElasticBody<double> still = made<double>(cage, options);
    for (const Eigen::Index number : {0, 4}) {
      const Mode mode = modeOf(still, cage, masses, number);
      for (const double perStep : {0.02, 0.05, 0.1}) {  // radians
        const double seconds = perStep / mode.frequency;
        const int steps = static_cast<int>(10.0 / perStep);
        for (const double damping : {0.0, 0.001, 0.02, 0.1, 1.0}) {
          if (damping * mode.frequency > 60.0) continue;  // it would not have moved yet
          options.stiffnessDamping = damping;
          EXPECT_NEAR(leftOfMode(cage, options, mode, masses, seconds, steps),
                      exactlyLeft(mode.frequency, damping, steps * seconds), 6.0 * perStep * perStep)
              << youngsModulus << ' ' << number << ' ' << perStep << ' ' << damping;
        }
      }
    }
  }
}

/// A beam in the middle of its swing, with the history of its steps.
ElasticBody<double> swinging(const TetMesh& cage, double damping) {
  ElasticOptions options;
  options.youngsModulus = 1e5;
  options.density = 1000.0;
  options.stiffnessDamping = damping;
  ElasticBody<double> body = made<double>(cage, options);
  pinTheEnd(body, cage);
  for (int k = 0; k < 30; ++k) body.step(1.0 / 240.0, kDown);
  return body;
}

TEST(OrderInTime, ABodyThatIsPutBackToRestStaysThere) {
  const TetMesh cage = beamCage();
  for (const double damping : {0.0, 0.02}) {
    ElasticBody<double> body = swinging(cage, damping);
    ASSERT_GT(fastest(body), 0.5);
    fill(body.positions(), cage.nodes);
    fill(body.velocities(), Points(cage.nodeCount(), Vector3d::Zero()));
    for (int k = 0; k < 5; ++k) body.step(1.0 / 240.0);
    EXPECT_LT(fastest(body), 1e-9) << damping;
  }
}

/// Otherwise the impulses left by the last step would throw the stopped nodes back.
TEST(OrderInTime, ABodyThatIsStoppedStartsAgainAsOneThatHasNeverMoved) {
  const TetMesh cage = beamCage();
  for (const double damping : {0.0, 0.02}) {
    ElasticBody<double> body = swinging(cage, damping), other = swinging(cage, damping);
    fill(body.velocities(), Points(cage.nodeCount(), Vector3d::Zero()));
    const Points stopped = pointsOf(body.positions());
    // Moved there and back, in two steps that begin with another shape.
    fill(other.positions(), cage.nodes);
    fill(other.velocities(), Points(cage.nodeCount(), Vector3d::Zero()));
    other.step(1.0 / 240.0);
    fill(other.positions(), stopped);
    fill(other.velocities(), Points(cage.nodeCount(), Vector3d::Zero()));
    body.step(1.0 / 240.0);
    other.step(1.0 / 240.0);
    const Points one = pointsOf(body.velocities()), another = pointsOf(other.velocities());
    for (std::size_t n = 0; n < cage.nodeCount(); ++n) {
      // The solve is relative to what has stopped it.
      EXPECT_LT((one[n] - another[n]).norm(), 0.05 * fastest(body)) << damping << ' ' << n;
    }
  }
}

TEST(OrderInTime, ReadingForcesAndEnergyChangesNothing) {
  const TetMesh cage = beamCage();
  ElasticBody<double> body = swinging(cage, 0.0), read = swinging(cage, 0.0);
  for (int k = 0; k < 60; ++k) {
    body.step(1.0 / 240.0, kDown);
    read.step(1.0 / 240.0, kDown);
    EXPECT_GT(read.energy(), 0.0);
    EXPECT_EQ(read.forces().size(), cage.nodeCount());
    ASSERT_EQ(pointsOf(read.positions()), pointsOf(body.positions())) << k;
    ASSERT_EQ(pointsOf(read.velocities()), pointsOf(body.velocities())) << k;
  }
}

}  // namespace
}  // namespace tetskin::test
