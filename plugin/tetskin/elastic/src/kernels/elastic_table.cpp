// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/kernels/instruction_set.h>
#include <tetskin/elastic/src/base/elastic_kernels.h>

namespace tetskin::kernels {

template <>
const ElasticTable<float>& elasticInUse() {
  TETSKIN_RETURN_IN_USE(elasticFloat);
}
template <>
const ElasticTable<double>& elasticInUse() {
  TETSKIN_RETURN_IN_USE(elasticDouble);
}

}  // namespace tetskin::kernels
