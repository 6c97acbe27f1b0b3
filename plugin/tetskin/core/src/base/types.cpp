// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/types.h>

#include <cstdio>
#include <exception>
#include <stdexcept>

namespace tetskin {

const char* toString(StatusCode code) {
  switch (code) {
    case StatusCode::Ok:
      return "ok";
    case StatusCode::FileNotFound:
      return "file not found";
    case StatusCode::FileNotWritable:
      return "file not writable";
    case StatusCode::UnsupportedFormat:
      return "unsupported format";
    case StatusCode::Malformed:
      return "malformed";
    case StatusCode::Empty:
      return "empty";
    case StatusCode::IndexOutOfRange:
      return "index out of range";
    case StatusCode::NonFinite:
      return "not finite";
    case StatusCode::Degenerate:
      return "degenerate";
    case StatusCode::SizeMismatch:
      return "size mismatch";
    case StatusCode::InvalidOption:
      return "invalid option";
    case StatusCode::OutsideCage:
      return "outside the cage";
    case StatusCode::CageMismatch:
      return "cage mismatch";
    case StatusCode::TooLarge:
      return "too large";
    case StatusCode::Asleep:
      return "asleep";
    case StatusCode::Hidden:
      return "hidden";
    case StatusCode::Unbound:
      return "unbound";
    case StatusCode::TopologyChanged:
      return "topology changed";
    case StatusCode::NoHit:
      return "no hit";
    case StatusCode::BodyDeleted:
      return "body deleted";
    case StatusCode::Released:
      return "released";
    case StatusCode::OtherBody:
      return "other body";
    case StatusCode::NotInWorld:
      return "not in the world";
    case StatusCode::NotAdded:
      return "not added";
    case StatusCode::Enclosed:
      return "enclosed by another body";
    case StatusCode::NotSaved:
      return "cannot be saved";
    case StatusCode::SnapshotMismatch:
      return "snapshot of another world";
    case StatusCode::Cancelled:
      return "cancelled";
  }
  return "unknown status";
}

void failResult(const std::string& message) {
#ifdef __cpp_exceptions
  throw std::logic_error(message);
#else
  std::fprintf(stderr, "%s\n", message.c_str());
  std::terminate();
#endif
}

}  // namespace tetskin
