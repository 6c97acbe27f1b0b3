// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/mesh_skin.h>

namespace tetskin::report {

/// A mesh carried by a cage in double precision, by the cage's map if it has one. Throws InputError.
MeshSkin<double> skinOf(const Cage& cage, const TriangleMesh& mesh, const BindingOptions& options);

}  // namespace tetskin::report
