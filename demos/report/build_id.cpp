// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "report/build_id.h"

#include <cstdio>
#include <optional>
#include <random>
#include <vector>

#include "scenes/files.h"
#include "scenes/system.h"

namespace tetskin::report {
namespace {

std::string makeBuildId() {
  const std::vector<std::string> paths = scenes::loadedCode();
  const auto unknown = [] { return "of this run alone: " + std::to_string(std::random_device()()); };
  if (paths.empty()) return unknown();
  std::uint64_t hash = scenes::kNoHash;
  for (const std::string& path : paths) {
    const std::optional<std::string> bytes = scenes::contentsOf(path);
    if (!bytes) return unknown();
    hash = scenes::hashOf(bytes->data(), bytes->size(), hash);
  }
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
  return text;
}

}  // namespace

const std::string& buildId() {
  static const std::string id = makeBuildId();
  return id;
}

}  // namespace tetskin::report
