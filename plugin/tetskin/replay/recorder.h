// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A run in a file: what an application did to its world before each step, so that anyone with the world and the file
// can play the run again, to the last bit. Attach this file to a bug report.
#pragma once

#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <tetskin/core/types.h>
#include <tetskin/export.h>

#include <cstddef>
#include <functional>
#include <memory>
#include <string>

namespace tetskin {

/// Options of a Recorder.
struct RecorderOptions {
  /// For whoever plays the file: how to build the world. Not interpreted.
  std::string description;
  /// Steps from one snapshot in the file to the next, at least 1.
  int snapshotEvery = 240;
};

/// Writes a run to a file: before each step, what has changed since the last one, no matter who changed it (moved pins
/// and targets, velocities, forces, gravity, materials, kinematic bodies); after each step, a hash of each object's
/// motion. Changes are found by comparing snapshots, see `saveSnapshot`: nothing has to be reported, and what no
/// snapshot holds is not recorded, such as callbacks within a step. Other shapes, rest shapes, objects and joints make
/// another world, see `Replay::onChange`; so does `setDeterministic`.
///
///     auto recorder = tetskin::Recorder::start(world, "run.replay").value();
///     ...
///     recorder->step(dt, 4, dt / 4);   // in place of world.stepSimulation(dt, 4, dt / 4)
///
/// Every step is in the file when the call returns, including the last one before a crash.
///
/// Lifetime  destroy it before the world
/// Cost      per step that of two snapshots, and in the file some 50 bytes, plus 4 per object and what has changed
class TETSKIN_REPLAY_API Recorder {
 public:
  /// Starts recording; replaces an existing file of that name.
  /// world   created with a `DeformableSolver`
  /// path    in UTF-8
  /// Errors  those of `saveSnapshot`; InvalidOption; FileNotWritable
  static Result<std::unique_ptr<Recorder>> start(btDeformableMultiBodyDynamicsWorld& world, const std::string& path,
                                                 const RecorderOptions& options = {});
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// Calls the world's `stepSimulation`, and records it. Returns the number of Bullet's steps.
  int step(btScalar seconds, int maxSubSteps = 1, btScalar fixedTimeStep = btScalar(1) / 60);

  /// Ok, or why nothing is recorded any more: the disk is full, or the world now contains something that cannot be
  /// saved, such as a compound whose children came or went since the last step.
  /// Steps are still made.
  const Status& status() const;
  /// Number of steps recorded.
  std::size_t steps() const;

 private:
  struct Impl;
  explicit Recorder(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// The result of playing a file.
struct ReplayReport {
  std::size_t steps = 0;        ///< steps played
  btScalar secondsPerStep = 0;  ///< length of Bullet's steps in the last of these
  bool differs = false;         ///< the last of these has not ended in the recorded state
  std::string object;           ///< if so, the first object whose motion differs: its index in the world, and its kind
  bool cutShort = false;        ///< the file ends within a step, as if the program was killed in it
};

/// Plays a run from a file, step by step. Kinematic bodies go to their recorded places: the application's motion states
/// are neither asked nor informed, except a btDefaultMotionState, which gets the new place.
///
///     build(world);   // the same bodies, in the same order
///     auto replay = tetskin::Replay::open(world, "run.replay").value();
///     while (replay->step()) draw(world);
///     if (replay->report().differs) ...
///
/// Lifetime  destroy it before the world
/// Cost      per step that of two snapshots
class TETSKIN_REPLAY_API Replay {
 public:
  /// Opens a file, and puts the world into the state in which recording began.
  /// world   with the same bodies, objects and joints as the recorded one, see `restoreSnapshot`
  /// path    in UTF-8
  /// Errors  FileNotFound; Malformed: not a recorded run, or damaged; those of `restoreSnapshot`
  static Result<std::unique_ptr<Replay>> open(btDeformableMultiBodyDynamicsWorld& world, const std::string& path);
  /// `RecorderOptions::description` of a file. Errors: FileNotFound, Malformed.
  static Result<std::string> descriptionOf(const std::string& path);
  ~Replay();
  Replay(const Replay&) = delete;
  Replay& operator=(const Replay&) = delete;

  /// If the recorded application added or removed bodies, objects or joints between steps, a file holds the state
  /// afterwards, but not how to get there: this function must make the same changes. It is called with the number of
  /// the step before which the world changed, from 0. Without it, such a file plays only up to that step.
  void onChange(std::function<void(std::size_t step)> change);

  /// Makes the next step of the file. Returns false, without a step, at the end of the file, if the last step has not
  /// ended in the recorded state, or on an error, see `status`.
  bool step();
  const ReplayReport& report() const;  ///< of the steps so far
  const Status& status() const;        ///< Ok, or why the file cannot be played any further

 private:
  struct Impl;
  explicit Replay(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace tetskin
