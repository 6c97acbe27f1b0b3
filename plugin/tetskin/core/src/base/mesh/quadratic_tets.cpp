// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/quadratic_tets.h>
#include <tetskin/core/src/base/mesh/mesh_checks.h>
#include <tetskin/core/src/base/mesh/tet_geometry.h>
#include <tetskin/core/src/base/mesh/uniform_refinement.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>
#include <string>

namespace tetskin {
namespace {

/// How far a node may be from the middle of its edge, and a volume from an eighth, as shares of the edge and the tet.
/// What is left out of account then is of that size, too.
constexpr double kMidpointTolerance = 1e-4, kVolumeTolerance = 1e-2;

/// The first node that both tets have, or -1.
int commonNode(const Tet& a, const Tet& b) {
  const auto found = std::find_first_of(a.begin(), a.end(), b.begin(), b.end());
  return found == a.end() ? -1 : *found;
}

bool isMidpoint(const TetMesh& mesh, int node, int a, int b) {
  const Eigen::Vector3d edge = mesh.nodes[b] - mesh.nodes[a];
  return (mesh.nodes[node] - mesh.nodes[a] - 0.5 * edge).norm() <= kMidpointTolerance * edge.norm();
}

/// The corner of each of the four tets at the corners, whose other nodes are midpoints: the node that none of the other
/// seven has.
std::vector<std::array<int, 2>> cornersIn(const TetMesh& mesh, const std::array<int, kSubTets>& tets) {
  std::vector<std::array<int, 2>> corners;  // node, tet
  for (const int t : tets) {
    for (const int node : mesh.tets[t]) {
      const auto uses = std::count_if(tets.begin(), tets.end(), [&](int other) {
        return std::count(mesh.tets[other].begin(), mesh.tets[other].end(), node) > 0;
      });
      if (uses == 1) corners.push_back({node, t});
    }
  }
  return corners;
}

/// The quadratic tet that these eight are the uniform refinement of.
std::optional<QuadraticTet> assembled(const TetMesh& mesh, const std::array<int, kSubTets>& tets) {
  std::vector<std::array<int, 2>> corners = cornersIn(mesh, tets);
  if (corners.size() != 4) return {};
  const auto whole = [&] { return Tet{corners[0][0], corners[1][0], corners[2][0], corners[3][0]}; };
  if (signedVolume(cornersOf(mesh, whole())) < 0.0) std::swap(corners[2], corners[3]);
  QuadraticTet result;
  result.tets = tets;
  std::size_t next = 4;
  for (std::size_t a = 0; a < 4; ++a) {
    result.nodes[a] = corners[a][0];
    for (std::size_t b = a + 1; b < 4; ++b) {
      const int middle = commonNode(mesh.tets[corners[a][1]], mesh.tets[corners[b][1]]);
      if (middle < 0 || !isMidpoint(mesh, middle, corners[a][0], corners[b][0])) return {};
      result.nodes[next++] = middle;
    }
  }
  const double volume = signedVolume(cornersOf(mesh, whole()));
  for (const int t : tets) {
    const double part = kSubTets * std::abs(signedVolume(cornersOf(mesh, mesh.tets[t])));
    if (!(std::abs(part - volume) <= kVolumeTolerance * volume)) return {};
    for (const int node : mesh.tets[t]) {
      if (std::count(result.nodes.begin(), result.nodes.end(), node) == 0) return {};
    }
  }
  return result;
}

Status invalid(const std::string& message) {
  return {StatusCode::InvalidOption, message};
}

}  // namespace

Result<std::vector<QuadraticTet>> quadraticTets(const Cage& cage) {
  std::vector<QuadraticTet> found;
  if (cage.quadraticTet.empty()) return found;
  if (cage.quadraticTet.size() != cage.mesh.tetCount()) {
    return Status{StatusCode::SizeMismatch, "the cage has " + std::to_string(cage.quadraticTet.size()) +
                                                " quadraticTet for " + std::to_string(cage.mesh.tetCount()) +
                                                " tets; pass as many values, or none"};
  }
  std::vector<std::size_t> counts;
  for (std::size_t t = 0; t < cage.quadraticTet.size(); ++t) {
    const int number = cage.quadraticTet[t];
    if (number < -1 || static_cast<std::size_t>(number + 1) > cage.mesh.tetCount() / kSubTets) {
      return invalid("the cage's quadraticTet[" + std::to_string(t) +
                     "] must be -1, or from 0 to below an eighth of the number of tets");
    }
    if (number < 0) continue;
    const auto k = static_cast<std::size_t>(number);
    if (k >= counts.size()) {
      counts.resize(k + 1, 0);
      found.resize(k + 1);
    }
    if (counts[k] < kSubTets) found[k].tets[counts[k]] = static_cast<int>(t);
    ++counts[k];
  }
  for (std::size_t k = 0; k < found.size(); ++k) {
    const std::optional<QuadraticTet> tet =
        counts[k] == kSubTets ? assembled(cage.mesh, found[k].tets) : std::optional<QuadraticTet>();
    if (!tet) {
      return invalid("the tets whose quadraticTet is " + std::to_string(k) +
                     " are not the eight of a uniformly refined tet, with nodes at the middles of its edges");
    }
    found[k] = *tet;
  }
  return found;
}

Result<Cage> refineQuadratic(const TetMesh& mesh) {
  TetMesh positive = mesh;
  const TetMeshReport report = repairTetMesh(positive);
  if (Status status = validate(mesh, report); !status.ok()) return status;
  if (report.zeroVolume.count + report.repeatedNode.count > 0) {
    return Status{StatusCode::Degenerate, "a flat tet has no quadratic one; remove flat tets"};
  }
  Cage cage(refineUniformly(positive).mesh);
  for (std::size_t t = 0; t < cage.mesh.tetCount(); ++t) cage.quadraticTet.push_back(static_cast<int>(t / kSubTets));
  return cage;
}

}  // namespace tetskin
