// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <array>
#include <string>
#include <vector>

namespace tetskin::report {

/// What a cage knows of the mesh in it. Bare tets are full of material; the others weigh what the mesh weighs, and are
/// as stiff as they are filled.
enum class CageKind {
  Same,            ///< bare, and not split: tets of the reference's material
  SameCalibrated,  ///< the same, softened by what its tets tell
  Split,           ///< bare, with a copy of a tet for each part of the mesh
  Filled,          ///< not split
  Calibrated,      ///< split, filled and calibrated: the library's own way
};
constexpr std::array<CageKind, 5> kCageKinds = {CageKind::Same, CageKind::SameCalibrated, CageKind::Split,
                                                CageKind::Filled, CageKind::Calibrated};

/// "same", "same_calibrated", "split", "filled", "calibrated".
const char* nameOf(CageKind kind);
bool isSplit(CageKind kind);
bool isFilled(CageKind kind);
bool isCalibrated(CageKind kind);

/// Those of these names, in the order above and each once; "all" is all of them. Throws InputError.
std::vector<CageKind> cageKindsOf(const std::vector<std::string>& names);

}  // namespace tetskin::report
