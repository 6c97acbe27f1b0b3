// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/mesh/tet_geometry.h>
#include <tetskin/elastic/src/tets/corotated_tets.h>

#include <set>

#include "elastic_fixtures.h"
#include "support/odd_meshes.h"
#include "support/shuffled_threads.h"

namespace tetskin::test {
namespace {

/// The tets of a cage alone, with nodes in slots of another order, and with spare slots.
template <class S>
class Tets {
 public:
  /// scale  by tet, of the stiffness
  Tets(const Cage& cage, const std::vector<double>& scale, const Lame& lame = kLame)
      : slotOf_(slots(cage.mesh.nodeCount())),
        tets_(elastic_detail::restTets(cage, quadraticTets(cage).value(), scale), slotOf_,
              cage.mesh.nodeCount() + kSpare) {
    tets_.setMaterial(lame);
  }

  Points forces(const Points& nodes, ParallelFor* threads = nullptr) {
    std::vector<S> out(4 * (nodes.size() + kSpare), S(-77));
    tets_.forces(toSlots(nodes).data(), out.data(), threads);
    Points result(nodes.size());
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      for (int k = 0; k < 3; ++k) result[n][k] = out[4 * slotOf_[n] + static_cast<std::size_t>(k)];
    }
    return result;
  }
  double energy(const Points& nodes, ParallelFor* threads = nullptr) {
    return tets_.energy(toSlots(nodes).data(), threads);
  }
  /// Iterates until the rotations have converged.
  void settle(const Points& nodes) {
    for (int k = 0; k < 10; ++k) forces(nodes);
  }
  CorotatedTets<S>& tets() { return tets_; }

 private:
  static constexpr std::size_t kSpare = 5;

  static std::vector<std::uint32_t> slots(std::size_t nodes) {
    std::vector<std::uint32_t> slotOf(nodes);
    for (std::size_t n = 0; n < nodes; ++n) slotOf[n] = static_cast<std::uint32_t>(nodes + kSpare - 1 - n);
    return slotOf;
  }
  std::vector<S> toSlots(const Points& nodes) const {
    std::vector<S> points(4 * (nodes.size() + kSpare), std::numeric_limits<S>::quiet_NaN());
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      for (int k = 0; k < 3; ++k) points[4 * slotOf_[n] + static_cast<std::size_t>(k)] = static_cast<S>(nodes[n][k]);
    }
    return points;
  }

  std::vector<std::uint32_t> slotOf_;
  CorotatedTets<S> tets_;
};

double largest(const Points& vectors) {
  double maximum = 0.0;
  for (const Vector3d& v : vectors) {
    if (!v.allFinite()) return std::numeric_limits<double>::infinity();
    maximum = std::max(maximum, v.norm());
  }
  return maximum;
}

double farthest(const Points& a, const Points& b) {
  Points apart;
  for (std::size_t k = 0; k < a.size(); ++k) apart.push_back(a[k] - b[k]);
  return largest(apart);
}

template <class S>
class CorotatedTetsOf : public WithScalar<S> {
 protected:
  static constexpr bool kDouble = sizeof(S) == sizeof(double);
};
TYPED_TEST_SUITE(CorotatedTetsOf, Scalars);

/// Calls visit(cage, scale) for the odd cages, each with every instruction set.
template <class Visit>
void onEachCage(Visit&& visit) {
  for (const Cage& cage : oddCages()) {
    const testing::ScopedTrace trace(__FILE__, __LINE__, std::to_string(quadraticTets(cage).value().size()));
    onEachInstructionSet([&] { visit(cage, variedScale(cage)); });
  }
}

void expectForcesAreTheSlopeOfTheEnergy(const Cage& cage, const std::vector<double>& scale, const Points& nodes) {
  Tets<double> tets(cage, scale);
  tets.settle(nodes);
  const Points forces = tets.forces(nodes);
  constexpr double kStep = 1e-6;
  Points slopes(nodes.size());
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    for (int k = 0; k < 3; ++k) {
      Points before = nodes, after = nodes;
      before[n][k] -= kStep;
      after[n][k] += kStep;
      slopes[n][k] = (tets.energy(before) - tets.energy(after)) / (2.0 * kStep);
    }
  }
  EXPECT_LT(farthest(forces, slopes), 1e-8 * largest(forces));
}

TEST(CorotatedTets, ForcesAreTheSlopeOfTheEnergy) {
  onEachCage([](const Cage& cage, const std::vector<double>& scale) {
    for (const unsigned seed : {1u, 2u, 3u}) {
      const Points turned = mapped(cage.mesh.nodes, turnBy(40.0 * seed, {1, 2, -1}), {1, 2, 3});
      expectForcesAreTheSlopeOfTheEnergy(cage, scale, scattered(turned, 0.05 * seed, seed));
    }
  });
}

