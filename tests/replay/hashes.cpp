// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Plays the scenes with `deterministic`, and prints a line for each: its name, and hashes of its state after 60, 120
// and 240 frames. With a file: fails where a line is not in it.
#include "replay_scenes.h"

#include <algorithm>
#include <cstdio>
#include <fstream>

int main(int argc, char** argv) {
  using namespace tetskin;
  std::vector<std::string> expected;
  std::ifstream file(argc > 1 ? argv[1] : "");
  for (std::string line; std::getline(file, line);) expected.push_back(line);
  DeformableWorldOptions options;
  options.deterministic = true;
  bool same = true;
  for (const std::string& name : test::replaySceneNames()) {
    const std::unique_ptr<test::ReplayScene> scene = test::ReplayScene::create(name, options);
    std::string line = name;
    for (int frame = 0; frame < test::kReplayFrames; ++frame) {
      scene->step(frame);
      if (frame != 59 && frame != 119 && frame != 239) continue;
      char text[20];
      std::snprintf(text, sizeof text, " %016llx", static_cast<unsigned long long>(test::stateHash(scene->world())));
      line += text;
    }
    std::printf("%s\n", line.c_str());
    const bool known = argc > 1 && sizeof(btScalar) == sizeof(float);  // the file has hashes of float
    same &= !known || std::find(expected.begin(), expected.end(), line) != expected.end();
  }
  return same ? 0 : 1;
}
