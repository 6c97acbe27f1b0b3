// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <btBulletDynamicsCommon.h>
#include <tetskin/core/mesh.h>

namespace tetskin::python {

/// The surface of a collision shape, in its own space, without groups; round ones as drawn, with some 50 sides. Of any
/// shape that `Shape` makes, except a plane, which has no end.
TriangleMesh meshOf(const btCollisionShape& shape);

}  // namespace tetskin::python
