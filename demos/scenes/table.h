// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/cage.h>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "scenes/scene.h"

namespace tetskin::scenes {

/// Makes a scene with a cage that already has its size in Bullet's world (see `placementOf`), centred at the origin.
/// Throws InputError if Bullet cannot make a body of it, or if the scene pins none of its nodes.
using MakeScene = std::unique_ptr<Scene> (*)(const Cage& cage, const SceneOptions& options);

struct SceneEntry {
  std::string name;
  int frames;         ///< number of frames if the options do not give one
  bool lands;         ///< bodies touch a floor
  std::string about;  ///< description for people: what happens to the body
  MakeScene maker;

  std::unique_ptr<Scene> make(const Cage& cage, SceneOptions options = {}) const;
};

/// All scenes.
const std::vector<SceneEntry>& sceneTable();
/// All names, separated by commas.
std::string sceneNames();
/// The scene with this name. Throws InputError, with all names, if there is none.
const SceneEntry& sceneNamed(const std::string& name);
/// The function that makes this scene, for `Player`. Throws InputError, with all names, if there is none.
std::function<std::unique_ptr<Scene>(const Cage&, const SceneOptions&)> makerOf(const std::string& name);

}  // namespace tetskin::scenes
