// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/types.h>

#include <functional>

namespace tetskin {

/// Tells an application how much of a long computation is done, and learns whether to go on.
class Progress {
 public:
  /// tell  returns false to cancel; may be empty; must outlive this
  explicit Progress(const std::function<bool(double fraction)>& tell) : tell_(tell) {}

  /// Tells the fraction, unless the application has cancelled. Returns false if it has, now or before.
  bool reach(double fraction) {
    if (!cancelled_ && tell_) cancelled_ = !tell_(fraction);
    return !cancelled_;
  }
  bool cancelled() const { return cancelled_; }

 private:
  const std::function<bool(double)>& tell_;
  bool cancelled_ = false;
};

/// The status of a computation that was cancelled.
inline Status cancelledStatus(const char* what) {
  return {StatusCode::Cancelled, std::string(what) + " was cancelled by its progress function"};
}

}  // namespace tetskin
