// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal: all loops behind skinning_kernels.h, P points at a time. Included once for each instruction set.
#pragma once

#include <tetskin/core/src/kernels/bone_loops.h>
#include <tetskin/core/src/kernels/direction_loops.h>
#include <tetskin/core/src/kernels/gradient_loops.h>
#include <tetskin/core/src/kernels/path_loops.h>
#include <tetskin/core/src/kernels/position_loops.h>

namespace tetskin::kernels::TETSKIN_KERNELS {

template <class S, int P>
constexpr Table<S> table() {
  return {positions<S, P>, directions<S, P>, gradients<S, P>, edges<S>, bends<S>, bones<S>, pathNormals<S>};
}

}  // namespace tetskin::kernels::TETSKIN_KERNELS
