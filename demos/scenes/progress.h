// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <cstdio>
#include <string>

#include "scenes/timer.h"

namespace tetskin::scenes {

/// Prints the progress of long work, and the time that it will take: a bar on a terminal, otherwise a line at every
/// tenth.
class Progress {
 public:
  /// total  steps of the whole work, above 0; quiet  prints nothing
  Progress(std::string what, int total, bool quiet, std::FILE* stream = stdout);
  /// Call after step `done` of `total`.
  void show(int done);

 private:
  std::string timeLeft(int done) const;

  std::string what_;
  int total_;
  bool quiet_;
  std::FILE* stream_;
  bool terminal_;
  WallTimer timer_;
  int lastTenth_ = 0;
};

}  // namespace tetskin::scenes
