// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "scenes/progress.h"

#include <unistd.h>

#include <cstdio>
#include <utility>

namespace tetskin::scenes {

Progress::Progress(std::string what, int total, bool quiet)
    : what_(std::move(what)), total_(total), quiet_(quiet), terminal_(isatty(STDOUT_FILENO) != 0) {}

void Progress::show(int done) {
  if (quiet_) return;
  constexpr int kWidth = 40;
  if (terminal_) {
    const std::string bar(static_cast<std::size_t>(kWidth * done / total_), '#');
    std::printf("\r%s [%-*s] %d/%d", what_.c_str(), kWidth, bar.c_str(), done, total_);
    if (done == total_) std::printf("\n");
  } else if (const int tenth = 10 * done / total_; tenth > lastTenth_) {
    std::printf("%s %d/%d\n", what_.c_str(), done, total_);
    lastTenth_ = tenth;
  }
  std::fflush(stdout);
}

}  // namespace tetskin::scenes
