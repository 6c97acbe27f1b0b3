// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#define TETSKIN_KERNELS plain
#define TETSKIN_PLAIN_LANES
#include <tetskin/core/src/kernels/filter_loop.h>
#include <tetskin/core/src/kernels/skinning_loops.h>

namespace tetskin::kernels::plain {

const Table<float> tableFloat = table<float, 1>();
const Table<double> tableDouble = table<double, 1>();
const SelectEntries select = selectEntries<1>;

}  // namespace tetskin::kernels::plain
