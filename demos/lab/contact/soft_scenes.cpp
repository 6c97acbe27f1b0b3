// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Contact among soft bodies: stacks, collisions, and bodies that begin inside each other.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "contact/scene_list.h"
#include "measure/extremes.h"
#include "measure/measuring_world.h"
#include "scenes/timer.h"

namespace tetskin::contact_demo {
namespace {

using namespace measure;
using Eigen::Matrix3d;
using Eigen::Vector3d;

/// A stack of boxes at rest on a floor.
/// stiffnesses  from below
void stack(Run& run, const std::vector<double>& stiffnesses) {
  constexpr double kHeight = 0.5, kSize = 1.0;
  const ModelPtr model = makeBox({0.5, 0.5 * kHeight, 0.5});
  MeasuringWorld world(run);
  world.addFloor();
  std::vector<SoftObject*> boxes;
  double height = 0.0;
  for (const double stiffness : stiffnesses) {
    boxes.push_back(&world.addSoftOn(height, model, BodyOptions{stiffness}));
    world.touchOthers(*boxes.back());
    height += kHeight + 2.0 * kMargin;
  }
  world.simulate(4);
  double gap = 0.0, fastest = 0.0;
  world.simulate(1, [&] {
    lower(gap, world.deepest());
    for (const SoftObject* box : boxes) raise(fastest, box->fastest());
  });
  run.report("least gap, S", gap / kSize);
  run.report("fastest node, S/s", fastest / kSize);
  run.report("downward displacement of the top box, S",
             2.5 * kHeight + 5.0 * kMargin - boxes.back()->motion().centroid.y());
}

struct Collision {
  double speed = 2.0;  ///< of the first ball, S/s; the other one is at rest
  double aside = 0.0;  ///< offset of its path from the other's centroid, S
  double stiffness = 50.0, otherStiffness = 50.0;
};

/// Two balls without gravity, until they have parted.
void collide(Run& run, const Collision& collision) {
  constexpr double kApart = 1.05;
  const ModelPtr model = makeBall();
  MeasuringWorld world(run, Vector3d::Zero());
  const double along = std::sqrt(kApart * kApart - collision.aside * collision.aside);
  // Off the origin, so that even a head-on collision has angular momentum to lose.
  const Vector3d at(0, 0, 0.5);
  SoftObject& moving =
      world.addSoft(model, BodyOptions{collision.stiffness}, at + Vector3d(-along, collision.aside, 0));
  SoftObject& other = world.addSoft(model, BodyOptions{collision.otherStiffness}, at);
  for (SoftObject* ball : {&moving, &other}) world.touchOthers(*ball);
  moving.push(Vector3d(collision.speed, 0, 0));
  double deepest = 0.0;
  int inverted = 0;
  reportConserved(run, world, 1, [&] {
    lower(deepest, world.deepest());
    inverted = std::max({inverted, invertedTets(*model, moving.soft()), invertedTets(*model, other.soft())});
  });
  run.report("least gap, S", deepest);
  run.report("most inverted tets", inverted);
}

/// Finds where points of space lie in a body at rest, by the tets that contain them at present: a measure of depth that
/// is independent of how contacts are found.
class RestSpace {
 public:
  explicit RestSpace(const SoftObject& body) {
    for (const Tet& tet : body.model().cage.mesh.tets) {
      TetMap map{Matrix3d(), Matrix3d(), body.model().cage.mesh.nodes[static_cast<std::size_t>(tet[0])],
                 node(body, tet[0])};
      Matrix3d edges;
      for (int k = 0; k < 3; ++k) {
        const int n = tet[static_cast<std::size_t>(k) + 1];
        map.restEdges.col(k) = body.model().cage.mesh.nodes[static_cast<std::size_t>(n)] - map.restOrigin;
        edges.col(k) = node(body, n) - map.origin;
      }
      map.toWeights = edges.inverse();
      maps_.push_back(map);
      for (const int n : tet) box_.extend(node(body, n));
    }
  }

  std::optional<Vector3d> at(const Vector3d& p) const {
    if (!box_.contains(p)) return std::nullopt;
    for (const TetMap& map : maps_) {
      const Vector3d weights = map.toWeights * (p - map.origin);
      if (weights.minCoeff() >= 0.0 && weights.sum() <= 1.0) return map.restOrigin + map.restEdges * weights;
    }
    return std::nullopt;
  }

 private:
  struct TetMap {
    Matrix3d restEdges, toWeights;
    Vector3d restOrigin, origin;
  };
  static Vector3d node(const SoftObject& body, int n) { return toEigen(body.soft().m_nodes[n].m_x); }

