// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/core/types.h>

#include <string>

namespace tetskin::io {

/// Ok unless a file states that it holds more than its bytes can: assimp takes such counts on trust, and allocates and
/// loops by them. Asked of OFF (vertices and faces), binary STL (triangles) and binary glTF (its scene); all other
/// files are Ok. Errors: FileNotFound; Malformed, with what is stated and what there is
Status checkStatedSizes(const std::string& path);

}  // namespace tetskin::io
