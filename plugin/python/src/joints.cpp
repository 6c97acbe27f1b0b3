// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "handles.h"

namespace tetskin::python {
namespace {

/// The joint; and the joint as the type that a call needs.
btTypedConstraint& alive(const JointHandle& joint) {
  if (!joint.state->joint) fail(StatusCode::Released, "the joint has been removed");
  return *joint.state->joint;
}
btHingeConstraint* hinge(const JointHandle& joint) {
  return alive(joint).getConstraintType() == HINGE_CONSTRAINT_TYPE
             ? static_cast<btHingeConstraint*>(joint.state->joint.get())
             : nullptr;
}
btSliderConstraint* slider(const JointHandle& joint) {
  return alive(joint).getConstraintType() == SLIDER_CONSTRAINT_TYPE
             ? static_cast<btSliderConstraint*>(joint.state->joint.get())
             : nullptr;
}
[[noreturn]] void noMotor() {
  fail(StatusCode::InvalidOption, "only hinges and sliders have a coordinate, limits and a motor");
}

double coordinateOf(const JointHandle& joint) {
  if (auto* h = hinge(joint)) return h->getHingeAngle();
  if (auto* s = slider(joint)) {
    s->calculateTransforms(s->getRigidBodyA().getCenterOfMassTransform(),
                           s->getRigidBodyB().getCenterOfMassTransform());
    return s->getLinDepth();
  }
  noMotor();
}

void wake(const JointHandle& joint) {
  joint.state->first->body->activate(true);
  if (joint.state->second) joint.state->second->body->activate(true);
}

void setMotor(JointHandle& joint, std::optional<double> velocity, double maxForce) {
  finite({velocity.value_or(0.0), 0, 0}, "velocity");
  if (!(maxForce >= 0.0 && maxForce < 1e12)) throw nb::value_error("max_force: must be 0 or more, and finite");
  const auto v = static_cast<btScalar>(velocity.value_or(0.0)), f = static_cast<btScalar>(maxForce);
  if (auto* h = hinge(joint)) {
    h->enableAngularMotor(velocity.has_value(), v, f);
  } else if (auto* s = slider(joint)) {
    s->setPoweredLinMotor(velocity.has_value());
    s->setTargetLinMotorVelocity(v);
    s->setMaxLinMotorForce(f);
  } else {
    noMotor();
  }
  wake(joint);
}

void setLimits(JointHandle& joint, const std::array<double, 2>& limits) {
  if (!(limits[0] <= limits[1])) throw nb::value_error("limits: the lower one must not be above the upper one");
  const auto lower = static_cast<btScalar>(limits[0]), upper = static_cast<btScalar>(limits[1]);
  if (auto* h = hinge(joint)) {
    h->setLimit(lower, upper);
  } else if (auto* s = slider(joint)) {
    s->setLowerLinLimit(lower);
    s->setUpperLinLimit(upper);
  } else {
    noMotor();
  }
  wake(joint);
}

/// A frame at the pivot, with its axis k along the direction.
btTransform frameAt(const Vec3& pivot, const Vec3& axis, int k) {
  const btVector3 along = toBullet(axis, "axis");
  if (!(along.length2() > 0)) throw nb::value_error("axis: must not be 0");
  const btVector3 a = along.normalized();
  btVector3 b, c;
  btPlaneSpace1(a, b, c);
  btVector3 columns[3];
  columns[k] = a;
  columns[(k + 1) % 3] = b;
  columns[(k + 2) % 3] = c;
  const btMatrix3x3 basis(columns[0].x(), columns[1].x(), columns[2].x(), columns[0].y(), columns[1].y(),
                          columns[2].y(), columns[0].z(), columns[1].z(), columns[2].z());
  return btTransform(basis, toBullet(pivot, "pivot"));
}

/// The ends of a joint: a rigid body, and another one or the world.
struct Ends {
  Ends(const std::shared_ptr<World>& world, const RigidHandle& a, const std::optional<RigidHandle>& b) {
    first = rigidOf(world, a);
    second = rigidOf(world, b);
    if (first == second) fail(StatusCode::InvalidOption, "a joint connects two different bodies");
    if (first->body->isStaticOrKinematicObject() && (!second || second->body->isStaticOrKinematicObject())) {
      fail(StatusCode::InvalidOption, "a joint needs a body that moves by itself, with a mass");
    }
  }
  btRigidBody& bodyA() const { return *first->body; }
  btRigidBody& bodyB() const { return second ? *second->body : btTypedConstraint::getFixedBody(); }
  btTransform inA(const btTransform& frame) const { return bodyA().getCenterOfMassTransform().inverse() * frame; }
  btTransform inB(const btTransform& frame) const {
    return second ? bodyB().getCenterOfMassTransform().inverse() * frame : frame;
  }

