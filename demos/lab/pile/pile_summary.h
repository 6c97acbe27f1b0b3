// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "pile/measurements.h"
#include "scenes/playback.h"

namespace tetskin::scenes {

nlohmann::ordered_json summarise(const PileOptions& options, const Pile& pile, const Measurements& measured,
                                 const Playback& run);

/// json  from `summarise`, with what all runs have
void printSummary(const nlohmann::ordered_json& json, const PileOptions& options);

}  // namespace tetskin::scenes
