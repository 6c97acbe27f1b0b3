// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#define TETSKIN_KERNELS unfused
#define TETSKIN_LANES 8
#include <tetskin/elastic/src/kernels/elastic_loops.h>