  std::shared_ptr<World::RigidBody> first, second;
};

JointHandle added(const std::shared_ptr<World>& world, const Ends& ends, std::unique_ptr<btTypedConstraint> joint,
                  bool collide) {
  return {world, world->addJoint(ends.first, ends.second, std::move(joint), collide)};
}

using OtherBody = std::optional<RigidHandle>;
using JointLimits = std::optional<std::array<double, 2>>;

JointHandle addPoint(const std::shared_ptr<World>& world, const RigidHandle& a, const OtherBody& b, const Vec3& pivot,
                     bool collide) {
  const Locked lock(*world);
  const Ends ends(world, a, b);
  const btTransform at(btQuaternion::getIdentity(), toBullet(pivot, "pivot"));
  return added(world, ends,
               std::make_unique<btPoint2PointConstraint>(ends.bodyA(), ends.bodyB(), ends.inA(at).getOrigin(),
                                                         ends.inB(at).getOrigin()),
               collide);
}
JointHandle addHinge(const std::shared_ptr<World>& world, const RigidHandle& a, const OtherBody& b, const Vec3& pivot,
                     const Vec3& axis, const JointLimits& limits, bool collide) {
  const Locked lock(*world);
  const Ends ends(world, a, b);
  const btTransform at = frameAt(pivot, axis, 2);
  // The angle is that of the first body relative to the second one, about the axis: Bullet measures its second body's.
  auto joint = std::make_unique<btHingeConstraint>(ends.bodyB(), ends.bodyA(), ends.inB(at), ends.inA(at), true);
  JointHandle handle = added(world, ends, std::move(joint), collide);
  if (limits) setLimits(handle, *limits);
  return handle;
}
JointHandle addSlider(const std::shared_ptr<World>& world, const RigidHandle& a, const OtherBody& b, const Vec3& pivot,
                      const Vec3& axis, const JointLimits& limits, bool collide) {
  const Locked lock(*world);
  const Ends ends(world, a, b);
  const btTransform at = frameAt(pivot, axis, 0);
  // The coordinate is the travel of the first body relative to the second one: Bullet measures its second body's.
  auto joint = std::make_unique<btSliderConstraint>(ends.bodyB(), ends.bodyA(), ends.inB(at), ends.inA(at), true);
  joint->setLowerAngLimit(0);
  joint->setUpperAngLimit(0);
  joint->setLowerLinLimit(1);  // lower above upper: unlimited
  joint->setUpperLinLimit(-1);
  JointHandle handle = added(world, ends, std::move(joint), collide);
  if (limits) setLimits(handle, *limits);
  return handle;
}
JointHandle addFixed(const std::shared_ptr<World>& world, const RigidHandle& a, const OtherBody& b, bool collide) {
  const Locked lock(*world);
  const Ends ends(world, a, b);
  const btTransform at = ends.bodyA().getCenterOfMassTransform();
  return added(world, ends, std::make_unique<btFixedConstraint>(ends.bodyA(), ends.bodyB(), ends.inA(at), ends.inB(at)),
               collide);
}

}  // namespace

void bindJoints(nb::module_& module, Class<World>& world) {
  Class<JointHandle> joint(
      module, "Joint",
      "A joint between a rigid body and another one, or the world. Made by World.add_hinge and similar functions.");
  bindIdentity(joint);
  joint
      .words([](const JointHandle& j) {
        if (!j.state->joint) return "removed";
        return hinge(j)                                                             ? "hinge"
               : slider(j)                                                          ? "slider"
               : j.state->joint->getConstraintType() == POINT2POINT_CONSTRAINT_TYPE ? "point"
                                                                                    : "fixed";
      })
      .def_prop_ro("coordinate", locked([](const JointHandle& j) { return coordinateOf(j); }),
                   "The angle of a hinge, in radians, or the travel of a slider, in world length, since it was made.")
      .def(
          "set_motor", locked([](JointHandle& j, std::optional<double> velocity, double maxForce) {
            setMotor(j, velocity, maxForce);
          }),
          "velocity"_a.none(), "max_force"_a,
          "Drives a hinge or slider: radians or world length per second, with at most this torque or force. None: off.")
      .def("set_limits", locked([](JointHandle& j, const std::array<double, 2>& limits) { setLimits(j, limits); }),
           "limits"_a, "The lower and the upper limit of the coordinate.")
      .def("remove", locked([](JointHandle& j) { j.world->remove(*j.state); }));

  world
      .def("add_point_joint", addPoint, "a"_a, "b"_a = nb::none(), nb::kw_only(), "pivot"_a, "collide"_a = false,
           "Holds a point of body a, given in current world space, to body b or to the world.")
      .def("add_hinge", addHinge, "a"_a, "b"_a = nb::none(), nb::kw_only(), "pivot"_a, "axis"_a,
           "limits"_a = nb::none(), "collide"_a = false,
           "Body a turns about an axis of body b, or of the world. pivot, axis: current world space; limits: radians.")
      .def("add_slider", addSlider, "a"_a, "b"_a = nb::none(), nb::kw_only(), "pivot"_a = Vec3{}, "axis"_a,
           "limits"_a = nb::none(), "collide"_a = false,
           "Body a slides along an axis of body b, or of the world. pivot, axis: current world space; limits: world "
           "length.")
      .def("add_fixed_joint", addFixed, "a"_a, "b"_a = nb::none(), nb::kw_only(), "collide"_a = false,
           "Holds body a to body b, or to the world, in their current poses.");
}

}  // namespace tetskin::python
