// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/cage.h>
#include <tetskin/core/src/base/mesh/mesh_checks.h>
#include <tetskin/core/src/base/mesh/quadratic_assembly.h>
#include <tetskin/core/src/base/mesh/tet_geometry.h>
#include <tetskin/core/src/base/mesh/uniform_refinement.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <string>

namespace tetskin {
namespace {

Status invalid(const std::string& message) {
  return {StatusCode::InvalidOption, message};
}

/// first  the first of the tets, if there are any
Status notEight(std::size_t number, std::size_t count, int first) {
  const std::string found =
      "the cage's quadraticTet is " + std::to_string(number) + " for " + std::to_string(count) + " tets";
  if (count == 0) return invalid(found + "; number quadratic tets from 0 on, without a gap");
  return invalid(found + ", the first of which is tet " + std::to_string(first) +
                 ", and these are not the eight of a "
                 "uniformly refined tet, with nodes at the middles of its edges");
}

/// Volume fractions of the eight tets of each: the means of those after a further refinement, if these are known.
void refineFill(const Cage& linear, Cage& refined) {
  if (linear.volumeFraction.empty()) return;
  constexpr std::size_t kPieces = kFineTets / kSubTets;
  for (std::size_t t = 0; t < refined.mesh.tetCount(); ++t) {
    if (linear.fineVolumeFraction.empty()) {
      refined.volumeFraction.push_back(linear.volumeFraction[t / kSubTets]);
      continue;
    }
    double sum = 0.0;
    for (std::size_t piece = 0; piece < kPieces; ++piece) {
      const std::uint8_t fraction = linear.fineVolumeFraction[kPieces * t + piece];
      sum += fraction;
      refined.fineVolumeFraction.insert(refined.fineVolumeFraction.end(), kFineTets / kPieces, fraction);
    }
    refined.volumeFraction.push_back(sum / (255.0 * static_cast<double>(kPieces)));
  }
}

/// Each of the eight tets gets the value of theirs.
std::vector<double> eightfold(const std::vector<double>& values) {
  std::vector<double> result;
  for (const double value : values) result.insert(result.end(), kSubTets, value);
  return result;
}

/// Distributes masses by the tets' filled volumes and densities, so that their sum stays the same; an empty tet gets a
/// share that holds its nodes, a node that no tet uses the least of all.
void refineMasses(const Cage& linear, Cage& refined) {
  if (linear.masses.empty()) return;
  refined.masses.assign(refined.mesh.nodeCount(), 0.0);
  for (std::size_t t = 0; t < refined.mesh.tetCount(); ++t) {
    const double fraction = refined.volumeFraction.empty() ? 1.0 : refined.volumeFraction[t];
    const double density = refined.paintedDensity.empty() ? 1.0 : refined.paintedDensity[t];
    const double volume = density * std::abs(signedVolume(cornersOf(refined.mesh, refined.mesh.tets[t])));
    for (const int n : refined.mesh.tets[t]) {
      refined.masses[n] += 0.25 * volume * std::max(fraction, Limits::kMinVolumeFraction);
    }
  }
  double least = std::numeric_limits<double>::infinity();
  for (const double mass : refined.masses) least = mass > 0.0 ? std::min(least, mass) : least;
  for (double& mass : refined.masses) mass = std::max(mass, least);
  const double before = std::accumulate(linear.masses.begin(), linear.masses.end(), 0.0);
  const double after = std::accumulate(refined.masses.begin(), refined.masses.end(), 0.0);
  for (double& mass : refined.masses) mass *= before / after;
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
    if (number < -1 || (number >= 0 && static_cast<std::size_t>(number) >= cage.mesh.tetCount() / kSubTets)) {
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
        counts[k] == kSubTets ? assembleQuadraticTet(cage.mesh, found[k].tets) : std::optional<QuadraticTet>();
    if (!tet) return notEight(k, counts[k], found[k].tets[0]);
    found[k] = *tet;
  }
  return found;
}

Result<Cage> refineQuadratic(const Cage& linear) {
  const TetMesh& mesh = linear.mesh;
  TetMesh positive = mesh;
  const TetMeshReport report = repairTetMesh(positive);
  if (Status status = validate(mesh, report); !status.ok()) return status;
  if (Status status = validateAttributes(linear); !status.ok()) return status;
  if (linear.hasDuplicates()) {
    return invalid(
        "a cage with duplicate elements cannot become quadratic: create it with CageOptions::duplicateElements false");
  }
  if (report.zeroVolume.count + report.repeatedNode.count > 0) {
    return Status{StatusCode::Degenerate, "a flat tet cannot become quadratic; remove flat tets"};
  }
  if (Status status = checkTetCounts(mesh.nodeCount(), kSubTets * mesh.tetCount()); !status.ok()) return status;
  Cage cage(refineUniformly(positive).mesh);
  for (std::size_t t = 0; t < cage.mesh.tetCount(); ++t) cage.quadraticTet.push_back(static_cast<int>(t / kSubTets));
  cage.paintedStiffness = eightfold(linear.paintedStiffness);
  cage.paintedDensity = eightfold(linear.paintedDensity);
  cage.paintedDamping = eightfold(linear.paintedDamping);
  refineFill(linear, cage);
  refineMasses(linear, cage);
  cage.meshHash = linear.meshHash;
  return cage;
}

}  // namespace tetskin
