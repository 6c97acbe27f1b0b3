// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/replay/recorder.h>
#include <tetskin/replay/src/record/object_motion.h>
#include <tetskin/replay/src/record/record_file.h>
#include <tetskin/replay/src/state/snapshot_bytes.h>

namespace tetskin {

using namespace bullet_detail;

struct Recorder::Impl {
  Impl(btDeformableMultiBodyDynamicsWorld& ofWorld, const RecorderOptions& options)
      : world(ofWorld), snapshotEvery(static_cast<std::size_t>(options.snapshotEvery)) {}

  void save(Bytes& state);
  void before(StepChunk& step);
  void after(StepChunk& step);
  void write(ChunkKind kind, const Bytes& bytes) { status = file.write(kind, bytes); }

  btDeformableMultiBodyDynamicsWorld& world;
  std::size_t snapshotEvery;
  RecordWriter file;
  Bytes ended, now;  ///< the states after the last step, and now
  Status status;
  std::size_t steps = 0;
};

void Recorder::Impl::save(Bytes& state) {
  status = saveInto(world, state);
  if (!status.ok() || isRecordable(state.size())) return;
  status = {StatusCode::NotSaved, "the state of this world takes more than 2 GB, which no file of a run can hold"};
}

/// Writes what has changed since the last step, or a full snapshot when one is due.
void Recorder::Impl::before(StepChunk& step) {
  save(now);
  if (!status.ok()) return;
  if (!areOfOneWorld(ended, now)) {
    write(ChunkKind::Change, now);
  } else {
    step.change = differenceOf(ended, now);
    if (steps % snapshotEvery == 0) write(ChunkKind::Snapshot, ended);
  }
}

void Recorder::Impl::after(StepChunk& step) {
  step.kinematic = kinematicTargets(world);
  step.motion = hashesOfMotion(world);
  write(ChunkKind::Step, step.toBytes());
  ++steps;
  if (status.ok()) save(ended);
}

Recorder::Recorder(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Recorder::~Recorder() = default;

Result<std::unique_ptr<Recorder>> Recorder::start(btDeformableMultiBodyDynamicsWorld& world, const std::string& path,
                                                  const RecorderOptions& options) {
  if (options.snapshotEvery < 1) {
    return Status{StatusCode::InvalidOption, "RecorderOptions::snapshotEvery must be at least 1"};
  }
  auto impl = std::make_unique<Impl>(world, options);
  impl->save(impl->ended);
  if (!impl->status.ok()) return impl->status;
  if (Status opened = impl->file.open(path); !opened.ok()) return opened;
  impl->write(ChunkKind::Description, Bytes(options.description.begin(), options.description.end()));
  if (!impl->status.ok()) return impl->status;
  return std::unique_ptr<Recorder>(new Recorder(std::move(impl)));
}

int Recorder::step(btScalar seconds, int maxSubSteps, btScalar fixedTimeStep) {
  StepChunk step;
  step.seconds = static_cast<double>(seconds);
  step.maxSubSteps = maxSubSteps;
  step.fixedTimeStep = static_cast<double>(fixedTimeStep);
  if (impl_->status.ok()) impl_->before(step);
  const int made = impl_->world.stepSimulation(seconds, maxSubSteps, fixedTimeStep);
  if (impl_->status.ok()) impl_->after(step);
  return made;
}

const Status& Recorder::status() const {
  return impl_->status;
}

std::size_t Recorder::steps() const {
  return impl_->steps;
}

}  // namespace tetskin
