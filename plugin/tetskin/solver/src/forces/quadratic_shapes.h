// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to tetskin::solver: the quadratic tets of a body. Bullet holds each as its eight linear parts, whose rest
// shapes may change.
#pragma once

#include <tetskin/core/cage.h>
#include <tetskin/elastic/src/exported/body_dynamics.h>

#include <vector>

namespace tetskin::bullet_detail {

/// A quadratic tet of a body, from the body's cage.
struct QuadraticShape {
  QuadraticTet tet;
  elastic_detail::RestQuadraticTet rest;
  double share = 1.0;  ///< `rest.volume` over the tet's own volume: fill and stiffness factor
};

/// cage            valid, without flat tets
/// stiffnessScale  by tet, above 0; empty: the cage's own
/// Errors          those of `quadraticTets`
Result<std::vector<QuadraticShape>> quadraticShapes(const Cage& cage, const std::vector<double>& stiffnessScale);

/// A body's tets at rest: eight linear ones become a quadratic one if their nodes and rest shapes are those of the
/// parts of a tet with straight edges, of any size and rotation.
/// linear          all tets, by volume
/// stiffnessScale  by tet, above 0, for those that stay linear; empty: 1
elastic_detail::RestTets withQuadraticTets(const elastic_detail::RestTets& linear,
                                           const std::vector<double>& stiffnessScale,
                                           const std::vector<QuadraticShape>& shapes);

}  // namespace tetskin::bullet_detail
