// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Options that several programs share, and those listed next to them: name, description and position in --help are the
// same everywhere.
#pragma once

#include <string>
#include <vector>

namespace tetskin::scenes {

struct SharedOption {
  std::string name;
  std::string group;  ///< heading in --help
  std::string description;
};

/// The shared options in the order of --help.
const std::vector<SharedOption>& sharedOptions();
/// Null for an option that the program describes itself. `names` may also contain a short name: "-o,--output".
const SharedOption* sharedOption(const std::string& names);

}  // namespace tetskin::scenes
