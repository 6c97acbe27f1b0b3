// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/kernels/dispatch.h>
#include <tetskin/elastic/src/kernels/elastic_kernels.h>

#include <type_traits>

namespace tetskin::kernels {

template <class S>
const ElasticTable<S>& elasticInUse() {
  if constexpr (std::is_same_v<S, float>) {
    return TETSKIN_KERNELS_IN_USE(elasticFloat);
  } else {
    return TETSKIN_KERNELS_IN_USE(elasticDouble);
  }
}

template const ElasticTable<float>& elasticInUse();
template const ElasticTable<double>& elasticInUse();

}  // namespace tetskin::kernels
