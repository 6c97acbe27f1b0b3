// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <algorithm>
#if defined(__wasm_simd128__)
#include <wasm_simd128.h>
#endif

namespace tetskin {

/// std::max, to the bit, including values that are not finite; for loops in which either number may be the larger one.
/// V8 compiles a scalar choice in WebAssembly to a jump, which processors mispredict, but this to one instruction.
template <class S>
S larger(S a, S b) {
  return std::max(a, b);
}

#if defined(__wasm_simd128__)
inline float larger(float a, float b) {
  return wasm_f32x4_extract_lane(wasm_f32x4_pmax(wasm_f32x4_splat(a), wasm_f32x4_splat(b)), 0);
}
#endif

}  // namespace tetskin
