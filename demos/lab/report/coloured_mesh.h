// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/mesh.h>

#include <string>
#include <vector>

namespace tetskin::report {

/// A mesh as ASCII PLY, each vertex coloured by a value: from dark blue for 0 over green to yellow for `maximum` and
/// above.
/// positions, values  vertexCount each
std::string colouredPly(const TriangleMesh& mesh, const std::vector<Eigen::Vector3d>& positions,
                        const std::vector<float>& values, double maximum);

/// The value that all but one in a hundred do not exceed; 0 if there are none.
double maxOf(std::vector<float> values);

}  // namespace tetskin::report
