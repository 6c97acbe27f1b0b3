// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "report/result_store.h"

#include <tetskin/io/src/text/atomic_file.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "scenes/input_error.h"

namespace tetskin::report {
namespace {

std::optional<std::string> contentsOf(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return {};
  std::ostringstream text;
  text << file.rdbuf();
  return std::move(text).str();
}

}  // namespace

std::uint64_t hashOf(const void* bytes, std::size_t count, std::uint64_t seed) {
  const auto* data = static_cast<const unsigned char*>(bytes);
  for (std::size_t i = 0; i < count; ++i) seed = (seed ^ data[i]) * 1099511628211ull;
  return seed;
}

ResultStore::ResultStore(std::string folder) : folder_(std::move(folder)) {
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  if (!std::filesystem::is_directory(folder_)) throw scenes::InputError(folder_ + ": cannot be made a folder");
}

std::string ResultStore::path(const nlohmann::ordered_json& settings, const char* extension) const {
  const std::string text = settings.dump();
  char name[17];
  std::snprintf(name, sizeof name, "%016llx", static_cast<unsigned long long>(hashOf(text.data(), text.size())));
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
    return {};  // of an older version: made anew
  }
}

void ResultStore::keep(const nlohmann::ordered_json& settings, const std::vector<Row>& rows) const {
  nlohmann::ordered_json json;
  json["settings"] = settings;
  json["rows"] = nlohmann::ordered_json::array();
  for (const Row& row : rows) json["rows"].push_back(toJson(row));
  scenes::require(io::writeFile(path(settings, ".json"), json.dump(1)));
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
  scenes::require(io::writeFile(path(settings, ".nodes"), bytes));
}

std::optional<std::string> ResultStore::text(const nlohmann::ordered_json& settings) const {
  return contentsOf(path(settings, ".ply"));
}

void ResultStore::keep(const nlohmann::ordered_json& settings, const std::string& text) const {
  scenes::require(io::writeFile(path(settings, ".ply"), text));
}

}  // namespace tetskin::report
