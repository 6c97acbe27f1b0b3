// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal: all loops behind skinning_kernels.h, P points at a time. Included once per instruction set, with
// TETSKIN_KERNELS, its namespace, and TETSKIN_LANES, the number of floats in a register.
#pragma once

#ifndef TETSKIN_LANES  // compiled on its own, as a check
#define TETSKIN_KERNELS plain
#define TETSKIN_LANES 1
#endif

#include <tetskin/core/src/kernels/bone_loops.h>
#include <tetskin/core/src/kernels/direction_loops.h>
#include <tetskin/core/src/kernels/filter_loop.h>
#include <tetskin/core/src/kernels/gradient_loops.h>
#include <tetskin/core/src/kernels/path_loops.h>
#include <tetskin/core/src/kernels/position_loops.h>

namespace tetskin::kernels::TETSKIN_KERNELS {

template <class S, int P>
constexpr Table<S> table() {
  return {positions<S, P>, directions<S, P>, gradients<S, P>, edges<S>, bends<S>, bones<S>, pathNormals<S>};
}

const Table<float> tableFloat = table<float, (TETSKIN_LANES + 3) / 4>();
const Table<double> tableDouble = table<double, (TETSKIN_LANES + 7) / 8>();
const SelectEntries select = selectEntries<TETSKIN_LANES>;

}  // namespace tetskin::kernels::TETSKIN_KERNELS
