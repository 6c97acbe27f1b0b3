// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "handles.h"

#include <facade/shapes.h>
#include <nanobind/stl/tuple.h>
#include <tuple>

namespace tetskin::python {
namespace {

ShapeModel convexHull(const ArrayLike& points) {
  return facade::convexHull(pointsOf(points, "points"));
}
ShapeModel meshShape(const MeshLike& mesh) {
  return facade::meshShape(*meshOf(mesh).mesh);
}

/// A compound, with its children.
struct CompoundParts {
  std::vector<ShapeModel> children;
  btCompoundShape shape;
};

ShapeModel compound(const std::vector<std::tuple<ShapeModel, Vec3, Quaternion>>& children) {
  if (children.empty()) fail(StatusCode::Empty, "children: a compound needs one or more");
  auto parts = std::make_shared<CompoundParts>();
  for (const auto& [child, position, rotation] : children) {
    if (child.shape->isConcave())
      fail(StatusCode::InvalidOption, "children: planes and meshes cannot be parts of a compound");
    parts->children.push_back(child);
    parts->shape.addChildShape(toBullet(position, rotation), child.shape.get());
  }
  return {std::shared_ptr<btCollisionShape>(parts, &parts->shape)};
}

Quaternion rotationOf(const btTransform& pose) {
  const btQuaternion q = pose.getRotation();
  return {q.x(), q.y(), q.z(), q.w()};
}

void setMass(RigidHandle& rigid, double mass) {
  btRigidBody& body = alive(rigid);
  positive(mass, "mass");
  if (body.isStaticOrKinematicObject())
    fail(StatusCode::InvalidOption, "a static or kinematic body has no mass; add it with one");
  btVector3 inertia;
  rigid.state->shape->calculateLocalInertia(static_cast<btScalar>(mass), inertia);
  body.setMassProps(static_cast<btScalar>(mass), inertia);
  body.updateInertiaTensor();
  body.setGravity(rigid.world->bullet().getGravity());
  body.activate(true);
}

/// Adds a rigid body with the shape made from the first argument.
template <class Of, class Make>
auto adding(Make make) {
  return locked([make](const std::shared_ptr<World>& world, const Of& of, double mass, const Vec3& position,
                       const Quaternion& rotation, double friction, bool kinematic) {
    return RigidHandle{world, addRigid(*world, make(of), mass, toBullet(position, rotation), friction, kinematic)};
  });
}

}  // namespace

std::shared_ptr<World::RigidBody> rigidOf(const std::shared_ptr<World>& world,
                                          const std::optional<RigidHandle>& rigid) {
  if (!rigid) return nullptr;
  (void)alive(*rigid);
  if (rigid->world != world) fail(StatusCode::NotInWorld, "the rigid body is in another world");
  return rigid->state;
}

void bindRigidBodies(nb::module_& module, Class<World>& world) {
  Class<ShapeModel>(module, "Shape",
                    "A collision shape, which any number of rigid bodies may share. Lengths are world lengths.")
      .words([](const ShapeModel& s) { return std::string(s.shape->getName()); })
      .def_static("plane", plane, "normal"_a = Vec3{0, 1, 0}, "offset"_a = 0.0,
                  "Everything below a plane: normal . x < offset.")
      .def_static("box", box, "half_extents"_a)
      .def_static("sphere", sphere, "radius"_a)
      .def_static("capsule", capsule, "radius"_a, "height"_a, "Along y; height: of the part between the caps.")
      .def_static("cylinder", cylinder, "radius"_a, "height"_a, "Along y.")
      .def_static("convex_hull", convexHull, "points"_a, "The convex hull of points, (n, 3).")
      .def_static(
          "mesh", meshShape, "mesh"_a,
          "A surface, for bodies without mass: collides on the side from which triangles look counter-clockwise.")
      .def_static("compound", compound, "children"_a,
                  "children: (shape, position, rotation) each; rotation: x, y, z, w.");

  Class<RigidHandle> rigid(
      module, "RigidBody",
      "A rigid body of a world, which keeps it. Made by World.add_rigid_body and similar functions.");
  bindIdentity(rigid);
  const auto read = [](auto get) {
    return [get](const RigidHandle& r) {
      const Locked lock(*r.world);
      return get(alive(r));
    };
  };
  rigid
      .words([](const RigidHandle& r) {
        if (r.state->removed) return std::string("removed");
        const Locked lock(*r.world);
        return r.state->shape->getName() + (" at " + wordsOf(r.state->body->getWorldTransform().getOrigin()));
      })
      .def_prop_rw("position", read([](btRigidBody& b) { return vectorOf(b.getWorldTransform().getOrigin()); }),
                   locked([](RigidHandle& r, const Vec3& at) { setPosition(*r.world, *r.state, at); }),
                   "(3,) float64, world space. A kinematic body moves to an assigned position in the next step.")
      .def_prop_rw("rotation", read([](btRigidBody& b) { return newQuaternion(rotationOf(b.getWorldTransform())); }),
                   locked([](RigidHandle& r, const Quaternion& q) { setRotation(*r.world, *r.state, q); }),
                   "(4,) float64: a quaternion x, y, z, w.")
      .def_prop_rw("velocity", read([](btRigidBody& b) { return vectorOf(b.getLinearVelocity()); }),
                   locked([](RigidHandle& r, const Vec3& v) {
                     alive(r).setLinearVelocity(toBullet(v, "velocity"));
                     r.state->body->activate(true);
                   }),
                   "(3,) float64, world length per second.")
      .def_prop_rw("angular_velocity", read([](btRigidBody& b) { return vectorOf(b.getAngularVelocity()); }),
                   locked([](RigidHandle& r, const Vec3& v) {
                     alive(r).setAngularVelocity(toBullet(v, "angular_velocity"));
                     r.state->body->activate(true);
                   }),
                   "(3,) float64, radians per second.")
      .def_prop_rw("mass", read([](btRigidBody& b) { return static_cast<double>(b.getMass()); }),
                   locked([](RigidHandle& r, double mass) { setMass(r, mass); }), "0: static or kinematic.")
      .def_prop_rw("friction", read([](btRigidBody& b) { return static_cast<double>(b.getFriction()); }),
                   locked([](RigidHandle& r, double friction) { setFriction(*r.state, friction); }),
                   "Coulomb's coefficient, which is multiplied by that of the touched object.")
      .def_prop_rw("restitution", read([](btRigidBody& b) { return static_cast<double>(b.getRestitution()); }),
                   locked([](RigidHandle& r, double e) { facade::setRestitution(alive(r), e); }),
                   "0 to 1, by default 0. The product of both objects' counts, so both need one: see Body.restitution.")
      .def_prop_ro("kinematic", read([](btRigidBody& b) { return b.isKinematicObject(); }))
      .def_prop_ro(
          "removed", [](const RigidHandle& r) { return r.state->removed; },
          "Whether it has been removed from its world.")
      .def("apply_impulse", locked([](RigidHandle& r, const Vec3& impulse, const std::optional<Vec3>& at) {
             btRigidBody& body = alive(r);
             const btVector3 arm =
                 at ? btVector3(toBullet(*at, "at") - body.getCenterOfMassPosition()) : btVector3(0, 0, 0);
             body.activate(true);
             body.applyImpulse(toBullet(impulse, "impulse"), arm);
           }),
           "impulse"_a, "at"_a = nb::none(),
           "Mass times velocity, at a point in world space; None: at the centre of mass.")
      .def("remove", locked([](RigidHandle& r) { r.world->remove(*r.state); }),
           "Removes it from its world, with its joints, springs and welds. Removing it again changes nothing.");

  const auto add = [&](const char* name, auto function, const char* of, const char* text) {
    world.def(name, function, nb::arg(of), nb::kw_only(), "mass"_a = 0.0, "position"_a = Vec3{},
              "rotation"_a = Quaternion{0, 0, 0, 1}, "friction"_a = 0.5, "kinematic"_a = false, text);
  };
  add("add_rigid_body", adding<ShapeModel>([](const ShapeModel& shape) { return shape; }), "shape",
      "Adds a rigid body. mass: 0 if it does not move by itself; rotation: x, y, z, w; kinematic: moved by its "
      "position and rotation.");
  add("add_box", adding<Vec3>(box), "half_extents", "Like add_rigid_body with Shape.box.");
  add("add_sphere", adding<double>(sphere), "radius", "Like add_rigid_body with Shape.sphere.");
  world
      .def("add_plane", locked([](const std::shared_ptr<World>& w, const Vec3& normal, double offset, double friction) {
             return RigidHandle{w,
                                addRigid(*w, plane(normal, offset), 0.0, btTransform::getIdentity(), friction, false)};
           }),
           nb::kw_only(), "normal"_a = Vec3{0, 1, 0}, "offset"_a = 0.0, "friction"_a = 0.5,
           "Adds a ground: y = 0 by default.")
      .def_prop_ro("rigid_bodies", locked([](const std::shared_ptr<World>& w) {
                     std::vector<RigidHandle> all;
                     for (const auto& state : w->rigidBodies()) all.push_back({w, state});
                     return all;
                   }));
}

}  // namespace tetskin::python
