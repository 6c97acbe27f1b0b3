// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/arithmetic/logarithms.h>
#include <tetskin/core/src/base/hash.h>
#include <tetskin/core/src/base/lists.h>
#include <tetskin/core/src/base/median.h>

#include <cmath>
#include <map>
#include <set>

namespace tetskin {
namespace {

TEST(PackLists, HoldEveryValueOfTheirKeyInTheOrderOfTheVisits) {
  std::mt19937 random(4);
  for (const std::size_t keys : {std::size_t{0}, std::size_t{1}, std::size_t{7}, std::size_t{1000}}) {
    std::vector<std::pair<std::size_t, std::uint32_t>> entries;
    for (std::uint32_t k = 0; keys > 0 && k < 500; ++k) entries.emplace_back(random() % keys, random());
    std::map<std::size_t, std::vector<std::uint32_t>> expected;
    for (const auto& [key, value] : entries) expected[key].push_back(value);
    const Lists<> lists = packLists(keys, [&](auto&& add) {
      for (const auto& [key, value] : entries) add(key, value);
    });
    ASSERT_EQ(lists.starts.size(), keys + 1);
    ASSERT_EQ(lists.values.size(), entries.size());
    for (std::size_t k = 0; k < keys; ++k) {
      const auto begin = lists.values.begin() + lists.starts[k], end = lists.values.begin() + lists.starts[k + 1];
      EXPECT_EQ(std::vector<std::uint32_t>(begin, end), expected[k]);
    }
  }
}

TEST(Hash, TellsNeighbouringWordsApartAndNotTheSignOfZero) {
  // The words are like the coordinates of a grid: the last bits of the index in a table must also depend on a word's
  // first bits.
  for (const int shift : {0, 32, 48, 52}) {
    std::set<std::uint32_t> indices;
    for (std::uint64_t word = 0; word < 4096; ++word) {
      Hash hash;
      hash.add(word << shift);
      indices.insert(hash.mixed() & 0xFFFFu);
    }
    EXPECT_GT(indices.size(), 3500u) << shift;
  }
  Hash plus, minus;
  plus.add(0.0);
  minus.add(-0.0);
  EXPECT_EQ(plus.value(), minus.value());
}

TEST(Median, IsTheUpperOfTheTwoInTheMiddle) {
  EXPECT_EQ(median({7.0}), 7.0);
  EXPECT_EQ(median({3.0, 1.0, 2.0}), 2.0);
  EXPECT_EQ(median({4.0, 1.0, 3.0, 2.0}), 3.0);
}

TEST(Logarithms, AgreeWithThoseOfTheLibrary) {
  for (const double x : {1e-320, 1e-300, 1e-9, 0.3, 0.7, 1.0, 1.4, 2.0, 1e5, 1e300}) {
    const double exact = std::log(x);
    EXPECT_NEAR(portableLog(x), exact, 1e-14 * (1 + std::abs(exact)));
    EXPECT_NEAR(portableExp(exact), std::exp(exact), 1e-14 * (1 + std::abs(exact)) * std::exp(exact)) << x;
  }
  EXPECT_EQ(portableLog(1.0), 0.0);
  EXPECT_EQ(portableExp(0.0), 1.0);
}

}  // namespace
}  // namespace tetskin
