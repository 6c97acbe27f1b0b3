// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Pressure and gas in an ElasticBody, against exact solutions.
#include <tetskin/elastic/elastic_body.h>
#include <tetskin/elastic/src/dynamics/pressure_law.h>
#include <tetskin/elastic/src/dynamics/pressure_surface.h>

#include <cmath>

#include "elastic_motion.h"
#include "support/hollow_sphere.h"
#include "support/odd_meshes.h"

namespace tetskin::test {
namespace {

template <class S>
class PressureOf : public WithScalar<S> {};
TYPED_TEST_SUITE(PressureOf, Scalars);

/// A hollow sphere of outer radius 1, so much larger than its corners that its volumes are those of spheres.
Cage sphereOfVolume(double inner, int level, int layers, bool quadratic) {
  Cage cage = hollowSphere(inner, 1.0, level, layers);
  const TriangleMesh unit = sphereOf(level);
  double volume = 0.0;
  for (const auto& [a, b, c] : unit.triangles) {
    volume += unit.positions[a].dot(unit.positions[b].cross(unit.positions[c])) / 6.0;
  }
  for (Vector3d& x : cage.mesh.nodes) x *= std::cbrt(4.0 * static_cast<double>(EIGEN_PI) / 3.0 / volume);
  return quadratic ? refineQuadratic(cage).value() : cage;
}

ElasticOptions rubber() {
  ElasticOptions options;
  options.youngsModulus = 1e6;
  options.density = 1000.0;
  options.stiffnessDamping = 0.05;
  return options;
}

/// Lame's displacement of a sphere of outer radius 1 at its inner wall, relative to the radius there.
double lamesStrain(double inner, double pressure, const ElasticOptions& of) {
  const double cube = inner * inner * inner, ratio = of.poissonRatio;
  return pressure * cube / (of.youngsModulus * (1.0 - cube)) * (1.0 - 2.0 * ratio + (1.0 + ratio) / (2.0 * cube));
}

template <class S>
Vector3d netForce(ElasticBody<S>& body, Vector3d& torque, const Vector3d& about) {
  Vector3d sum = Vector3d::Zero();
  torque.setZero();
  const std::vector<std::array<double, 3>> forces = body.forces();
  const Points points = pointsOf(body.positions());
  for (std::size_t n = 0; n < forces.size(); ++n) {
    const Vector3d force(forces[n][0], forces[n][1], forces[n][2]);
    sum += force;
    torque += (points[n] - about).cross(force);
  }
  return sum;
}

TYPED_TEST(PressureOf, AThickSphereGrowsAsLameSaysAtAnyStep) {
  constexpr double kPressure = 1e3;
  for (const bool quadratic : {false, true}) {
    const double inner = quadratic ? 0.5 : 0.8;
    const Cage cage = sphereOfVolume(inner, quadratic ? 2 : 3, quadratic ? 2 : 3, quadratic);
    for (const int substeps : {1, 4, 16}) {
      ElasticBody<TypeParam> body = made<TypeParam>(cage, rubber());
      ASSERT_TRUE(body.setPressure(kPressure).ok());
      const double volume = body.volume();
      EXPECT_NEAR(volume / (4.0 * static_cast<double>(EIGEN_PI) / 3.0 * inner * inner * inner), 1.0, 1e-6);
      for (int k = 0; k < 50 * substeps; ++k) body.step(1.0 / 60.0 / substeps);
      const double strain = std::cbrt(body.volume() / volume) - 1.0;
      EXPECT_NEAR(strain / lamesStrain(inner, kPressure, rubber()), 1.0, 0.03) << quadratic << " " << substeps;
    }
  }
}

TYPED_TEST(PressureOf, ASolidIsStretchedFromOutside) {
  const TetMesh cage = latticeCage(3, 3, 3, 0.2);
  ElasticBody<TypeParam> body = made<TypeParam>(cage, rubber());
  constexpr double kPressure = 1e4;
  ASSERT_TRUE(body.setPressure(kPressure).ok());
  EXPECT_NEAR(body.volume() / totalVolume(cage), 1.0, 1e-6);
  const double volume = body.volume();
  for (int k = 0; k < 80; ++k) body.step(1.0 / 60.0);
  // Corotated stress belongs to the area at rest, and pressure to that of now, which has grown by 1 + e squared.
  const double strain = std::cbrt(body.volume() / volume) - 1.0, bulk = 1e6 / (3.0 * (1.0 - 0.6));
  EXPECT_NEAR(3.0 * bulk * strain / (kPressure * (1.0 + strain) * (1.0 + strain)), 1.0, 0.002);
}

TYPED_TEST(PressureOf, ForcesOnAClosedSurfaceHaveNoSumAndNoTorque) {
  for (const bool quadratic : {false, true}) {
    const Cage cage = sphereOfVolume(0.5, quadratic ? 1 : 2, 2, quadratic);
    ElasticBody<TypeParam> body = made<TypeParam>(cage, rubber()), free = made<TypeParam>(cage, rubber());
    constexpr double kPressure = 1e5;
    ASSERT_TRUE(body.setPressure(kPressure).ok());
    Random random(7);
    Points points = cage.mesh.nodes;
    for (Vector3d& x : points) x = x + 0.03 * random.vector() + Vector3d(3, -2, 1);
    fill(body.positions(), points);
    fill(free.positions(), points);
    Vector3d torque, elasticTorque;
    const Vector3d about(3, -2, 1);
    const Vector3d sum = netForce(body, torque, about) - netForce(free, elasticTorque, about);
    const double area = 4.0 * static_cast<double>(EIGEN_PI) * 0.25;
    // Each float force is rounded; its own bodies have forces of 1e5.
    EXPECT_LT(sum.norm() / (kPressure * area), 1e-6);
    EXPECT_LT((torque - elasticTorque).norm() / (kPressure * area), 1e-6);
  }
}

TEST(Pressure, ForcesAreTheSlopesOfTheEnergy) {
  for (const bool quadratic : {false, true}) {
    for (const int kind : {0, 1, 2, 3}) {
      const Cage cage = sphereOfVolume(0.5, 1, 1, quadratic);
      ElasticBody<double> body = made<double>(cage, rubber());
      const Status status = kind == 0   ? body.setPressure(2e4)
                            : kind == 1 ? body.setPressure(-2e4)
                            : kind == 2 ? body.setGas(2e4)
                                        : body.setGas(2e4, 1e5);
      ASSERT_TRUE(status.ok()) << status.message;
      Random random(3);
      Points points = cage.mesh.nodes;
      for (Vector3d& x : points) x = 1.1 * x + 0.02 * random.vector();
      fill(body.positions(), points);
      const std::vector<std::array<double, 3>> forces = body.forces();
      for (const std::size_t n : {0u, 5u, 11u}) {
        for (int k = 0; k < 3; ++k) {
          constexpr double kStep = 1e-5;
          double energies[2];
          for (const int side : {0, 1}) {
            Points moved = points;
            moved[n][k] += side == 0 ? -kStep : kStep;
            fill(body.positions(), moved);
            energies[side] = body.energy();
          }
          EXPECT_NEAR(forces[n][static_cast<std::size_t>(k)], (energies[0] - energies[1]) / (2 * kStep), 0.05);
        }
      }
    }
  }
}

TEST(Pressure, TheLawOfEnergyHoldsAtAllVolumes) {
  using elastic_detail::PressureLaw;
  for (const PressureLaw& law :
       {PressureLaw{PressureLaw::Kind::Constant, 3.0, 0.0, 2.0},
        PressureLaw{PressureLaw::Kind::Constant, -3.0, 0.0, 2.0}, PressureLaw{PressureLaw::Kind::Gas, 3.0, 0.0, 2.0},
        PressureLaw{PressureLaw::Kind::Gas, -1.0, 5.0, 2.0}}) {
    EXPECT_NEAR(law.energy(2.0), 0.0, 1e-12);
    EXPECT_EQ(law.at(2.0), law.pressure);
    for (const double volume :
         {-260.0, -240.0, -140.0, -2.0, 0.001, 0.03, 0.05, 0.15, 0.3, 1.0, 2.0, 20.0, 120.0, 140.0, 240.0, 260.0}) {
      constexpr double kStep = 1e-6;
      const auto slope = [&](auto&& f) { return (f(volume + kStep) - f(volume - kStep)) / (2 * kStep); };
      EXPECT_NEAR(law.at(volume), -slope([&](double v) { return law.energy(v); }),
                  1e-5 * (1 + std::abs(law.at(volume))));
      // The matrix takes no slope below 0, as that of a body that is far inside out.
      const double exact = std::max(-slope([&](double v) { return law.at(v); }), 0.0);
      EXPECT_NEAR(law.slope(volume), exact, 1e-5 * (1 + law.slope(volume)));
      EXPECT_GE(law.slope(volume), 0.0);
    }
    for (const double volume : {-1e6, -1.0, 0.0, 1e-9, 1e9}) EXPECT_TRUE(std::isfinite(law.at(volume)));
  }
}

/// Half of a flat bipyramid over a regular octagon of radius 1, whose wall faces inwards.
void appendLens(TriangleMesh& to, int firstOfRim, int sideOf) {
  const int up = static_cast<int>(to.vertexCount());
  to.positions.insert(to.positions.end(),
                      {Vector3d(0, 0.5 * sideOf, 0.2), Vector3d(0, 0.5 * sideOf, -0.2), Vector3d(0, 0.1 * sideOf, 0)});
  for (int k = 0; k < 6; ++k) {
    const auto rim = [&](int at) { return at % 6 == 5 ? up + 2 : (firstOfRim + at % 6) % 8; };
    to.triangles.push_back({up, rim(k + 1), rim(k)});
    to.triangles.push_back({up + 1, rim(k), rim(k + 1)});
  }
}

TEST(Pressure, HollowsThatTouchTheOutsideAreHollows) {
  // Each edge of the rim is one of two hollows and of both halves of the outside.
  TriangleMesh mesh;
  for (int k = 0; k < 8; ++k) {
    const double angle = 0.25 * k * static_cast<double>(EIGEN_PI);
    mesh.positions.emplace_back(std::cos(angle), std::sin(angle), 0);
  }
  appendLens(mesh, 0, 1);
  appendLens(mesh, 4, -1);
  const int top = static_cast<int>(mesh.vertexCount());
  mesh.positions.insert(mesh.positions.end(), {Vector3d(0, 0, 1), Vector3d(0, 0, -1)});
  for (int k = 0; k < 8; ++k) {
    mesh.triangles.push_back({top, k, (k + 1) % 8});
    mesh.triangles.push_back({top + 1, (k + 1) % 8, k});
  }
  std::vector<std::array<double, 3>> positions;
  std::vector<elastic_detail::SurfaceVertex> vertices;
  for (const Vector3d& x : mesh.positions) {
    vertices.push_back({{{static_cast<int>(positions.size()), 1.0}, {0, 0.0}, {0, 0.0}, {0, 0.0}}});
    positions.push_back({x[0], x[1], x[2]});
  }
  const auto surface = elastic_detail::PressureSurface::ofMesh(positions, mesh.triangles, vertices);
  ASSERT_TRUE(surface.ok()) << surface.status().message;
  EXPECT_TRUE(surface.value().isHollow());
  const double half = std::sqrt(2.0) - 0.1;  // the area of a lens
  EXPECT_NEAR(surface.value().restVolume(), 2 * half * 0.4 / 3, 1e-9);
}

TEST(Pressure, AStiffnessScaleCountsWheneverItIsSet) {
  const Cage cage = hollowSphere(0.45, 0.5, 1, 1);
  const auto after = [&](bool first) {
    ElasticBody<double> body = made<double>(cage, rubber());
    const std::vector<double> factors(cage.mesh.tetCount(), 0.05);
    if (first) {
      EXPECT_TRUE(body.setStiffnessScale(factors).ok());
    }
    EXPECT_TRUE(body.setPressure(1e3).ok());
    if (!first) {
      EXPECT_TRUE(body.setStiffnessScale(factors).ok());
    }
    for (int k = 0; k < 5; ++k) body.step(1.0 / 60.0);
    return pointsOf(body.positions());
  };
  EXPECT_EQ(after(true), after(false));
}

TYPED_TEST(PressureOf, AGasKeepsPressureTimesVolume) {
  const Cage cage = sphereOfVolume(0.9, 2, 1, false);
  ElasticBody<TypeParam> body = made<TypeParam>(cage, rubber());
  ASSERT_TRUE(body.setGas(2e4, 1e5).ok());
  const double amount = 1.2e5 * body.volume();
  EXPECT_NEAR(body.pressure(), 2e4, 1.0);
  for (int k = 0; k < 100; ++k) body.step(1.0 / 60.0);
  EXPECT_LT(body.pressure(), 1.9e4);
  EXPECT_NEAR((body.pressure() + 1e5) * body.volume() / amount, 1.0, 1e-6);
  ASSERT_TRUE(body.setPressure(0).ok());
  EXPECT_EQ(body.pressure(), 0.0);
  for (int k = 0; k < 200; ++k) body.step(1.0 / 60.0);
  EXPECT_NEAR(std::cbrt(body.volume() * 1.2e5 / amount), 1.0, 1e-4);
}

/// Undamped, from 1e2 to 1e6 Pa, light and heavy: each comes to the same rest by its steps' own damping, or swings
/// about it, without gaining energy.
TYPED_TEST(PressureOf, BalloonsOfAnyMassRestWhereTheirPressureSays) {
  Cage cage = hollowSphere(0.45, 0.5, 1, 1);
  for (const double pressure : {1e2, 1e4, 1e5, 1e6}) {
    for (const bool gas : {false, true}) {
      if (!gas && pressure > 1e4) continue;  // it bursts
      double expected = 0.0;
      for (const double density : {1.0, 100.0, 1e4}) {
        for (const int substeps : {1, 4, 16}) {
          ElasticOptions options = rubber();
          options.density = density;
          options.stiffnessDamping = density > 100.0 ? 0.005 : 0.0;
          ElasticBody<TypeParam> body = made<TypeParam>(cage, options);
          ASSERT_TRUE((gas ? body.setGas(pressure) : body.setPressure(pressure)).ok());
          std::vector<double> masses = lumped(cage.mesh);
          for (double& m : masses) m *= density;
          const double scale = pressure * body.volume();
          double most = 0.0;
          for (int k = 0; k < 60 * substeps; ++k) {
            body.step(1.0 / 60.0 / substeps);
            most = std::max(most, motionOf(body, masses).energy());
          }
          const testing::ScopedTrace trace(__FILE__, __LINE__,
                                           std::to_string(pressure) + " Pa, " + std::to_string(density) + ", " +
                                               std::to_string(substeps) + (gas ? ", gas" : ""));
          EXPECT_LT(most / scale, 0.02);
          if (density == 1.0 && substeps == 1) expected = body.volume();
          EXPECT_NEAR(body.volume() / expected, 1.0, density < 10.0 ? 1e-3 : 0.05);
        }
      }
    }
  }
}

TYPED_TEST(PressureOf, AThinSphereBurstsWhereItsEquilibriumEnds) {
  constexpr double kWall = 0.04;
  ElasticOptions options = rubber();
  options.stiffnessDamping = 0.02;
  const double limit = kWall * options.youngsModulus / (2.0 * (1.0 - kWall / 2) * (1.0 - options.poissonRatio));
  for (const double share : {0.5, 0.8, 1.2}) {
    ElasticBody<TypeParam> body = made<TypeParam>(sphereOfVolume(1.0 - kWall, 2, 1, false), options);
    const double volume = body.volume();
    for (int k = 0; k < 600; ++k) {
      ASSERT_TRUE(body.setPressure(limit * share * std::min(1.0, k / 200.0 + 0.01)).ok());
      body.step(1.0 / 60.0);
    }
    // p R / (2 t E) (1 - nu) = (x - 1) / x^2, with x the stretch.
    const double stretch = 2.0 * (1.0 - std::sqrt(std::max(1.0 - share, 0.0))) / share;
    if (share < 1.0) {
      EXPECT_NEAR(std::cbrt(body.volume() / volume) / stretch, 1.0, 0.06) << share;
    } else {
      EXPECT_GT(body.volume() / volume, 60.0) << share;
    }
  }
}

TYPED_TEST(PressureOf, WhatBurstsOrIsCrushedStaysFinite) {
  const Cage cage = hollowSphere(0.45, 0.5, 1, 1);
  for (const double pressure : {1e5, 1e7, -1e4, -1e6}) {
    for (const double density : {1.0, 1000.0}) {
      ElasticOptions options = rubber();
      options.density = density;
      ElasticBody<TypeParam> body = made<TypeParam>(cage, options);
      const double volume = body.volume();
      ASSERT_TRUE(body.setPressure(pressure).ok());
      for (int k = 0; k < 300; ++k) body.step(1.0 / 60.0);
      ASSERT_LT(fastest(body), kInfinity) << pressure;
      EXPECT_LT(body.volume() / volume, 130.0);
      EXPECT_GT(body.volume() / volume, pressure > 0 ? 2.0 : -0.1);
    }
  }
  // A gas in a body that is flat, or inside out.
  for (const double squeezed : {1e-3, 0.0, -0.5}) {
    ElasticBody<TypeParam> body = made<TypeParam>(cage, rubber());
    ASSERT_TRUE(body.setGas(1e4).ok());
    const double volume = body.volume();
    Points points = cage.mesh.nodes;
    for (Vector3d& x : points) x.y() *= squeezed;
    fill(body.positions(), points);
    EXPECT_TRUE(std::isfinite(body.pressure()));
    for (int k = 0; k < 300; ++k) body.step(1.0 / 60.0);
    ASSERT_LT(fastest(body), kInfinity) << squeezed;
    EXPECT_GT(body.volume() / volume, 0.9) << squeezed;
  }
}

TYPED_TEST(PressureOf, StepsHaveTheSameBitsWithAnyThreads) {
  const Cage cage = hollowSphere(0.8, 1.0, 4, 1);
  const auto after = [&](ParallelFor* threads) {
    ElasticOptions options = rubber();
    options.deterministic = true;
    ElasticBody<TypeParam> body = made<TypeParam>(cage, options);
    EXPECT_TRUE(body.setGas(1e4).ok());
    for (int k = 0; k < 5; ++k) body.step(1.0 / 240.0, {0, -9.8, 0}, threads);
    return pointsOf(body.positions());
  };
  struct Backwards : ParallelFor {
    void run(std::size_t count, Task task) override {
      for (std::size_t k = count; k-- > 0;) task(k);
    }
  } backwards;
  EXPECT_EQ(after(nullptr), after(&backwards));
}

TEST(Pressure, WhatCannotBeIsRefused) {
  const Cage cage = hollowSphere(0.45, 0.5, 1, 1);
  ElasticBody<float> body = made<float>(cage, rubber());
  ASSERT_TRUE(body.setPressure(100).ok());
  const double none = std::nan("");
  const auto refuses = [&](const Status& status, StatusCode code, const std::string& words) {
    EXPECT_EQ(status.code, code);
    EXPECT_NE(status.message.find(words), std::string::npos) << status.message;
    EXPECT_EQ(body.pressure(), 100.0);
  };
  refuses(body.setPressure(none), StatusCode::NonFinite, "not finite");
  refuses(body.setPressure(kInfinity), StatusCode::NonFinite, "not finite");
  refuses(body.setPressure(1e30), StatusCode::InvalidOption, "too large");
  refuses(body.setPressure(-1e30), StatusCode::InvalidOption, "too large");
  refuses(body.setGas(none), StatusCode::NonFinite, "not finite");
  refuses(body.setGas(-1.0), StatusCode::InvalidOption, "above 0");
  refuses(body.setGas(-2e5, 1e5), StatusCode::InvalidOption, "above 0");
  refuses(body.setGas(10.0, -1.0), StatusCode::InvalidOption, "outside");
  refuses(body.setGas(10.0, none), StatusCode::NonFinite, "not finite");
  refuses(body.setGas(-1e30, 1.0000001e30), StatusCode::InvalidOption, "too large");
  Points points = cage.mesh.nodes;
  for (Vector3d& x : points) x.y() = 0;
  fill(body.positions(), points);
  refuses(body.setGas(10.0), StatusCode::InvalidOption, "crushed");
  EXPECT_FALSE(ElasticBody<float>().setPressure(1).ok());
}

}  // namespace
}  // namespace tetskin::test
