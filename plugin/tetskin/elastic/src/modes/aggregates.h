// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/src/base/lists.h>

#include <vector>

namespace tetskin::elastic_detail {

/// Groups of neighbouring nodes.
struct Aggregates {
  std::vector<int> indices;  ///< by node; -1: no group
  int count = 0;
};

/// At most this many groups; each node belongs to the group whose seed is nearest, counted in edges. Seeds are as far
/// from each other as possible, so that groups are round and of similar size. If the graph has more components than
/// groups, the nodes of the other components are in no group.
/// neighbours  by node
/// Cost        O(groups x nodes)
Aggregates aggregate(const Lists<>& neighbours, int maximum);

}  // namespace tetskin::elastic_detail
