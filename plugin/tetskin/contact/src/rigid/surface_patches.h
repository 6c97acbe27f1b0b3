// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to SurfaceContact: the points of a surface that collide.
#pragma once

#include <tetskin/core/embedding.h>
#include <tetskin/solver/src/base/contact_patches.h>

#include <cstdint>
#include <vector>

namespace tetskin::contact_detail {

/// By triangle: the number of parts into which its edges are cut, a power of 2; 1: no samples.
using Divisions = std::vector<std::uint32_t>;

/// Divisions such that neighbouring samples are at most the spacing apart. Cost O(triangles)
/// spacing  rest units, above 0; infinite: no samples
Divisions divisionsFor(const TriangleMesh& mesh, double spacing);
/// The default: triangles with edges longer than a quarter of the mean edge of the tets that carry their corners get
/// samples at most an eighth of it apart, so that things half as large as such a tet do not pass; farther apart if
/// there would otherwise be more than kMaxSamples. Cost O(triangles)
/// mesh       of the embedding
/// restNodes  of the embedding, 4 values per node
Divisions defaultDivisions(const Embedding& embedding, const TriangleMesh& mesh,
                           const std::vector<btScalar>& restNodes);
/// The number of samples. Cost O(triangles)
double countOfSamples(const Divisions& divisions);

/// The patches of a mesh: the vertices of its triangles (all vertices, if there are no triangles), each position once,
/// and the samples on its triangles. Cost O(n log n) for n vertices and triangles.
/// mesh       of the embedding
/// divisions  by triangle; empty: no samples
bullet_detail::ContactPatches makeContactPatches(const Embedding& embedding, const TriangleMesh& mesh,
                                                 const Divisions& divisions);

}  // namespace tetskin::contact_detail
