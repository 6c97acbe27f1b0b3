// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "scenes/crowd.h"

#include <cmath>

#include "scenes/table.h"

namespace tetskin::scenes {

/// A crowd in which any body may sleep.
std::unique_ptr<Scene> makeCrowd(const Cage& cage, const SceneOptions& options) {
  constexpr double kSpacing = 2.0;  // between neighbours, in units of the body's size
  auto scene = std::make_unique<Scene>(options, kEarth);
  const auto columns = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(options.bodies))));
  for (std::size_t i = 0; i < options.bodies; ++i) {
    const std::size_t row = i / columns;
    const Eigen::Vector3d where(static_cast<double>(i % columns), 0.0, static_cast<double>(row));
    scene->add(cage, {}, kSpacing * options.size * where).forceActivationState(ACTIVE_TAG);
  }
  return scene;
}

void setAsleep(Scene& crowd, bool asleep) {
  for (std::size_t i = 0; i < crowd.bodyCount(); ++i) {
    if (!alwaysAwake(i)) crowd.body(i).forceActivationState(asleep ? ISLAND_SLEEPING : ACTIVE_TAG);
  }
}

std::size_t asleepCount(const Scene& crowd) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < crowd.bodyCount(); ++i) count += !crowd.body(i).isActive();
  return count;
}

}  // namespace tetskin::scenes
