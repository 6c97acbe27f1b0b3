// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/kernels/instruction_set.h>
#include <tetskin/core/src/kernels/kernel_tables.h>

namespace tetskin::kernels {

template <>
const Table<float>& tableInUse() {
  TETSKIN_RETURN_IN_USE(tableFloat);
}
template <>
const Table<double>& tableInUse() {
  TETSKIN_RETURN_IN_USE(tableDouble);
}

SelectEntries selectInUse() {
  TETSKIN_RETURN_IN_USE(select);
}

}  // namespace tetskin::kernels
