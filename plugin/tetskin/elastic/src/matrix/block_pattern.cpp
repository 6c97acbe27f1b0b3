// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/shared/base/lists.h>
#include <tetskin/elastic/src/matrix/block_matrix.h>

#include <algorithm>
#include <array>
#include <cassert>

namespace tetskin::elastic_detail {
namespace {

using kernels::kGroup;

/// Handing work to another thread costs some microseconds, in which this many chunks are swept.
constexpr std::size_t kChunksPerTask = 24;

/// Two corners of a tet that contribute to the block of a pair of nodes.
struct Term {
  std::uint32_t own = 0, other = 0;
};

/// A node's neighbours, sorted, and the terms of each block.
struct Row {
  std::vector<std::uint32_t> neighbours;
  std::vector<std::vector<Term>> terms;
};

struct Pair {
  std::uint32_t neighbour = 0;
  Term term;
};

std::vector<Row> rowsOf(std::size_t nodes, const std::vector<Tet>& tets) {
  assert(tets.size() < 0xFFFFFFFFu / 4);
  const Lists<Pair> pairs = packLists<Pair>(nodes, [&](auto&& visit) {
    for (std::uint32_t t = 0; t < tets.size(); ++t) {
      for (std::uint32_t a = 0; a < 4; ++a) {
        for (std::uint32_t b = 0; b < 4; ++b) {
          if (a == b) continue;
          visit(static_cast<std::size_t>(tets[t][a]),
                Pair{static_cast<std::uint32_t>(tets[t][b]), {4 * t + a, 4 * t + b}});
        }
      }
    }
  });
  std::vector<Row> rows(nodes);
  for (std::size_t n = 0; n < nodes; ++n) {
    std::vector<Pair> sorted(pairs.values.begin() + pairs.starts[n], pairs.values.begin() + pairs.starts[n + 1]);
    std::stable_sort(sorted.begin(), sorted.end(),
                     [](const Pair& p, const Pair& q) { return p.neighbour < q.neighbour; });
    for (const Pair& pair : sorted) {
      if (rows[n].neighbours.empty() || rows[n].neighbours.back() != pair.neighbour) {
        rows[n].neighbours.push_back(pair.neighbour);
        rows[n].terms.emplace_back();
      }
      rows[n].terms.back().push_back(pair.term);
    }
  }
  return rows;
}

/// Each node has the first colour that none of its neighbours before it has.
std::vector<std::uint32_t> coloursOf(const std::vector<Row>& rows) {
  std::vector<std::uint32_t> colours(rows.size());
  std::vector<char> taken;
  for (std::size_t n = 0; n < rows.size(); ++n) {
    taken.assign(rows[n].neighbours.size() + 1, 0);
    for (const std::uint32_t m : rows[n].neighbours) {
      if (m < n && colours[m] < taken.size()) taken[colours[m]] = 1;
    }
    colours[n] = static_cast<std::uint32_t>(std::find(taken.begin(), taken.end(), 0) - taken.begin());
  }
  return colours;
}

/// The number of neighbours that are swept before a row.
std::size_t lowerCount(const Row& row, std::uint32_t colour, const std::vector<std::uint32_t>& colours) {
  return static_cast<std::size_t>(std::count_if(row.neighbours.begin(), row.neighbours.end(),
                                                [&](std::uint32_t m) { return colours[m] < colour; }));
}

/// Creates the chunks of up to eight rows one after the other.
class PatternMaker {
 public:
  PatternMaker(BlockPattern& pattern, const std::vector<Row>& rows, const std::vector<std::uint32_t>& colours,
               std::size_t noTet)
      : pattern_(pattern), rows_(rows), colours_(colours), none_(static_cast<std::uint32_t>(4 * noTet)) {
    pattern_.starts.push_back(0);
    pattern_.sums.push_back(0);
  }

  /// nodes  of the chunk; fewer than eight if no more nodes have this colour
  void addChunk(const std::uint32_t* nodes, std::size_t count, std::uint32_t firstSlot) {
    assert(count > 0 && count <= kGroup && firstSlot % kGroup == 0);
    for (const bool lower : {true, false}) {
      std::array<std::vector<std::size_t>, kGroup> indices;  // positions in the rows' lists
      std::size_t longest = 0;
      for (std::size_t i = 0; i < count; ++i) {
        const Row& row = rows_[nodes[i]];
        for (std::size_t k = 0; k < row.neighbours.size(); ++k) {
          if ((colours_[row.neighbours[k]] < colours_[nodes[i]]) == lower) indices[i].push_back(k);
        }
        longest = std::max(longest, indices[i].size());
      }
      for (std::size_t k = 0; k < longest; ++k) addEntry(nodes, count, firstSlot, indices, k);
      pattern_.starts.push_back(static_cast<std::uint32_t>(pattern_.sums.size() - 1));
    }
  }

