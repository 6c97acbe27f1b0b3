// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Plays the scenes with `deterministic`, and prints a line for each: its name, and hashes of its state after 60, 120
// and 240 frames. Fails where a line is not in the file. With a number of frames instead of a file: stops after them,
// and plays only the scenes named next. With --baseline before all that: with the kernels that each processor of this
// architecture has.
#include "replay_scenes.h"

#include <tetskin/core/src/base/kernels/instruction_set.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>

int main(int argc, char** argv) {
  using namespace tetskin;
  if (argc > 1 && std::strcmp(argv[1], "--baseline") == 0) {
    setInstructionSet(InstructionSet::Baseline);
    --argc;
    ++argv;
  }
  std::vector<std::string> expected;
  const int fewer = argc > 1 ? std::atoi(argv[1]) : 0;
  const int frames = fewer > 0 ? std::min(fewer, test::kReplayFrames) : test::kReplayFrames;
  std::ifstream file(argc > 1 && fewer == 0 ? argv[1] : "");
  for (std::string line; std::getline(file, line);) expected.push_back(line);
  DeformableWorldOptions options;
  options.deterministic = true;
  bool same = true;
  const std::vector<std::string> asked(argv + std::min(argc, 2), argv + argc);
  for (const std::string& name : asked.empty() ? test::replaySceneNames() : asked) {
    const std::unique_ptr<test::ReplayScene> scene = test::ReplayScene::create(name, options);
    if (!scene) return std::fprintf(stderr, "no scene is called %s\n", name.c_str()), 1;
    std::string line = name;
    for (int frame = 0; frame < frames; ++frame) {
      scene->step(frame);
      if (frame != 59 && frame != 119 && frame != 239) continue;
      char text[20];
      std::snprintf(text, sizeof text, " %016llx", static_cast<unsigned long long>(test::stateHash(scene->world())));
      line += text;
    }
    std::printf("%s\n", line.c_str());
    std::fflush(stdout);
    const bool known = argc > 1 && fewer == 0 && sizeof(btScalar) == sizeof(float);  // the file has hashes of float
    same &= !known || std::find(expected.begin(), expected.end(), line) != expected.end();
  }
  return same ? 0 : 1;
}
