// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// One unit, two instruction sets: as a unity build may join them.

#define TETSKIN_KERNELS first_of_unit
#include <tetskin/core/src/base/kernels/lanes.h>
#undef TETSKIN_KERNELS
#define TETSKIN_KERNELS second_of_unit
#include <tetskin/core/src/base/kernels/lanes.h>
#undef TETSKIN_KERNELS

namespace tetskin::kernels {
namespace {

TEST(Lanes, OneUnitHasThemInEachOfItsNamespaces) {
  const auto a = first_of_unit::laneNumbers<float, 4>();
  const auto b = second_of_unit::laneNumbers<float, 4>();
  EXPECT_EQ(a[3], 3.0f);
  EXPECT_EQ(b[3], 3.0f);
  EXPECT_EQ(first_of_unit::smaller(1.0f, 2.0f), 1.0f);
  EXPECT_EQ(second_of_unit::squareRoot(9.0), 3.0);
}

}  // namespace
}  // namespace tetskin::kernels
