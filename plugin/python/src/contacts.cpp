// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "handles.h"

#include <nanobind/stl/variant.h>
#include <variant>

namespace tetskin::python {
namespace {

/// Contact points as arrays.
struct ContactArrays {
  std::vector<float> points, normals, distances, impulses;
  nb::object bodies;
};

void append(std::vector<float>& rows, const btVector3& v) {
  rows.insert(rows.end(), {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())});
}

nb::object rigidAt(const std::shared_ptr<World>& world, const btCollisionObject* object) {
  for (const auto& state : world->rigidBodies()) {
    if (state->body.get() == object) return nb::cast(RigidHandle{world, state});
  }
  return nb::none();
}
nb::object bodyAt(const std::shared_ptr<World>& world, const btSoftBody* soft) {
  for (const auto& state : world->bodies()) {
    if (&state->body->body() == soft) return nb::cast(BodyHandle{world, state});
  }
  return nb::none();
}

ContactArrays contactsOf(const BodyHandle& body) {
  const Locked lock(*body.world);
  (void)alive(body);
  ContactArrays arrays;
  nb::list bodies;
  if (body.state->contact) {
    for (const SurfaceContactPoint& contact : body.state->contact->contacts()) {
      append(arrays.points, contact.point);
      append(arrays.normals, contact.normal);
      append(arrays.impulses, contact.impulse);
      arrays.distances.push_back(static_cast<float>(contact.distance));
      bodies.append(rigidAt(body.world, contact.object));
    }
  }
  arrays.bodies = bodies;
  return arrays;
}

ContactArrays softContactsOf(const std::shared_ptr<World>& world) {
  const Locked lock(*world);
  ContactArrays arrays;
  nb::list bodies;
  if (const SoftContacts* contacts = world->softContacts()) {
    for (const SoftContact& contact : contacts->contacts()) {
      append(arrays.points, contact.point);
      append(arrays.normals, contact.normal);
      append(arrays.impulses, contact.impulse * contact.normal);
      arrays.distances.push_back(static_cast<float>(contact.distance));
      bodies.append(nb::make_tuple(bodyAt(world, contact.body), bodyAt(world, contact.other)));
    }
  }
  arrays.bodies = bodies;
  return arrays;
}

using Either = std::variant<BodyHandle, RigidHandle>;

const btCollisionObject& objectOf(const Either& either) {
  if (const auto* body = std::get_if<BodyHandle>(&either)) return alive(*body).body();
  return alive(std::get<RigidHandle>(either));
}

}  // namespace

void bindContacts(nb::module_& module, Class<World>& world) {
  Class<ContactArrays>(module, "Contacts", "Contact points of the last substep, as arrays with one row per point.")
      .words([](const ContactArrays& c) { return counted(c.distances.size(), "point", "points"); })
      .def_prop_ro(
          "points", [](const ContactArrays& c) { return newRows3(std::vector<float>(c.points)); },
          "(n, 3) float32, world space.")
      .def_prop_ro(
          "normals", [](const ContactArrays& c) { return newRows3(std::vector<float>(c.normals)); },
          "(n, 3) float32, unit length, away from the other body.")
      .def_prop_ro(
          "distances", [](const ContactArrays& c) { return newColumn(std::vector<float>(c.distances)); },
          "(n,) float32, world length; negative: nearer than the margin, or penetration.")
      .def_prop_ro(
          "impulses", [](const ContactArrays& c) { return newRows3(std::vector<float>(c.impulses)); },
          "(n, 3) float32 on the soft body whose point it is: force times seconds.")
      .def_ro("bodies", &ContactArrays::bodies, nb::sig("def bodies(self) -> list[typing.Any]"),
              "Per point: the RigidBody; in World.soft_contacts, the body whose point it is and the other one.")
      .def("__len__", [](const ContactArrays& c) { return c.distances.size(); });

  Class<Wrench>(module, "Wrench",
                "A force, and its torque about the centre of mass of the object that it acts on, world space.")
      .words([](const Wrench& w) { return "force " + wordsOf(w.force) + ", torque " + wordsOf(w.torque); })
      .def_prop_ro(
          "force", [](const Wrench& w) { return vectorOf(w.force); }, "(3,) float64, mass length / s^2.")
      .def_prop_ro(
          "torque", [](const Wrench& w) { return vectorOf(w.torque); }, "(3,) float64, mass length^2 / s^2.");
  Class<AppliedForces>(module, "AppliedForces", "Forces by cause: the mean over the last step.")
      .words([](const AppliedForces& f) { return "total force " + wordsOf(f.total().force); })
      .def_ro("contact", &AppliedForces::contact, "Normal forces of contacts.")
      .def_ro("friction", &AppliedForces::friction, "Friction forces, tangential to the contacts.")
      .def_ro("joints", &AppliedForces::joints, "Springs, welds and forces applied to points.")
      .def_prop_ro("total", &AppliedForces::total, "The sum of all.");

  world.def_prop_ro("soft_contacts", softContactsOf, "Contacts between soft bodies, including self-contact.")
      .def(
          "contacts",
          [](const std::shared_ptr<World>& w, const BodyHandle& b) {
            if (b.world != w) fail(StatusCode::NotInWorld, "the body is in another world");
            return contactsOf(b);
          },
          "body"_a,
          "Contacts of a soft body with rigid bodies at its surface, in the last substep in which it was awake.")
      .def("forces_on",
           locked([](const std::shared_ptr<World>& w, const Either& body, const std::optional<Either>& other) {
             const btCollisionObject& object = objectOf(body);
             if (!other) return forcesOf(*w).forcesOn(object);
             return forcesOf(*w).forcesBetween(object, objectOf(*other));
           }),
           "body"_a, "other"_a = nb::none(),
           "Forces on a soft body from all objects that it touches or is attached to, or on a rigid body from all soft "
           "bodies; with other, from that one alone.");
}

}  // namespace tetskin::python
