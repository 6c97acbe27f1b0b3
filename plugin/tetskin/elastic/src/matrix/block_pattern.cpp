// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/disjoint_sets.h>
#include <tetskin/core/src/base/lists.h>
#include <tetskin/elastic/src/matrix/block_matrix.h>

#include <algorithm>
#include <array>
#include <cassert>

namespace tetskin::elastic_detail {
namespace {

using kernels::kGroup;

/// Sums over more chunks than this would lose digits of float.
constexpr std::size_t kChunksPerRange = 24;
/// Nodes of a part: what a sweep reads again stays in the first-level cache, and sweeping it takes longer than passing
/// it to another thread.
constexpr std::size_t kNodesPerPart = 1800;
/// Most separators, as a fraction of all nodes.
constexpr double kMaxSeparated = 0.25;

/// Two corners of a tet that contribute to the block of a pair of nodes; for quadratic tets, the first corners of two
/// nodes.
struct Term {
  std::uint32_t own = 0, other = 0;
};

struct Terms {
  std::vector<Term> linear, quadratic;

  /// A quadratic tet takes four times as long as a linear one.
  std::size_t effort() const { return linear.size() + 4 * quadratic.size(); }
};

/// A node's neighbours, sorted, and the terms of each block.
struct Row {
  std::vector<std::uint32_t> neighbours;
  std::vector<Terms> terms;
};

struct Pair {
  std::uint32_t neighbour = 0;
  Term term;
};

/// Calls visit(node, pair) for all ordered pairs of nodes of a tet.
/// corner  the number of a node's corner
template <std::size_t N, class Corner, class Visit>
void visitPairs(const std::array<int, N>& nodes, Corner&& corner, Visit&& visit) {
  for (std::size_t a = 0; a < N; ++a) {
    for (std::size_t b = 0; b < N; ++b) {
      if (a == b) continue;
      const Term term{static_cast<std::uint32_t>(corner(a)), static_cast<std::uint32_t>(corner(b))};
      visit(static_cast<std::size_t>(nodes[a]), Pair{static_cast<std::uint32_t>(nodes[b]), term});
    }
  }
}

std::vector<Row> rowsOf(std::size_t nodes, const RestTets& rest) {
  assert(rest.cornerCount() < 0xFFFFFFFFu);
  const Lists<Pair> pairs = packLists<Pair>(nodes, [&](auto&& visit) {
    for (std::size_t t = 0; t < rest.count(); ++t) {
      visitPairs(
          rest.tets[t], [&](std::size_t a) { return 4 * t + a; }, visit);
    }
    for (std::size_t t = 0; t < rest.quadratic.size(); ++t) {
      visitPairs(
          rest.quadratic[t].nodes, [&](std::size_t a) { return rest.quadraticCorner(t, a); }, visit);
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
      Terms& terms = rows[n].terms.back();
      (pair.term.own < rest.zeroCorner() ? terms.linear : terms.quadratic).push_back(pair.term);
    }
  }
  return rows;
}

/// Each node gets the first colour that none of its earlier neighbours has.
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

/// Appends the nodes to which a node is connected, by distance from it, except those in `found`; appended nodes are
/// added to `found`.
void appendByDistance(const std::vector<Row>& rows, std::uint32_t start, std::vector<char>& found,
                      std::vector<std::uint32_t>& order) {
  assert(!found[start]);
  std::size_t next = order.size();
  found[start] = 1;
  order.push_back(start);
  for (; next < order.size(); ++next) {
    for (const std::uint32_t m : rows[order[next]].neighbours) {
      if (found[m]) continue;
      found[m] = 1;
      order.push_back(m);
    }
  }
}

/// All nodes, component by component, each by distance from a node at one of its ends: E. Cuthill, J. McKee, "Reducing
/// the bandwidth of sparse symmetric matrices", ACM '69, doi 10.1145/800195.805928.
std::vector<std::uint32_t> orderByDistance(const std::vector<Row>& rows) {
  std::vector<std::uint32_t> order;
  std::vector<char> found(rows.size(), 0), foundAgain(rows.size(), 0);
  for (std::uint32_t n = 0; n < rows.size(); ++n) {
    if (found[n]) continue;
    std::vector<std::uint32_t> component;
    appendByDistance(rows, n, found, component);
    appendByDistance(rows, component.back(), foundAgain, order);
  }
  assert(order.size() == rows.size());
  return order;
}

/// Tasks of a sweep: parts of the body, and separators, which are the nodes of a part that have neighbours in later
/// parts. No two parts are neighbours, nor are two separators.
struct Division {
  std::vector<std::uint32_t> taskOf;  ///< by node; parts are followed by separators
  std::uint32_t parts = 1, separators = 0;
};

Division divide(const std::vector<Row>& rows, const std::vector<std::uint32_t>& order, std::uint32_t parts) {
  assert(parts > 0 && order.size() == rows.size());
  Division division;
  division.parts = parts;
  std::vector<std::uint32_t> partOf(rows.size());
  for (std::size_t k = 0; k < order.size(); ++k)
    partOf[order[k]] = static_cast<std::uint32_t>(k * parts / order.size());
  const auto separates = [&](std::uint32_t n) {
    return std::any_of(rows[n].neighbours.begin(), rows[n].neighbours.end(),
                       [&](std::uint32_t m) { return partOf[m] > partOf[n]; });
  };
  division.taskOf = partOf;
  std::vector<std::uint32_t> separators;
  for (std::uint32_t n = 0; n < rows.size(); ++n) {
    if (separates(n)) separators.push_back(n);
  }
  for (const std::uint32_t n : separators) division.taskOf[n] = parts + partOf[n];
  // Neighbouring separators, which occur if parts are thin, become one.
  DisjointSets sets(parts);
  for (const std::uint32_t n : separators) {
    for (const std::uint32_t m : rows[n].neighbours) {
      if (division.taskOf[m] >= parts) sets.unite(static_cast<int>(partOf[n]), static_cast<int>(partOf[m]));
    }
  }
  // A part without a number so far.
  constexpr std::uint32_t kNone = 0xFFFFFFFFu;
  std::vector<std::uint32_t> numbers(parts, kNone);
  for (const std::uint32_t n : separators) {
    std::uint32_t& number = numbers[static_cast<std::size_t>(sets.find(static_cast<int>(partOf[n])))];
    if (number == kNone) number = division.separators++;
    division.taskOf[n] = parts + number;
  }
  return division;
}

/// Divides large bodies into parts, with few separators.
Division divide(const std::vector<Row>& rows) {
  auto parts = static_cast<std::uint32_t>(rows.size() / kNodesPerPart);
  if (parts > 1) {
    const std::vector<std::uint32_t> order = orderByDistance(rows);
    for (; parts > 1; parts /= 2) {
      Division division = divide(rows, order, parts);
      const auto separated = static_cast<double>(std::count_if(division.taskOf.begin(), division.taskOf.end(),
                                                               [&](std::uint32_t task) { return task >= parts; }));
      if (separated <= kMaxSeparated * static_cast<double>(rows.size())) return division;
    }
  }
  Division whole;
  whole.taskOf.assign(rows.size(), 0);
  return whole;
}

/// The number of neighbours that are swept before a row.
std::size_t lowerCount(const Row& row, std::uint32_t level, const std::vector<std::uint32_t>& levels) {
  return static_cast<std::size_t>(
      std::count_if(row.neighbours.begin(), row.neighbours.end(), [&](std::uint32_t m) { return levels[m] < level; }));
}

/// Creates the chunks of up to eight rows, one after the other.
class PatternMaker {
 public:
  PatternMaker(BlockPattern& pattern, const std::vector<Row>& rows, const std::vector<std::uint32_t>& levels,
               std::size_t zeroCorner)
      : pattern_(pattern), rows_(rows), levels_(levels), none_(static_cast<std::uint32_t>(zeroCorner)) {
    pattern_.starts.push_back(0);
    pattern_.sums.push_back(0);
    pattern_.quadraticSums.push_back(0);
  }

  /// nodes  of the chunk; fewer than eight if the level has no more nodes
  void addChunk(const std::uint32_t* nodes, std::size_t count, std::uint32_t firstSlot) {
    assert(count > 0 && count <= kGroup && firstSlot % kGroup == 0);
    for (const bool lower : {true, false}) {
      std::array<std::vector<std::size_t>, kGroup> indices;  // positions in the rows' lists
      std::size_t longest = 0;
      for (std::size_t i = 0; i < count; ++i) {
        const Row& row = rows_[nodes[i]];
        for (std::size_t k = 0; k < row.neighbours.size(); ++k) {
          if ((levels_[row.neighbours[k]] < levels_[nodes[i]]) == lower) indices[i].push_back(k);
        }
        // Sums over similar numbers of terms are put side by side, because shorter ones are padded.
        std::stable_sort(indices[i].begin(), indices[i].end(),
                         [&](std::size_t a, std::size_t b) { return row.terms[a].effort() > row.terms[b].effort(); });
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
    std::array<const Terms*, kGroup> terms{};
    for (std::size_t i = 0; i < kGroup; ++i) {
      std::uint32_t neighbour = firstSlot + static_cast<std::uint32_t>(i);
      if (i < count && k < indices[i].size()) {
        const Row& row = rows_[nodes[i]];
        neighbour = pattern_.slotOf[row.neighbours[indices[i][k]]];
        terms[i] = &row.terms[indices[i][k]];
      }
      pattern_.neighbours.push_back(neighbour);
    }
    addTerms(terms, &Terms::linear, pattern_.terms, pattern_.sums);
    addTerms(terms, &Terms::quadratic, pattern_.quadraticTerms, pattern_.quadraticSums);
  }

  /// Adds the terms of one kind of the blocks of an entry.
  void addTerms(const std::array<const Terms*, kGroup>& terms, std::vector<Term> Terms::*kind,
                std::vector<std::uint32_t>& all, std::vector<std::uint32_t>& sums) {
    std::size_t longest = 0;
    for (const Terms* of : terms) longest = std::max(longest, of ? (of->*kind).size() : 0);
    for (std::size_t t = 0; t < longest; ++t) {
      const auto there = [&](std::size_t i) { return terms[i] && t < (terms[i]->*kind).size(); };
      for (std::size_t i = 0; i < kGroup; ++i) all.push_back(there(i) ? (terms[i]->*kind)[t].own : none_);
      for (std::size_t i = 0; i < kGroup; ++i) all.push_back(there(i) ? (terms[i]->*kind)[t].other : none_);
    }
    sums.push_back(static_cast<std::uint32_t>(all.size() / (2 * kGroup)));
  }

  BlockPattern& pattern_;
  const std::vector<Row>& rows_;
  const std::vector<std::uint32_t>& levels_;
  std::uint32_t none_;
};

}  // namespace

BlockPattern blockPattern(std::size_t nodes, const RestTets& rest) {
  const std::vector<Row> rows = rowsOf(nodes, rest);
  const std::vector<std::uint32_t> colours = coloursOf(rows);
  const std::uint32_t colourCount = colours.empty() ? 0 : *std::max_element(colours.begin(), colours.end()) + 1;
  const Division division = divide(rows);
  const std::uint32_t taskCount = division.parts + division.separators, levelCount = taskCount * colourCount;
  // Rows of one level are not neighbours, and levels are swept one after the other, except for those of other tasks.
  std::vector<std::uint32_t> levels(nodes);
  for (std::size_t n = 0; n < nodes; ++n) levels[n] = division.taskOf[n] * colourCount + colours[n];
  Lists<> onLevel = packLists(levelCount, [&](auto&& visit) {
    for (std::uint32_t n = 0; n < nodes; ++n) visit(levels[n], n);
  });

  // Rows of similar length share a chunk, because the shorter rows of a chunk are padded.
  BlockPattern pattern;
  pattern.slotOf.resize(nodes);
  std::uint32_t slot = 0;
  for (std::uint32_t level = 0; level < levelCount; ++level) {
    const auto first = onLevel.values.begin() + onLevel.starts[level],
               last = onLevel.values.begin() + onLevel.starts[level + 1];
    const auto lengths = [&](std::uint32_t n) {
      return std::make_pair(lowerCount(rows[n], level, levels), rows[n].neighbours.size());
    };
    std::stable_sort(first, last, [&](std::uint32_t n, std::uint32_t m) { return lengths(n) < lengths(m); });
    for (auto n = first; n != last; ++n) pattern.slotOf[*n] = slot++;
    slot = (slot + kGroup - 1) / kGroup * kGroup;
  }

  PatternMaker maker(pattern, rows, levels, rest.zeroCorner());
  std::uint32_t chunk = 0;
  pattern.rangeChunks.push_back(0);
  pattern.tasks.push_back(0);
  for (std::uint32_t level = 0; level < levelCount; ++level) {
    const std::size_t first = onLevel.starts[level], last = onLevel.starts[level + 1];
    const std::uint32_t firstChunk = chunk;
    for (std::size_t k = first; k < last; k += kGroup) {
      maker.addChunk(&onLevel.values[k], std::min<std::size_t>(kGroup, last - k), chunk * kGroup);
      ++chunk;
      const bool whole = (chunk - firstChunk) % kChunksPerRange == 0;
      if (whole || k + kGroup >= last) pattern.rangeChunks.push_back(chunk);
    }
    const bool ends = (level + 1) % colourCount == 0;
    if (ends) pattern.tasks.push_back(static_cast<std::uint32_t>(pattern.rangeChunks.size() - 1));
  }
  pattern.phases = {0, division.parts, taskCount};
  if (levelCount == 0) pattern.phases = {0, 0, 0};
  assert(pattern.starts.size() == 2 * std::size_t{chunk} + 1 &&
         pattern.sums.back() * 2 * kGroup == pattern.terms.size());
  assert(std::is_sorted(pattern.starts.begin(), pattern.starts.end()) && slot == chunk * kGroup);
  assert(pattern.phases.back() == pattern.taskCount());
  return pattern;
}

}  // namespace tetskin::elastic_detail
