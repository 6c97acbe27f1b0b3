// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "pile/pile.h"
#include "scenes/printed_table.h"

namespace tetskin::scenes {

/// Pairs of bodies that touch in a heap.
constexpr std::size_t kManyPairs = 40;

/// Of a frame, or the mean of several.
struct FrameTime {
  double wall = 0.0;       ///< milliseconds
  double processor = 0.0;  ///< milliseconds of all threads together
};

struct SlowestSecond {
  FrameTime mean;
  StageTimes stages;
};

/// Measurements during a run of the pile, and their table.
class Measurements {
 public:
  /// pile, options  must outlive this object
  Measurements(const Pile& pile, const PileOptions& options);

  /// Called after every frame.
  /// time  that the frame has taken; frame 0 took none
  void measure(int frame, const FrameTime& time);
  std::string table() const { return table_.text(); }
  FrameTime meanTime() const;
  /// The slowest second during which kManyPairs pairs of bodies touch all the time; empty if there is none.
  std::optional<SlowestSecond> slowestSecond() const;

  double deepestContact = 0.0;        ///< over all frames, in the scene's unit; 0 or negative
  std::optional<double> deepestDent;  ///< over all frames, metres
  DeepestVertex deepest, latest;
  int deepestFrame = 0;

 private:
  void addRow(int frame);

  const Pile& pile_;
  const PileOptions& options_;
  PrintedTable table_;
  SolveTotals before_;
  std::vector<FrameTime> times_;    ///< of frames from 1 on
  std::vector<std::size_t> pairs_;  ///< of bodies that touch, in the same frames
  std::vector<StageTimes> stages_;  ///< until the end of each frame, 0 included
  std::size_t told_ = 0;            ///< number of times that are in the table
};

}  // namespace tetskin::scenes
