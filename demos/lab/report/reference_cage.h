// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/cage.h>

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "report/cage_shelf.h"
#include "report/report_options.h"
#include "scenes/placement.h"

namespace tetskin::report {

constexpr const char *kBuilt = "built", *kFormula = "formula";

/// The source of the tets whose motion counts as exact. They must not fuse components of the mesh that are near each
/// other: such a reference would not detect this error in other cages. Built ones have duplicate elements for this
/// reason.
struct ReferenceSource {
  std::string from = kBuilt;  ///< kBuilt: as the other cages; kFormula: by formula; otherwise the file
  std::size_t tets = 0;       ///< requested number if built, otherwise the actual number; eight for each quadratic tet
  Filling filling;            ///< kFormula: in the space where cages are compared
  std::size_t fewest = 0;     ///< tets that the formula makes
  std::optional<Cage> cage;   ///< of a file, in the same space
};

/// The tets of the file, else those made by the formula of the built-in model if it has any with at most that many
/// tets, else built ones.
/// mesh       in its own space, which is that of the file
/// placement  from there to the space where cages are compared
/// Throws InputError if the file cannot be used, does not belong to the mesh, or is not finer than all cages
ReferenceSource referenceFor(const TriangleMesh& mesh, const ReportOptions& options,
                             const scenes::Placement& placement);

/// A description in words, with the number of tets.
std::string describe(const ReferenceSource& source);

/// Tets of the references: quadratic ones, whose own error is small; linear ones for Bullet's forces, which support no
/// others, and for vibration modes. The latter are calibrated, as their excess stiffness would otherwise count as the
/// cages' error.
enum class ReferenceTets { Quadratic, Linear };

/// The cages whose motions count as exact, and coarser ones made in the same way, from which the error of these motions
/// is estimated. Built ones have duplicate elements and volume fractions, so that they approach the mesh itself, and
/// are not fitted, as fitted tets of many shapes are stiffer. Each is made when it is first asked for. Throws
/// InputError.
class ReferenceShelf {
 public:
  /// mesh  where cages are compared; outlives this object
  ReferenceShelf(const TriangleMesh& mesh, ReferenceSource source) : mesh_(mesh), source_(std::move(source)) {}

  /// 0 is the reference itself; from each level to the next coarser one, the number of tets is divided by kLevelRatio.
  const ShelvedCage& at(ReferenceTets tets, int level = 0);
  /// The number of levels, up to kLevels: fewer where tets of a file or of a formula cannot be coarser.
  int levelCount(ReferenceTets tets) const;

  static constexpr int kLevels = 3;
  static constexpr std::size_t kLevelRatio = 3;

 private:
  std::size_t elementsAt(ReferenceTets tets, int level) const;
  ShelvedCage made(ReferenceTets tets, int level) const;

  const TriangleMesh& mesh_;
  ReferenceSource source_;
  std::map<std::pair<ReferenceTets, int>, ShelvedCage> cages_;
};

}  // namespace tetskin::report
