// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "scenes/materials.h"

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <set>

namespace tetskin::scenes {
namespace {

constexpr Material kMaterials[] = {
    {"scales", {0.10, 0.44, 0.27}, 0.25},    {"horn", {0.80, 0.60, 0.34}, 0.2},
    {"ivory", {0.95, 0.92, 0.80}, 0.2},      {"eye", {1.00, 0.62, 0.05}, 0.3},
    {"pupil", {0.02, 0.02, 0.02}, 0.3},      {"hand", {0.86, 0.58, 0.42}, 0.1},
    {"bar", {0.22, 0.38, 0.62}, 0.1},        {"slotted_beam", {0.62, 0.40, 0.30}, 0.1},
    {"hat", {0.72, 0.16, 0.16}, 0.1},        {"ring", {0.86, 0.70, 0.30}, 0.5},
    {"pointer", {0.95, 0.45, 0.12}, 0.3},    {"floor", {0.957, 0.949, 0.933}, 0.0},
    {"ramp", {0.66, 0.74, 0.84}, 0.0},       {"dome", {0.93, 0.66, 0.50}, 0.0},
    {"wall", {0.66, 0.72, 0.78}, 0.0, 0.22}, {"pole", {0.35, 0.36, 0.40}, 0.2},
    {"mat", {0.62, 0.78, 0.80}, 0.1},        {"mat_chequer", {0.36, 0.60, 0.66}, 0.1},
    {"ball", {0.93, 0.62, 0.22}, 0.3},       {"heavy_ball", {0.42, 0.43, 0.47}, 0.4},
    {"cube", {0.80, 0.33, 0.38}, 0.2},       {"muscle", {0.70, 0.20, 0.17}, 0.3},
};

/// In viewers whose only light is at the camera, surfaces that face upwards would be black.
constexpr double kAmbient = 0.25;

std::string definitionOf(const Material& material) {
  const auto& [r, g, b] = material.colour;
  char text[256];
  std::snprintf(text, sizeof text, "newmtl %s\nKd %g %g %g\nKa %g %g %g\nKs %g %g %g\nNs 40\nd %g\n", material.name, r,
                g, b, kAmbient * r, kAmbient * g, kAmbient * b, material.shine, material.shine, material.shine,
                material.opacity);
  return text;
}

}  // namespace

const Material* materialNamed(const std::string& name) {
  const auto* found = std::find_if(std::begin(kMaterials), std::end(kMaterials),
                                   [&](const Material& material) { return name == material.name; });
  return found == std::end(kMaterials) ? nullptr : found;
}

std::vector<SurfaceMaterial> surfaceMaterials() {
  std::vector<SurfaceMaterial> all;
  for (const Material& material : kMaterials) {
    SurfaceMaterial& added = all.emplace_back();
    added.name = material.name;
    for (std::size_t k = 0; k < 3; ++k) {
      added.colour[static_cast<Eigen::Index>(k)] = static_cast<float>(material.colour[k]);
    }
    added.opacity = static_cast<float>(material.opacity);
    added.roughness = static_cast<float>(1.0 - material.shine);
  }
  return all;
}

std::vector<view::ViewMaterial> viewMaterials() {
  std::vector<view::ViewMaterial> all;
  for (const Material& m : kMaterials) all.push_back({m.name, m.colour, m.shine, m.opacity});
  return all;
}

std::string materialLibrary(const TriangleMesh& mesh) {
  std::set<std::string> names;
  for (const TriangleGroup& group : mesh.groups) names.insert(group.material);
  std::string text;
  for (const std::string& name : names) {
    if (const Material* material = materialNamed(name)) text += definitionOf(*material);
  }
  return text;
}

}  // namespace tetskin::scenes
