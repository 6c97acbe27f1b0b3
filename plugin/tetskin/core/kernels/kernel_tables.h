// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to skinning: the kernels for this processor.
#pragma once

#include <tetskin/core/kernels/skinning_kernels.h>

namespace tetskin::kernels {

/// Those of `instructionSet()`.
template <class Scalar>
const Table<Scalar>& tableInUse();

}  // namespace tetskin::kernels
