// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A run in a file: what an application did to its world before each step, so that the run can be played again, to the
// last bit, by whoever has the world and the file. A bug report is this file.
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
  /// For whoever plays the file: how the world is built. Not interpreted.
  std::string description;
  /// Steps from one snapshot in the file to the next, at least 1.
  int snapshotEvery = 240;
};

/// Writes a run to a file: before each step what has changed since the last one, whoever has changed it (pins and
/// targets that were moved, velocities, forces, gravity, materials, kinematic bodies), and after it a hash of each
/// object's motion. What has changed is seen by comparing snapshots, see `saveSnapshot`; so nothing has to be told, and
/// what no snapshot holds is not recorded: callbacks within a step. Other shapes, rest shapes, objects and joints make
/// another world, see `Replay::onChange`; so does `setDeterministic`.
///
///     auto recorder = tetskin::Recorder::start(world, "run.replay").value();
///     ...
///     recorder->step(dt, 4, dt / 4);   // in place of world.stepSimulation(dt, 4, dt / 4)
///
/// Every step is in the file when it returns: also the one before a crash.
///
/// Lifetime  destroy it before the world
/// Cost      per step that of two snapshots, and some 50 bytes of the file, with 4 per object and what has changed
class TETSKIN_REPLAY_API Recorder {
 public:
  /// Starts recording; a file of that name is replaced.
  /// world   created with a `DeformableSolver`
  /// path    in UTF-8
  /// Errors  those of `saveSnapshot`; InvalidOption; FileNotWritable
  static Result<std::unique_ptr<Recorder>> start(btDeformableMultiBodyDynamicsWorld& world, const std::string& path,
                                                 const RecorderOptions& options = {});
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// Steps the world by its `stepSimulation`, and records it. Returns the number of Bullet's steps.
  int step(btScalar seconds, int maxSubSteps = 1, btScalar fixedTimeStep = btScalar(1) / 60);

  /// Ok, or why nothing is recorded any more: the disk is full, or the world has something now that cannot be saved,
  /// such as a compound whose children came or went since the last step.
  /// Steps are made all the same.
  const Status& status() const;
  /// Number of steps recorded.
  std::size_t steps() const;

 private:
  struct Impl;
  explicit Recorder(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// What playing a file has found.
struct ReplayReport {
  std::size_t steps = 0;        ///< steps played
  btScalar secondsPerStep = 0;  ///< of Bullet's steps in the last of these
  bool differs = false;         ///< the last of these has ended in another state than the recorded one
  std::string object;           ///< if so, the first object whose motion differs: its place in the world, and its kind
  bool cutShort = false;        ///< the file ends within a step, as that of a program that was killed
};

/// Plays a run from a file, one step after the other. Kinematic bodies go where they went: the application's motion
/// states are neither asked nor told, but for a btDefaultMotionState, which gets the new place.
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
  /// Errors  FileNotFound; Malformed: it is not a recorded run, or damaged; those of `restoreSnapshot`
  static Result<std::unique_ptr<Replay>> open(btDeformableMultiBodyDynamicsWorld& world, const std::string& path);
  /// `RecorderOptions::description` of a file. Errors: FileNotFound, Malformed.
  static Result<std::string> descriptionOf(const std::string& path);
  ~Replay();
  Replay(const Replay&) = delete;
  Replay& operator=(const Replay&) = delete;

  /// Where the recorded application added or removed bodies, objects or joints between steps, a file holds the state
  /// afterwards, but not how to get there: this function does it. It is called with the number of the step before
  /// which the world changed, from 0. Without one, such a file is played up to there.
  void onChange(std::function<void(std::size_t step)> change);

  /// Makes the next step of the file. Returns false, without a step, at the end of the file, if the last step has ended
  /// in another state than the recorded one, or on an error, see `status`.
  bool step();
  const ReplayReport& report() const;  ///< of the steps so far
  const Status& status() const;        ///< Ok, or why the file cannot be played any further

 private:
  struct Impl;
  explicit Replay(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace tetskin
