// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Meshes and cages as bytes, for another worker.
#pragma once

#include "guarded.h"

#include <facade/models.h>

namespace tetskin::js {

std::vector<unsigned char> bytesOf(const TriangleMesh& mesh);
std::vector<unsigned char> bytesOf(const CageModel& cage);
/// These throw a Failure with the code Malformed for invalid bytes, or with the error of `validate`.
MeshModel meshOfBytes(const unsigned char* bytes, std::size_t count);
CageModel cageOfBytes(const unsigned char* bytes, std::size_t count);

}  // namespace tetskin::js
