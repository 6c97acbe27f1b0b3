// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to Recorder: the file, a sequence of chunks. Numbers in them have the machine's own byte order, which the
// snapshots state.
#pragma once

#include <tetskin/core/types.h>
#include <tetskin/replay/src/record/state_patch.h>

#include <cstdint>
#include <fstream>
#include <optional>
#include <string>

namespace tetskin {
class StateStream;
}

namespace tetskin::bullet_detail {

/// What a chunk holds. The values are part of the file format.
enum class ChunkKind : std::uint32_t {
  Description = 1,  ///< text
  Snapshot = 2,     ///< the state before the next step
  Change = 3,       ///< the same, after objects were added or removed
  Step = 4,         ///< see StepChunk
};

struct Chunk {
  ChunkKind kind = ChunkKind::Description;
  Bytes bytes;
};

/// Arguments of `stepSimulation`, what has changed before it, and the motion after it.
struct StepChunk {
  double seconds = 0;
  std::int32_t maxSubSteps = 0;
  double fixedTimeStep = 0;
  Bytes change;                       ///< difference from the snapshot after the last step to the one before this step
  Bytes kinematic;                    ///< see LedToTargets
  std::vector<std::uint32_t> motion;  ///< by object: a hash of its motion after the step

  void serialize(StateStream& stream);
  Bytes toBytes();
  /// Empty if the bytes are not such a chunk.
  static std::optional<StepChunk> fromBytes(const Bytes& bytes);
};

/// Lengths in files have 32 bits: the difference of two states, including its headers, is less than twice as long as
/// one state.
constexpr bool isRecordable(std::uint64_t bytes) {
  return bytes < 0x80000000u;
}

class RecordWriter {
 public:
  /// Error: FileNotWritable.
  Status open(const std::string& path);
  /// Writes the chunk at once, so that it is in the file if the program crashes. Errors: FileNotWritable; NotSaved: it
  /// is too large.
  Status write(ChunkKind kind, const Bytes& bytes);

 private:
  std::string path_;
  std::ofstream file_;
};

class RecordReader {
 public:
  /// Errors: FileNotFound; Malformed: not the beginning of such a file.
  Status open(const std::string& path);
  /// The next chunk; empty at the end. An incomplete chunk counts as the end, and `isCutShort` is true from then on.
  /// Errors: Malformed: a chunk is damaged.
  Result<std::optional<Chunk>> next();
  bool isCutShort() const { return cutShort_; }

 private:
  std::string path_;
  std::ifstream file_;
  std::uint64_t left_ = 0, size_ = 0;  ///< bytes not read yet, and of the whole file
  bool cutShort_ = false;
};

}  // namespace tetskin::bullet_detail
