// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A built-in model whose parts lie nearer to each other than a tet of most cages: a cage that fuses them bends as one
// beam, the body itself as two leaves, four times as far.
#pragma once

#include <tetskin/core/tet_mesh.h>
#include <tetskin/core/triangle_mesh.h>

#include <cstddef>

namespace tetskin::scenes {

/// Of the beam as it is: a slot 2.4 long and 0.04 wide in 4 x 1 x 1.
constexpr double kSlottedBeamVolume = 3.904;

/// A beam of 4 x 1 x 1 units, centred at the origin, its section in x and y, that leans over to +x. A slot from its
/// upper end, across all of its width, leaves two prongs 0.48 thick and 0.04 apart. Closed and welded, flat sides and
/// sharp edges; at least `triangles`, which are clamped as those of the serpent, and few more.
TriangleMesh makeSlottedBeam(std::size_t triangles = 60000);

/// Fewest tets of the mesh below.
constexpr std::size_t kMinSlottedBeamTets = 2000;

/// The same body as a conforming mesh of tets that fills it exactly, at least `tets` of them and few more: a reference
/// that no builder of cages has made, and in which the prongs share nothing but the solid end.
TetMesh makeSlottedBeamTets(std::size_t tets);

/// Across the beam. Beyond it there is nothing but the two prongs.
Eigen::Hyperplane<double, 3> slottedBeamPlane();

}  // namespace tetskin::scenes
