// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "pile/measurements.h"

#include <algorithm>
#include <cmath>

namespace tetskin::scenes {
namespace {

/// The data of a table's row: a moment, and the frames since the previous row.
struct Row {
  const Pile& pile;
  double seconds;
  const DeepestVertex& deepest;
  FrameTime time;     ///< the mean of these frames
  SolveTotals solve;  ///< of these frames
  int things;         ///< that the scene has
};

struct Column {
  TableColumn heading;
  std::string (*cell)(const Row& row);
};

/// A mean over steps, which the row of the first moment has none of.
std::string perStep(const Row& row, const char* format, double number) {
  return row.solve.steps == 0 ? "-" : formatted(format, number);
}
std::string perStep(const Row& row, long total) {
  return perStep(row, "%.1f", static_cast<double>(total) / row.solve.steps);
}
std::string percent(double lengthInUnits) {
  return formatted("%.2f", 100.0 * std::abs(lengthInUnits));
}
std::string millimetres(double metres) {
  return formatted("%.2f", 1e3 * std::abs(metres));
}

const Column kTime{{"time", "s"}, [](const Row& row) { return formatted("%.2f", row.seconds); }};
const Column kContacts{{"contacts", ""}, [](const Row& row) { return std::to_string(row.pile.contactCount()); }};
const Column kPairs{{"pairs", ""}, [](const Row& row) { return std::to_string(row.pile.pairCount()); }};
const Column kInside{{"vertices inside", ""}, [](const Row& row) { return std::to_string(row.deepest.count); }};
const Column kIterations{{"iterations", "per step"}, [](const Row& row) { return perStep(row, row.solve.iterations); }};
const Column kPasses{{"passes", "per step"}, [](const Row& row) { return perStep(row, row.solve.passes); }};
const Column kWall{{"simulation", "ms/frame"}, [](const Row& row) { return perStep(row, "%.2f", row.time.wall); }};
const Column kProcessor{{"processor", "ms/frame"},
                        [](const Row& row) { return perStep(row, "%.2f", row.time.processor); }};
const Column kAsleep{{"asleep", ""}, [](const Row& row) { return std::to_string(row.pile.asleepCount()); }};
const Column kFastest{{"fastest", "m/s"}, [](const Row& row) { return formatted("%.4f", row.pile.fastest()); }};
const Column kDeepestVertex{{"deepest vertex", "mm"}, [](const Row& row) { return millimetres(row.deepest.depth); }};
const Column kDeepestContact{{"deepest contact", "mm"},
                             [](const Row& row) { return millimetres(row.pile.deepestContact()); }};
const Column kDent{{"deepest dent", "mm"}, [](const Row& row) { return millimetres(*row.pile.deepestDent()); }};

std::vector<Column> columnsOfDepths() {
  return {
      kTime,
      kContacts,
      kPairs,
      {{"deepest vertex", "% of size"}, [](const Row& row) { return percent(row.deepest.depth); }},
      kInside,
      {{"deepest contact", "% of size"}, [](const Row& row) { return percent(row.pile.deepestContact()); }},
      {{"RMS node speed", "body lengths/s"}, [](const Row& row) { return formatted("%.3f", row.pile.nodeSpeed()); }},
      kIterations,
      kWall,
      kProcessor};
}

std::vector<Column> columnsOfRest(const Pile& pile) {
  std::vector<Column> columns = {kTime, kAsleep, kFastest, kDeepestVertex};
  if (pile.ballCount() > 0) {
    columns.push_back(kDent);
  } else {
    columns.insert(columns.end(), {kDeepestContact, kContacts, kPairs});
  }
  const Column each{{std::string("each ") + pile.scene().thing, "us/frame"},
                    [](const Row& row) { return perStep(row, "%.1f", 1e3 * row.time.wall / row.things); }};
  columns.insert(columns.end(), {kIterations, kPasses, kWall, kProcessor, each});
  return columns;
}

std::vector<Column> columnsOf(const Pile& pile) {
  return pile.scene().figures == PileFigures::Depths ? columnsOfDepths() : columnsOfRest(pile);
}

std::vector<TableColumn> headingsOf(const std::vector<Column>& columns) {
  std::vector<TableColumn> headings;
  for (const Column& column : columns) headings.push_back(column.heading);
  return headings;
}

FrameTime meanOf(const std::vector<FrameTime>& frames, std::size_t first, std::size_t count) {
  FrameTime mean;
  for (std::size_t k = first; k < first + count; ++k) {
    mean.wall += frames[k].wall / static_cast<double>(count);
    mean.processor += frames[k].processor / static_cast<double>(count);
  }
  return mean;
}

}  // namespace

Measurements::Measurements(const Pile& pile, const PileOptions& options)
    : pile_(pile), options_(options), table_(headingsOf(columnsOf(pile))) {}

void Measurements::measure(int frame, const FrameTime& time) {
  stages_.push_back(pile_.stageTimes());
  if (frame > 0) {
    times_.push_back(time);
    pairs_.push_back(pile_.pairCount());
  }
  deepestContact = std::min(deepestContact, pile_.deepestContact());
  if (const auto dent = pile_.deepestDent()) deepestDent = std::max(deepestDent.value_or(0.0), *dent);
  const bool asked = frame % options_.depthEvery == 0, second = frame % kFramesPerSecond == 0;
  const bool last = frame + 1 == options_.output.frames;
  if (!asked && !second && !last) return;
  latest = pile_.deepestVertex();
  if (latest.depth > deepest.depth) {
    deepest = latest;
    deepestFrame = frame;
  }
  if (second || last) addRow(frame);
}

FrameTime Measurements::meanTime() const {
  return meanOf(times_, 0, times_.size());
}

void Measurements::addRow(int frame) {
  const SolveTotals totals = pile_.world().solveTotals();
  SolveTotals since;
  since.steps = totals.steps - before_.steps;
  since.iterations = totals.iterations - before_.iterations;
  since.passes = totals.passes - before_.passes;
  const Row row{pile_, frame * kFrame, latest, meanOf(times_, told_, times_.size() - told_), since, options_.bodies};
  std::vector<std::string> cells;
  for (const Column& column : columnsOf(pile_)) cells.push_back(column.cell(row));
  table_.add(std::move(cells));
  before_ = totals;
  told_ = times_.size();
}

std::optional<SlowestSecond> Measurements::slowestSecond() const {
  std::optional<SlowestSecond> slowest;
  std::size_t touching = 0;  // the last frames in a row in which many pairs touch
  for (std::size_t k = 0; k < times_.size(); ++k) {
    touching = pairs_[k] < kManyPairs ? 0 : touching + 1;
    if (touching < kFramesPerSecond) continue;
    const FrameTime mean = meanOf(times_, k + 1 - kFramesPerSecond, kFramesPerSecond);
    if (slowest && mean.wall <= slowest->mean.wall) continue;
    slowest = SlowestSecond{mean, stages_[k + 1] - stages_[k + 1 - kFramesPerSecond]};
  }
  return slowest;
}

}  // namespace tetskin::scenes
