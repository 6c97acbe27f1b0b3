// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/replay/recorder.h>
#include <tetskin/replay/snapshot.h>
#include <tetskin/replay/src/record/object_motion.h>
#include <tetskin/replay/src/record/record_file.h>
#include <tetskin/replay/src/state/snapshot_bytes.h>

#include <algorithm>

namespace tetskin {

using namespace bullet_detail;

namespace {

Status malformed(const std::string& path, const std::string& fault) {
  return {StatusCode::Malformed, path + ": " + fault};
}

}  // namespace

struct Replay::Impl {
  Impl(btDeformableMultiBodyDynamicsWorld& ofWorld, const std::string& ofPath) : world(ofWorld), path(ofPath) {}

  /// The next step's chunk, after the chunks before it have been applied; empty at the end, or on an error.
  std::optional<StepChunk> nextStep();
  Status begin();
  Status obey(const Chunk& chunk);
  Status prepare(const StepChunk& step);
  Status make(const StepChunk& step);
  void compareState(const Bytes& recorded);
  void compare(const StepChunk& step);

  btDeformableMultiBodyDynamicsWorld& world;
  std::string path;
  RecordReader file;
  std::function<void(std::size_t)> change;
  Bytes ended, now;      ///< the states after the last step, and now
  bool changed = false;  ///< the world is already in the state before the next step
  ReplayReport report;
  std::size_t next = 0;  ///< number of the next step
  Status status;
};

/// Reads up to the first snapshot: the state in which recording began.
Status Replay::Impl::begin() {
  for (;;) {
    Result<std::optional<Chunk>> chunk = file.next();
    if (!chunk.ok()) return chunk.status();
    if (!chunk.value()) return malformed(path, "has no step");
    const ChunkKind kind = chunk.value()->kind;
    if (kind == ChunkKind::Step) return malformed(path, "begins with a step");
    if (Status done = obey(*chunk.value()); !done.ok()) return done;
    if (kind == ChunkKind::Snapshot || kind == ChunkKind::Change) return {};
  }
}

/// Applies a chunk that precedes a step. A snapshot holds the state after the last step; for a change, the function set
/// by `onChange` is called first.
Status Replay::Impl::obey(const Chunk& chunk) {
  switch (chunk.kind) {
    case ChunkKind::Description:
      return {};
    case ChunkKind::Snapshot:
      if (!ended.empty()) {
        compareState(chunk.bytes);
        return {};
      }
      ended = chunk.bytes;
      return restoreSnapshot(world, ended.data(), ended.size());
    case ChunkKind::Change:
      if (change && next > 0) change(next);
      changed = true;
      return restoreSnapshot(world, chunk.bytes.data(), chunk.bytes.size());
    case ChunkKind::Step:
      break;
  }
  return malformed(path, "holds something of another version");
}

std::optional<StepChunk> Replay::Impl::nextStep() {
  for (;;) {
    Result<std::optional<Chunk>> chunk = file.next();
    status = chunk.status();
    if (!status.ok() || !chunk.value()) return {};
    if (chunk.value()->kind == ChunkKind::Step) {
      std::optional<StepChunk> step = StepChunk::fromBytes(chunk.value()->bytes);
      if (!step) status = malformed(path, "step " + std::to_string(next) + " is damaged");
      return step;
    }
    status = obey(*chunk.value());
    if (!status.ok()) return {};
  }
}

/// Brings the world from the state after the last step to the one before this step.
Status Replay::Impl::prepare(const StepChunk& step) {
  if (!changed) {
    const std::optional<Bytes> before = applied(step.change, ended);
    if (!before) return malformed(path, "the change before step " + std::to_string(next) + " is of another state");
    if (Status saved = saveInto(world, now); !saved.ok()) return saved;
    if (now != *before) {
      if (Status restored = restoreSnapshot(world, before->data(), before->size()); !restored.ok()) return restored;
    }
  }
  changed = false;
  return {};
}

Status Replay::Impl::make(const StepChunk& step) {
  const LedToTargets led(world, step.kinematic);
  if (!led.fits()) return malformed(path, "other bodies are kinematic in step " + std::to_string(next));
  const auto seconds = static_cast<btScalar>(step.seconds), fixed = static_cast<btScalar>(step.fixedTimeStep);
  world.stepSimulation(seconds, step.maxSubSteps, fixed);
  report.secondsPerStep = step.maxSubSteps > 0 ? fixed : seconds;
  ++next;
  return {};
}

void Replay::Impl::compareState(const Bytes& recorded) {
  if (ended == recorded) return;
  report.differs = true;
  report.object = "what the solver remembers, while all objects move as recorded";
}

void Replay::Impl::compare(const StepChunk& step) {
  const std::vector<std::uint32_t> motion = hashesOfMotion(world);
  const auto other = std::mismatch(motion.begin(), motion.end(), step.motion.begin(), step.motion.end());
  report.steps = next;
  if (other.first == motion.end() && other.second == step.motion.end()) return;
  report.differs = true;
  const auto index = static_cast<int>(other.first - motion.begin());
  const btCollisionObjectArray& objects = world.getCollisionObjectArray();
  report.object = index < objects.size() ? nameOf(*objects[index]) : "an object that no longer exists";
}

Replay::Replay(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Replay::~Replay() = default;

Result<std::unique_ptr<Replay>> Replay::open(btDeformableMultiBodyDynamicsWorld& world, const std::string& path) {
  auto impl = std::make_unique<Impl>(world, path);
  if (Status opened = impl->file.open(path); !opened.ok()) return opened;
  if (Status begun = impl->begin(); !begun.ok()) return begun;
  return std::unique_ptr<Replay>(new Replay(std::move(impl)));
}

Result<std::string> Replay::descriptionOf(const std::string& path) {
  RecordReader file;
  if (Status opened = file.open(path); !opened.ok()) return opened;
  Result<std::optional<Chunk>> chunk = file.next();
  if (!chunk.ok()) return chunk.status();
  if (!chunk.value() || chunk.value()->kind != ChunkKind::Description) return malformed(path, "has no description");
  const Bytes& text = chunk.value()->bytes;
  return std::string(text.begin(), text.end());
}

void Replay::onChange(std::function<void(std::size_t step)> change) {
  impl_->change = std::move(change);
}

bool Replay::step() {
  Impl& impl = *impl_;
  if (!impl.status.ok() || impl.report.differs) return false;
  const std::optional<StepChunk> step = impl.nextStep();
  impl.report.cutShort = impl.file.isCutShort();
  if (!step || impl.report.differs) return false;
  impl.status = impl.prepare(*step);
  if (impl.status.ok()) impl.status = impl.make(*step);
  if (!impl.status.ok()) return false;
  impl.compare(*step);
  impl.status = saveInto(impl.world, impl.ended);
  return true;
}

const ReplayReport& Replay::report() const {
  return impl_->report;
}

const Status& Replay::status() const {
  return impl_->status;
}

}  // namespace tetskin
