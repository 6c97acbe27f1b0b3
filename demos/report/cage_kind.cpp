// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "report/cage_kind.h"

#include <algorithm>

#include "scenes/input_error.h"

namespace tetskin::report {
namespace {

constexpr const char* kAll = "all";

void requireKnown(const std::string& name) {
  std::string known = kAll;
  for (const CageKind kind : kCageKinds) {
    if (name == nameOf(kind)) return;
    known += std::string(", ") + nameOf(kind);
  }
  if (name != kAll) throw scenes::InputError("--cages: unknown kind '" + name + "'; choose from: " + known);
}

}  // namespace

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
  std::for_each(names.begin(), names.end(), requireKnown);
  const auto named = [&](const char* name) { return std::count(names.begin(), names.end(), name) > 0; };
  std::vector<CageKind> kinds;
  std::copy_if(kCageKinds.begin(), kCageKinds.end(), std::back_inserter(kinds),
               [&](CageKind kind) { return named(kAll) || named(nameOf(kind)); });
  return kinds;
}

}  // namespace tetskin::report
