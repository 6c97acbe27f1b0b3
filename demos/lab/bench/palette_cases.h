// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <functional>

#include "scenes/model.h"

namespace tetskin::bench {

/// Registers Palette: the bones of a frame, of linear and quadratic surfaces. The time depends on the nodes alone.
/// model  called by each case; what it returns must outlive the cases
void registerPaletteCases(const std::function<const scenes::Model&()>& model);

}  // namespace tetskin::bench
