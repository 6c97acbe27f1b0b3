// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/contact/src/soft/surface_thickness.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace tetskin::contact_detail {
namespace {

/// Number of places at which the thickness of a body is measured, and the part of its surface that may be thinner: fins
/// and horns do not make a body thin.
constexpr int kThicknessPlaces = 500;
constexpr double kThinPart = 0.5;

/// The thickness of the body behind the middle of a triangle, up to a bound: twice the depth of the middle of the body
/// there.
double thicknessAt(const Eigen::Vector3d& middle, const Eigen::Vector3d& inwards, const TriangleBvh& surface,
                   double most) {
  constexpr double kStep = 0.8, kSame = 0.95;
  constexpr int kDepths = 24;
  double depth = most / 2;
  for (int k = 0; k < kDepths; ++k, depth *= kStep) {
    if (std::sqrt(surface.nearest(middle + depth * inwards).squaredDistance) >= kSame * depth) break;
  }
  return 2 * depth;
}

}  // namespace

/// Triangles are sampled evenly by area.
double usualThickness(const TriangleMesh& mesh, const std::vector<int>& triangles, const TriangleBvh& surface,
                      double most) {
  assert(most > 0.0);
  std::vector<Eigen::Vector3d> areas;
  double total = 0.0, sum = 0.0;
  for (const int t : triangles) {
    const auto& [a, b, c] = mesh.triangles[static_cast<std::size_t>(t)];
    const auto at = [&](int v) -> const Eigen::Vector3d& { return mesh.positions[static_cast<std::size_t>(v)]; };
    areas.push_back((at(b) - at(a)).cross(at(c) - at(a)));
    total += areas.back().norm();
  }
  if (!(total > 0.0)) return most;
  const double spacing = total / kThicknessPlaces;
  std::vector<double> thickness;
  for (std::size_t k = 0; k < areas.size(); ++k) {
    sum += areas[k].norm();
    const auto places = static_cast<std::size_t>(sum / spacing);
    if (places <= thickness.size()) continue;
    const std::array<int, 3>& corners = mesh.triangles[static_cast<std::size_t>(triangles[k])];
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (const int v : corners) middle += mesh.positions[static_cast<std::size_t>(v)] / 3.0;
    thickness.resize(places, thicknessAt(middle, -areas[k].normalized(), surface, most));
  }
  if (thickness.empty()) return most;
  const auto thin = thickness.begin() + static_cast<std::ptrdiff_t>(kThinPart * static_cast<double>(thickness.size()));
  std::nth_element(thickness.begin(), thin, thickness.end());
  return *thin;
}

}  // namespace tetskin::contact_detail
