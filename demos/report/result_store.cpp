// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "report/result_store.h"

#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "scenes/files.h"
#include "scenes/input_error.h"

namespace tetskin::report {

using scenes::contentsOf;
using scenes::writeFile;

ResultStore::ResultStore(std::string folder) : folder_(std::move(folder)) {
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  if (!std::filesystem::is_directory(folder_))
    throw scenes::InputError(folder_ + ": cannot be created; check the path and its permissions");
}

std::string ResultStore::path(const nlohmann::ordered_json& settings, const char* extension) const {
  const std::string text = settings.dump();
  char name[17];
  std::snprintf(name, sizeof name, "%016llx",
                static_cast<unsigned long long>(scenes::hashOf(text.data(), text.size())));
  return (std::filesystem::path(folder_) / (std::string(name) + extension)).string();
}

std::optional<std::vector<Row>> ResultStore::rows(const nlohmann::ordered_json& settings) const {
  const std::optional<std::string> text = contentsOf(path(settings, ".json"));
  if (!text) return {};
  try {
    const auto json = nlohmann::ordered_json::parse(*text);
    if (json.at("settings") != settings) return {};
    std::vector<Row> rows;
    for (const auto& row : json.at("rows")) rows.push_back(rowFrom(row));
    return rows;
  } catch (const nlohmann::json::exception&) {
    return {};  // written by an older version: computed again
  }
}

void ResultStore::keep(const nlohmann::ordered_json& settings, const std::vector<Row>& rows) const {
  nlohmann::ordered_json json;
  json["settings"] = settings;
  json["rows"] = nlohmann::ordered_json::array();
  for (const Row& row : rows) json["rows"].push_back(toJson(row));
  writeFile(path(settings, ".json"), json.dump(1));
}

std::optional<Trajectory> ResultStore::trajectory(const nlohmann::ordered_json& settings) const {
  const std::optional<std::string> bytes = contentsOf(path(settings, ".nodes"));
  std::uint64_t size[2] = {};
  if (!bytes || bytes->size() < sizeof size) return {};
  std::memcpy(size, bytes->data(), sizeof size);
  const std::size_t frameBytes = size[1] * sizeof(Eigen::Vector3f);
  if (size[1] == 0 || bytes->size() != sizeof size + size[0] * frameBytes) return {};
  Trajectory trajectory(size[0], std::vector<Eigen::Vector3f>(size[1]));
  const char* at = bytes->data() + sizeof size;
  for (auto& frame : trajectory) {
    std::memcpy(frame.front().data(), at, frameBytes);
    at += frameBytes;
  }
  return trajectory;
}

void ResultStore::keep(const nlohmann::ordered_json& settings, const Trajectory& trajectory) const {
  const std::uint64_t size[2] = {trajectory.size(), trajectory.front().size()};
  std::string bytes(reinterpret_cast<const char*>(size), sizeof size);
  for (const auto& frame : trajectory) {
    bytes.append(reinterpret_cast<const char*>(frame.front().data()), frame.size() * sizeof(Eigen::Vector3f));
  }
  writeFile(path(settings, ".nodes"), bytes);
}

std::optional<std::string> ResultStore::text(const nlohmann::ordered_json& settings) const {
  return contentsOf(path(settings, ".ply"));
}

void ResultStore::keep(const nlohmann::ordered_json& settings, const std::string& text) const {
  writeFile(path(settings, ".ply"), text);
}

}  // namespace tetskin::report
