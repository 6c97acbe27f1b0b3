// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/bullet/deformable_body.h>
#include <tetskin/core/tet_mesh.h>
#include <tetskin/core/triangle_mesh.h>

#include <memory>
#include <vector>

#include "scenes/deformable_world.h"

namespace tetskin::scenes {

/// Soft bodies of one cage in a deformable world, side by side in free fall, too far apart ever to meet. Every tenth is
/// always awake; the others may be put to sleep.
class Crowd {
 public:
  /// Largest side of a cage in Bullet's world: Bullet has absolute constants (sleep thresholds, clamps).
  static constexpr double kSize = 2.0;
  static constexpr std::size_t kPerAwake = 10;
  static constexpr int kSubsteps = 4;

  /// cage  of size kSize, see `scaleToCrowd`; throws InputError if Bullet cannot make a body of it
  Crowd(const TetMesh& cage, std::size_t bodies);

  std::size_t size() const { return bodies_.size(); }
  btSoftBody& body(std::size_t i) { return bodies_[i]->body(); }
  static bool alwaysAwake(std::size_t i) { return i % kPerAwake == 0; }
  static std::size_t awakeAmong(std::size_t bodies) { return (bodies + kPerAwake - 1) / kPerAwake; }

  /// Puts nine of ten bodies to sleep, or wakes them.
  void setAsleep(bool asleep);
  std::size_t asleepCount() const;
  /// One frame of 1/60 s; returns the number of substeps.
  int step();
  /// A frame in which no time passes; returns the number of substeps: 0.
  int stepNothing();
  /// Moves the nodes in one half of every body a little, back at the next call; the other half stays.
  void moveHalf();

 private:
  std::vector<int> half_;  ///< nodes above the middle of the cage's x
  btScalar nudge_ = btScalar(0.01 * kSize);
  DeformableWorld world_;
  std::vector<std::unique_ptr<DeformableBody>> bodies_;
};

/// Scales both about the origin, so that the cage's largest side is Crowd::kSize.
void scaleToCrowd(TetMesh& cage, TriangleMesh& mesh);

/// Empties the processor's caches of everything else, by streaming through more memory than they hold.
class CacheEviction {
 public:
  CacheEviction();
  void evict();
  std::size_t bytes() const { return buffer_.size() * sizeof(buffer_[0]); }

 private:
  std::vector<std::uint64_t> buffer_;
};

/// Bytes allocated at present; 0 where the C library does not tell.
std::size_t heapBytes();

}  // namespace tetskin::scenes
