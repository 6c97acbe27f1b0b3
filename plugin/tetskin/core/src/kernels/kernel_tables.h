// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal: the kernels of `instructionSet()`, for this processor.
#pragma once

#include <tetskin/core/src/kernels/search_kernels.h>
#include <tetskin/core/src/kernels/skinning_kernels.h>

namespace tetskin::kernels {

template <class Scalar>
const Table<Scalar>& tableInUse();
template <>
const Table<float>& tableInUse();
template <>
const Table<double>& tableInUse();
SelectEntries selectInUse();

}  // namespace tetskin::kernels
