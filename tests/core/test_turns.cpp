// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/arithmetic/turns.h>

#include <limits>

namespace tetskin {
namespace {

/// A few last digits of numbers about 1.
constexpr double kDigits = 8 * std::numeric_limits<double>::epsilon();

TEST(Turns, SinesAndCosinesAreThoseOfTheCLibraryButForTheLastDigits) {
  std::mt19937 random(1);
  for (const double largest : {1e-9, 0.1, 1.0, 7.0, 100.0}) {
    std::uniform_real_distribution<double> angles(-largest, largest);
    for (int k = 0; k < 20'000; ++k) {
      const double x = angles(random);
      const SineAndCosine made = sineAndCosine(x);
      ASSERT_NEAR(made.sine, std::sin(x), kDigits * std::min(1.0, std::abs(x)) * std::max(1.0, largest)) << x;
      ASSERT_NEAR(made.cosine, std::cos(x), kDigits * std::max(1.0, largest)) << x;
    }
  }
  EXPECT_EQ(sineAndCosine(0.0).sine, 0.0);
  EXPECT_EQ(sineAndCosine(0.0).cosine, 1.0);
}

TEST(Turns, ArcSinesAreThoseOfTheCLibraryButForTheLastDigits) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> sines(-1.0, 1.0);
  for (int k = 0; k < 20'000; ++k) {
    const double x = k % 2 == 0 ? sines(random) : std::copysign(1.0 - std::abs(sines(random)) * 1e-9, sines(random));
    ASSERT_NEAR(arcSine(x), std::asin(x), 20 * kDigits) << x;  // the worst are near 1
  }
  EXPECT_EQ(arcSine(0.0), 0.0);
  EXPECT_NEAR(arcSine(1.0), std::asin(1.0), 2 * kDigits);
  EXPECT_NEAR(arcSine(-1.0), std::asin(-1.0), 2 * kDigits);
}

TEST(Turns, CubeRootsAreThoseOfTheCLibraryButForTheLastDigits) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> exponents(-300.0, 300.0);
  for (int k = 0; k < 20'000; ++k) {
    const double x = std::pow(10.0, exponents(random));
    ASSERT_NEAR(cubeRoot(x) / std::cbrt(x), 1.0, kDigits) << x;
  }
  EXPECT_EQ(cubeRoot(0.0), 0.0);
  EXPECT_EQ(cubeRoot(27.0), 3.0);
  EXPECT_TRUE(std::isinf(cubeRoot(std::numeric_limits<double>::infinity())));
}

}  // namespace
}  // namespace tetskin
