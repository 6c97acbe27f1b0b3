// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace tetskin {

/// Lists by key, packed: the list of key k is values[starts[k]] to values[starts[k + 1] - 1].
template <class Value = std::uint32_t>
struct Lists {
  std::vector<std::uint32_t> starts;  ///< keys + 1
  std::vector<Value> values;
};

/// A counting sort; every list keeps the order of the visits. It needs no memory except for the result.
/// forEach  is called twice with a function; must call it with the key and the value of every entry, identically
template <class Value = std::uint32_t, class ForEach>
Lists<Value> packLists(std::size_t keys, ForEach&& forEach) {
  Lists<Value> lists;
  // The counts are stored two entries late. Their running sums are the beginnings of the lists, one entry late; filling
  // moves each beginning to its own entry.
  lists.starts.assign(keys + 2, 0);
  forEach([&](std::size_t key, const Value&) { ++lists.starts[key + 2]; });
  std::partial_sum(lists.starts.begin(), lists.starts.end(), lists.starts.begin());
  lists.values.resize(lists.starts.back());
  forEach([&](std::size_t key, const Value& value) { lists.values[lists.starts[key + 1]++] = value; });
  lists.starts.pop_back();
  assert(lists.starts.back() == lists.values.size());
  return lists;
}

}  // namespace tetskin
