// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#define TETSKIN_KERNELS avx2
#include <tetskin/core/src/kernels/filter_loop.h>
#include <tetskin/core/src/kernels/skinning_loops.h>

namespace tetskin::kernels::avx2 {

const Table<float> tableFloat = table<float, 2>();
const Table<double> tableDouble = table<double, 1>();
const SelectEntries select = selectEntries<8>;

}  // namespace tetskin::kernels::avx2
