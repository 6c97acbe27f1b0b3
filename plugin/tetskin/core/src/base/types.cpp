// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/types.h>

#include <cstdio>
#include <exception>
#include <stdexcept>

namespace tetskin {

namespace {

struct Words {
  const char* name;  ///< as in the enumeration
  const char* said;  ///< to people
};

/// By their codes.
constexpr Words kWords[] = {
    {"Ok", "ok"},
    {"FileNotFound", "file not found"},
    {"FileNotWritable", "file not writable"},
    {"UnsupportedFormat", "unsupported format"},
    {"Malformed", "malformed"},
    {"Empty", "empty"},
    {"IndexOutOfRange", "index out of range"},
    {"NonFinite", "not finite"},
    {"Degenerate", "degenerate"},
    {"SizeMismatch", "size mismatch"},
    {"InvalidOption", "invalid option"},
    {"OutsideCage", "outside the cage"},
    {"CageMismatch", "cage mismatch"},
    {"TooLarge", "too large"},
    {"Asleep", "asleep"},
    {"Hidden", "hidden"},
    {"Unbound", "unbound"},
    {"TopologyChanged", "topology changed"},
    {"NoHit", "no hit"},
    {"BodyDeleted", "body deleted"},
    {"Released", "released"},
    {"OtherBody", "other body"},
    {"NotInWorld", "not in the world"},
    {"NotAdded", "not added"},
    {"Enclosed", "enclosed by another body"},
    {"NotSaved", "cannot be saved"},
    {"SnapshotMismatch", "snapshot of another world"},
    {"Cancelled", "cancelled"},
};
static_assert(sizeof kWords / sizeof *kWords == static_cast<std::size_t>(StatusCode::Cancelled) + 1);

const Words& wordsOf(StatusCode code) {
  static constexpr Words kUnknown = {"Unknown", "unknown status"};
  const auto index = static_cast<std::size_t>(code);
  return index < sizeof kWords / sizeof *kWords ? kWords[index] : kUnknown;
}

}  // namespace

const char* toString(StatusCode code) {
  return wordsOf(code).said;
}

const char* nameOf(StatusCode code) {
  return wordsOf(code).name;
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
