// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#define TETSKIN_KERNELS baseline
#include <tetskin/elastic/src/kernels/elastic_loops.h>

namespace tetskin::kernels::baseline {

const ElasticTable<float> elasticFloat = elasticTable<float, 4>();
const ElasticTable<double> elasticDouble = elasticTable<double, 2>();

}  // namespace tetskin::kernels::baseline
