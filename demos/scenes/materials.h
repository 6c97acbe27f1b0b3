// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The colours of what the demos make themselves, by the names of materials.
#pragma once

#include <tetskin/core/triangle_mesh.h>

#include <array>
#include <string>

namespace tetskin::scenes {

struct Material {
  const char* name;
  std::array<double, 3> colour;
  double shine;          ///< of highlights, 0 to 1
  double opacity = 1.0;  ///< walls in front of what they hold are seen through
};

/// Null for a name that is not in the table.
const Material* materialNamed(const std::string& name);

/// As a Wavefront material library: those of the mesh's materials that are in the table. Empty if none is.
std::string materialLibrary(const TriangleMesh& mesh);

}  // namespace tetskin::scenes
