// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "report/build_id.h"

#include <link.h>

#include <cstdio>
#include <optional>
#include <random>
#include <vector>

#include "scenes/files.h"

namespace tetskin::report {
namespace {

std::vector<std::string> loadedLibraries() {
  std::vector<std::string> paths;
  dl_iterate_phdr(
      [](dl_phdr_info* info, std::size_t, void* into) {
        const std::string path = info->dlpi_name;
        const auto has = [&](const char* name) { return path.find(name) != std::string::npos; };
        if (has("tetskin") || has("Bullet") || has("LinearMath")) {
          static_cast<std::vector<std::string>*>(into)->push_back(path);
        }
        return 0;
      },
      &paths);
  return paths;
}

std::string makeBuildId() {
  std::vector<std::string> paths = loadedLibraries();
  paths.insert(paths.begin(), "/proc/self/exe");
  std::uint64_t hash = scenes::kNoHash;
  for (const std::string& path : paths) {
    const std::optional<std::string> bytes = scenes::contentsOf(path);
    if (!bytes) return "of this run alone: " + std::to_string(std::random_device()());
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
