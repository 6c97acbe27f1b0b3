// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <string>

namespace tetskin::scenes {

/// Tells how far long work has come on standard output: a bar on a terminal, a line every tenth otherwise.
class Progress {
 public:
  /// total  steps of the whole work, above 0; quiet: prints nothing
  Progress(std::string what, int total, bool quiet);
  /// After step `done` of total.
  void show(int done);

 private:
  std::string what_;
  int total_;
  bool quiet_;
  bool terminal_;
  int lastTenth_ = 0;
};

}  // namespace tetskin::scenes
