// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#define TETSKIN_KERNELS baseline
#define TETSKIN_LANES 4
#include <tetskin/core/src/kernels/skinning_loops.h>
