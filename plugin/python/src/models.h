// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The functions that bind the library to Python, one per subject.
#pragma once

#include "arrays.h"

#include <facade/worlds.h>
#include <atomic>
#include <mutex>

namespace tetskin::python {

/// What of a world has to be there before it, and as long.
struct WorldLock {
  std::unique_ptr<ParallelFor> threads;
  std::recursive_mutex mutex;
  std::atomic<unsigned> lockedIn{0};  ///< the process: see Locked
};
/// A world, with a lock for calls of several threads, and the threads that work on its steps.
class World : public WorldLock, public tetskin::World {
 public:
  World(std::unique_ptr<ParallelFor> pool, WorldOptions options)
      : WorldLock{std::move(pool), {}, {}}, tetskin::World(with(threads.get(), options)) {}

 private:
  static WorldOptions with(ParallelFor* pool, WorldOptions& options) {
    options.threads = pool;
    return options;
  }
};

/// A TriangleMesh, or a mesh of another package: see Mesh in tetskin/typing.py.
struct MeshLike {
  nb::object object;
};
MeshModel meshOf(const MeshLike& mesh);

/// Each binds one subject; those that take the class of worlds add methods to it.
void bindMeshes(nb::module_& module);
void bindCages(nb::module_& module);
void bindSkins(nb::module_& module);
void bindAnimations(nb::module_& module);
void bindRigidBodies(nb::module_& module, Class<World>& world);
void bindJoints(nb::module_& module, Class<World>& world);
void bindContacts(nb::module_& module, Class<World>& world);
void bindTouch(nb::module_& module, Class<World>& world);
Class<World> bindWorlds(nb::module_& module);
void bindRuns(nb::module_& module, Class<World>& world);
/// After all functions are defined: makes a TypeError on argument names say which is wrong. keywords.cpp
void nameFaults(nb::module_& module);

}  // namespace tetskin::python

namespace nanobind::detail {
template <>
struct type_caster<tetskin::python::MeshLike> {
  NB_TYPE_CASTER(tetskin::python::MeshLike, const_name("TriangleMesh | Mesh"))
  bool from_python(handle source, std::uint8_t, cleanup_list*) noexcept {
    value.object = borrow(source);
    return true;
  }
};
}  // namespace nanobind::detail
