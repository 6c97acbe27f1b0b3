// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include "scenes/twist.h"

namespace tetskin::scenes {

/// When what happens in the scene "wring", in frames. Twice as fast, and the twist gathers at the moved end.
constexpr int kTurned = 120, kReleased = 150;

/// The twist between its held ends, in a frame before the release.
Twist wringAt(const Box3& cage, int frame);

}  // namespace tetskin::scenes
