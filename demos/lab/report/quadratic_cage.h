// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/cage.h>
#include <tetskin/core/mesh.h>

namespace tetskin::report {

/// The same cage of quadratic tets, each of them eight tets, with all data of the cage about its mesh.
/// cage  valid, its tets positive
/// mesh  of which the cage knows `vertexTets`; not used if it knows none
/// Throws InputError
Cage quadraticCage(const Cage& cage, const TriangleMesh& mesh);

}  // namespace tetskin::report