/// The energy by singular values: that of the least strain that a rotation leaves.
double exactEnergy(const Cage& cage, const std::vector<double>& scale, const Points& nodes) {
  double total = 0.0;
  for (const PlainPoint& point : plainPoints(cage, scale)) {
    const Matrix3d f = point.gradientAt(nodes);
    Vector3d strain = singularValuesOf(f);
    if (f.determinant() < 0.0) strain[2] = -strain[2];
    strain.array() -= 1.0;
    total += point.volume * (kLame.mu * strain.squaredNorm() + 0.5 * kLame.lambda * strain.sum() * strain.sum());
  }
  return total;
}

/// A body at rest that is turned at once is free of forces, and a deformed one keeps its energy.
TYPED_TEST(CorotatedTetsOf, FindTheirRotationsAtOnceHoweverFarTheyHaveTurned) {
  Random random(61);
  std::vector<Vector3d> axes{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {1, 2, 3}};
  for (int k = 0; k < 10; ++k) axes.push_back(random.vector());
  onEachCage([&](const Cage& cage, const std::vector<double>& scale) {
    for (const Vector3d& axis : axes) {
      for (const double degrees : {60.0, 90.0, 120.0, 170.0, 179.0, 179.9, 179.99, 180.0}) {
        for (const double stretch : {1.0, 1.3, -0.7}) {  // along x; with the last value it is inside out
          const Matrix3d gradient = Vector3d(stretch, 1.1, 0.8).asDiagonal();
          Tets<TypeParam> tets(cage, scale);
          tets.settle(mapped(cage.mesh.nodes, gradient, {0, 0, 0}));
          const Points turned = mapped(cage.mesh.nodes, turnBy(degrees, axis) * gradient, {1, 2, 3});
          const double exact = exactEnergy(cage, scale, turned);
          tets.forces(turned);
          EXPECT_NEAR(tets.energy(turned), exact, (this->kDouble ? 1e-9 : 1e-4) * exact)
              << degrees << " degrees about " << axis.transpose() << ", stretched " << stretch;
        }
      }
    }
  });
}

TYPED_TEST(CorotatedTetsOf, FindTheRotationsOfAnyGradientFromAnyOther) {
  const TetMesh mesh = singleTet();
  onEachInstructionSet([&] {
    const Cage cage(mesh);
    const std::vector<double> scale = variedScale(cage);
    Random random(62);
    Tets<TypeParam> tets(cage, scale);
    int inverted = 0;
    for (int k = 0; k < 500; ++k) {
      Matrix3d gradient;
      for (int i = 0; i < 9; ++i) gradient(i / 3, i % 3) = random();
      inverted += gradient.determinant() < 0.0;
      const Points nodes = mapped(mesh.nodes, gradient, {0, 0, 0});
      tets.forces(nodes);  // starts from the rotation of the previous gradient
      EXPECT_NEAR(tets.energy(nodes), exactEnergy(cage, scale, nodes), 3e-3) << gradient;
    }
    EXPECT_GT(inverted, 100);
  });
}

TEST(CorotatedTets, ForcesAreTheSlopeOfTheEnergyInsideOut) {
  Matrix3d mirror = Vector3d(1.3, 0.9, -0.7).asDiagonal();
  onEachCage([&](const Cage& cage, const std::vector<double>& scale) {
    expectForcesAreTheSlopeOfTheEnergy(
        cage, scale, scattered(mapped(cage.mesh.nodes, turnBy(30.0, {1, 2, -1}) * mirror, {1, 2, 3}), 0.03, 5));
  });
}

TYPED_TEST(CorotatedTetsOf, AreFreeOfForceAtRestAndAfterRigidMotions) {
  onEachCage([&](const Cage& cage, const std::vector<double>& scale) {
    for (const double degrees : {0.0, 1.0, 30.0, 90.0, 135.0}) {
      Tets<TypeParam> tets(cage, scale);
      const Points nodes = mapped(cage.mesh.nodes, turnBy(degrees, {0.3, -1, 0.8}), {0.5, -1, 2});
      const double force = largest(tets.forces(nodes)), energy = tets.energy(nodes);
      EXPECT_LT(force, 150.0 * this->kEpsilon);
      EXPECT_LT(energy, 1000.0 * this->kEpsilon * this->kEpsilon);
    }
  });
}

