// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/replay/src/record/state_patch.h>

#include <algorithm>
#include <cassert>
#include <cstring>

namespace tetskin::bullet_detail {
namespace {

/// A run's header: bytes kept before it, bytes taken out, bytes put in.
struct RunHead {
  std::uint32_t kept, taken, put;
};
/// A gap of equal bytes up to this length is cheaper to write than another header.
constexpr std::size_t kGap = sizeof(RunHead);

void addRun(Bytes& difference, RunHead head, const unsigned char* put) {
  const auto* bytes = reinterpret_cast<const unsigned char*>(&head);
  difference.insert(difference.end(), bytes, bytes + sizeof head);
  difference.insert(difference.end(), put, put + head.put);
}

std::uint32_t narrow(std::size_t count) {
  assert(count <= 0xFFFFFFFFu);
  return static_cast<std::uint32_t>(count);
}

/// The first differing byte from `k` on.
std::size_t nextOther(const Bytes& from, const Bytes& to, std::size_t k) {
  return static_cast<std::size_t>(std::mismatch(from.begin() + static_cast<std::ptrdiff_t>(k), from.end(),
                                                to.begin() + static_cast<std::ptrdiff_t>(k))
                                      .first -
                                  from.begin());
}

Bytes differenceInPlaces(const Bytes& from, const Bytes& to) {
  Bytes difference;
  std::size_t written = 0;
  for (std::size_t first = nextOther(from, to, 0); first < to.size();) {
    std::size_t last = first + 1, next = nextOther(from, to, last);
    while (next < to.size() && next - last <= kGap) {
      last = next + 1;
      next = nextOther(from, to, last);
    }
    addRun(difference, {narrow(first - written), narrow(last - first), narrow(last - first)}, &to[first]);
    written = last;
    first = next;
  }
  return difference;
}

Bytes differenceInOneRun(const Bytes& from, const Bytes& to) {
  const std::size_t least = std::min(from.size(), to.size());
  std::size_t before = 0, after = 0;
  while (before < least && from[before] == to[before]) ++before;
  while (after < least - before && from[from.size() - 1 - after] == to[to.size() - 1 - after]) ++after;
  Bytes difference;
  addRun(difference, {narrow(before), narrow(from.size() - before - after), narrow(to.size() - before - after)},
         to.data() + before);
  return difference;
}

}  // namespace

Bytes differenceOf(const Bytes& from, const Bytes& to) {
  return from.size() == to.size() ? differenceInPlaces(from, to) : differenceInOneRun(from, to);
}

std::optional<Bytes> applied(const Bytes& difference, const Bytes& from) {
  Bytes to;
  to.reserve(from.size());
  std::size_t read = 0;
  for (std::size_t k = 0; k < difference.size();) {
    RunHead head;
    if (difference.size() - k < sizeof head) return {};
    std::memcpy(&head, &difference[k], sizeof head);
    k += sizeof head;
    if (head.kept > from.size() - read || head.taken > from.size() - read - head.kept) return {};
    if (head.put > difference.size() - k) return {};
    const auto at = [](const Bytes& bytes, std::size_t index) {
      return bytes.begin() + static_cast<std::ptrdiff_t>(index);
    };
    to.insert(to.end(), at(from, read), at(from, read + head.kept));
    to.insert(to.end(), at(difference, k), at(difference, k + head.put));
    read += head.kept + head.taken;
    k += head.put;
  }
  to.insert(to.end(), from.begin() + static_cast<std::ptrdiff_t>(read), from.end());
  return to;
}

}  // namespace tetskin::bullet_detail
