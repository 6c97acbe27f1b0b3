// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Where the blocks of a matrix lie, and from which corners of tets each is summed.
#include <gtest/gtest.h>
#include <tetskin/elastic/src/matrix/block_matrix.h>

#include <algorithm>
#include <map>
#include <set>

#include "elastic_fixtures.h"
#include "support/odd_meshes.h"

namespace tetskin {
namespace {

using Eigen::Vector3d;
using elastic_detail::BlockMatrix;
using elastic_detail::BlockPattern;
using kernels::kGroup;

/// The cages for the tests of the pattern; one of them has nodes that no tet uses.
std::vector<TetMesh> patternCages() {
  std::vector<TetMesh> cages{test::singleTet(), test::latticeCage(3, 2, 1), test::bodyCentredCage(3, 3, 2),
                             test::latticeCage(12, 12, 12)};
  cages[1].nodes.insert(cages[1].nodes.end(), 3, Vector3d(5, 5, 5));
  return cages;
}

BlockPattern patternOf(const TetMesh& cage) {
  return BlockMatrix<double>(cage.nodeCount(), cage.tets, test::CorotatedTets<double>::noTet(cage.tetCount()))
      .pattern();
}

/// By slot: its node, -1 where there is none.
std::vector<int> nodesOf(const BlockPattern& pattern) {
  std::vector<int> nodes(pattern.slotCount(), -1);
  for (std::size_t n = 0; n < pattern.slotOf.size(); ++n) nodes[pattern.slotOf[n]] = static_cast<int>(n);
  return nodes;
}

std::vector<std::size_t> coloursOfChunks(const BlockPattern& pattern) {
  std::vector<std::size_t> colours(pattern.chunkCount(), 999);
  for (std::size_t c = 0; c + 1 < pattern.colours.size(); ++c) {
    for (std::size_t chunk = pattern.taskChunks[pattern.colours[c]]; chunk < pattern.taskChunks[pattern.colours[c + 1]];
         ++chunk) {
      colours[chunk] = c;
    }
  }
  return colours;
}

TEST(BlockPattern, EveryNodeHasASlotOfItsOwnAndEveryChunkATaskAndAColour) {
  for (const TetMesh& cage : patternCages()) {
    const BlockPattern pattern = patternOf(cage);
    ASSERT_EQ(pattern.slotOf.size(), cage.nodeCount());
    std::set<std::uint32_t> slots;
    for (const std::uint32_t slot : pattern.slotOf) {
      EXPECT_LT(slot, pattern.slotCount());
      EXPECT_TRUE(slots.insert(slot).second) << slot;
    }
    EXPECT_EQ(pattern.taskChunks.front(), 0u);
    EXPECT_EQ(pattern.taskChunks.back(), pattern.chunkCount());
    EXPECT_TRUE(std::is_sorted(pattern.taskChunks.begin(), pattern.taskChunks.end()));
    EXPECT_EQ(pattern.colours.front(), 0u);
    EXPECT_EQ(pattern.colours.back(), pattern.taskCount());
    EXPECT_TRUE(std::is_sorted(pattern.colours.begin(), pattern.colours.end()));
    const std::vector<std::size_t> colours = coloursOfChunks(pattern);
    EXPECT_EQ(std::count(colours.begin(), colours.end(), 999u), 0);
  }
}

TEST(BlockPattern, NeighboursAreThereOnceFromEachSideAndNeverOfOneColour) {
  for (const TetMesh& cage : patternCages()) {
    const BlockPattern pattern = patternOf(cage);
    const std::vector<int> nodes = nodesOf(pattern);
    const std::vector<std::size_t> colours = coloursOfChunks(pattern);
    std::map<std::pair<int, int>, int> lower, upper;
    for (std::size_t chunk = 0; chunk < pattern.chunkCount(); ++chunk) {
      for (std::size_t e = pattern.starts[2 * chunk]; e < pattern.starts[2 * chunk + 2]; ++e) {
        const bool isLower = e < pattern.starts[2 * chunk + 1];
        for (std::size_t lane = 0; lane < kGroup; ++lane) {
          const std::size_t own = kGroup * chunk + lane, other = pattern.neighbours[kGroup * e + lane];
          if (other == own) continue;  // padding
          ASSERT_GE(nodes[own], 0);
          ASSERT_GE(nodes[other], 0);
          const std::size_t otherColour = colours[other / kGroup];
          EXPECT_TRUE(isLower ? otherColour < colours[chunk] : otherColour > colours[chunk]) << own << " " << other;
          ++(isLower ? lower : upper)[{nodes[own], nodes[other]}];
        }
      }
    }
    std::map<std::pair<int, int>, int> both = lower;
    both.insert(upper.begin(), upper.end());
    EXPECT_EQ(both.size(), lower.size() + upper.size());
    for (const auto& [pair, times] : both) EXPECT_EQ(times, 1) << pair.first << " " << pair.second;
    for (const auto& [pair, times] : lower) EXPECT_EQ(upper.count({pair.second, pair.first}), 1u);
    const auto edges = uniqueEdges(cage);
    EXPECT_EQ(both.size(), 2 * edges.size());
    for (const auto& [a, b] : edges) EXPECT_EQ(both.count({a, b}) + both.count({b, a}), 2u) << a << " " << b;
  }
}

TEST(BlockPattern, EveryTetHasATermInEachOfItsBlocks) {
  for (const TetMesh& cage : patternCages()) {
    const BlockPattern pattern = patternOf(cage);
    const std::vector<int> nodes = nodesOf(pattern);
    const std::size_t none = 4 * test::CorotatedTets<double>::noTet(cage.tetCount());
    const auto nodeAt = [&](std::uint32_t corner) { return cage.tets[corner / 4][corner % 4]; };
    std::size_t terms = 0;
    for (std::size_t chunk = 0; chunk < pattern.chunkCount(); ++chunk) {
      for (std::size_t e = pattern.starts[2 * chunk]; e < pattern.starts[2 * chunk + 2]; ++e) {
        for (std::size_t term = pattern.sums[e]; term < pattern.sums[e + 1]; ++term) {
          for (std::size_t lane = 0; lane < kGroup; ++lane) {
            const std::uint32_t own = pattern.terms[2 * kGroup * term + lane];
            const std::uint32_t other = pattern.terms[2 * kGroup * term + kGroup + lane];
            EXPECT_EQ(own == none, other == none);
            if (own == none || other == none) continue;
            ++terms;
            ASSERT_LT(std::max(own, other), none);
            EXPECT_EQ(own / 4, other / 4) << "of one tet";
            EXPECT_EQ(nodeAt(own), nodes[kGroup * chunk + lane]);
            EXPECT_EQ(nodeAt(other), nodes[pattern.neighbours[kGroup * e + lane]]);
          }
        }
      }
    }
    EXPECT_EQ(terms, 12 * cage.tetCount());  // ordered pairs of corners
  }
}

}  // namespace
}  // namespace tetskin
