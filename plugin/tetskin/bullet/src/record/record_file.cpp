// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/bullet/src/record/record_file.h>
#include <tetskin/core/src/base/bytes.h>

#include <algorithm>
#include <filesystem>

namespace tetskin::bullet_detail {
namespace {

/// The first bytes of a file; the digits are those of the format's version.
constexpr char kMagic[] = "tetskin replay 01\n";
constexpr std::size_t kMagicSize = sizeof kMagic - 1;

struct ChunkHead {
  std::uint32_t kind = 0, size = 0;
  std::uint64_t hash = 0;
};

std::uint64_t hashOfChunk(std::uint32_t kind, const Bytes& bytes) {
  return tetskin::hashOf(bytes.data(), bytes.size()) ^ kind;
}

template <class T>
void put(Bytes& bytes, const T* values, std::size_t count) {
  const auto* from = reinterpret_cast<const unsigned char*>(values);
  bytes.insert(bytes.end(), from, from + count * sizeof(T));
}

template <class Vector>
void putList(Bytes& bytes, const Vector& values) {
  const auto count = static_cast<std::uint32_t>(values.size());
  put(bytes, &count, 1);
  put(bytes, values.data(), values.size());
}

/// Takes values off bytes, as long as there are enough.
class Taker {
 public:
  explicit Taker(const Bytes& bytes) : bytes_(bytes) {}
  template <class T>
  void take(T* values, std::size_t count) {
    if (count > (bytes_.size() - at_) / sizeof(T)) {
      whole_ = false;
      return;
    }
    if (count > 0) std::memcpy(values, &bytes_[at_], count * sizeof(T));
    at_ += count * sizeof(T);
  }
  template <class Vector>
  void takeList(Vector& values) {
    std::uint32_t count = 0;
    take(&count, 1);
    if (count > (bytes_.size() - at_) / sizeof(values[0])) {
      whole_ = false;
      return;
    }
    values.resize(count);
    take(values.data(), count);
  }
  bool isWhole() const { return whole_ && at_ == bytes_.size(); }

 private:
  const Bytes& bytes_;
  std::size_t at_ = 0;
  bool whole_ = true;
};

}  // namespace

Bytes StepChunk::toBytes() const {
  Bytes bytes;
  put(bytes, &seconds, 1);
  put(bytes, &maxSubSteps, 1);
  put(bytes, &fixedTimeStep, 1);
  putList(bytes, change);
  putList(bytes, kinematic);
  putList(bytes, motion);
  return bytes;
}

std::optional<StepChunk> StepChunk::fromBytes(const Bytes& bytes) {
  StepChunk step;
  Taker taker(bytes);
  taker.take(&step.seconds, 1);
  taker.take(&step.maxSubSteps, 1);
  taker.take(&step.fixedTimeStep, 1);
  taker.takeList(step.change);
  taker.takeList(step.kinematic);
  taker.takeList(step.motion);
  if (!taker.isWhole()) return {};
  return step;
}

Bytes WorldBuildUp::toBytes() const {
  Bytes bytes;
  putList(bytes, described);
  putList(bytes, reason);
  return bytes;
}

std::optional<WorldBuildUp> WorldBuildUp::fromBytes(const Bytes& bytes) {
  WorldBuildUp buildUp;
  Taker taker(bytes);
  taker.takeList(buildUp.described);
  taker.takeList(buildUp.reason);
  if (!taker.isWhole()) return {};
  return buildUp;
}

Status RecordWriter::open(const std::string& path) {
  path_ = path;
  file_.open(std::filesystem::u8path(path), std::ios::binary | std::ios::trunc);
  file_.write(kMagic, kMagicSize);
  file_.flush();
  if (file_) return {};
  return {StatusCode::FileNotWritable, path + ": cannot be written; choose another place"};
}

Status RecordWriter::write(ChunkKind kind, const Bytes& bytes) {
  const auto number = static_cast<std::uint32_t>(kind);
  const ChunkHead head{number, static_cast<std::uint32_t>(bytes.size()), hashOfChunk(number, bytes)};
  file_.write(reinterpret_cast<const char*>(&head), sizeof head);
  file_.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  file_.flush();
  if (file_) return {};
  return {StatusCode::FileNotWritable, path_ + ": cannot be written any more; is the disk full?"};
}

Status RecordReader::open(const std::string& path) {
  path_ = path;
  file_.open(std::filesystem::u8path(path), std::ios::binary | std::ios::ate);
  if (!file_) return {StatusCode::FileNotFound, path + ": cannot be opened"};
  size_ = static_cast<std::uint64_t>(std::max<std::streamoff>(0, file_.tellg()));
  char magic[kMagicSize] = {};
  file_.seekg(0);
  file_.read(magic, kMagicSize);
  if (!file_ || std::memcmp(magic, kMagic, kMagicSize) != 0) {
    return {StatusCode::Malformed, path + ": is no run that tetskin's Recorder has written, or of another version"};
  }
  left_ = size_ - kMagicSize;
  return {};
}

Result<std::optional<Chunk>> RecordReader::next() {
  ChunkHead head;
  if (left_ == 0) return std::optional<Chunk>();
  if (left_ >= sizeof head) file_.read(reinterpret_cast<char*>(&head), sizeof head);
  if (left_ < sizeof head || left_ - sizeof head < head.size) {
    cutShort_ = true;
    left_ = 0;
    return std::optional<Chunk>();
  }
  Chunk chunk;
  chunk.kind = static_cast<ChunkKind>(head.kind);
  chunk.bytes.resize(head.size);
  file_.read(reinterpret_cast<char*>(chunk.bytes.data()), head.size);
  if (!file_ || hashOfChunk(head.kind, chunk.bytes) != head.hash) {
    return Status{StatusCode::Malformed, path_ + ": is damaged at byte " + std::to_string(size_ - left_)};
  }
  left_ -= sizeof head + head.size;
  return std::optional<Chunk>(std::move(chunk));
}

}  // namespace tetskin::bullet_detail
