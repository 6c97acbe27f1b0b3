// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#define TETSKIN_KERNELS baseline
#include <tetskin/core/kernels/skinning_loops.h>

namespace tetskin::kernels::baseline {

const Table<float> tableFloat = table<float, 4>();
const Table<double> tableDouble = table<double, 2>();

}  // namespace tetskin::kernels::baseline