TYPED_TEST(CorotatedTetsOf, FindARotationByAlmostHalfATurn) {
  onEachCage([&](const Cage& cage, const std::vector<double>& scale) {
    for (const Vector3d& axis : {Vector3d(1, 0, 0), Vector3d(0, 0, 1), Vector3d(0.3, -1, 0.8)}) {
      Tets<TypeParam> tets(cage, scale);
      const Points nodes = mapped(cage.mesh.nodes, turnBy(179.0, axis), {0, 0, 0});
      int calls = 1;
      while (calls < 20 && !(largest(tets.forces(nodes)) < 150.0 * this->kEpsilon)) ++calls;
      EXPECT_LE(calls, 3);
    }
  });
}

TYPED_TEST(CorotatedTetsOf, PushAndTurnNothingAsAWhole) {
  onEachCage([&](const Cage& cage, const std::vector<double>& scale) {
    for (const unsigned seed : {1u, 2u, 3u}) {
      Tets<TypeParam> tets(cage, scale);
      const Points nodes = scattered(mapped(cage.mesh.nodes, turnBy(50.0, {1, 1, 0}), {0, 1, 0}), 0.15 * seed, seed);
      tets.settle(nodes);
      const Points forces = tets.forces(nodes);
      Vector3d push = Vector3d::Zero(), turn = Vector3d::Zero();
      for (std::size_t n = 0; n < nodes.size(); ++n) {
        push += forces[n];
        turn += nodes[n].cross(forces[n]);
      }
      ASSERT_GT(largest(forces), 0.3);
      EXPECT_LT(push.norm(), 15.0 * this->kEpsilon * largest(forces));
      EXPECT_LT(turn.norm(), 300.0 * this->kEpsilon * largest(forces));
    }
  });
}

/// Nodes that are in no boundary face.
std::vector<std::size_t> innerNodes(const TetMesh& cage) {
  std::vector<bool> outside(cage.nodeCount(), false);
  for (const auto& face : boundaryFaces(cage)) {
    for (const int n : face) outside[static_cast<std::size_t>(n)] = true;
  }
  std::vector<std::size_t> inner;
  for (std::size_t n = 0; n < cage.nodeCount(); ++n) {
    if (!outside[n]) inner.push_back(n);
  }
  return inner;
}

TYPED_TEST(CorotatedTetsOf, AnEvenStrainHasItsEnergyAndLeavesInnerNodesAlone) {
  Matrix3d strain;
  strain << 0.02, 0.01, -0.03, 0.01, -0.04, 0.02, -0.03, 0.02, 0.03;
  const Lame lame{1.5, 2.5};
  const double density = lame.mu * strain.squaredNorm() + 0.5 * lame.lambda * strain.trace() * strain.trace();
  for (const Cage& cage : {Cage(jittered(latticeCage(4, 3, 3), 0.15, 4)),
                           refineQuadratic(jittered(latticeCage(2, 2, 2), 0.15, 4)).value()}) {
    const std::vector<std::size_t> inner = innerNodes(cage.mesh);
    ASSERT_GE(inner.size(), 12u);
    onEachInstructionSet([&] {
      Tets<TypeParam> tets(cage, {}, lame);
      const Points nodes =
          mapped(cage.mesh.nodes, turnBy(70.0, {1, 2, 3}) * (Matrix3d::Identity() + strain), {0.1, 0.2, 0.3});
      tets.settle(nodes);
      const Points forces = tets.forces(nodes);
      ASSERT_GT(largest(forces), 0.05);
      double maximum = 0.0;
      for (const std::size_t n : inner) maximum = std::max(maximum, forces[n].norm());
      EXPECT_LT(maximum, 300.0 * this->kEpsilon);
      EXPECT_NEAR(tets.energy(nodes) / (totalVolume(cage.mesh) * density), 1.0, 30.0 * this->kEpsilon);
    });
  }
}

/// A small bending, whose displacements are quadratic and whose stress, linear, is in equilibrium without forces
/// inside. Its stress is not uniform: linear tets have forces inside.
TEST(CorotatedTets, QuadraticOnesBendWithoutForcesInside) {
  constexpr double kCurvature = 1e-6;
  const double poisson = 0.5 * kLame.lambda / (kLame.lambda + kLame.mu);
  const TetMesh mesh = jittered(latticeCage(2, 2, 2), 0.15, 4);
  const auto bent = [&](Points nodes) {
    for (Vector3d& p : nodes) {
      const double x = p.x(), y = p.y(), z = p.z();
      p += kCurvature * Vector3d(x * y, 0.5 * (poisson * (z * z - y * y) - x * x), -poisson * y * z);
    }
    return nodes;
  };
  const auto forceInside = [&](const Cage& cage) {
    Tets<double> tets(cage, {});
    const Points forces = tets.forces(bent(cage.mesh.nodes));
    double maximum = 0.0;
    for (const std::size_t n : innerNodes(cage.mesh)) maximum = std::max(maximum, forces[n].norm());
    return maximum / largest(forces);
  };
  onEachInstructionSet([&] {
    const Cage quadratic = refineQuadratic(mesh).value();
    EXPECT_LT(forceInside(quadratic), 1e-4);
    EXPECT_GT(forceInside(Cage(quadratic.mesh)), 0.05);
  });
}

