// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "scenes/playback.h"

#include <cinttypes>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "scenes/progress.h"
#include "scenes/summary.h"
#include "scenes/timer.h"

namespace tetskin::scenes {

Playback playFrames(const char* doing, const OutputOptions& output, World& world, const FrameStep& step,
                    const OfFrame& measure, const OfFrame& write) {
  Playback run;
  world.setStepping(steppingBy(output, world.deformableWorld()));
  const Stepping* stepping = world.stepping();
  Progress progress(doing, output.frames, output.quiet);
  for (int frame = 0; frame < output.frames; ++frame) {
    run.finite = step(frame, run);
    if (!run.finite || (stepping && stepping->hasEnded())) break;
    if (output.hash) run.hash = world.hashOfNodes(run.hash);
    measure(frame);
    if (frame % output.every == 0) {
      const WallTimer timer;
      write(frame);
      run.writeMs += timer.milliseconds();
      ++run.written;
    }
    run.frames = frame + 1;
    progress.show(frame + 1);
  }
  if (stepping) {
    run.repeats = stepping->holds();
    std::printf("%s\n", stepping->finding().c_str());
  }
  if (output.hash) std::printf("nodes of %d frames: %016" PRIx64 "\n", run.frames, run.hash);
  return run;
}

int finishRun(const char* program, const OutputOptions& output, const Playback& run, FrameWriter& writer,
              Recording& recording, const std::function<nlohmann::ordered_json()>& summarise,
              const std::function<void(const nlohmann::ordered_json& json)>& print) {
  writer.finish();
  recording.writeGlb();
  nlohmann::ordered_json json = summarise();
  json["frames"] = run.frames;
  json["frames_written"] = run.written;
  json["finite"] = run.finite;
  json["out"] = output.out;
  writeJson(json, summaryPath(output));
  if (!output.quiet) print(json);
  recording.writePage();
  if (!run.repeats) return kRunFailed;
  if (run.finite) return kDone;
  std::fprintf(stderr, "%s: the simulation exploded after frame %d\n", program, run.frames - 1);
  return kRunFailed;
}

}  // namespace tetskin::scenes
