// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal: all loops behind elastic_kernels.h, W tets or rows at a time. Included once per instruction set, with
// TETSKIN_KERNELS, its namespace, and TETSKIN_LANES, the number of floats at a time; for doubles, half as many.
#pragma once

#ifndef TETSKIN_LANES  // compiled on its own, as a check
#define TETSKIN_KERNELS plain
#define TETSKIN_LANES 1
#endif

#include <tetskin/elastic/src/kernels/quadratic_tet_loops.h>
#include <tetskin/elastic/src/kernels/row_loops.h>
#include <tetskin/elastic/src/kernels/tet_loops.h>

namespace tetskin::kernels::TETSKIN_KERNELS {

template <class S, int W>
constexpr ElasticTable<S> elasticTable() {
  return {{forces<S, W>, rotatedGradients<S, W>},
          {quadraticForces<S, W>, quadraticRotatedGradients<S, W>},
          sum<S>,
          assemble<S, W>,
          multiply<S, W>,
          multiplyByDifferences<S, W>,
          backward<S, W>,
          forward<S, W>,
          advance<S, W>,
          lower<S, W>,
          difference<S, W>,
          inner<S, W>};
}

const ElasticTable<float> elasticFloat = elasticTable<float, TETSKIN_LANES>();
const ElasticTable<double> elasticDouble = elasticTable<double, (TETSKIN_LANES + 1) / 2>();

}  // namespace tetskin::kernels::TETSKIN_KERNELS
