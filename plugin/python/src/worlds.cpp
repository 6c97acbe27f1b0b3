// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "handles.h"

#include <chrono>
#include <thread>
#include <vector>

namespace tetskin::python {
namespace {

/// Number of `fork`s that led to this process; each keeps only one of the threads.
std::atomic<unsigned> forks{0};

void countForks() {
  const nb::module_ os = nb::module_::import_("os");
  if (nb::hasattr(os, "register_at_fork"))
    os.attr("register_at_fork")("after_in_child"_a = nb::cpp_function([] { ++forks; }));
}

std::unique_ptr<ParallelFor> poolOf(int threads) {
  if (threads < 1 || threads > 256) throw nb::value_error("threads: must be from 1 to 256");
  if (threads == 1) return nullptr;
  return std::make_unique<ThreadPool>(static_cast<std::size_t>(threads));
}

int step(const std::shared_ptr<World>& world, double dt, int substeps) {
  return unlocked(*world, [&] {
    return facade::step(*world, dt, substeps, [&](btScalar whole, int count, btScalar substep) {
      return world->bullet().stepSimulation(whole, count, substep);
    });
  });
}

nb::bytes save(const std::shared_ptr<World>& world) {
  const std::vector<char> bytes = unlocked(*world, [&] { return take(world->save()); });
  return nb::bytes(bytes.data(), bytes.size());
}

void restore(const std::shared_ptr<World>& world, const nb::bytes& snapshot) {
  const char* data = snapshot.c_str();
  const std::size_t size = snapshot.size();
  unlocked(*world, [&] { check(world->restore(data, size)); });
}

}  // namespace

Locked::Locked(World& world) : lock_(world.mutex, std::try_to_lock) {
  if (!lock_.owns_lock()) {
    const nb::gil_scoped_release release;
    // Returns at once if a thread of this process has the lock.
    for (int look = 0; world.lockedIn != forks && !lock_.try_lock(); ++look) {
      if (look == 100) {
        fail(StatusCode::InvalidOption,
             "the world was in a call of another thread when this process was forked, which leaves it as it was then: "
             "start processes by 'spawn' (multiprocessing.get_context), or fork between steps");
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    if (!lock_.owns_lock()) lock_.lock();
  }
  world.lockedIn = forks.load();
}

Class<World> bindWorlds(nb::module_& module) {
  countForks();
  Class<World> world(
      module, "World",
      "A world of soft and rigid bodies, which it keeps. It belongs to one thread at a time: calls of others wait.");
  world
      .words([](const World& w) {
        return counted(w.bodies().size(), "soft body", "soft bodies") + ", " +
               counted(w.rigidBodies().size(), "rigid body", "rigid bodies");
      })
      .def(
          "__init__",
          [](World* self, const Vec3& gravity, int threads, bool deterministic, bool recordForces, double sleepAfter,
             int impactParts) {
            const WorldOptions options = worldOptions(gravity, deterministic, recordForces, sleepAfter, impactParts);
            new (self) World(poolOf(threads), options);
          },
          nb::kw_only(), "gravity"_a = Vec3{0, -9.81, 0}, "threads"_a = 1, "deterministic"_a = false,
          "record_forces"_a = true, "sleep_after"_a = 0.5, "impact_parts"_a = 4,
          "gravity: world length / s^2. threads: number that work on a step; any number gives the same results to the "
          "bit. deterministic: the same bits on other processors, at a cost of some percent. record_forces: for "
          "forces_on. sleep_after: seconds at rest until soft bodies, and what they lie on or carry, fall asleep: at "
          "least 0; inf: never. impact_parts: into how many parts steps may be divided while a body with little "
          "damping hits something, 1 to 64; 1: never.")
      .def("step", step, "dt"_a = 1.0 / 60.0, nb::kw_only(), "substeps"_a = 4,
           "Advances by dt seconds in `substeps` steps of Bullet, and updates all surfaces; returns the number of "
           "steps made: 0 for 0 seconds. The GIL is released. An Error with the code NON_FINITE is raised after the "
           "step: a body has exploded.")
      .def("save", save,
           "The state of the world as bytes. After restore the world continues to the last bit: in this process or "
           "another, on any number of threads.")
      .def("restore", restore, "snapshot"_a,
           "Restores a state in place. The world must have the same bodies and joints as when it was saved, made in "
           "the same order. On an Error nothing is changed.")
      .def("shift_origin", locked([](const std::shared_ptr<World>& w, const Vec3& origin) {
             check(w->shiftOrigin(toBullet(origin, "origin")));
           }),
           "origin"_a,
           "Makes a point the origin: subtracts it from all positions in the world, which continues as before. For "
           "worlds that are large for the precision of a float; best by multiples of 1,024.")
      .def(
          "__reduce__",
          [](const std::shared_ptr<World>&) -> nb::tuple {
            throw nb::type_error(
                "cannot pickle a World. Pickle what builds it, a function with its meshes and cages, and world.save(), "
                "which restore() of a world built alike takes");
          },
          nb::sig("def __reduce__(self) -> tuple[typing.Any, ...]"),
          "Raises a TypeError: pickle what builds a world, and its snapshot.")
      .def_prop_rw("gravity",
                   locked([](const std::shared_ptr<World>& w) { return vectorOf(w->bullet().getGravity()); }),
                   locked([](const std::shared_ptr<World>& w, const Vec3& gravity) {
                     w->bullet().setGravity(toBullet(gravity, "gravity"));
                   }),
                   "(3,) float64, world length / s^2; for all bodies without their own.");
  return world;
}

}  // namespace tetskin::python
