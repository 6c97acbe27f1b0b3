// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/bytes.h>
#include <tetskin/core/src/base/state/state_stream.h>
#include <tetskin/replay/src/record/record_file.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <limits>

namespace tetskin::bullet_detail {
namespace {

/// The first bytes of a file; the digits are the format's version.
constexpr char kMagic[] = "tetskin replay 03\n";
constexpr std::size_t kMagicSize = sizeof kMagic - 1;

struct ChunkHead {
  std::uint32_t kind = 0, size = 0;
  std::uint64_t hash = 0;
};

std::uint64_t hashOfChunk(std::uint32_t kind, const Bytes& bytes) {
  return tetskin::hashOf(bytes.data(), bytes.size()) ^ kind;
}

}  // namespace

void StepChunk::serialize(StateStream& stream) {
  stream(seconds, maxSubSteps, fixedTimeStep);
  stream.array(change);
  stream.array(kinematic);
  stream.array(motion);
}
Bytes StepChunk::toBytes() {
  return bytesWrittenBy([this](StateStream& stream) { serialize(stream); });
}
std::optional<StepChunk> StepChunk::fromBytes(const Bytes& bytes) {
  StepChunk chunk;
  StateStream read(bytes.data(), bytes.size());
  chunk.serialize(read);
  if (read.failed() || read.count() != bytes.size()) return {};
  return chunk;
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
  if (bytes.size() > std::numeric_limits<std::uint32_t>::max()) {
    return {StatusCode::NotSaved, path_ + ": the world has a part of more than 4 GB, which a file cannot hold"};
  }
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
    return {StatusCode::Malformed, path + ": was not written by tetskin's Recorder, or is of another version"};
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
