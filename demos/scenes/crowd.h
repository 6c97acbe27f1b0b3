// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include "scenes/scene.h"

namespace tetskin::scenes {

/// In the scene "crowd" every tenth body is always awake; the others may be put to sleep.
inline bool alwaysAwake(std::size_t body) {
  return body % 10 == 0;
}
inline std::size_t awakeAmong(std::size_t bodies) {
  return (bodies + 9) / 10;
}
/// Puts nine of ten bodies to sleep, or wakes them up.
void setAsleep(Scene& crowd, bool asleep);
std::size_t asleepCount(const Scene& crowd);

}  // namespace tetskin::scenes
