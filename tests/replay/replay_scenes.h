// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Scenes that are the same on every machine: without files, random numbers or functions of the C library, whose last
// bits differ between platforms. A scene's actions in a frame depend on the world and the frame's number alone, so that
// a world restored from a snapshot continues like the one that was saved.
#pragma once

#include <tetskin/replay/src/exported/state_hash.h>
#include <tetskin/solver/deformable_world.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace tetskin::test {

inline constexpr int kReplayFrames = 240;  ///< of 1/60 s, each in 4 substeps

/// A world with everything in it.
class ReplayScene {
 public:
  virtual ~ReplayScene() = default;
  ReplayScene(const ReplayScene&) = delete;
  ReplayScene& operator=(const ReplayScene&) = delete;

  /// One of `replaySceneNames()`; null for any other name. Two scenes of one name have the same objects in the same
  /// order.
  static std::unique_ptr<ReplayScene> create(const std::string& name, const DeformableWorldOptions& options = {});

  tetskin::DeformableWorld& world() { return world_; }
  /// The application's actions before a frame.
  virtual void act(int /*frame*/) {}
  /// Makes one frame: `act`, then four substeps.
  void step(int frame);

 protected:
  explicit ReplayScene(const DeformableWorldOptions& options) : world_(options) {}

 private:
  tetskin::DeformableWorld world_;
};

/// drop: a ball onto a dynamic ball, a fixed one and the floor; heap: 26 soft toys; drag: a ball with a hat, drawn by a
/// spring; twist: a bar, wrung and released; pit: a ball falls among 48 rigid ones; changing: a heap of clay, of a
/// muscle, of what grows, of gas, and of all of it.
const std::vector<std::string>& replaySceneNames();

using bullet_detail::stateHash;

}  // namespace tetskin::test
