// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/mesh/quadratic_assembly.h>
#include <tetskin/core/src/base/mesh/tet_geometry.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tetskin {
namespace {

/// How far the volumes of the eight may be from an eighth of the tet's, as a share of it: moved midpoints affect thin
/// tets the most.
constexpr double kVolumeTolerance = 1e-2;

/// A corner, and the only one of the eight tets that contains it.
struct Corner {
  int node, tet;
};

/// The four nodes that only one of the eight tets has; all others are midpoints, which several share.
std::optional<std::array<Corner, 4>> cornersIn(const TetMesh& mesh, const std::array<int, kSubTets>& tets) {
  std::array<Corner, 4 * kSubTets> uses{};
  std::size_t next = 0;
  for (const int t : tets) {
    for (const int node : mesh.tets[t]) uses[next++] = {node, t};
  }
  std::sort(uses.begin(), uses.end(), [](const Corner& a, const Corner& b) { return a.node < b.node; });
  std::array<Corner, 4> corners{};
  std::size_t found = 0;
  for (std::size_t k = 0; k < uses.size(); ++k) {
    const bool shared =
        (k > 0 && uses[k - 1].node == uses[k].node) || (k + 1 < uses.size() && uses[k + 1].node == uses[k].node);
    if (shared) continue;
    if (found == 4) return {};
    corners[found++] = uses[k];
  }
  return found == 4 ? std::optional(corners) : std::nullopt;
}

/// The node that both tets have, or -1.
int commonNode(const Tet& a, const Tet& b) {
  const auto found = std::find_first_of(a.begin(), a.end(), b.begin(), b.end());
  return found == a.end() ? -1 : *found;
}

/// A bit for each midpoint that a tet has; none if it has other nodes.
unsigned midpointsOf(const Tet& tet, const QuadraticTet& whole) {
  unsigned bits = 0;
  for (const int node : tet) {
    const auto found = std::find(whole.nodes.begin() + 4, whole.nodes.end(), node);
    if (found == whole.nodes.end()) return 0;
    bits |= 1u << (found - whole.nodes.begin() - 4);
  }
  return bits;
}

/// True if the four tets without a corner are those around one diagonal of the octahedron between the midpoints:
/// different tets, which share the same two opposite midpoints.
bool areAroundADiagonal(const TetMesh& mesh, const QuadraticTet& whole, const std::array<Corner, 4>& corners) {
  unsigned common = ~0u;
  std::array<unsigned, 4> inner{};
  std::size_t count = 0;
  for (const int t : whole.tets) {
    if (std::any_of(corners.begin(), corners.end(), [t](const Corner& c) { return c.tet == t; })) continue;
    if (count == 4) return false;  // a tet has two corners
    inner[count] = midpointsOf(mesh.tets[t], whole);
    common &= inner[count++];
  }
  std::sort(inner.begin(), inner.end());
  if (count != 4 || std::adjacent_find(inner.begin(), inner.end()) != inner.end()) return false;
  return common == 0b100001u || common == 0b010010u || common == 0b001100u;
}

bool haveEighths(const TetMesh& mesh, const QuadraticTet& whole, const TetCorners& corners) {
  const double volume = std::abs(signedVolume(corners));
  return std::all_of(whole.tets.begin(), whole.tets.end(), [&](int t) {
    const double part = kSubTets * std::abs(signedVolume(cornersOf(mesh, mesh.tets[t])));
    return std::abs(part - volume) <= kVolumeTolerance * volume;
  });
}

}  // namespace

bool isMidpoint(const TetMesh& mesh, int node, int a, int b) {
  const Eigen::Vector3d edge = mesh.nodes[b] - mesh.nodes[a];
  return (mesh.nodes[node] - mesh.nodes[a] - 0.5 * edge).norm() <= kMidpointTolerance * edge.norm();
}

std::optional<QuadraticTet> assembleQuadraticTet(const TetMesh& mesh, const std::array<int, kSubTets>& tets) {
  assert(std::is_sorted(tets.begin(), tets.end()));
  auto corners = cornersIn(mesh, tets);
  if (!corners) return {};
  std::array<Corner, 4>& c = *corners;
  const auto positions = [&] { return cornersOf(mesh, {c[0].node, c[1].node, c[2].node, c[3].node}); };
  if (isFlat(positions())) return {};
  if (signedVolume(positions()) < 0.0) std::swap(c[2], c[3]);
  QuadraticTet whole;
  whole.tets = tets;
  for (std::size_t k = 0; k < 4; ++k) whole.nodes[k] = c[k].node;
  for (std::size_t e = 0; e < kTetEdges.size(); ++e) {
    const auto [a, b] = kTetEdges[e];
    const int middle = commonNode(mesh.tets[c[a].tet], mesh.tets[c[b].tet]);
    if (middle < 0 || !isMidpoint(mesh, middle, c[a].node, c[b].node)) return {};
    whole.nodes[4 + e] = middle;
  }
  if (!areAroundADiagonal(mesh, whole, c) || !haveEighths(mesh, whole, positions())) return {};
  return whole;
}

}  // namespace tetskin
