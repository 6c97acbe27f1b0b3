// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Python's handles of a world and its objects, and how calls wait for each other.
#pragma once

#include "models.h"

#include <tetskin/elastic/elastic_body.h>
#include <tetskin/threads/thread_pool.h>
#include <memory>
#include <mutex>

namespace tetskin::python {

/// A world's lock, for a call with the GIL: releases the GIL while waiting. Calls from within the world's own calls
/// pass. Throws if a thread of the process from which this one was forked held it, because it is never released here.
class Locked {
 public:
  explicit Locked(World& world);

 private:
  std::unique_lock<std::recursive_mutex> lock_;
};
/// Runs without the GIL, and with the world's lock.
template <class Work>
auto unlocked(World& world, Work&& work) {
  const Locked lock(world);
  const nb::gil_scoped_release release;
  return work();
}

inline World& worldOf(const std::shared_ptr<World>& world) {
  return *world;
}
template <class Of>
World& worldOf(const Of& handle) {
  return *handle.world;
}
/// Wraps calls with the lock of their first argument's world.
template <class Return, class Of, class... Arguments>
auto locked(Return (*call)(Of&, Arguments...)) {
  return [call](Of& of, Arguments... arguments) -> Return {
    const Locked lock(worldOf(of));
    return call(of, std::forward<Arguments>(arguments)...);
  };
}
template <class Call, class Return, class Of, class... Arguments>
auto lockedAs(Call call, Return (Call::*)(Of&, Arguments...) const) {
  return [call](Of& of, Arguments... arguments) -> Return {
    const Locked lock(worldOf(of));
    return call(of, std::forward<Arguments>(arguments)...);
  };
}
template <class Call>
auto locked(Call call) {
  return lockedAs(call, &Call::operator());
}

/// Arrays that a handle keeps: only for soft bodies.
template <class State>
struct Arrays {};
template <>
struct Arrays<World::Body> {
  Kept<Row3<float>> positions, normals, nodes, velocities;
};

/// Python's handle: equal to any other handle of the same state.
template <class State>
struct Handle {
  std::shared_ptr<World> world;
  std::shared_ptr<State> state;
  Arrays<State> arrays{};
};
using RigidHandle = Handle<World::RigidBody>;
using JointHandle = Handle<World::Joint>;
using BodyHandle = Handle<World::Body>;
/// A body by itself, and the number of its tets.
struct ElasticModel {
  std::shared_ptr<ElasticBody<double>> body;
  std::size_t tets = 0;
};
struct SpringHandle : Handle<World::Touch> {};
struct WeldHandle : Handle<World::Touch> {};

/// Throw if the object has been removed from its world.
using facade::alive;
using facade::checkSurface;
inline btRigidBody& alive(const RigidHandle& rigid) {
  return alive(*rigid.state);
}
inline DeformableBody& alive(const BodyHandle& body) {
  return alive(*body.state);
}
inline void checkSurface(const BodyHandle& body) {
  checkSurface(*body.state);
}

/// A rigid body of the same world, or null for None.
std::shared_ptr<World::RigidBody> rigidOf(const std::shared_ptr<World>& world, const std::optional<RigidHandle>& rigid);

/// The equality and hash of handles.
template <class Of>
void bindIdentity(Class<Of>& type) {
  type.def("__eq__",
           [](const Of& a, nb::handle b) { return nb::isinstance<Of>(b) && nb::cast<const Of&>(b).state == a.state; });
  type.def("__hash__", [](const Of& a) { return std::hash<const void*>()(a.state.get()); });
}

/// See models.h; these need the type of a body.
Class<ElasticModel> bindElasticBodies(nb::module_& module);
Class<BodyHandle> bindBodies(nb::module_& module, Class<World>& world);
void bindMaterialChanges(nb::module_& module, Class<BodyHandle>& body, Class<ElasticModel>& elastic);
void bindPages(nb::module_& module, Class<World>& world, Class<BodyHandle>& body);

}  // namespace tetskin::python
