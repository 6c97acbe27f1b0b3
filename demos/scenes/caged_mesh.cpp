// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "scenes/caged_mesh.h"

#include <utility>

#include "scenes/input_error.h"

namespace tetskin::scenes {

Cage builtCage(const TriangleMesh& mesh, const CageOptions& options) {
  Result<Cage> cage = createCage(mesh, options);
  require(cage.status());
  return std::move(cage).value();
}

Cage builtCage(const TriangleMesh& mesh, std::size_t tets) {
  CageOptions options;
  options.targetTets = tets;
  return builtCage(mesh, options);
}

SoftBodyBinding::Pointer boundTo(const Cage& cage, const TriangleMesh& mesh) {
  const auto binding = SoftBodyBinding::create(cage, mesh);
  require(binding.status());
  return binding.value();
}

Placement putInWorld(TriangleMesh& mesh, Cage& cage) {
  const Placement position = placementOf(boundingBox(cage.mesh.nodes));
  position.toWorld(mesh.positions);
  cage = position.toWorld(std::move(cage));
  return position;
}

CagedMesh inWorld(TriangleMesh mesh, std::size_t tets) {
  Cage cage = builtCage(mesh, tets);
  putInWorld(mesh, cage);
  return {std::move(mesh), std::move(cage)};
}

}  // namespace tetskin::scenes