TYPED_TEST(CorotatedTetsOf, ForcesAreInProportionToTheStiffnessOfEachTet) {
  onEachCage([&](const Cage& cage, const std::vector<double>& scale) {
    const Points nodes = scattered(cage.mesh.nodes, 0.1, 8);
    Tets<TypeParam> tets(cage, scale);
    tets.settle(nodes);
    const Points forces = tets.forces(nodes);
    const double energy = tets.energy(nodes);
    // The factor is a power of two, which causes no rounding.
    tets.tets().setMaterial({4 * kLame.mu, 4 * kLame.lambda});
    const Points stiff = tets.forces(nodes);
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      EXPECT_LT((stiff[n] - 4.0 * forces[n]).norm(), 1000.0 * this->kEpsilon * largest(stiff));
    }
    EXPECT_NEAR(tets.energy(nodes) / energy, 4.0, 1000.0 * this->kEpsilon);
    // Only one tet is changed.
    std::vector<double> changed = scale;
    std::set<int> corners(cage.mesh.tets[11].begin(), cage.mesh.tets[11].end());
    changed[11] *= 3.0;
    const std::vector<QuadraticTet> quadratic = quadraticTets(cage).value();
    for (const QuadraticTet& tet : quadratic) {
      if (std::count(tet.tets.begin(), tet.tets.end(), 11) == 0) continue;
      for (const int t : tet.tets) changed[t] = changed[11];
      corners = {tet.nodes.begin(), tet.nodes.end()};
    }
    Tets<TypeParam> others(cage, changed);
    others.settle(nodes);
    const Points other = others.forces(nodes);
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      const double change = (other[n] - forces[n]).norm();
      EXPECT_EQ(change > 1e-3 * largest(forces), corners.count(static_cast<int>(n)) > 0) << n << " " << change;
    }
  });
}

TYPED_TEST(CorotatedTetsOf, FlatCollapsedAndMirroredTetsHaveFiniteForces) {
  const Matrix3d flat = Vector3d(1, 1, 0).asDiagonal(), thread = Vector3d(1, 0, 0).asDiagonal();
  const Matrix3d mirror = Vector3d(1, -1, 1).asDiagonal();
  onEachCage([&](const Cage& cage, const std::vector<double>& scale) {
    for (const Matrix3d& gradient : {flat, thread, mirror, Matrix3d(-Matrix3d::Identity()), Matrix3d(Matrix3d::Zero()),
                                     Matrix3d(1e-20 * mirror), Matrix3d(1e6 * mirror)}) {
      Tets<TypeParam> tets(cage, scale);
      const Points nodes = mapped(cage.mesh.nodes, gradient, {0.1, 0.2, 0.3});
      for (int k = 0; k < 5; ++k) {
        const double force = largest(tets.forces(nodes));
        EXPECT_TRUE(std::isfinite(force)) << gradient;
        EXPECT_GT(force, 0.1) << gradient;
      }
      EXPECT_TRUE(std::isfinite(tets.energy(nodes))) << gradient;
      // The rotations must still work afterwards.
      const Points rest = cage.mesh.nodes;
      tets.settle(rest);
      EXPECT_LT(largest(tets.forces(rest)), 100.0 * this->kEpsilon) << gradient;
    }
  });
}

TYPED_TEST(CorotatedTetsOf, InstructionSetsAgreeToRounding) {
  for (const Cage& cage : oddCages()) {
    const Points nodes = scattered(mapped(cage.mesh.nodes, turnBy(100.0, {1, 2, -1}), {1, 2, 3}), 0.1, 9);
    Points expected;
    double energy = 0.0;
    onEachInstructionSet([&] {
      Tets<TypeParam> tets(cage, variedScale(cage));
      tets.settle(nodes);
      const Points forces = tets.forces(nodes);
      if (expected.empty()) {
        expected = forces;
        energy = tets.energy(nodes);
      }
      EXPECT_LT(farthest(forces, expected), 30.0 * this->kEpsilon * largest(expected));
      EXPECT_NEAR(tets.energy(nodes) / energy, 1.0, 30.0 * this->kEpsilon);
    });
  }
}

