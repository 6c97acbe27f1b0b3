// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The bodies in the table of gaps: a serpent, a ball and an animal with four legs.
#pragma once

#include <string>
#include <vector>

#include "measure/body_model.h"

namespace tetskin::gaps {

/// The names of the bodies: "serpent", "round", "legs".
const std::vector<std::string>& bodyNames();

/// In world space, centred at the origin; the largest side of the cage's box is kSize. Throws InputError for any other
/// name.
measure::ModelPtr makeGapBody(const std::string& name, std::size_t tets, std::size_t triangles);

}  // namespace tetskin::gaps
