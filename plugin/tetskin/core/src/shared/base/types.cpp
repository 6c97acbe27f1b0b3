// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/types.h>

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
      return "of another cage";
    case StatusCode::TooLarge:
      return "too large";
  }
  return "unknown status";
}

}  // namespace tetskin
