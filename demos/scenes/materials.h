// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The colours of everything that the demos draw, by name of material.
#pragma once

#include <tetskin/core/mesh.h>
#include <tetskin/io/animation.h>

#include <array>
#include <string>
#include <vector>

#include "view/view_page.h"

namespace tetskin::scenes {

struct Material {
  const char* name;
  std::array<double, 3> colour;
  double shine;          ///< strength of highlights, 0 to 1
  double opacity = 1.0;  ///< walls in front of their contents are transparent
};

/// Null for a name that is not in the table.
const Material* materialNamed(const std::string& name);

/// The mesh's materials that are in the table, as a Wavefront material library. Empty if none is.
std::string materialLibrary(const TriangleMesh& mesh);

/// The whole table, for GLB, and for pages.
std::vector<SurfaceMaterial> surfaceMaterials();
std::vector<view::ViewMaterial> viewMaterials();

}  // namespace tetskin::scenes
