// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "handles.h"

namespace tetskin::js {
namespace {

/// Where a ray has hit a surface.
struct HitNumbers {
  int body = -1;  ///< of the world's bodies; -1: nowhere
  int triangle = -1;
  Vec3 weights{}, point{}, normal{};
  double distance = 0;
};

HitNumbers raycast(WorldHandle& handle, Vec3 start, Vec3 end) {
  const World::RayHit found = take(handle.world->raycast(toBullet(start, "start"), toBullet(end, "end")));
  HitNumbers numbers;
  if (!found.body) return numbers;
  const auto& bodies = handle.world->bodies();
  numbers.body = static_cast<int>(std::find(bodies.begin(), bodies.end(), found.body) - bodies.begin());
  numbers.triangle = found.hit.triangle;
  for (std::size_t k = 0; k < 3; ++k) numbers.weights[k] = static_cast<double>(found.hit.weights[k]);
  numbers.point = vectorOf(found.hit.point);
  numbers.normal = vectorOf(found.hit.normal);
  numbers.distance = static_cast<double>(found.hit.distance);
  return numbers;
}

SurfacePoint pointAt(BodyHandle& body, int triangle, const Vec3& weights) {
  const SurfaceTree& tree = treeOf(*body.world, *body.state);
  btSoftBody& soft = body.state->body->body();
  if (triangle < 0 || static_cast<std::size_t>(triangle) >= body.state->mesh->triangleCount())
    fail(StatusCode::IndexOutOfRange, "hit: there is no triangle " + std::to_string(triangle));
  SurfaceHit hit;
  hit.status = StatusCode::Ok;
  hit.body = &soft;
  hit.triangle = triangle;
  for (std::size_t k = 0; k < 3; ++k) hit.weights[k] = static_cast<btScalar>(weights[k]);
  return take(tree.pointAt(soft, hit));
}

SpringHandle* addSpring(BodyHandle& body, int triangle, Vec3 weights, double stiffness, double dampingRatio,
                        double maxForce) {
  SurfaceSpringOptions options;
  options.stiffness = given(stiffness);
  options.dampingRatio = dampingRatio;
  options.maxForce = given(maxForce);
  const SurfacePoint point = pointAt(body, triangle, weights);
  World::Touch touch;
  touch.body = body.state;
  auto spring = std::make_unique<SpringHandle>(SpringHandle{body.world, {}, point});
  touch.spring = take(SurfaceSpring::add(body.world->bullet(), point, options));
  spring->state = body.world->add(std::move(touch));
  return spring.release();
}
void applyImpulse(BodyHandle& body, int triangle, Vec3 weights, Vec3 impulse) {
  SurfacePoint point = pointAt(body, triangle, weights);
  check(point.applyImpulse(toBullet(impulse, "impulse")), "applyImpulse");
}

SurfaceSpring& alive(SpringHandle& spring) {
  if (!spring.state->spring) fail(StatusCode::Released, "the spring's body has been removed");
  return *spring.state->spring;
}
void setTarget(SpringHandle& spring, Vec3 target) {
  check(alive(spring).setTarget(toBullet(target, "target")), "setTarget");
}
void setStiffness(SpringHandle& spring, double stiffness) {
  check(alive(spring).setStiffness(stiffness), "setStiffness");
}
void setMaxForce(SpringHandle& spring, double force) {
  check(alive(spring).setMaxForce(force), "setMaxForce");
}
Vec3 position(SpringHandle& spring) {
  (void)alive(spring);
  check(spring.point.status(), "the spring's point");
  return vectorOf(*spring.point.position());
}
Vec3 force(SpringHandle& spring) {
  return vectorOf(alive(spring).force());
}
double stretch(SpringHandle& spring) {
  return static_cast<double>(alive(spring).stretch());
}
void release(SpringHandle& spring) {
  spring.world->remove(*spring.state);
}

}  // namespace

EMSCRIPTEN_BINDINGS(touch) {
  emscripten::value_object<HitNumbers>("Hit")
      .field("body", &HitNumbers::body)
      .field("triangle", &HitNumbers::triangle)
      .field("weights", &HitNumbers::weights)
      .field("point", &HitNumbers::point)
      .field("normal", &HitNumbers::normal)
      .field("distance", &HitNumbers::distance);
  emscripten::class_<SpringHandle>("Spring");
  expose<&raycast>("raycast");
  expose<&addSpring>("addSpring");
  expose<&applyImpulse>("applyImpulse");
  expose<&setTarget>("setTarget");
  expose<&setStiffness>("setStiffness");
  expose<&setMaxForce>("setMaxForce");
  expose<&position>("springPosition");
  expose<&force>("springForce");
  expose<&stretch>("springStretch");
  expose<&release>("releaseSpring");
}

}  // namespace tetskin::js
