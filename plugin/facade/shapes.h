// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Collision shapes for rigid bodies. Lengths are world lengths. All throw for numbers out of range.
#pragma once

#include "worlds.h"

#include <vector>

namespace tetskin::facade {

/// The number, if it is above 0 and finite.
double positive(double value, const char* name);

ShapeModel plane(const Vec3& normal, double offset);  ///< everything below a plane: normal . x < offset
ShapeModel box(const Vec3& halfExtents);
ShapeModel sphere(double radius);
ShapeModel capsule(double radius, double height);   ///< along y; height: of the part between the caps
ShapeModel cylinder(double radius, double height);  ///< along y
ShapeModel convexHull(const std::vector<Eigen::Vector3d>& points);
ShapeModel meshShape(const TriangleMesh& mesh);  ///< collides on the side from which triangles look counter-clockwise

}  // namespace tetskin::facade
