// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "handles.h"

#include <vector>

namespace tetskin::python {
namespace {

std::unique_ptr<ParallelFor> poolOf(int threads) {
  if (threads < 1 || threads > 256) throw nb::value_error("threads: must be from 1 to 256");
  if (threads == 1) return nullptr;
  return std::make_unique<ThreadPool>(static_cast<std::size_t>(threads));
}

/// Steps may not be called from a replay's own call of on_change: the world's lock lets its thread in.
int step(const std::shared_ptr<World>& world, double dt, int substeps) {
  return unlocked(*world, [&] {
    return world->step(dt, substeps, [&](btScalar whole, int count, btScalar substep) {
      return world->bullet().stepSimulation(whole, count, substep);
    });
  });
}

nb::bytes save(const std::shared_ptr<World>& world) {
  const std::vector<char> bytes = unlocked(*world, [&] { return world->save(); });
  return nb::bytes(bytes.data(), bytes.size());
}

void restore(const std::shared_ptr<World>& world, const nb::bytes& snapshot) {
  const char* data = snapshot.c_str();
  const std::size_t size = snapshot.size();
  unlocked(*world, [&] { world->restore(data, size); });
}

}  // namespace

Class<World> bindWorlds(nb::module_& module) {
  Class<World> world(
      module, "World",
      "A world of soft and rigid bodies, which it keeps. It belongs to one thread at a time: calls of others wait.");
  world
      .def(
          "__init__",
          [](World* self, const Vec3& gravity, int threads, bool deterministic, bool recordForces) {
            new (self) World(gravity, poolOf(threads), deterministic, recordForces);
          },
          nb::kw_only(), "gravity"_a = Vec3{0, -9.81, 0}, "threads"_a = 1, "deterministic"_a = false,
          "record_forces"_a = true,
          "gravity: world length / s^2. threads: number that work on a step; results are the same to the bit with any. "
          "deterministic: the same bits on other "
          "processors, for some percent of the time. record_forces: for forces_on.")
      .def("step", step, "dt"_a = 1.0 / 60.0, nb::kw_only(), "substeps"_a = 4,
           "Goes on by dt seconds, in so many steps of Bullet's, and updates all surfaces; returns the number of steps "
           "made. The GIL is released.")
      .def("save", save,
           "The state of the world, as bytes, from which restore goes on to the last bit: in this process or another, "
           "on any number of threads.")
      .def("restore", restore, "snapshot"_a,
           "Restores a state in place. The world has the same bodies and joints as when it was saved, made in the same "
           "order. On an Error nothing is changed.")
      .def(
          "__reduce__",
          [](const std::shared_ptr<World>&) -> nb::tuple {
            throw nb::type_error(
                "cannot pickle a World. Pickle what builds it, a function with its meshes and cages, and world.save(), "
                "which restore() of a world built alike takes");
          },
          "Raises a TypeError: what travels is what builds a world, and its snapshot.")
      .def_prop_rw(
          "gravity",
          [](const std::shared_ptr<World>& w) {
            const Locked lock(*w);
            return vectorOf(w->bullet().getGravity());
          },
          [](const std::shared_ptr<World>& w, const Vec3& gravity) {
            const Locked lock(*w);
            w->bullet().setGravity(toBullet(gravity, "gravity"));
          },
          "(3,) float64, world length / s^2; that of all bodies without their own.");
  return world;
}

}  // namespace tetskin::python
