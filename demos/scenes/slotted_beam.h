// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A built-in model with limbs that are nearer to each other than a tet of most cages is large: a cage that fuses them
// bends as one beam, while the body itself bends as two leaves, four times as far.
#pragma once

#include <tetskin/core/mesh.h>

#include <cstddef>

namespace tetskin::scenes {

/// Volume of the beam: 4 x 1 x 1 without a slot of length 2.4 and width 0.04.
constexpr double kSlottedBeamVolume = 3.904;

/// A beam of 4 x 1 x 1 units, centred at the origin, its cross-section in x and y, that leans over to +x. A slot from
/// its upper end, across the whole width, leaves two prongs 0.48 thick and 0.04 apart. Closed and welded, with flat
/// sides and sharp edges; at least `triangles`, and only a few more. `triangles` is clamped as for the serpent.
TriangleMesh makeSlottedBeam(std::size_t triangles = 60000);

/// The fewest tets that makeSlottedBeamTets makes.
constexpr std::size_t kMinSlottedBeamTets = 60;

/// The same body as a conforming mesh of tets that fills it exactly, at least `tets` and only a few more: a reference
/// that no cage builder has made, and in which the prongs share nothing but the solid end.
TetMesh makeSlottedBeamTets(std::size_t tets);

/// A plane across the beam. Beyond it there is nothing but the two prongs.
Eigen::Hyperplane<double, 3> slottedBeamPlane();

}  // namespace tetskin::scenes
