// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/types.h>

#include <cstddef>
#include <string>

namespace tetskin::io {

/// A 3MF package with its models alone, and how many there are.
struct Models3mf {
  std::string bytes;
  std::size_t count = 0;
};

/// Copies the models of a 3MF package and what leads to them into a new package, as they are packed. assimp 5.2.5 frees
/// images of a package (thumbnails, textures) twice, and finds no entry whose size is stated in 64 bits.
/// Error: Malformed, with the path in front
Result<Models3mf> modelsOf3mf(const std::string& path, const std::string& bytes);

}  // namespace tetskin::io
