// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// JavaScript's handles: shares of a world and of its objects.
#pragma once

#include "guarded.h"

#include <facade/worlds.h>

namespace tetskin::js {

/// A world, with the times of its last step in milliseconds, in the order of StageTimes in tetskin.d.ts.
struct WorldHandle {
  std::shared_ptr<World> world;
  std::array<double, 8> times{};
  std::vector<float> poses;
};
struct BodyHandle {
  std::shared_ptr<World> world;
  std::shared_ptr<World::Body> state;
  std::vector<float> nodes, velocities;  ///< of the last call that asked for them, contiguous
};
struct RigidHandle {
  std::shared_ptr<World> world;
  std::shared_ptr<World::RigidBody> state;
};
struct SpringHandle {
  std::shared_ptr<World> world;
  std::shared_ptr<World::Touch> state;
  SurfacePoint point;
};

inline Vec3 vectorOf(const btVector3& v) {
  return {static_cast<double>(v.x()), static_cast<double>(v.y()), static_cast<double>(v.z())};
}
/// An option that is not given is NaN.
inline std::optional<double> given(double option) {
  return option == option ? std::optional(option) : std::nullopt;
}

}  // namespace tetskin::js
