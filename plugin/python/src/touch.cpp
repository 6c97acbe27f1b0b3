// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "handles.h"

namespace tetskin::python {
namespace {

/// A point of a body's surface.
struct PointHandle {
  BodyHandle body;
  SurfacePoint point;
};
/// Where a ray has hit a surface.
struct HitHandle {
  BodyHandle body;
  SurfaceHit hit;
};

World& worldOf(const PointHandle& point) {
  return *point.body.world;
}

const PointHandle& alivePoint(const PointHandle& point) {
  (void)alive(point.body);
  check(point.point.status(), "the point of the surface");
  return point;
}

std::optional<HitHandle> hitOf(const std::shared_ptr<World>& world, const World::RayHit& found) {
  if (!found.body) return std::nullopt;
  return HitHandle{{world, found.body}, found.hit};
}
std::optional<HitHandle> raycast(const BodyHandle& body, const Vec3& from, const Vec3& to) {
  const Locked lock(*body.world);
  return hitOf(body.world, take(body.world->raycast(body.state, toBullet(from, "start"), toBullet(to, "end"))));
}
std::optional<HitHandle> raycastAll(const std::shared_ptr<World>& world, const Vec3& from, const Vec3& to) {
  const Locked lock(*world);
  return hitOf(world, take(world->raycast(toBullet(from, "start"), toBullet(to, "end"))));
}

template <class Find>
PointHandle pointOf(const BodyHandle& body, Find&& find) {
  const Locked lock(*body.world);
  const SurfaceTree& tree = treeOf(*body.world, *body.state);
  return {body, take(find(tree, body.state->body->body()))};
}

SpringHandle addSpring(const std::shared_ptr<World>& world, const PointHandle& point,
                       const std::optional<RigidHandle>& rigid, const Vec3& pivot, std::optional<double> stiffness,
                       double dampingRatio, std::optional<double> maxForce, bool collide) {
  const Locked lock(*world);
  alivePoint(point);
  if (point.body.world != world) fail(StatusCode::NotInWorld, "the point is of a body in another world");
  const std::shared_ptr<World::RigidBody> other = rigidOf(world, rigid);
  SurfaceSpringOptions options;
  options.stiffness = stiffness;
  options.dampingRatio = dampingRatio;
  options.maxForce = maxForce;
  options.collideConnected = collide;
  World::Touch touch;
  touch.body = point.body.state;
  touch.rigid = other;
  touch.spring =
      other ? take(SurfaceSpring::add(world->bullet(), point.point, *other->body, toBullet(pivot, "pivot"), options))
            : take(SurfaceSpring::add(world->bullet(), point.point, options));
  return {{world, world->add(std::move(touch))}};
}

WeldHandle addWeld(const std::shared_ptr<World>& world, const PointHandle& point, const RigidHandle& rigid,
                   bool collide) {
  const Locked lock(*world);
  alivePoint(point);
  if (point.body.world != world) fail(StatusCode::NotInWorld, "the point is of a body in another world");
  World::Touch touch;
  touch.body = point.body.state;
  touch.rigid = rigidOf(world, rigid);
  touch.weld = take(SurfaceWeld::add(world->bullet(), point.point, *touch.rigid->body, collide));
  return {{world, world->add(std::move(touch))}};
}

SurfaceSpring& spring(const SpringHandle& handle) {
  if (!handle.state->spring)
    fail(StatusCode::Released, "the spring has been released, or its body or rigid body removed");
  return *handle.state->spring;
}
SurfaceWeld& weld(const WeldHandle& handle) {
  if (!handle.state->weld) fail(StatusCode::Released, "the weld has been released, or its body or rigid body removed");
  return *handle.state->weld;
}

}  // namespace

void bindTouch(nb::module_& module, Class<World>& world) {
  Class<PointHandle>(module, "SurfacePoint",
                     "A point of a body's surface. Made by World.point_at_vertex and similar functions.")
      .words([](const PointHandle& p) {
        if (p.body.state->removed) return std::string("of a body that has been removed");
        const Locked lock(*p.body.world);
        return "at " + wordsOf(*alivePoint(p).point.position());
      })
      .def_prop_ro("body", [](const PointHandle& p) { return p.body; })
      .def_prop_ro("position", locked([](const PointHandle& p) { return vectorOf(*alivePoint(p).point.position()); }),
                   "(3,) float64, world space, after the last step.")
      .def_prop_ro("velocity", locked([](const PointHandle& p) { return vectorOf(*alivePoint(p).point.velocity()); }),
                   "(3,) float64, world length per second.")
      .def_prop_ro("normal", locked([](const PointHandle& p) { return vectorOf(alivePoint(p).point.frame()->normal); }),
                   "(3,) float64: the outward normal.")
      .def_prop_ro("effective_mass", locked([](const PointHandle& p) {
                     return static_cast<double>(alivePoint(p).point.effectiveMass());
                   }),
                   "Mass felt by an impulse at the point; infinite if all nodes around it are pinned.")
      .def("apply_impulse", locked([](PointHandle& p, const Vec3& impulse) {
             alivePoint(p);
             check(p.point.applyImpulse(toBullet(impulse, "impulse")), "apply_impulse");
           }),
           "impulse"_a, "Mass times velocity, world space: acts at once.")
      .def("apply_force", locked([](PointHandle& p, const Vec3& force, int substeps) {
             alivePoint(p);
             check(p.point.applyForce(toBullet(force, "force"), substeps), "apply_force");
           }),
           "force"_a, "substeps"_a = 1, "Mass times length / s^2, world space, during the next substeps.");

  Class<HitHandle>(module, "Hit", "The first intersection of a ray with a surface.")
      .words([](const HitHandle& h) {
        return "triangle " + std::to_string(h.hit.triangle) + " at " + wordsOf(h.hit.point);
      })
      .def_prop_ro("body", [](const HitHandle& h) { return h.body; })
      .def_prop_ro(
          "triangle", [](const HitHandle& h) { return h.hit.triangle; }, "Index of the triangle in the mesh.")
      .def_prop_ro(
          "weights", [](const HitHandle& h) { return vectorOf(h.hit.weights); },
          "(3,) float64: barycentric weights of its corners.")
      .def_prop_ro(
          "point", [](const HitHandle& h) { return vectorOf(h.hit.point); }, "(3,) float64, world space.")
      .def_prop_ro(
          "normal", [](const HitHandle& h) { return vectorOf(h.hit.normal); },
          "(3,) float64, unit length, of the triangle.")
      .def_prop_ro(
          "distance", [](const HitHandle& h) { return static_cast<double>(h.hit.distance); },
          "From the start of the ray, world length.");

  Class<SpringHandle> springs(
      module, "Spring", "Pulls a point of a surface to a point in space or of a rigid body. Made by World.add_spring.");
  bindIdentity(springs);
  springs.words([](const SpringHandle& s) { return s.state->spring ? "holds" : "released"; })
      .def("set_target", locked([](SpringHandle& s, const Vec3& target) {
             check(spring(s).setTarget(toBullet(target, "target")), "set_target");
           }),
           "target"_a, "World space; for a spring to a rigid body, in that body's local space.")
      .def("set_stiffness",
           locked([](SpringHandle& s, double stiffness) { check(spring(s).setStiffness(stiffness), "set_stiffness"); }),
           "stiffness"_a)
      .def("set_max_force",
           locked([](SpringHandle& s, double force) { check(spring(s).setMaxForce(force), "set_max_force"); }),
           "force"_a)
      .def_prop_ro("force", locked([](const SpringHandle& s) { return vectorOf(spring(s).force()); }),
                   "(3,) float64 on the soft body in the last step, world space.")
      .def_prop_ro("stretch", locked([](const SpringHandle& s) { return static_cast<double>(spring(s).stretch()); }),
                   "Distance between point and target, world length.")
      .def_prop_ro("released", [](const SpringHandle& s) { return !s.state->spring; })
      .def("release", locked([](SpringHandle& t) { t.world->remove(*t.state); }),
           "Lets go. Releasing it again changes nothing.");

  Class<WeldHandle> welds(module, "Weld", "Fixes a rigid body to a point of a surface. Made by World.add_weld.");
  bindIdentity(welds);
  welds.words([](const WeldHandle& w) { return w.state->weld ? "holds" : "released"; })
      .def_prop_ro("force", locked([](const WeldHandle& w) { return vectorOf(weld(w).force()); }),
                   "(3,) float64 on the soft body in the last step, world space.")
      .def_prop_ro("torque", locked([](const WeldHandle& w) { return vectorOf(weld(w).torque()); }),
                   "(3,) float64, about the point.")
      .def_prop_ro("separation", locked([](const WeldHandle& w) { return static_cast<double>(weld(w).separation()); }),
                   "Error of the position, world length.")
      .def_prop_ro("angle", locked([](const WeldHandle& w) { return static_cast<double>(weld(w).angle()); }),
                   "Error of the rotation, radians.")
      .def_prop_ro("released", [](const WeldHandle& w) { return !w.state->weld; })
      .def("release", locked([](WeldHandle& t) { t.world->remove(*t.state); }),
           "Lets go. Releasing it again changes nothing.");

  world
      .def("raycast", raycastAll, "start"_a, "end"_a,
           "The first intersection of the segment with any soft body's surface, from either side, or None.")
      .def(
          "raycast_body",
          [](const std::shared_ptr<World>& w, const BodyHandle& b, const Vec3& from, const Vec3& to) {
            if (b.world != w) fail(StatusCode::NotInWorld, "the body is in another world");
            return raycast(b, from, to);
          },
          "body"_a, "start"_a, "end"_a, "The same for one body alone.")
      .def(
          "point_at",
          [](const std::shared_ptr<World>&, const HitHandle& hit) {
            return pointOf(hit.body,
                           [&](const SurfaceTree& tree, btSoftBody& soft) { return tree.pointAt(soft, hit.hit); });
          },
          "hit"_a, "The point of the surface at a ray's hit.")
      .def(
          "point_at_vertex",
          [](const std::shared_ptr<World>&, const BodyHandle& body, int vertex) {
            return pointOf(body,
                           [&](const SurfaceTree& tree, btSoftBody& soft) { return tree.pointAtVertex(soft, vertex); });
          },
          "body"_a, "vertex"_a, "The point of the surface at a vertex of the mesh.")
      .def(
          "point_at_rest",
          [](const std::shared_ptr<World>&, const BodyHandle& body, const Vec3& rest) {
            finite(rest, "rest");
            return pointOf(body, [&](const SurfaceTree& tree, btSoftBody& soft) {
              return tree.pointAtRest(soft, Eigen::Vector3d(rest[0], rest[1], rest[2]));
            });
          },
          "body"_a, "rest"_a, "The point of the surface nearest to a position in rest space.")
      .def("add_spring", addSpring, "point"_a, "rigid_body"_a = nb::none(), nb::kw_only(), "pivot"_a = Vec3{},
           "stiffness"_a = nb::none(), "damping_ratio"_a = 0.0, "max_force"_a = nb::none(),
           "collide_connected"_a = false,
           "Pulls a point of a surface to its current position, which set_target moves, or to a pivot in a rigid "
           "body's local space. stiffness: divided by a point's mass, in 1 / (1/240 s)^2; None: 10 to a point in "
           "space, 1000 to a body. max_force: None: a few times the body's weight; unbounded to a body.")
      .def("add_weld", addWeld, "point"_a, "rigid_body"_a, nb::kw_only(), "collide"_a = false,
           "Fixes a rigid body to a point of a surface in their current poses; the surface around it still deforms.");
}

}  // namespace tetskin::python