/// -V R (2 mu E + lambda tr(E)) g for each node and point, with R by a polar decomposition.
Points plainForces(const Cage& cage, const std::vector<double>& scale, const Points& nodes) {
  Points forces(nodes.size(), Vector3d::Zero());
  for (const PlainPoint& point : plainPoints(cage, scale)) {
    const Matrix3d f = point.gradientAt(nodes), turn = rotationOf(f);
    const Matrix3d strain = turn.transpose() * f - Matrix3d::Identity();
    const Matrix3d stress =
        point.volume * turn * (2.0 * kLame.mu * strain + kLame.lambda * strain.trace() * Matrix3d::Identity());
    for (std::size_t a = 0; a < point.nodes.size(); ++a) {
      forces[point.nodes[a]] -= stress * point.gradients.col(static_cast<Eigen::Index>(a));
    }
  }
  return forces;
}

TYPED_TEST(CorotatedTetsOf, HaveTheForcesOfThePlainFormulas) {
  onEachCage([&](const Cage& cage, const std::vector<double>& scale) {
    const Points nodes = scattered(mapped(cage.mesh.nodes, turnBy(100.0, {1, 2, -1}), {0.1, 0.2, 0.3}), 0.05, 9);
    Tets<TypeParam> tets(cage, scale);
    tets.settle(nodes);
    const Points expected = plainForces(cage, scale, nodes);
    EXPECT_LT(farthest(tets.forces(nodes), expected), 100.0 * this->kEpsilon * largest(expected));
  });
}

/// Else it could rest so, with no stress at any of its points.
TEST(CorotatedTets, AQuadraticTetThatIsInsideOutAtAPointHasTheRotationOfItsMeanGradient) {
  const Cage cage = refineQuadratic(singleTet()).value();
  const std::vector<double> scale(cage.mesh.tetCount(), 1.0);
  int checked = 0;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    const Points nodes = scattered(cage.mesh.nodes, 0.3, seed);
    Matrix3d sum = Matrix3d::Zero();
    double least = 1.0, expected = 0.0, trace = 0.0, volume = 0.0;
    const std::vector<PlainPoint> points = plainPoints(cage, scale);
    for (const PlainPoint& point : points) sum += point.gradientAt(nodes);
    const Matrix3d turn = rotationOf(sum);
    for (const PlainPoint& point : points) {
      const Matrix3d f = point.gradientAt(nodes);
      least = std::min(least, f.determinant());
      trace += (turn.transpose() * f).trace() / static_cast<double>(points.size());
      expected += point.volume * kLame.mu * (f - turn).squaredNorm();
      volume += point.volume;
    }
    if (least > -0.01 || sum.determinant() < 0.1) continue;
    ++checked;
    expected += 0.5 * volume * kLame.lambda * (trace - 3.0) * (trace - 3.0);
    Tets<double> tets(cage, scale);
    tets.settle(nodes);
    EXPECT_NEAR(tets.energy(nodes), expected, 1e-9 * expected) << seed;
  }
  EXPECT_GT(checked, 5);
}

TYPED_TEST(CorotatedTetsOf, TellByHowMuchTheyHaveTurned) {
  onEachCage([&](const Cage& cage, const std::vector<double>& scale) {
    Tets<TypeParam> tets(cage, scale);
    for (const double degrees : {1.0, 5.0, 20.0, -70.0}) {
      const Points before = mapped(cage.mesh.nodes, turnBy(40.0, {1, 2, -1}), {1, 2, 3});
      const Points after = mapped(before, turnBy(degrees, {0, 1, 3}), {1, 2, 3});
      const double angle = std::abs(degrees) * 3.14159265358979323846 / 180.0;
      tets.settle(before);
      static_cast<void>(tets.tets().cornersForMatrix(1, nullptr));
      tets.forces(before);
      // The angle is a square root of rounded values.
      EXPECT_LT(tets.tets().meanTurn(), 10.0 * std::sqrt(this->kEpsilon));
      EXPECT_LT(tets.tets().maxTurn(), 10.0 * std::sqrt(this->kEpsilon));
      tets.settle(after);
      EXPECT_NEAR(tets.tets().maxTurn() / angle, 1.0, 0.01);
      EXPECT_NEAR(tets.tets().meanTurn() / angle, 1.0, 0.03);
    }
  });
}

}  // namespace
}  // namespace tetskin::test
