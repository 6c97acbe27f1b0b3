// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/elastic/elastic_body.h>
#include <tetskin/elastic/src/tets/material.h>

namespace tetskin::elastic_detail {
namespace {

TEST(Lame, ParametersOfAKnownMaterial) {
  const Lame quarter = lameOf(1.0, 0.25);
  EXPECT_DOUBLE_EQ(quarter.mu, 0.4);
  EXPECT_DOUBLE_EQ(quarter.lambda, 0.4);
  EXPECT_EQ(lameOf(5.0, 0.0).lambda, 0.0);
}

TEST(Lame, TellYoungsModulusAndPoissonsRatioAgain) {
  for (const double poisson : {0.0, 0.25, 0.49}) {
    const Lame lame = lameOf(3e4, poisson);
    const ElasticModuli moduli = fromLame(lame.mu, lame.lambda);
    EXPECT_NEAR(moduli.youngsModulus, 3e4, 1e-8);
    EXPECT_NEAR(moduli.poissonRatio, poisson, 1e-12);
  }
}

}  // namespace
}  // namespace tetskin::elastic_detail
