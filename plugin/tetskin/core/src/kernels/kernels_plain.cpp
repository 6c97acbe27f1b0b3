// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#define TETSKIN_KERNELS plain
#define TETSKIN_LANES 1
#define TETSKIN_PLAIN_LANES
#include <tetskin/core/src/kernels/skinning_loops.h>
