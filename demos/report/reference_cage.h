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

/// Which tets count as right. They must not fuse parts of the mesh that are near to each other: a reference that does
/// finds nothing wrong with cages that do. Built ones are split for that: see CageShelf.
struct ReferenceCage {
  std::string from = kBuilt;  ///< as the other cages are, by the formula of a built-in model, or the file
  std::size_t tets = 0;       ///< wished for of a built one, otherwise as many as it has
  std::uint64_t hash = 0;     ///< of all that the cage holds; 0 for a built one
  double factor = 1.0;        ///< of its stiffness, by calibration; known once it has been simulated
  std::optional<Cage> cage;   ///< where cages are compared; nothing: to be built
};

/// True if it is as the other cages are: they approach it as they get finer, which tells how wrong it is itself.
inline bool isBuilt(const ReferenceCage& reference) {
  return reference.from == kBuilt;
}

/// The file's tets, those by formula of the built-in model if it has any of at least so many, or none.
/// mesh       in its own space, which is that of the file
/// placement  from there to where cages are compared
/// Throws InputError if the file cannot be used, does not belong to the mesh, or is not finer than all cages
ReferenceCage referenceCageFor(const TriangleMesh& mesh, const ReportOptions& options,
                               const scenes::Placement& placement);

/// In words, with the number of tets.
std::string describe(const ReferenceCage& reference);

}  // namespace tetskin::report
