// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/kernels/instruction_set.h>
#include <tetskin/elastic/src/kernels/elastic_kernels.h>

#include <type_traits>

namespace tetskin::kernels {
namespace {

template <class S>
const ElasticTable<S>& pick(const ElasticTable<float>& single, const ElasticTable<double>& twice) {
  if constexpr (std::is_same_v<S, float>) {
    return single;
  } else {
    return twice;
  }
}

}  // namespace

template <class S>
const ElasticTable<S>& elasticInUse() {
#ifdef TETSKIN_X86_KERNELS
  if (instructionSet() == InstructionSet::Avx512) return pick<S>(avx512::elasticFloat, avx512::elasticDouble);
  if (instructionSet() == InstructionSet::Avx2) return pick<S>(avx2::elasticFloat, avx2::elasticDouble);
#endif
#ifdef TETSKIN_VECTOR_KERNELS
  if (instructionSet() == InstructionSet::Baseline) return pick<S>(baseline::elasticFloat, baseline::elasticDouble);
#endif
  return pick<S>(plain::elasticFloat, plain::elasticDouble);
}

template const ElasticTable<float>& elasticInUse();
template const ElasticTable<double>& elasticInUse();

}  // namespace tetskin::kernels
