// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <algorithm>
#include <array>
#include <iterator>
#include <string>
#include <vector>

#include "scenes/input_error.h"

namespace tetskin::report {

/// The choices with these names (`nameOf`), in the order of `all` and without repetitions; "all" means all of them.
/// Throws InputError if there is another name.
/// option  whose values the names are
/// what    one choice is called
template <class Choice, std::size_t N>
std::vector<Choice> choicesOf(const std::string& option, const std::string& what, const std::array<Choice, N>& all,
                              const std::vector<std::string>& names) {
  const std::string everything = "all";
  std::string known = everything;
  for (const Choice choice : all) known += std::string(", ") + nameOf(choice);
  for (const std::string& name : names) {
    const auto hasName = [&](Choice choice) { return name == nameOf(choice); };
    if (name == everything || std::any_of(all.begin(), all.end(), hasName)) continue;
    throw scenes::InputError(option + ": unknown " + what + " '" + name + "'; choose from: " + known);
  }
  std::vector<Choice> choices;
  std::copy_if(all.begin(), all.end(), std::back_inserter(choices), [&](Choice choice) {
    return std::any_of(names.begin(), names.end(),
                       [&](const std::string& name) { return name == everything || name == nameOf(choice); });
  });
  return choices;
}

}  // namespace tetskin::report
