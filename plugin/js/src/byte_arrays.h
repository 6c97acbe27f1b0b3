// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Meshes and cages as bytes, which another worker reads.
#pragma once

#include "guarded.h"

#include <facade/models.h>

namespace tetskin::js {

std::vector<unsigned char> bytesOf(const TriangleMesh& mesh);
std::vector<unsigned char> bytesOf(const CageModel& cage);
/// These throw a Failure of the code Malformed for other bytes, and what `validate` says.
MeshModel meshOfBytes(const unsigned char* bytes, std::size_t count);
CageModel cageOfBytes(const unsigned char* bytes, std::size_t count);

}  // namespace tetskin::js
