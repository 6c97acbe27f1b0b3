// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "scenes/stepping.h"

#include <tetskin/replay/recorder.h>
#include <tetskin/replay/snapshot.h>
#include <tetskin/solver/deformable_world.h>
#include <tetskin/tetskin.h>

#include <nlohmann/json.hpp>
#include <vector>

#include "scenes/command_line.h"
#include "scenes/input_error.h"

namespace tetskin::scenes {
namespace {

using BulletWorld = btDeformableMultiBodyDynamicsWorld;
using Snapshot = std::vector<unsigned char>;

void save(BulletWorld& world, Snapshot& snapshot) {
  const Result<std::size_t> size = saveSnapshot(world, snapshot.data(), snapshot.size());
  if (size.ok() && size.value() == snapshot.size()) return;
  const Result<std::size_t> needed = saveSnapshot(world, nullptr, 0);
  require(needed.status());
  snapshot.resize(needed.value());
  require(saveSnapshot(world, snapshot.data(), snapshot.size()).status());
}

/// Saves, steps, goes back, steps again, and compares everything in a snapshot.
class TwiceFromOneState : public Stepping {
 public:
  explicit TwiceFromOneState(BulletWorld& world) : world_(world) { save(world_, before_); }

  int step(double seconds) override {
    const auto dt = static_cast<btScalar>(seconds);
    save(world_, before_);
    const int made = world_.stepSimulation(dt, 0);
    save(world_, first_);
    require(restoreSnapshot(world_, before_.data(), before_.size()));
    world_.stepSimulation(dt, 0);
    save(world_, second_);
    if (first_ != second_ && differs_ == 0) differs_ = steps_ + 1;
    ++steps_;
    return made;
  }
  std::string finding() const override {
    if (differs_ > 0) return "step " + std::to_string(differs_) + " is another one when it is made again";
    return std::to_string(steps_) + " steps, each made again from a snapshot: equal to the last bit";
  }
  bool holds() const override { return differs_ == 0; }

 private:
  BulletWorld& world_;
  Snapshot before_, first_, second_;
  int steps_ = 0, differs_ = 0;  ///< the first step that differs, from 1
};

class IntoAFile : public Stepping {
 public:
  IntoAFile(BulletWorld& world, const OutputOptions& output) : path_(output.record) {
    RecorderOptions options;
    const nlohmann::ordered_json made = {
        {"program", output.program}, {"arguments", output.arguments}, {"tetskin", TETSKIN_VERSION}};
    options.description = made.dump();
    Result<std::unique_ptr<Recorder>> started = Recorder::start(world, path_, options);
    require(started.status());
    recorder_ = std::move(started).value();
  }

  int step(double seconds) override { return recorder_->step(static_cast<btScalar>(seconds), 0); }
  std::string finding() const override {
    if (!holds()) return recorder_->status().message;
    return std::to_string(recorder_->steps()) + " steps are in " + path_;
  }
  bool holds() const override { return recorder_->status().ok(); }

 private:
  std::string path_;
  std::unique_ptr<Recorder> recorder_;
};

class FromAFile : public Stepping {
 public:
  FromAFile(BulletWorld& world, const std::string& path) {
    Result<std::unique_ptr<Replay>> opened = Replay::open(world, path);
    require(opened.status());
    replay_ = std::move(opened).value();
  }

  int step(double /*seconds*/) override {
    ended_ = !replay_->step();
    return ended_ ? 0 : 1;
  }
  bool hasEnded() const override { return ended_ || replay_->report().differs; }
  std::string finding() const override { return findingOf(*replay_); }
  bool holds() const override { return replay_->status().ok() && !replay_->report().differs; }

 private:
  std::unique_ptr<Replay> replay_;
  bool ended_ = false;
};

}  // namespace

std::string findingOf(const Replay& replay) {
  const ReplayReport& report = replay.report();
  if (!replay.status().ok()) return replay.status().message;
  if (report.differs) return "step " + std::to_string(report.steps) + " differs, first in " + report.object;
  return std::to_string(report.steps) + " steps are as recorded, to the last bit" +
         (report.cutShort ? "; the file ends within the next one" : "");
}

std::unique_ptr<Stepping> steppingBy(const OutputOptions& options, BulletWorld* world) {
  const int wanted =
      (options.checkDeterminism ? 1 : 0) + (options.record.empty() ? 0 : 1) + (options.replay.empty() ? 0 : 1);
  if (wanted == 0) return nullptr;
  if (wanted > 1) throw InputError("choose one of --check-determinism, --record and --replay");
  if (!world) throw InputError("Bullet's own world cannot be saved; leave --elasticity at tetskin");
  if (options.checkDeterminism) return std::make_unique<TwiceFromOneState>(*world);
  if (!options.record.empty()) return std::make_unique<IntoAFile>(*world, options);
  return std::make_unique<FromAFile>(*world, options.replay);
}

}  // namespace tetskin::scenes