  std::vector<TetMap> maps_;
  Box3 box_;
};

/// The penetration depth of all vertices in all other bodies, metres; almost 0 where surfaces lie on each other.
/// distance  from the surface at rest, negative inside
double depthOf(const std::vector<SoftObject*>& bodies, const Distance& distance) {
  double deepest = 0.0;
  for (SoftObject* body : bodies) {
    const RestSpace rest(*body);
    for (SoftObject* other : bodies) {
      if (other == body) continue;
      for (const Vector3d& p : other->surface()) {
        if (const auto inside = rest.at(p)) lower(deepest, distance(*inside));
      }
    }
  }
  return -deepest;
}

/// The least distance between any two bodies' centroids: it shows bodies that have not parted because their surfaces
/// coincide.
double minDistance(const std::vector<SoftObject*>& bodies) {
  double minimum = HUGE_VAL;
  for (std::size_t a = 0; a < bodies.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      lower(minimum, (bodies[a]->motion().centroid - bodies[b]->motion().centroid).norm());
    }
  }
  return minimum;
}

/// Bodies that begin inside each other, for three seconds.
void part(Run& run, const Vector3d& gravity, const ModelPtr& model, const std::vector<Vector3d>& centres,
          const Distance& distance) {
  MeasuringWorld world(run, gravity);
  if (!gravity.isZero()) world.addFloor();
  ContactShapeOptions shape;
  shape.sampleCount = 300;  // as each of seven bodies touches six others
  std::vector<SoftObject*> bodies;
  for (const Vector3d& centre : centres) {
    bodies.push_back(&world.addSoft(model, BodyOptions{50.0}, centre));
    world.touchOthers(*bodies.back(), shape);
  }
  double fastest = 0.0;
  int maximum = 0, last = 0;
  const scenes::CpuTimer timer;
  world.simulate(3, [&] {
    last = 0;
    for (const SoftObject* body : bodies) {
      raise(fastest, body->fastest());
      last += invertedTets(*model, body->soft());
    }
    maximum = std::max(maximum, last);
  });
  run.report("ms per step", timer.milliseconds() / static_cast<double>(run.steps));
  run.report("fastest node, S/s", fastest / model->size);
  run.report("depth at the end, S", depthOf(bodies, distance) / model->size);
  run.report("nearest centroids, S", minDistance(bodies) / model->size);
  run.report("most inverted tets", maximum);
  run.report("inverted tets at the end", last);
}

double toBall(const Vector3d& p) {
  return p.norm() - 0.5;
}

double toCube(const Vector3d& p) {
  return p.cwiseAbs().maxCoeff() - 0.5;
}

void componentCubes(Run& run, const Vector3d& gravity) {
  part(run, gravity, makeBox({0.5, 0.5, 0.5}), {{0, 0.51, 0}, {0.5, 0.51, 0}}, toCube);
}

/// apart  distance, in metres, from the common position at which all of them would coincide
void componentBalls(Run& run, const Vector3d& gravity, double apart) {
  std::vector<Vector3d> centres = {{0, 0, 0}};
  for (int k = 0; k < 6; ++k) centres.emplace_back((k % 2 == 0 ? apart : -apart) * Vector3d::Unit(k / 2));
  for (Vector3d& centre : centres) centre.y() += 0.5 + apart + kMargin;
  constexpr int kTets = 200, kLevel = 2;
  part(run, gravity, makeBall(kTets, kLevel), centres, toBall);
}

}  // namespace

void addSoftScenes(ContactScenes& scenes) {
  const auto add = [&](const std::string& name, const std::function<void(Run&)>& run) {
    scenes.push_back({name, run, {Kind::Surface}});  // only this kind has contact between soft bodies
  };
  add("soft stack/1 to 1 to 1", [](Run& run) { stack(run, {50, 50, 50}); });
  add("soft stack/1 to 100 to 1", [](Run& run) { stack(run, {50, 5000, 50}); });
  for (const double other : {50.0, 5000.0}) {
    for (const double speed : {2.0, 10.0}) {
      const std::string end = " at " + text(speed) + "/k50 and " + text(other);
      add("soft collide/head-on" + end, [=](Run& run) { collide(run, {speed, 0.0, 50.0, other}); });
      add("soft collide/off-centre" + end, [=](Run& run) { collide(run, {speed, 0.5, 50.0, other}); });
    }
  }
  const Vector3d weightless = Vector3d::Zero(), earth(0, -scenes::kEarth, 0);
  for (const Vector3d& gravity : {weightless, earth}) {
    const std::string end = gravity.isZero() ? "/weightless" : "/on a floor";
    add("soft overlap/cubes" + end, [=](Run& run) { componentCubes(run, gravity); });
    add("soft overlap/balls 0.1 aside" + end, [=](Run& run) { componentBalls(run, gravity, 0.1); });
    add("soft overlap/balls in one place" + end, [=](Run& run) { componentBalls(run, gravity, 0.0); });
  }
}

}  // namespace tetskin::contact_demo
