// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "scenes/progress.h"

#include <cstdio>
#include <utility>

#include "scenes/system.h"

namespace tetskin::scenes {

Progress::Progress(std::string what, int total, bool quiet, std::FILE* stream)
    : what_(std::move(what)), total_(total), quiet_(quiet), stream_(stream), terminal_(isTerminal(stream)) {}

void Progress::show(int done) {
  if (quiet_) return;
  constexpr int kWidth = 40;
  const auto share = [&](int components) {
    return static_cast<int>(static_cast<long long>(components) * done / total_);
  };
  if (terminal_) {
    const std::string bar(static_cast<std::size_t>(share(kWidth)), '#');
    std::fprintf(stream_, "\r%s [%-*s] %d/%d%s\033[K", what_.c_str(), kWidth, bar.c_str(), done, total_,
                 timeLeft(done).c_str());
    if (done == total_) std::fprintf(stream_, "\n");
  } else if (const int tenth = share(10); tenth > lastTenth_) {
    std::fprintf(stream_, "%s %d/%d%s\n", what_.c_str(), done, total_, timeLeft(done).c_str());
    lastTenth_ = tenth;
  }
  std::fflush(stream_);
}

std::string Progress::timeLeft(int done) const {
  const double elapsed = timer_.seconds();
  if (elapsed < 1.0 || done <= 0 || done == total_) return {};
  const auto seconds = static_cast<long long>(elapsed * (total_ - done) / done + 0.5);
  char text[48];
  std::snprintf(text, sizeof text, ", %lld:%02lld left", seconds / 60, seconds % 60);
  return text;
}

}  // namespace tetskin::scenes
