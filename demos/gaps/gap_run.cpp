// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "gaps/gap_run.h"

#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>

#include <algorithm>
#include <cmath>

#include "scenes/input_error.h"
#include "scenes/scene.h"

namespace tetskin::gaps {
namespace {

using namespace scenes;
using Eigen::Vector3d;

constexpr double kAbove = 0.02;  ///< where the surface begins, over the body's size
constexpr double kOff = 0.1;     ///< distance from the obstacle, over the body's size, at which the body has fallen off
constexpr double kStill = 0.05;  ///< body lengths per second
constexpr double kDamping = 0.04;  ///< seconds: leaves half as much rocking as the default
constexpr double kWatched = 0.25;  ///< seconds of an impact that are measured

/// A body over an obstacle.
class Watched {
 public:
  Watched(const GapObstacle& obstacle, const GapBody& body, Contact contact)
      : obstacle_(obstacle),
        scene_(sceneOptions(), kEarth),
        soft_(scene_.add(body.cage, {}, Vector3d(0, -boundingBox(body.mesh.positions).min().y() + kAbove * kSize, 0))) {
    obstacle.addTo(scene_.world());
    require(skin_.bind(soft_, body.binding));
    if (contact == Contact::Surface) scene_.world().touchBySurface(soft_, *body.binding, body.mesh);
  }

  void throwDown(double speed) { soft_.setVelocity(btVector3(0, static_cast<btScalar>(-speed * kSize), 0)); }
  bool step() {
    scene_.world().step(scene_.options().substep());
    skin_.markMoved();
    return skin_.update() == StatusCode::Ok;
  }
  double gap() const {
    double minimum = HUGE_VAL;
    for (std::size_t v = 0; v < skin_.positions().size(); ++v) {
      const btScalar* p = skin_.positions()[v];
      minimum = std::min(minimum, obstacle_.distance(Vector3d(p[0], p[1], p[2])));
    }
    return minimum / kSize;
  }
  double speed() const { return scene_.nodeSpeed(); }
  double substep() const { return scene_.options().substep(); }

 private:
  static SceneOptions sceneOptions() {
    SceneOptions options;
    options.force = Force::Elastic;
    options.body.stiffnessDamping = kDamping;
    return options;
  }

  const GapObstacle& obstacle_;
  Scene scene_;
  btSoftBody& soft_;
  SoftBodySkin skin_;
};

}  // namespace

bool Rest::touches() const {
  return finite && std::abs(gap) < kOff;
}
bool Rest::still() const {
  return speed < kStill;
}

Rest restOn(const GapObstacle& obstacle, const GapBody& body, Contact contact, double seconds) {
  constexpr double kLast = 0.5, kBetween = 1.0 / 60;
  Watched watched(obstacle, body, contact);
  Rest rest;
  double squared = 0.0, next = seconds - kLast;
  int count = 0;
  for (double time = 0.0; time < seconds; time += watched.substep()) {
    if (!watched.step()) return {0.0, 0.0, false};
    if (time < next) continue;
    next += kBetween;
    const double gap = watched.gap();
    if (std::abs(gap) > std::abs(rest.gap)) rest.gap = gap;
    squared += watched.speed() * watched.speed();
    ++count;
  }
  rest.speed = std::sqrt(squared / std::max(1, count));
  return rest;
}

double deepestAt(double speed, const GapObstacle& obstacle, const GapBody& body, Contact contact) {
  Watched watched(obstacle, body, contact);
  watched.throwDown(speed);
  double deepest = HUGE_VAL;
  for (double time = 0.0; time < kWatched; time += watched.substep()) {
    if (!watched.step()) return -HUGE_VAL;
    deepest = std::min(deepest, watched.gap());
  }
  return deepest;
}

}  // namespace tetskin::gaps
