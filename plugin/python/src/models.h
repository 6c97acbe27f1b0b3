// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The functions that bind the library to Python, one per subject.
#pragma once

#include "arrays.h"

#include <facade/world_model.h>

namespace tetskin::python {

/// A TriangleMesh, or a mesh of another package: see Mesh in tetskin/typing.py.
struct MeshLike {
  nb::object object;
};
MeshModel meshOf(const MeshLike& mesh);

/// Each binds one subject; those that take the class of worlds add methods to it.
void bindMeshes(nb::module_& module);
void bindCages(nb::module_& module);
void bindSkins(nb::module_& module);
void bindElasticBodies(nb::module_& module);
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
