// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Where the blocks of a matrix lie, and from which corners of tets each is summed.
#include <tetskin/elastic/src/matrix/block_matrix.h>

#include <map>
#include <set>

#include "elastic_fixtures.h"
#include "support/odd_meshes.h"

namespace tetskin::test {
namespace {

using kernels::kGroup;

/// The cages for the tests of the pattern; one of them has nodes that no tet uses.
std::vector<TetMesh> patternCages() {
  std::vector<TetMesh> cages{singleTet(), latticeCage(3, 2, 1), bodyCentredCage(3, 3, 2), latticeCage(12, 12, 12),
                             latticeCage(120, 7, 7)};
  cages[1].nodes.insert(cages[1].nodes.end(), 3, Vector3d(5, 5, 5));
  return cages;
}

BlockPattern patternOf(const TetMesh& cage) {
  return BlockMatrix<double>(cage.nodeCount(), elastic_detail::restTets(cage)).pattern();
}

/// By slot: its node, or -1.
std::vector<int> nodesOf(const BlockPattern& pattern) {
  std::vector<int> nodes(pattern.slotCount(), -1);
  for (std::size_t n = 0; n < pattern.slotOf.size(); ++n) nodes[pattern.slotOf[n]] = static_cast<int>(n);
  return nodes;
}

constexpr std::size_t kNone = 999;

/// By chunk: its task.
std::vector<std::size_t> tasksOfChunks(const BlockPattern& pattern) {
  std::vector<std::size_t> tasks(pattern.chunkCount(), kNone);
  for (std::size_t t = 0; t < pattern.taskCount(); ++t) {
    const std::size_t first = pattern.rangeChunks[pattern.tasks[t]], last = pattern.rangeChunks[pattern.tasks[t + 1]];
    for (std::size_t chunk = first; chunk < last; ++chunk) tasks[chunk] = t;
  }
  return tasks;
}

/// By chunk: its range.
std::vector<std::size_t> rangesOfChunks(const BlockPattern& pattern) {
  std::vector<std::size_t> ranges(pattern.chunkCount(), kNone);
  for (std::size_t r = 0; r < pattern.rangeCount(); ++r) {
    for (std::size_t chunk = pattern.rangeChunks[r]; chunk < pattern.rangeChunks[r + 1]; ++chunk) ranges[chunk] = r;
  }
  return ranges;
}

std::size_t phaseOf(const BlockPattern& pattern, std::size_t task) {
  return static_cast<std::size_t>(std::upper_bound(pattern.phases.begin(), pattern.phases.end(), task) -
                                  pattern.phases.begin());
}

void expectDivided(const std::vector<std::uint32_t>& starts, std::size_t count) {
  EXPECT_EQ(starts.front(), 0u);
  EXPECT_EQ(starts.back(), count);
  EXPECT_TRUE(std::is_sorted(starts.begin(), starts.end()));
}

TEST(BlockPattern, EveryNodeHasASlotOfItsOwnAndEveryChunkATaskAndARange) {
  for (const TetMesh& cage : patternCages()) {
    const BlockPattern pattern = patternOf(cage);
    ASSERT_EQ(pattern.slotOf.size(), cage.nodeCount());
    std::set<std::uint32_t> slots;
    for (const std::uint32_t slot : pattern.slotOf) {
      EXPECT_LT(slot, pattern.slotCount());
      EXPECT_TRUE(slots.insert(slot).second) << slot;
    }
    expectDivided(pattern.rangeChunks, pattern.chunkCount());
    expectDivided(pattern.tasks, pattern.rangeCount());
    expectDivided(pattern.phases, pattern.taskCount());
    const std::vector<std::size_t> tasks = tasksOfChunks(pattern), ranges = rangesOfChunks(pattern);
    EXPECT_EQ(std::count(tasks.begin(), tasks.end(), kNone), 0);
    EXPECT_EQ(std::count(ranges.begin(), ranges.end(), kNone), 0);
  }
}

TEST(BlockPattern, NeighboursAreThereOnceFromEachSideAndNeverInOneRange) {
  for (const TetMesh& cage : patternCages()) {
    const BlockPattern pattern = patternOf(cage);
    const std::vector<int> nodes = nodesOf(pattern);
    const std::vector<std::size_t> ranges = rangesOfChunks(pattern);
    std::map<std::pair<int, int>, int> lower, upper;
    for (std::size_t chunk = 0; chunk < pattern.chunkCount(); ++chunk) {
      for (std::size_t e = pattern.starts[2 * chunk]; e < pattern.starts[2 * chunk + 2]; ++e) {
        const bool isLower = e < pattern.starts[2 * chunk + 1];
        for (std::size_t lane = 0; lane < kGroup; ++lane) {
          const std::size_t own = kGroup * chunk + lane, other = pattern.neighbours[kGroup * e + lane];
          if (other == own) continue;  // padding
          ASSERT_GE(nodes[own], 0);
          ASSERT_GE(nodes[other], 0);
          const std::size_t otherRange = ranges[other / kGroup];
          EXPECT_TRUE(isLower ? otherRange < ranges[chunk] : otherRange > ranges[chunk]) << own << " " << other;
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

TEST(BlockPattern, NoTasksOfOnePhaseAreNeighbours) {
  for (const TetMesh& cage : patternCages()) {
    const BlockPattern pattern = patternOf(cage);
    const std::vector<std::size_t> tasks = tasksOfChunks(pattern);
    for (const auto& [a, b] : uniqueEdges(cage)) {
      const std::size_t one = tasks[pattern.slotOf[static_cast<std::size_t>(a)] / kGroup];
      const std::size_t other = tasks[pattern.slotOf[static_cast<std::size_t>(b)] / kGroup];
      EXPECT_TRUE(one == other || phaseOf(pattern, one) != phaseOf(pattern, other)) << a << " " << b;
    }
  }
}

TEST(BlockPattern, LargeBodiesHavePartsOfSimilarSizeAndFewSeparators) {
  const BlockPattern pattern = patternOf(latticeCage(120, 7, 7));
  ASSERT_EQ(pattern.phases.size(), 3u);
  const std::size_t parts = pattern.phases[1];
  ASSERT_GE(parts, 3u);
  EXPECT_EQ(pattern.phases[2], 2 * parts - 1);
  const auto chunksOf = [&](std::size_t first, std::size_t last) {
    return pattern.rangeChunks[pattern.tasks[last]] - pattern.rangeChunks[pattern.tasks[first]];
  };
  for (std::size_t t = 0; t < parts; ++t) {
    EXPECT_NEAR(static_cast<double>(parts * chunksOf(t, t + 1)) / pattern.chunkCount(), 1.0, 0.2) << t;
  }
  EXPECT_LT(chunksOf(parts, 2 * parts - 1), pattern.chunkCount() / 10);
}

TEST(BlockPattern, EveryTetHasATermInEachOfItsBlocks) {
  std::vector<Cage> cages{oddQuadraticCage(), oddMixedCage()};
  for (const TetMesh& mesh : patternCages()) cages.emplace_back(mesh);
  for (const Cage& cage : cages) {
    const RestTets rest = elastic_detail::restTets(cage, quadraticTets(cage).value());
    const BlockPattern pattern = BlockMatrix<double>(cage.mesh.nodeCount(), rest).pattern();
    const std::vector<int> nodes = nodesOf(pattern);
    // A corner's node and tet.
    const auto linear = [&](std::uint32_t corner) -> std::pair<int, std::size_t> {
      EXPECT_LT(corner, rest.zeroCorner());
      return {rest.tets[corner / 4][corner % 4], corner / 4};
    };
    const auto quadratic = [&](std::uint32_t corner) -> std::pair<int, std::size_t> {
      const std::size_t k = corner - rest.quadraticCorner(0);
      EXPECT_LE(corner + 3, rest.cornerCount());
      EXPECT_EQ(k % 3, 0u);
      return {rest.quadratic[k / 30].nodes[k / 3 % 10], k / 30};
    };
    const auto countTerms = [&](const auto& all, const auto& sums, const auto& whatIs) {
      std::size_t count = 0;
      for (std::size_t chunk = 0; chunk < pattern.chunkCount(); ++chunk) {
        for (std::size_t e = pattern.starts[2 * chunk]; e < pattern.starts[2 * chunk + 2]; ++e) {
          for (std::size_t term = sums[e]; term < sums[e + 1]; ++term) {
            for (std::size_t lane = 0; lane < kGroup; ++lane) {
              const std::uint32_t own = all[2 * kGroup * term + lane], other = all[2 * kGroup * term + kGroup + lane];
              EXPECT_EQ(own == rest.zeroCorner(), other == rest.zeroCorner());
              if (own == rest.zeroCorner() || other == rest.zeroCorner()) continue;
              ++count;
              EXPECT_EQ(whatIs(own).second, whatIs(other).second) << "of one tet";
              EXPECT_EQ(whatIs(own).first, nodes[kGroup * chunk + lane]);
              EXPECT_EQ(whatIs(other).first, nodes[pattern.neighbours[kGroup * e + lane]]);
            }
          }
        }
      }
      return count;
    };
    // Ordered pairs of nodes.
    EXPECT_EQ(countTerms(pattern.terms, pattern.sums, linear), 12 * rest.count());
    EXPECT_EQ(countTerms(pattern.quadraticTerms, pattern.quadraticSums, quadratic), 90 * rest.quadratic.size());
  }
}

}  // namespace
}  // namespace tetskin::test
