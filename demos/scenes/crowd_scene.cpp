// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "scenes/crowd_scene.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>

#include "scenes/input_error.h"

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace tetskin::scenes {
namespace {

/// Distance of neighbours, in sizes.
constexpr double kSpacing = 2.0;
/// Of the last-level cache where the system does not tell, and the most that is streamed through.
constexpr std::size_t kUnknownCache = std::size_t(64) << 20, kMostStreamed = std::size_t(512) << 20;

std::size_t lastLevelCacheBytes() {
#ifdef _SC_LEVEL3_CACHE_SIZE
  if (const long bytes = sysconf(_SC_LEVEL3_CACHE_SIZE); bytes > 0) return static_cast<std::size_t>(bytes);
#endif
  return kUnknownCache;
}

}  // namespace

Crowd::Crowd(const TetMesh& cage, std::size_t bodies) {
  const auto columns = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(bodies))));
  for (std::size_t i = 0; i < bodies; ++i) {
    auto body = DeformableBody::add(world_.world(), cage);
    require(body.status());
    const Eigen::Vector3d where(static_cast<double>(i % columns), 0.0, static_cast<double>(i / columns));
    body.value()->body().translate(toBullet(kSpacing * kSize * where));
    bodies_.push_back(std::move(body).value());
  }
  const double middle = boundingBox(cage.nodes).center().x();
  for (std::size_t n = 0; n < cage.nodeCount(); ++n) {
    if (cage.nodes[n].x() > middle) half_.push_back(static_cast<int>(n));
  }
}

void Crowd::moveHalf() {
  for (const auto& added : bodies_) {
    for (const int n : half_) added->body().m_nodes[n].m_x += btVector3(0, nudge_, 0);
  }
  nudge_ = -nudge_;
}

void Crowd::setAsleep(bool asleep) {
  for (std::size_t i = 0; i < size(); ++i) {
    if (!alwaysAwake(i)) body(i).forceActivationState(asleep ? ISLAND_SLEEPING : ACTIVE_TAG);
  }
}

std::size_t Crowd::asleepCount() const {
  return static_cast<std::size_t>(
      std::count_if(bodies_.begin(), bodies_.end(), [](const auto& b) { return !b->body().isActive(); }));
}

int Crowd::step() {
  constexpr btScalar kFrame = btScalar(1) / 60;
  return world_.world().stepSimulation(kFrame, kSubsteps, kFrame / kSubsteps);
}

int Crowd::stepNothing() {
  return world_.world().stepSimulation(btScalar(0), kSubsteps, btScalar(1) / 60 / kSubsteps);
}

void scaleToCrowd(TetMesh& cage, TriangleMesh& mesh) {
  const double scale = Crowd::kSize / boundingBox(cage.nodes).sizes().maxCoeff();
  for (Eigen::Vector3d& p : cage.nodes) p *= scale;
  for (Eigen::Vector3d& p : mesh.positions) p *= scale;
}

CacheEviction::CacheEviction() : buffer_(std::min(2 * lastLevelCacheBytes(), kMostStreamed) / sizeof(std::uint64_t)) {}

void CacheEviction::evict() {
  constexpr std::size_t kLine = 64 / sizeof(std::uint64_t);
  volatile std::uint64_t* data = buffer_.data();
  for (std::size_t i = 0; i < buffer_.size(); i += kLine) data[i] = data[i] + 1;
}

std::size_t heapBytes() {
#if defined(__GLIBC__) && (__GLIBC__ > 2 || __GLIBC_MINOR__ >= 33)
  const struct mallinfo2 info = mallinfo2();
  return info.uordblks + info.hblkhd;
#else
  return 0;
#endif
}

}  // namespace tetskin::scenes
