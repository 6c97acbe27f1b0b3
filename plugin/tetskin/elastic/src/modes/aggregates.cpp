// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// This work is based on:
//   Teofilo Gonzalez, "Clustering to Minimize the Maximum Intercluster Distance", Theor. Comput. Sci. 38, 1985
#include <tetskin/elastic/src/modes/aggregates.h>

#include <algorithm>
#include <cassert>
#include <limits>

namespace tetskin::elastic_detail {

Aggregates aggregate(const Lists<>& neighbours, int maximum) {
  const std::size_t nodes = neighbours.starts.size() - 1;
  assert(nodes > 0 && maximum > 0);
  Aggregates result{std::vector<int>(nodes, -1), 0};
  std::vector<int> distance(nodes, std::numeric_limits<int>::max());
  std::vector<std::uint32_t> queue;
  std::size_t seed = 0;
  while (result.count < maximum && distance[seed] > 0) {
    const int group = result.count++;
    distance[seed] = 0;
    result.indices[seed] = group;
    queue.assign(1, static_cast<std::uint32_t>(seed));
    for (std::size_t k = 0; k < queue.size(); ++k) {
      const std::uint32_t node = queue[k];
      for (std::uint32_t j = neighbours.starts[node]; j < neighbours.starts[node + 1]; ++j) {
        const std::uint32_t other = neighbours.values[j];
        if (distance[other] <= distance[node] + 1) continue;
        distance[other] = distance[node] + 1;
        result.indices[other] = group;
        queue.push_back(other);
      }
    }
    seed = static_cast<std::size_t>(std::max_element(distance.begin(), distance.end()) - distance.begin());
  }
  return result;
}

}  // namespace tetskin::elastic_detail
