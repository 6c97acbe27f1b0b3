// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The scene of tetskin_drop. It does not use the table of all scenes, so that a first build compiles no other scene.
#pragma once

#include <tetskin/core/cage.h>
#include <memory>

#include "scenes/scene.h"

namespace tetskin::scenes {

/// A body above a floor, a ramp and a dome.
std::unique_ptr<Scene> makeObstacles(const Cage& cage, const SceneOptions& options);

}  // namespace tetskin::scenes
