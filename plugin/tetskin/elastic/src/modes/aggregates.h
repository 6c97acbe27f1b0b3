// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/src/shared/base/lists.h>

#include <vector>

namespace tetskin::elastic_detail {

/// Groups of neighbouring nodes.
struct Aggregates {
  std::vector<int> of;  ///< by node
  int count = 0;
};

/// At most so many groups, each of the nodes that are nearest to one of them, counted in edges: seeds are as far from
/// each other as they can be, so that groups are round and of like size. The graph must be connected.
/// neighbours  by node
/// Cost        O(groups x nodes)
Aggregates aggregate(const Lists<>& neighbours, int most);

}  // namespace tetskin::elastic_detail
