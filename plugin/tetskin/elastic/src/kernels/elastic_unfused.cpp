// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#define TETSKIN_KERNELS unfused
#include <tetskin/elastic/src/kernels/elastic_loops.h>

namespace tetskin::kernels::unfused {

const ElasticTable<float> elasticFloat = elasticTable<float, 8>();
const ElasticTable<double> elasticDouble = elasticTable<double, 4>();

}  // namespace tetskin::kernels::unfused
