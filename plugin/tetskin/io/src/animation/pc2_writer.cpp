// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/bytes.h>
#include <tetskin/io/animation.h>
#include <tetskin/io/src/text/atomic_file.h>
#include <tetskin/io/src/text/file_text.h>

#include <cmath>
#include <limits>
#include <utility>

namespace tetskin {
namespace {

/// Position of the number of frames in the header: after the name, the version, the number of vertices, the first frame
/// and the step.
constexpr long kFrameCountOffset = 28;

Status cacheFinished() {
  return {StatusCode::FileNotWritable, "the point cache is finished; create another writer"};
}

}  // namespace

struct Pc2Writer::Impl {
  std::string path;
  std::size_t vertexCount = 0;
  std::uint32_t frames = 0;
  io::AtomicFile file;
  std::string buffer;  ///< of one frame
};

Pc2Writer::Pc2Writer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Pc2Writer::~Pc2Writer() = default;
Pc2Writer::Pc2Writer(Pc2Writer&& other) noexcept = default;
Pc2Writer& Pc2Writer::operator=(Pc2Writer&& other) noexcept = default;

Result<Pc2Writer> Pc2Writer::create(const std::string& path, std::size_t vertexCount, float first, float step) {
  if (vertexCount > Limits::kMaxVertices) {
    return io::fileError(StatusCode::TooLarge, path, 0, "cannot hold so many vertices: at most 2147483647");
  }
  Result<io::AtomicFile> file = io::AtomicFile::create(path);
  if (!file.ok()) return file.status();
  if (!file.value().replaceable()) {
    return io::fileError(StatusCode::FileNotWritable, path, 0,
                         "is not a regular file, as a point cache must be; give the path of a file");
  }
  auto impl = std::make_unique<Impl>();
  impl->path = path;
  impl->vertexCount = vertexCount;
  impl->file = std::move(file).value();
  std::string header("POINTCACHE2\0", 12);
  appendLittleEndian(std::uint32_t{1}, header);
  appendLittleEndian(static_cast<std::uint32_t>(vertexCount), header);
  appendLittleEndian(first, header);
  appendLittleEndian(step, header);
  appendLittleEndian(std::uint32_t{0}, header);
  if (Status status = impl->file.append(header); !status.ok()) return status;
  return Pc2Writer(std::move(impl));
}

template <class Scalar>
Status Pc2Writer::add(PointView<const Scalar> positions) {
  if (!impl_) return cacheFinished();
  if (positions.size() != impl_->vertexCount) {
    return io::fileError(StatusCode::SizeMismatch, impl_->path, 0,
                         std::to_string(positions.size()) + " positions were given for " +
                             std::to_string(impl_->vertexCount) + " vertices");
  }
  const std::size_t bad = firstUnusable(positions);
  if (bad < positions.size()) {
    return io::fileError(StatusCode::NonFinite, impl_->path, 0,
                         "vertex " + std::to_string(bad) + " in frame " + std::to_string(impl_->frames) +
                             " is not finite, or too far away");
  }
  impl_->buffer.clear();
  for (std::size_t v = 0; v < positions.size(); ++v) {
    for (int k = 0; k < 3; ++k) appendLittleEndian(static_cast<float>(positions[v][k]), impl_->buffer);
  }
  Status status = impl_->file.append(impl_->buffer);
  if (status.ok()) ++impl_->frames;
  return status;
}

Status Pc2Writer::addFrame(PointView<const float> positions) {
  return add(positions);
}
Status Pc2Writer::addFrame(PointView<const double> positions) {
  return add(positions);
}

Status Pc2Writer::finish() {
  if (!impl_) return cacheFinished();
  const std::unique_ptr<Impl> impl = std::move(impl_);
  if (impl->frames == 0) {
    return io::fileError(StatusCode::Empty, impl->path, 0, "cannot be written without frames; add one first");
  }
  std::string count;
  appendLittleEndian(impl->frames, count);
  Status status = impl->file.overwrite(kFrameCountOffset, count);
  return status.ok() ? impl->file.finish() : status;
}

}  // namespace tetskin
