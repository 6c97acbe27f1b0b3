// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "handles.h"

namespace tetskin::python {
namespace {

using View = Made<Row3<float>>;

/// The memory of a body's nodes, kept alive by the body's state.
View nodesOf(const BodyHandle& body) {
  const btSoftBody& soft = alive(body).body();
  return body.arrays.nodes.view([&] { return view3<float>(nodePositions(soft), body.state); });
}
View velocitiesOf(const BodyHandle& body) {
  const btSoftBody& soft = alive(body).body();
  return body.arrays.velocities.view([&] {
    return view3<float>(&soft.m_nodes[0].m_v[0], static_cast<std::size_t>(soft.m_nodes.size()), body.state,
                        sizeof(btSoftBody::Node));
  });
}
View surfaceOf(const BodyHandle& body, const std::vector<float>& numbers, const Kept<Row3<float>>& array) {
  (void)facade::surfaceOf(*body.state);
  return array.view([&] { return view3<float>(numbers.data(), numbers.size() / 3, body.state); });
}

void setVelocities(BodyHandle& body, const ArrayLike& array) {
  const Numbers<double> numbers(array, "velocities", 3);
  const Locked lock(*body.world);
  facade::setVelocities(*body.state, numbers.data(), 3 * numbers.rows());
}

std::size_t nodeCount(const BodyHandle& body) {
  return body.state->cage->mesh.nodeCount();
}

void setPinned(BodyHandle& body, const ArrayLike& nodes, bool pinned) {
  const std::vector<int> indices = indicesOf(nodes, "nodes", nodeCount(body));
  const Locked lock(*body.world);
  facade::setPinned(*body.state, indices, pinned);
}

void setPinnedPositions(BodyHandle& body, const ArrayLike& nodes, const ArrayLike& positions) {
  const std::vector<int> indices = indicesOf(nodes, "nodes", nodeCount(body));
  const Numbers<double> numbers(positions, "positions", 3);
  const Locked lock(*body.world);
  facade::setPinnedPositions(*body.state, indices, numbers.data(), 3 * numbers.rows());
}

Column<bool> pinnedOf(const BodyHandle& body) {
  const Locked lock(*body.world);
  return newMask(facade::pinnedOf(*body.state));
}

void transform(BodyHandle& body, const Vec3& position, const Quaternion& rotation) {
  const btTransform motion = toBullet(position, rotation);
  const Locked lock(*body.world);
  check(body.world->teleport(*body.state, motion));
}

ImpulseResult radialImpulse(BodyHandle& body, const Vec3& centre, double radius, double strength) {
  const Locked lock(*body.world);
  finite({radius, strength, 0}, "radius, strength");
  return facade::radialImpulse(
      *body.world, *body.state,
      {toBullet(centre, "centre"), static_cast<btScalar>(radius), static_cast<btScalar>(strength)});
}

/// A property of the body that is a number, with the world's lock.
template <class Get>
auto number(Get get) {
  return [get](const BodyHandle& body) {
    const Locked lock(*body.world);
    return get(alive(body));
  };
}
template <class Set>
auto setter(Set set) {
  return [set](BodyHandle& body, double value) {
    const Locked lock(*body.world);
    check(set(alive(body), value));
  };
}

/// How Python gives an option of BodyWords: most as it is.
template <class T>
struct Given {
  using Type = T;
  static T read(const T& given, const char*, std::size_t) { return given; }
  static T shown(const T& fallback) { return fallback; }
};
template <>
struct Given<std::optional<double>> : Given<double> {
  using Type = std::optional<double>;
  static Type read(const Type& given, const char*, std::size_t) { return given; }
  static nb::object shown(const Type&) { return nb::none(); }
};
template <class Of>
struct Given<Choice<Of>> {
  using Type = Choice<Of>;
  static Type read(const Type& given, const char*, std::size_t) { return given; }
  static std::string shown(const Type& fallback) { return fallback.name; }
};
struct GivenArray {
  using Type = std::optional<ArrayLike>;
  template <class Of>
  static nb::object shown(const Of&) {
    return nb::none();
  }
};
template <>
struct Given<std::vector<double>> : GivenArray {
  static std::vector<double> read(const Type& array, const char* name, std::size_t) {
    if (!array) return {};
    const Numbers<double> numbers(*array, name, 0);
    return {numbers.data(), numbers.data() + numbers.rows()};
  }
};
template <>
struct Given<std::vector<int>> : GivenArray {
  static std::vector<int> read(const Type& array, const char* name, std::size_t nodes) {
    return array ? indicesOf(*array, name, nodes) : std::vector<int>();
  }
};

#define TETSKIN_PARAMETER(of, type, name, python, ...) , const Given<type>::Type& name
#define TETSKIN_READ(of, type, name, python, ...) words.name = Given<type>::read(name, #python, nodes);
#define TETSKIN_ARGUMENT(of, type, name, python, ...) , nb::arg(#python) = Given<type>::shown(BodyWords().name)

BodyHandle addBody(const std::shared_ptr<World>& world, const CageModel& cage,
                   const std::optional<MeshLike>& mesh TETSKIN_BODY_OPTIONS(TETSKIN_PARAMETER)) {
  const std::size_t nodes = cage.cage->mesh.nodeCount();
  BodyWords words;
  TETSKIN_BODY_OPTIONS(TETSKIN_READ)
  const bool bare = !mesh || mesh->object.is_none();
  const MeshModel model = bare ? MeshModel() : meshOf(*mesh);
  return unlocked(*world, [&] { return BodyHandle{world, facade::addBody(*world, cage, model, words)}; });
}

}  // namespace

Class<BodyHandle> bindBodies(nb::module_& module, Class<World>& world) {
  Class<ImpulseResult>(module, "ImpulseResult", "Sums over all vertices pushed by a radial impulse.")
      .words([](const ImpulseResult& r) {
        return counted(static_cast<std::size_t>(r.vertices), "vertex", "vertices") + ", linear " + wordsOf(r.linear);
      })
      .def_prop_ro(
          "linear", [](const ImpulseResult& r) { return vectorOf(r.linear); },
          "(3,) float64: the impulse, world space.")
      .def_prop_ro(
          "angular", [](const ImpulseResult& r) { return vectorOf(r.angular); },
          "(3,) float64: its moment about the world's origin.")
      .def_ro("vertices", &ImpulseResult::vertices, "Number of vertices pushed.");

  Class<BodyHandle> body(module, "Body", "A soft body of a world, which keeps it. Made by World.add_body.");
  bindIdentity(body);
  body.words([](const BodyHandle& b) {
        if (b.state->removed) return std::string("removed");
        return counted(b.state->cage->mesh.tetCount(), "tet", "tets") + ", " +
               (b.state->mesh ? counted(b.state->mesh->vertexCount(), "vertex", "vertices") : "no surface");
      })
      .def_prop_ro(
          "positions", [](const BodyHandle& b) { return surfaceOf(b, b.state->positions, b.arrays.positions); },
          "(vertices, 3) float32, world space: the surface. A read-only view, which each step overwrites.")
      .def_prop_ro(
          "normals", [](const BodyHandle& b) { return surfaceOf(b, b.state->normals, b.arrays.normals); },
          "(vertices, 3) float32, unit length; (0, 3) for a body added with normals='none'. A read-only view, which "
          "each step overwrites.")
      .def_prop_ro("nodes", nodesOf,
                   "(nodes, 3) float32, world space. A read-only view, which each step overwrites; its rows are not "
                   "contiguous.")
      .def_prop_rw("velocities", velocitiesOf, setVelocities,
                   "(nodes, 3) float32, world length per second: at the middle of the last substep. A read-only view, "
                   "which each step overwrites; assign an array. Those of pinned nodes stay.")
      .def_prop_ro(
          "cage",
          [](const BodyHandle& b) { return CageModel{std::static_pointer_cast<const ReportedCage>(b.state->cage)}; })
      .def_prop_ro(
          "mesh",
          [](const BodyHandle& b) { return b.state->mesh ? std::optional(MeshModel{b.state->mesh}) : std::nullopt; })
      .def_prop_ro("node_count", nodeCount, "Number of nodes.")
      .def_prop_ro("bounds", locked([](const BodyHandle& b) {
                     const Box3& box = facade::surfaceOf(*b.state).bounds();
                     return nb::make_tuple(vectorOf(box.min()), vectorOf(box.max()));
                   }),
                   kBoundsType, "The box of the surface: two corners, world space.")
      .def_prop_rw(
          "visible", [](const BodyHandle& b) { return b.state->skin.visible(); },
          locked([](BodyHandle& b, bool visible) { facade::surfaceOf(*b.state).setVisible(visible); }),
          "Whether steps update the surface. When shown again, it is updated at once.")
      .def_prop_ro("asleep", number([](DeformableBody& b) { return !b.body().isActive(); }),
                   "Whether it sleeps, and costs next to nothing.")
      .def_prop_ro(
          "removed", [](const BodyHandle& b) { return b.state->removed; },
          "Whether it has been removed from its world.")
      .def_prop_rw("youngs_modulus", number([](DeformableBody& b) { return b.youngsModulus(); }),
                   setter([](DeformableBody& b, double v) { return b.setYoungsModulus(v); }),
                   "Pressure units, above 0.")
      .def_prop_ro("relative_stiffness", number([](DeformableBody& b) { return b.relativeStiffness(); }),
                   "Young's modulus over density x gravity x size: from 30 (wobbles, sags) to 300 (firm).")
      .def_prop_rw("poisson_ratio", number([](DeformableBody& b) { return b.poissonRatio(); }),
                   setter([](DeformableBody& b, double v) { return b.setPoissonRatio(v); }), "0 to below 0.5.")
      .def_prop_rw("stiffness_damping", number([](DeformableBody& b) { return b.stiffnessDamping(); }),
                   setter([](DeformableBody& b, double v) { return b.setStiffnessDamping(v); }),
                   "Seconds: Rayleigh damping, 0 or more.")
      .def_prop_rw("pressure", number([](DeformableBody& b) { return b.pressure(); }),
                   setter([](DeformableBody& b, double v) { return b.setPressure(v); }),
                   "Inside, above that outside, in pressure units; 0: none; below 0: suction. In its hollows if it has "
                   "any (a balloon, a tyre), otherwise in the whole; on the visible surface where that is closed.")
      .def("set_gas",
           locked([](BodyHandle& b, double pressure, double outside) { check(alive(b).setGas(pressure, outside)); }),
           "pressure"_a, "outside"_a = 0.0,
           "Fills it with a gas of this pressure above that outside: from now on (pressure + outside) x volume is "
           "constant. outside: absolute, 0 for a soft toy, 101325 for a real tyre in Pa. 0 and 0: lets the gas out.")
      .def(
          "set_pressure_surface",
          [](BodyHandle& b, const std::optional<MeshLike>& mesh) {
            const MeshModel model = mesh ? meshOf(*mesh) : MeshModel();
            const Locked lock(*b.world);
            facade::setPressureSurface(*b.state, model);
          },
          "mesh"_a.none(),
          "Sets the surface on which pressure acts, and whose volume counts: a closed mesh in the cage, rest space, "
          "such as an inner wall. None: the boundary of the tets. A gas keeps its present pressure.")
      .def_prop_ro("volume", number([](DeformableBody& b) { return b.volume(); }),
                   "The volume that pressure fills: of its hollows or, without any, of the body.")
      .def_prop_rw("friction", number([](DeformableBody& b) { return static_cast<double>(b.body().m_cfg.kDF); }),
                   locked([](BodyHandle& b, double friction) { facade::setFriction(*b.state, friction); }),
                   "0 to 1; multiplied by that of rigid bodies.")
      .def_prop_rw("restitution",
                   number([](DeformableBody& b) { return static_cast<double>(b.body().getRestitution()); }),
                   locked([](BodyHandle& b, double e) { facade::setRestitution(facade::alive(*b.state).body(), e); }),
                   "0 to 1, by default 0. The product of both objects' is the least share of the speed of approach "
                   "with which they part, so both need one.")
      .def_prop_ro("mass", number([](DeformableBody& b) { return static_cast<double>(b.body().getTotalMass()); }),
                   "Total, without pinned nodes.")
      .def("set_gravity", locked([](BodyHandle& b, const std::optional<Vec3>& gravity) {
             if (gravity) {
               check(alive(b).setGravity(toBullet(*gravity, "gravity")));
             } else {
               alive(b).followWorldGravity();
             }
           }),
           "gravity"_a.none(), "Its own gravity, world length / s^2; None: the world's.")
      .def_prop_ro("pinned", pinnedOf, "(nodes,) bool: which nodes are pinned. A new array.")
      .def("set_pinned", setPinned, "nodes"_a, "pinned"_a = true,
           "Pins nodes at their current positions, or releases them: a mask of booleans, or indices.")
      .def("set_pinned_positions", setPinnedPositions, "nodes"_a, "positions"_a,
           "Moves pinned nodes, a mask or indices, to positions (n, 3), world space, in the following steps: call it "
           "once per frame. On an Error nothing is moved.")
      .def("transform", transform, "position"_a = Vec3{}, "rotation"_a = Quaternion{0, 0, 0, 1},
           "Moves the whole body at once, without stopping its motion: rotates it about the world's origin (x, y, z, "
           "w), then translates it by position. Velocities and pinned nodes move along; its contacts are forgotten.")
      .def("reset", locked([](BodyHandle& b) { check(b.world->reset(*b.state)); }),
           "Puts it back into the state in which it was added: at its place, at rest, without history, so that its "
           "steps are those of a new body. Settings stay: pinned nodes, material, gravity, springs.")
      .def("apply_radial_impulse", radialImpulse, "centre"_a, "radius"_a, "strength"_a,
           "Pushes all of the surface in a ball away from its centre: an explosion. strength: sum of the magnitudes at "
           "all vertices.")
      .def("remove", locked([](BodyHandle& b) { b.world->remove(*b.state); }),
           "Removes it from its world, with its contacts, springs and welds. Views of it stay valid. Removing it again "
           "changes nothing.");

  world
      .def("add_body", addBody, "cage"_a, "mesh"_a.none() = nb::none(),
           nb::kw_only() TETSKIN_BODY_OPTIONS(TETSKIN_ARGUMENT),
           "Adds a soft body, which collides with rigid bodies at its visible surface. Without a mesh it has no "
           "surface, and collides at its nodes.\n\n"
           "position, rotation (x, y, z, w): of the rest space in the world. pinned: nodes, a mask of booleans or "
           "indices. mass: total; None: from "
           "density, mass per volume. youngs_modulus: pressure units; None: relative_stiffness x density x gravity x "
           "size, from 30 (wobbles, sags) to "
           "300 (firm). stiffness_damping: seconds. friction: 0 to 1. restitution: 0 to 1; the product of both "
           "objects' counts, so both need one. margin: collision margin of the nodes, world length; None: 2 % of the "
           "body's size.\n\n"
           "interpolation, normals, outside, max_distance, hard_edge_degrees: as in Skin. visible: whether steps "
           "update the surface. surface_contact: with rigid bodies; contact_margin: the distance kept, None: 0.2 % "
           "of the body's size; sample_spacing: rest units, of points on large triangles. soft_contact: with other "
           "bodies that have it; self_contact: with "
           "others and itself. Both need a distance grid of the surface, made once, which takes a second for 20,000 "
           "triangles.")
      .def_prop_ro("bodies", locked([](const std::shared_ptr<World>& w) {
                     std::vector<BodyHandle> all;
                     for (const auto& state : w->bodies()) all.push_back({w, state});
                     return all;
                   }),
                   "The soft bodies, in the order in which they were added.");
  return body;
}

}  // namespace tetskin::python