 private:
  /// Adds the k-th neighbour of each row; a row without one gets itself, with a block of zeros.
  void addEntry(const std::uint32_t* nodes, std::size_t count, std::uint32_t firstSlot,
                const std::array<std::vector<std::size_t>, kGroup>& indices, std::size_t k) {
    std::array<const std::vector<Term>*, kGroup> terms{};
    std::size_t longest = 0;
    for (std::size_t i = 0; i < kGroup; ++i) {
      std::uint32_t neighbour = firstSlot + static_cast<std::uint32_t>(i);
      if (i < count && k < indices[i].size()) {
        const Row& row = rows_[nodes[i]];
        neighbour = pattern_.slotOf[row.neighbours[indices[i][k]]];
        terms[i] = &row.terms[indices[i][k]];
        longest = std::max(longest, terms[i]->size());
      }
      pattern_.neighbours.push_back(neighbour);
    }
    for (std::size_t t = 0; t < longest; ++t) {
      const auto there = [&](std::size_t i) { return terms[i] && t < terms[i]->size(); };
      for (std::size_t i = 0; i < kGroup; ++i) pattern_.terms.push_back(there(i) ? (*terms[i])[t].own : none_);
      for (std::size_t i = 0; i < kGroup; ++i) pattern_.terms.push_back(there(i) ? (*terms[i])[t].other : none_);
    }
    pattern_.sums.push_back(static_cast<std::uint32_t>(pattern_.terms.size() / (2 * kGroup)));
  }

  BlockPattern& pattern_;
  const std::vector<Row>& rows_;
  const std::vector<std::uint32_t>& colours_;
  std::uint32_t none_;
};

}  // namespace

BlockPattern blockPattern(std::size_t nodes, const std::vector<Tet>& tets, std::size_t noTet) {
  assert(noTet >= tets.size());
  const std::vector<Row> rows = rowsOf(nodes, tets);
  const std::vector<std::uint32_t> colours = coloursOf(rows);
  const std::uint32_t colourCount = colours.empty() ? 0 : *std::max_element(colours.begin(), colours.end()) + 1;
  Lists<> ofColour = packLists(colourCount, [&](auto&& visit) {
    for (std::uint32_t n = 0; n < nodes; ++n) visit(colours[n], n);
  });

  // Rows of similar length are put in one chunk, since the shorter rows of a chunk are padded.
  BlockPattern pattern;
  pattern.slotOf.resize(nodes);
  std::uint32_t slot = 0;
  for (std::uint32_t c = 0; c < colourCount; ++c) {
    const auto first = ofColour.values.begin() + ofColour.starts[c],
               last = ofColour.values.begin() + ofColour.starts[c + 1];
    const auto lengths = [&](std::uint32_t n) {
      return std::make_pair(lowerCount(rows[n], c, colours), rows[n].neighbours.size());
    };
    std::stable_sort(first, last, [&](std::uint32_t n, std::uint32_t m) { return lengths(n) < lengths(m); });
    for (auto n = first; n != last; ++n) pattern.slotOf[*n] = slot++;
    slot = (slot + kGroup - 1) / kGroup * kGroup;
  }

  PatternMaker maker(pattern, rows, colours, noTet);
  std::uint32_t chunk = 0;
  pattern.taskChunks.push_back(0);
  pattern.colours.push_back(0);
  for (std::uint32_t c = 0; c < colourCount; ++c) {
    const std::size_t first = ofColour.starts[c], last = ofColour.starts[c + 1];
    const std::uint32_t firstChunk = chunk;
    for (std::size_t k = first; k < last; k += kGroup) {
      maker.addChunk(&ofColour.values[k], std::min<std::size_t>(kGroup, last - k), chunk * kGroup);
      ++chunk;
      const bool whole = (chunk - firstChunk) % kChunksPerTask == 0;
      if (whole || k + kGroup >= last) pattern.taskChunks.push_back(chunk);
    }
    pattern.colours.push_back(static_cast<std::uint32_t>(pattern.taskChunks.size() - 1));
  }
  assert(pattern.starts.size() == 2 * std::size_t{chunk} + 1 &&
         pattern.sums.back() * 2 * kGroup == pattern.terms.size());
  assert(std::is_sorted(pattern.starts.begin(), pattern.starts.end()) && slot == chunk * kGroup);
  return pattern;
}

}  // namespace tetskin::elastic_detail
