// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#define TETSKIN_KERNELS avx2
#define TETSKIN_LANES 8
#include <tetskin/core/src/kernels/skinning_loops.h>
