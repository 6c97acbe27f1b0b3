// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "report/cage_kind.h"

#include "report/named_choices.h"

namespace tetskin::report {

const char* nameOf(CageKind kind) {
  constexpr const char* kNames[] = {"same", "same_calibrated", "split", "filled", "calibrated"};
  return kNames[static_cast<std::size_t>(kind)];
}

bool isSplit(CageKind kind) {
  return kind == CageKind::Split || kind == CageKind::Calibrated;
}

bool isFilled(CageKind kind) {
  return kind == CageKind::Filled || kind == CageKind::Calibrated;
}

bool isCalibrated(CageKind kind) {
  return kind == CageKind::SameCalibrated || kind == CageKind::Calibrated;
}

std::vector<CageKind> cageKindsOf(const std::vector<std::string>& names) {
  return choicesOf("--cages", "kind", kCageKinds, names);
}

}  // namespace tetskin::report
