// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#define TETSKIN_KERNELS avx512
#define TETSKIN_LANES 16
#include <tetskin/core/src/kernels/skinning_loops.h>
