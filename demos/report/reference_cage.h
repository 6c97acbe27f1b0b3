// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/cage.h>

#include <cstdint>
#include <optional>
#include <string>

#include "report/report_options.h"
#include "scenes/placement.h"

namespace tetskin::report {

constexpr const char *kBuilt = "built", *kFormula = "formula";

/// The tets whose motion counts as exact. They must not fuse components of the mesh that are near each other: such a
/// reference would find nothing wrong with cages that fuse them, too. Built ones have duplicate elements for this
/// reason: see CageShelf.
struct ReferenceCage {
  std::string from = kBuilt;  ///< kBuilt: as the other cages; kFormula: by formula; otherwise the file
  std::size_t tets = 0;       ///< requested number if built, otherwise the actual number
  std::uint64_t hash = 0;     ///< of everything that the cage holds; 0 for a built one
  double factor = 1.0;        ///< stiffness factor found by calibration; known once it has been simulated
  std::optional<Cage> cage;   ///< in the space where cages are compared; nothing: still to be built
};

/// True if it is built as the other cages are: they approach it as they get finer, which allows an estimate of its own
/// error.
inline bool isBuilt(const ReferenceCage& reference) {
  return reference.from == kBuilt;
}

/// The tets of the file, else those made by the formula of the built-in model if it has any with at least that many
/// tets, else none.
/// mesh       in its own space, which is that of the file
/// placement  from there to the space where cages are compared
/// Throws InputError if the file cannot be used, does not belong to the mesh, or is not finer than all cages
ReferenceCage referenceCageFor(const TriangleMesh& mesh, const ReportOptions& options,
                               const scenes::Placement& placement);

/// A description in words, with the number of tets.
std::string describe(const ReferenceCage& reference);

}  // namespace tetskin::report
