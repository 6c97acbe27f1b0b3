// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <functional>

#include "scenes/command_line.h"
#include "scenes/files.h"
#include "scenes/frame_writer.h"
#include "scenes/recording.h"

namespace tetskin::scenes {

/// The results of a run.
struct Playback {
  int frames = 0, written = 0;
  double simulationMs = 0.0, writeMs = 0.0;  ///< totals of all frames
  bool finite = true;            ///< finite and not exploded; the run ends before the first frame that is not
  bool aboveFloor = true;        ///< true in all frames
  bool repeats = true;           ///< false: it was to be another run's repetition, and is not
  std::uint64_t hash = kNoHash;  ///< hash of the nodes in all frames, if requested

  int steps() const { return frames > 1 ? frames - 1 : 1; }
};

/// Called with the number of a frame.
using OfFrame = std::function<void(int frame)>;
/// Makes a frame; number 0 already exists. Adds to the simulation's time; returns false if the body has exploded.
using FrameStep = std::function<bool(int frame, Playback& run)>;

/// Simulates the frames that the options request, and prints the progress, and the hash if it is requested. The world
/// makes its steps as the options request, see Stepping.
/// world  the one that `step` steps; measure  called after every frame; write  called after those that are to be
/// written
Playback playFrames(const char* doing, const OutputOptions& output, World& world, const FrameStep& step,
                    const OfFrame& measure, const OfFrame& write);

/// Ends a run: writes the rest of its frames, its GLB, its summary and its page. Returns the exit status, and reports
/// if the simulation exploded.
/// summarise  called once the GLB is written; the values of all runs are added; print  called unless the run is quiet
int finishRun(const char* program, const OutputOptions& output, const Playback& run, FrameWriter& writer,
              Recording& recording, const std::function<nlohmann::ordered_json()>& summarise,
              const std::function<void(const nlohmann::ordered_json& json)>& print);

}  // namespace tetskin::scenes
