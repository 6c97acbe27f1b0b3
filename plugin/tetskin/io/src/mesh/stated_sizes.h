// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/types.h>

#include <string>

namespace tetskin::io {

/// Ok unless a file states that it contains more than its bytes can: assimp trusts such counts, and allocates and loops
/// by them. Tested are OFF (vertices and faces), binary STL (triangles) and binary glTF (its scene); all other files
/// are Ok. Errors: FileNotFound; Malformed, with the stated and the actual size
Status checkStatedSizes(const std::string& path);

}  // namespace tetskin::io
