// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Continues, in another process, from a saved snapshot: to the last bit, in every later frame.
//   runs save SCENE FOLDER THREADS EVERY   steps a scene, and saves a snapshot every so many frames, and all hashes
//   runs go_on SCENE FOLDER THREADS EVERY  makes the scene anew for each snapshot, restores it, and compares
//   runs churn SCENE FOLDER THREADS EVERY  the same, after other bodies have come and gone
#include <tetskin/replay/snapshot.h>
#include <tetskin/threads/thread_pool.h>

#include <btBulletDynamicsCommon.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>

#include "replay/replay_scenes.h"
#include "support/rigids.h"

namespace {

using namespace tetskin;
using namespace tetskin::test;
using Bytes = std::vector<unsigned char>;

struct Arguments {
  std::string scene, folder;
  std::size_t threads = 1;
  int every = 30;

  std::string fileOf(int frame) const { return folder + "/" + scene + "_" + std::to_string(frame) + ".snapshot"; }
  std::string hashes() const { return folder + "/" + scene + ".hashes"; }
};

[[noreturn]] void fail(const std::string& message) {
  std::fprintf(stderr, "%s\n", message.c_str());
  std::exit(1);
}

/// A scene, and the threads that it is lent.
struct Run {
  explicit Run(const Arguments& arguments) : pool(arguments.threads) {
    DeformableWorldOptions options;
    if (arguments.threads > 1) options.threads = &pool;
    scene = ReplayScene::create(arguments.scene, options);
    if (!scene) fail("no scene is called " + arguments.scene);
  }
  Bytes save() const {
    Bytes bytes(saveSnapshot(scene->world(), nullptr, 0).value());
    if (!saveSnapshot(scene->world(), bytes.data(), bytes.size()).ok())
      fail("the size that was asked for does not suffice");
    return bytes;
  }
  ThreadPool pool;
  std::unique_ptr<ReplayScene> scene;
};

void save(const Arguments& arguments) {
  const Run run(arguments);
  std::vector<std::uint64_t> hashes;
  for (int frame = 0; frame < kReplayFrames; ++frame) {
    if (frame > 0 && frame % arguments.every == 0) {
      const Bytes bytes = run.save();
      std::ofstream(arguments.fileOf(frame), std::ios::binary)
          .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    }
    run.scene->step(frame);
    hashes.push_back(stateHash(run.scene->world()));
  }
  std::ofstream(arguments.hashes(), std::ios::binary)
      .write(reinterpret_cast<const char*>(hashes.data()), static_cast<std::streamsize>(8 * hashes.size()));
}

Bytes read(const std::string& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  if (!file) fail(path + " is missing");
  Bytes bytes(static_cast<std::size_t>(file.tellg()));
  file.seekg(0).read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  return bytes;
}

/// Rigid bodies that fall on each other, and all leave again.
void churn(ReplayScene& scene) {
  test::Rigids boxes(scene.world());
  auto& shape = boxes.shape<btBoxShape>(btVector3(1, 1, 1));
  for (int k = 0; k < 7; ++k) boxes.add(shape, 1, btVector3(btScalar(20 + 0.5 * k), btScalar(5 + 1.5 * k), 0));
  for (int frame = 0; frame < 3; ++frame) scene.step(frame);
  for (const std::size_t k : {2, 5, 0, 0, 2, 1, 0}) boxes.remove(*boxes.bodies[k]);
}

void goOn(const Arguments& arguments, bool withChurn) {
  const Bytes raw = read(arguments.hashes());
  if (raw.size() != 8u * kReplayFrames) fail(arguments.hashes() + " has another number of frames");
  for (int from = arguments.every; from < kReplayFrames; from += arguments.every) {
    const Run run(arguments);
    if (withChurn) churn(*run.scene);
    const Bytes snapshot = read(arguments.fileOf(from));
    const Status restored = restoreSnapshot(run.scene->world(), snapshot.data(), snapshot.size());
    if (!restored.ok()) fail("frame " + std::to_string(from) + ": " + restored.message);
    if (run.save() != snapshot) fail("what was restored at frame " + std::to_string(from) + " is saved differently");
    for (int frame = from; frame < kReplayFrames; ++frame) {
      run.scene->step(frame);
      std::uint64_t expected = 0;
      std::memcpy(&expected, &raw[8u * static_cast<std::size_t>(frame)], 8);
      if (stateHash(run.scene->world()) != expected) {
        fail("restored at frame " + std::to_string(from) + ", frame " + std::to_string(frame) + " differs");
      }
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 6) fail("runs save|go_on|churn SCENE FOLDER THREADS EVERY");
  const Arguments arguments{argv[2], argv[3], static_cast<std::size_t>(std::atoi(argv[4])), std::atoi(argv[5])};
  const std::string mode = argv[1];
  if (mode == "save") {
    save(arguments);
  } else {
    goOn(arguments, mode == "churn");
  }
}
