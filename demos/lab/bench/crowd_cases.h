// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <cstddef>

#include "scenes/model.h"

namespace tetskin::bench {

/// The skins of many bodies of one model, nine of ten of them asleep or hidden (`Crowd/`): their cost per frame of four
/// substeps, with cold caches and without Bullet's step, and the same without each optional part.
void registerCrowdCases(const scenes::ModelOptions& model, std::size_t bodies);

}  // namespace tetskin::bench
