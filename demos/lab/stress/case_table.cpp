// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "stress/case_groups.h"

namespace tetskin::stress {

std::vector<StressCase> stressCases() {
  Cases cases;
  addMaterialCases(cases);
  addEventCases(cases);
  addModelCases(cases);
  addContactCases(cases);
  addReducedCases(cases);
  addClaims(cases);
  return cases;
}

}  // namespace tetskin::stress
