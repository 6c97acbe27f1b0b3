// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <optional>
#include <string>
#include <vector>

#include "report/report_row.h"
#include "report/simulation.h"

namespace tetskin::report {

/// Finished results, kept in a folder under a hash of all settings that they depend on, so that an interrupted run
/// continues where it stopped. A file is either complete or absent. Throws InputError if the folder cannot be written.
class ResultStore {
 public:
  /// folder  made if it does not exist
  explicit ResultStore(std::string folder);

  /// Empty if there are no results, or if they cannot be read.
  std::optional<std::vector<Row>> rows(const nlohmann::ordered_json& settings) const;
  void keep(const nlohmann::ordered_json& settings, const std::vector<Row>& rows) const;

  /// A reference's rows need its motion as well: nodes by frame, of equal number in all frames.
  std::optional<Trajectory> trajectory(const nlohmann::ordered_json& settings) const;
  void keep(const nlohmann::ordered_json& settings, const Trajectory& trajectory) const;

  /// Text that goes with the rows, such as a coloured mesh.
  std::optional<std::string> text(const nlohmann::ordered_json& settings) const;
  void keep(const nlohmann::ordered_json& settings, const std::string& text) const;

 private:
  std::string path(const nlohmann::ordered_json& settings, const char* extension) const;

  std::string folder_;
};

}  // namespace tetskin::report
