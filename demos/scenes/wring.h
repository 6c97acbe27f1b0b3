// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include "scenes/twist.h"

namespace tetskin::scenes {

/// The times of events in the scene "wring", in frames. If it were twice as fast, the twist would gather at the moved
/// end.
constexpr int kTurned = 120, kReleased = 150;

/// The twist between the pinned ends, in a frame before the release.
Twist wringAt(const Box3& cage, int frame);

}  // namespace tetskin::scenes
