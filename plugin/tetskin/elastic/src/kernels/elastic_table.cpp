// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/kernels/instruction_set.h>
#include <tetskin/elastic/src/base/elastic_kernels.h>

#ifdef TETSKIN_X86_KERNELS
#define TETSKIN_RETURN_UNFUSED(name) \
  return instructionSet() >= InstructionSet::Avx2 ? unfused_avx2::name : unfused::name
#elif defined(TETSKIN_VECTOR_KERNELS)
#define TETSKIN_RETURN_UNFUSED(name) return unfused::name
#else
#define TETSKIN_RETURN_UNFUSED(name) return plain::name
#endif

namespace tetskin::kernels {

template <>
const ElasticTable<float>& elasticInUse(bool deterministic) {
  if (deterministic) TETSKIN_RETURN_UNFUSED(elasticFloat);
  TETSKIN_RETURN_IN_USE(elasticFloat);
}
template <>
const ElasticTable<double>& elasticInUse(bool deterministic) {
  if (deterministic) TETSKIN_RETURN_UNFUSED(elasticDouble);
  TETSKIN_RETURN_IN_USE(elasticDouble);
}

}  // namespace tetskin::kernels
