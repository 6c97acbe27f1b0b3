// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "scenes/table.h"

namespace tetskin::scenes {

/// Each body floats a little higher than the previous one: their boxes overlap.
std::unique_ptr<Scene> makeFloat(const Cage& cage, const SceneOptions& options) {
  constexpr double kShift = 0.05;  // in units of the body's size
  auto scene = std::make_unique<Scene>(options, 0.0);
  for (std::size_t k = 0; k < options.bodies; ++k) {
    scene->add(cage, {}, kShift * options.size * static_cast<double>(k) * Eigen::Vector3d::UnitY());
  }
  return scene;
}

}  // namespace tetskin::scenes
