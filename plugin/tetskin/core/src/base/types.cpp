// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/types.h>

#include <cstdio>
#include <exception>
#include <stdexcept>

namespace tetskin {

namespace {

/// By code.
constexpr const char* kWords[] = {
    "ok",
    "file not found",
    "file not writable",
    "unsupported format",
    "malformed",
    "empty",
    "index out of range",
    "not finite",
    "degenerate",
    "size mismatch",
    "invalid option",
    "outside the cage",
    "cage mismatch",
    "too large",
    "asleep",
    "hidden",
    "unbound",
    "topology changed",
    "no hit",
    "body deleted",
    "released",
    "other body",
    "not in the world",
    "not added",
    "enclosed by another body",
    "cannot be saved",
    "snapshot of another world",
    "cancelled",
};
static_assert(sizeof kWords / sizeof *kWords == static_cast<std::size_t>(StatusCode::Cancelled) + 1);

}  // namespace

const char* toString(StatusCode code) {
  const auto index = static_cast<std::size_t>(code);
  return index < sizeof kWords / sizeof *kWords ? kWords[index] : "unknown status";
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
