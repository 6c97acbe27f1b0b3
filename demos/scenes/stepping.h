// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// How a run makes its steps: as they come, each twice from the same state, into a file, or as a file has them.
#pragma once

#include <memory>
#include <string>

class btDeformableMultiBodyDynamicsWorld;

namespace tetskin {
class Replay;
}

namespace tetskin::scenes {

struct OutputOptions;

class Stepping {
 public:
  virtual ~Stepping() = default;
  /// Replaces Bullet's `stepSimulation`: one step of this many seconds. Returns the number of Bullet's steps.
  virtual int step(double seconds) = 0;
  /// True if there are no steps any more.
  virtual bool hasEnded() const { return false; }
  /// The result of the checks, in a line; empty: nothing was checked.
  virtual std::string finding() const { return {}; }
  /// False if the run has differed from the expected one.
  virtual bool holds() const { return true; }
};

/// The result of a played run, in a line.
std::string findingOf(const Replay& replay);

/// By the options; null: as they come. Throws InputError where a file cannot be used, or the world has something that
/// cannot be saved.
/// world  null for one that is not deformable
std::unique_ptr<Stepping> steppingBy(const OutputOptions& options, btDeformableMultiBodyDynamicsWorld* world);

}  // namespace tetskin::scenes
