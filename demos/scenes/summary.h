// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "scenes/model.h"
#include "scenes/world.h"

namespace tetskin::scenes {

/// The beginning of a summary: the model, and how well the mesh fits the cage.
nlohmann::ordered_json summaryOf(const Model& model);
nlohmann::ordered_json summaryOf(const Model& model, const EmbedReport& fit);

/// Adds the totals of the library's solver; null where another solver was in use.
void tellSolve(const SolveTotals& totals, nlohmann::ordered_json& json);

/// Throws InputError.
void writeJson(const nlohmann::ordered_json& json, const std::string& path);

}  // namespace tetskin::scenes
