// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#define TETSKIN_KERNELS baseline
#include <tetskin/core/src/kernels/filter_loop.h>
#include <tetskin/core/src/kernels/skinning_loops.h>

namespace tetskin::kernels::baseline {

const Table<float> tableFloat = table<float, 1>();
const Table<double> tableDouble = table<double, 1>();
const SelectEntries select = selectEntries<4>;

}  // namespace tetskin::kernels::baseline
