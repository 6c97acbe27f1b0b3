// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Many bodies touch at once: soft ones of three models fall into a bowl, some of them across thin poles, or many of
// them into a heap; balls fall on a mat, or cubes into a bin. Prints how deep they enter each other, and run time, once
// per second.
#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "pile/measurements.h"
#include "pile/pile.h"
#include "pile/pile_summary.h"
#include "scenes/command_line.h"
#include "scenes/frame_writer.h"
#include "scenes/input_error.h"
#include "scenes/playback.h"
#include "scenes/recording.h"
#include "scenes/timer.h"

namespace {

using namespace tetskin;
using namespace tetskin::scenes;
using Eigen::Vector3d;

constexpr int kMaxThreads = 256;

int run(const PileOptions& options) {
  const OutputOptions& output = options.output;
  const std::string view = viewPath(output);
  Pile pile(options);
  FrameWriter writer(framePlanOf(output, pile.mesh(), pile.obstacles()), ObjLayout::create(pile.mesh()));
  Recording recording = pile.record(options, view);
  if (recording.hasGlb()) writer.addOther(Recording::kGlbName, recording.glbBytes());
  Measurements measured(pile, options);
  FrameTime time;
  const auto step = [&](int frame, Playback& run) {
    const WallTimer wall;
    const ProcessTimer processor;
    const bool finite = frame == 0 || pile.step();
    time = {wall.milliseconds(), processor.milliseconds()};
    run.simulationMs += time.wall;
    return finite;
  };
  const auto measure = [&](int frame) {
    measured.measure(frame, time);
    if (recording.wanted()) recording.keep(pile.moment());
  };
  const auto write = [&](int frame) {
    const std::vector<Vector3d> surface = pile.surface();
    writer.write(frame, surface, boundingBox(surface), {});
  };
  const Playback run = playFrames("simulating", output, pile.world(), step, measure, write);
  return finishRun(
      "tetskin_pile", output, run, writer, recording, [&] { return summarise(options, pile, measured, run); },
      [&](const nlohmann::ordered_json& json) {
        std::printf("\n%s\n", measured.table().c_str());
        printSummary(json, options);
      });
}

/// Sets options that are not on the command line to the scene's defaults, and refuses those that it does not support.
void complete(const CommandLine& line, PileOptions& options) {
  const PileScene& scene = pileSceneNamed(options.scene);
  const PileOptions preset = presetOf(options.scene);
  if (!line.given("--bodies")) options.bodies = preset.bodies;
  if (!line.given("--tets")) options.model.tets = preset.model.tets;
  if (!line.given("--triangles")) options.model.triangles = preset.model.triangles;
  if (!line.given("--self-contact")) options.selfContact = preset.selfContact;
  options.model.calibrate = options.model.calibrate || preset.model.calibrate;
  options.model.quiet = options.output.quiet;
  const std::string of = "--scene " + options.scene + ": ";
  for (const char* name : {"--mesh", "--triangles", "--calibrate"}) {
    if (scene.ownMeshes && line.given(name)) throw InputError(of + "has its own meshes, and takes no " + name);
  }
  if (options.bodies > scene.mostBodies) {
    throw InputError(of + "--bodies " + std::to_string(options.bodies) + " is more than " +
                     std::to_string(scene.mostBodies));
  }
}

std::vector<std::string> sceneNames() {
  std::vector<std::string> names;
  for (const PileScene& scene : pileScenes()) names.emplace_back(scene.name);
  return names;
}

/// The most that any scene may have.
int mostBodies() {
  int most = 0;
  for (const PileScene& scene : pileScenes()) most = std::max(most, scene.mostBodies);
  return most;
}

}  // namespace

int main(int argc, char** argv) {
  PileOptions options = presetOf("column");
  CommandLine line(
      "Drops soft bodies of three models, or of your mesh, into a bowl, some across thin poles and onto each other; or "
      "balls on a soft mat; or soft cubes into a bin. Prints contacts, depths and run time once per second.",
      {{{"tetskin_pile", "ten bodies: out/pile/frame_0000.obj, ..., and summary.json"},
        {"tetskin_pile --scene heap",
         "26 bodies with 330,000 vertices, in calibrated cages, in layers and without poles"},
        {"tetskin_pile --scene pit --bodies 50", "48 light balls and two heavy ones on a soft mat"},
        {"tetskin_pile --scene bin --seed 2 --threads 2", "50 soft cubes in a bin, by two threads"},
        {"tetskin_pile --mesh yours.obj", "ten copies of your mesh, which must be closed"},
        {"tetskin_pile --frames 100 --depth-every 1", "the impacts, with the deepest vertex of every frame"},
        {"tetskin_pile --bodies 3 --contact cage", "three bodies that touch the bowl by the nodes of their cages"}},
       "the simulation exploded"});
  line.addInput("--mesh", options.model.mesh, "closed", CommandLine::Need::Optional, "three built-in models");
  line.addWord(
      "--scene", options.scene, sceneNames(),
      "column: bodies fall one after the other, some across poles; heap: in layers of four, 26 bodies of 24,700 "
      "triangles in calibrated cages where nothing else is given; pit: 100 rigid balls on a soft mat of 3,000 tets; "
      "bin: 50 soft cubes of 100 tets each. Pit and bin have their own meshes");
  line.addCount("--triangles", options.model.triangles, "each", 500000);
  line.addCount("--tets", options.model.tets, "each", 20000);
  line.addFlag("--calibrate", options.model.calibrate);
  line.addCount("--bodies", options.bodies, "of the pit: balls; at most 100 in column and heap", mostBodies());
  line.addCount("--seed", options.seed,
                "Of the bodies' rotations before they fall, 1: fixed ones; of the pit: of the balls' places", 1000000);
  line.addCount("--threads", options.threads, "Threads of the solver and of the surfaces; they change no result",
                kMaxThreads);
  line.addContactOption(options.contact);
  line.addSelfContactOption(options.selfContact);
  line.addCount("--depth-every", options.depthEvery,
                "Measure the deepest vertex every Nth frame, as well as once per second: each vertex against the "
                "surfaces of all other bodies",
                1000000);
  line.addOutputOptions(options.output);
  return line.run(argc, argv, [&] {
    complete(line, options);
    return run(options);
  });
}
