// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#define TETSKIN_KERNELS avx512
#include <tetskin/core/src/kernels/filter_loop.h>
#include <tetskin/core/src/kernels/skinning_loops.h>

namespace tetskin::kernels::avx512 {

const Table<float> tableFloat = table<float, 4>();
const Table<double> tableDouble = table<double, 2>();
const SelectEntries select = selectEntries<16>;

}  // namespace tetskin::kernels::avx512
