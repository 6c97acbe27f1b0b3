// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <array>
#include <string>
#include <vector>

namespace tetskin::report {

/// How much a cage knows of the mesh in it. Tets of bare cages are full of material; those of the others have the mass
/// of the material that they contain, and the stiffness of their volume fraction.
enum class CageKind {
  Same,            ///< bare, without duplicate elements: tets of the reference's material
  SameCalibrated,  ///< as `Same`, and softened by calibration
  Split,           ///< bare, with a duplicate of a tet for each component of the mesh in it
  Filled,          ///< with volume fractions, without duplicate elements
  Calibrated,      ///< with duplicate elements, volume fractions and calibration: the library's recommended cage
};
/// The data that a cage has.
constexpr std::array<CageKind, 5> kCageKinds = {CageKind::Same, CageKind::SameCalibrated, CageKind::Split,
                                                CageKind::Filled, CageKind::Calibrated};
/// "same", "same_calibrated", "split", "filled", "calibrated".
const char* nameOf(CageKind kind);
bool isSplit(CageKind kind);
bool isFilled(CageKind kind);
bool isCalibrated(CageKind kind);

/// The kinds with these names, in the order above and without repetitions; "all" means all of them. Throws InputError.
std::vector<CageKind> cageKindsOf(const std::vector<std::string>& names);

}  // namespace tetskin::report
