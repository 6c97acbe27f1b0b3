// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <functional>

#include "scenes/command_line.h"
#include "scenes/files.h"

namespace tetskin::scenes {

/// What a run has shown.
struct Playback {
  int frames = 0, written = 0;
  double simulationMs = 0.0, writeMs = 0.0;  ///< of all frames
  bool finite = true;                        ///< and not exploded; the run ends before the first frame that is not
  bool aboveFloor = true;                    ///< in all frames
  std::uint64_t hash = kNoHash;              ///< of the nodes in all frames, if it was asked for

  int steps() const { return frames > 1 ? frames - 1 : 1; }
};

/// Told the number of a frame.
using OfFrame = std::function<void(int frame)>;
/// Makes a frame; number 0 is there already. Adds to the simulation's time; returns false if it has exploded.
using FrameStep = std::function<bool(int frame, Playback& run)>;

/// Simulates the frames that the options say, and tells how far it has come, and what they hash to, if it is asked for.
/// world  that `step` steps; measure  after every frame; write  after those that are to be written
Playback playFrames(const char* doing, const OutputOptions& output, const World& world, const FrameStep& step,
                    const OfFrame& measure, const OfFrame& write);

}  // namespace tetskin::scenes
