// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Meshes and cages for other languages: immutable, so that bodies, skins and threads can share them.
#pragma once

#include "errors.h"

#include <tetskin/core/cage.h>
#include <tetskin/core/mesh.h>
#include <tetskin/core/mesh_skin.h>
#include <tetskin/elastic/elastic_law.h>

#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace tetskin::facade {

using Vec3 = std::array<double, 3>;
using Quaternion = std::array<double, 4>;  ///< x, y, z, w

struct MeshModel {
  std::shared_ptr<const TriangleMesh> mesh;
};
struct ReportedCage : Cage {
  ReportedCage(Cage&& cage, std::string&& words) : Cage(std::move(cage)), report(std::move(words)) {}
  std::string report;  ///< on how it was made, in words; may be empty
};
struct CageModel {
  std::shared_ptr<const ReportedCage> cage;
};
inline CageModel cageModel(Cage&& cage, std::string report = {}) {
  return {std::make_shared<const ReportedCage>(std::move(cage), std::move(report))};
}

/// As `validate`, and that normals, tangents and texture coordinates are none, or one for each vertex. Throws.
void checkMesh(const TriangleMesh& mesh);
/// Called with the number of bytes; returns where they are written.
using Room = std::function<unsigned char*(std::size_t)>;
/// As bytes, for other workers and processes of this version of tetskin, on machines of the same kind.
void writeBytes(const MeshModel& mesh, const Room& room);
void writeBytes(const CageModel& cage, const Room& room);
/// Back. Throw: Malformed, if bytes have changed or are of something else; or the error of `checkMesh` or `validate`.
MeshModel meshOfBytes(const unsigned char* bytes, std::size_t count);
CageModel cageOfBytes(const unsigned char* bytes, std::size_t count);

/// One of several words, for a value of this type.
template <class Of>
struct Choice {
  std::string name;
};

/// Throws unless all numbers are finite, and no larger than the library supports.
const Vec3& finite(const Vec3& vector, const char* name);

/// The value that a word stands for; throw for another word.
ElasticLaw::Kind valueOf(const Choice<ElasticLaw::Kind>& law);
Loading valueOf(const Choice<Loading>& loading);
Interpolation valueOf(const Choice<Interpolation>& interpolation);
Normals valueOf(const Choice<Normals>& normals);
OutsideRule valueOf(const Choice<OutsideRule>& outside);

/// The placement of a rest space in the world.
Eigen::Affine3d placementOf(const Vec3& position, const Quaternion& rotation);

}  // namespace tetskin::facade
