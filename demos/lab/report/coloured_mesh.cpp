// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// This work is based on:
//   Stéfan van der Walt and Nathaniel Smith, "viridis", the default colour map of matplotlib (its colours at six
//   places)
#include "report/coloured_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace tetskin::report {
namespace {

using Colour = std::array<double, 3>;

/// Evenly spaced; perceptually uniform, also in grey and for the colour-blind.
constexpr std::array<Colour, 6> kViridis = {
    {{68, 1, 84}, {65, 68, 135}, {42, 120, 142}, {34, 168, 132}, {122, 209, 81}, {253, 231, 37}}};

std::array<int, 3> colourOf(double fraction) {
  const double at = std::clamp(fraction, 0.0, 1.0) * (kViridis.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(at), kViridis.size() - 2);
  const double part = at - static_cast<double>(below);
  std::array<int, 3> colour{};
  for (std::size_t c = 0; c < 3; ++c) {
    colour[c] = static_cast<int>(std::lround((1.0 - part) * kViridis[below][c] + part * kViridis[below + 1][c]));
  }
  return colour;
}

template <class... Values>
void append(std::string& text, const char* format, Values... values) {
  char line[128];
  text.append(line, static_cast<std::size_t>(std::snprintf(line, sizeof line, format, values...)));
}

}  // namespace

std::string colouredPly(const TriangleMesh& mesh, const std::vector<Eigen::Vector3d>& positions,
                        const std::vector<float>& values, double maximum) {
  std::string text = "ply\nformat ascii 1.0\n";
  append(text, "comment viridis from 0 to %.4g\nelement vertex %zu\n", maximum, positions.size());
  text += "property float x\nproperty float y\nproperty float z\n";
  text += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  append(text, "element face %zu\nproperty list uchar int vertex_indices\nend_header\n", mesh.triangleCount());
  for (std::size_t v = 0; v < positions.size(); ++v) {
    const Eigen::Vector3d& p = positions[v];
    const std::array<int, 3> c = colourOf(maximum > 0.0 ? static_cast<double>(values[v]) / maximum : 0.0);
    append(text, "%.6g %.6g %.6g %d %d %d\n", p.x(), p.y(), p.z(), c[0], c[1], c[2]);
  }
  for (const auto& t : mesh.triangles) append(text, "3 %d %d %d\n", t[0], t[1], t[2]);
  return text;
}

double maxOf(std::vector<float> values) {
  if (values.empty()) return 0.0;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(99 * (values.size() - 1) / 100);
  std::nth_element(values.begin(), at, values.end());
  return static_cast<double>(*at);
}

}  // namespace tetskin::report
