// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/io/obj_sequence.h>
#include <tetskin/io/src/text/atomic_file.h>
#include <tetskin/io/src/text/file_text.h>

#include <cassert>
#include <cstdio>
#include <filesystem>
#include <system_error>
#include <utility>

namespace tetskin {

namespace fs = std::filesystem;

Result<ObjSequenceWriter> ObjSequenceWriter::create(const std::string& directory, const ObjLayout& layout,
                                                    std::string baseName) {
  ObjSequenceWriter writer;
  writer.directory_ = directory.empty() ? "." : directory;
  writer.baseName_ = std::move(baseName);
  std::error_code error;
  fs::create_directories(writer.directory_, error);
  if (!fs::is_directory(writer.directory_)) {
    return io::fileError(StatusCode::FileNotWritable, directory, 0,
                         "the folder cannot be created: " + error.message() + "; choose another one");
  }
  const std::string probe = (fs::path(writer.directory_) / (writer.baseName_ + "probe")).string();
  const Status writable = io::writeFile(probe, "");
  fs::remove(probe, error);
  if (!writable.ok()) {
    return io::fileError(StatusCode::FileNotWritable, directory, 0,
                         "no file can be created in this folder: " + writable.message);
  }
  writer.layout_ = layout.forFolder(writer.directory_);
  return writer;
}

std::string ObjSequenceWriter::framePath(int frame) const {
  assert(frame >= 0);
  char number[16];
  std::snprintf(number, sizeof(number), "%04d", frame);
  return (fs::path(directory_) / (baseName_ + number + ".obj")).string();
}

template <class Scalar>
Status ObjSequenceWriter::writeFrame(int frame, PointView<const Scalar> positions, PointView<const float> normals) {
  const std::string path = framePath(frame);
  Status status = layout_.checkPoints(path, positions, normals);
  if (!status.ok()) return status;
  return io::writeFile(path, layout_.format(positions, buffer_, normals));
}

Status ObjSequenceWriter::write(int frame, PointView<const float> positions, PointView<const float> normals) {
  return writeFrame(frame, positions, normals);
}

Status ObjSequenceWriter::write(int frame, PointView<const double> positions, PointView<const float> normals) {
  return writeFrame(frame, positions, normals);
}

}  // namespace tetskin
