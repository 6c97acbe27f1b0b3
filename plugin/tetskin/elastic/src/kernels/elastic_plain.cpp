// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#define TETSKIN_KERNELS plain
#define TETSKIN_PLAIN_LANES
#include <tetskin/elastic/src/kernels/elastic_loops.h>

namespace tetskin::kernels::plain {

const ElasticTable<float> elasticFloat = elasticTable<float, 1>();
const ElasticTable<double> elasticDouble = elasticTable<double, 1>();

}  // namespace tetskin::kernels::plain
