// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "report/mode_shelf.h"

#include "report/cage_skin.h"
#include "scenes/tets_of_nodes.h"

namespace tetskin::report {
namespace {

/// A cage with a map, by which other cages' nodes find its duplicate tets, though it may have been made without a map.
Cage withMap(Cage cage, const TriangleMesh& mesh) {
  if (!cage.vertexTets.empty()) return cage;
  const MeshSkin<double> skin = skinOf(cage, mesh, {});
  for (const VertexBinding& binding : skin.binding()->embedding().bindings()) cage.vertexTets.push_back(binding.tet);
  return cage;
}

}  // namespace

std::shared_ptr<scenes::Reduction> ModeShelf::reductionOf(const TriangleMesh& mesh, const Cage& reference,
                                                          const Cage& cage) {
  if (!reduction_) reduction_ = std::make_shared<scenes::Reduction>(reference, max_);
  const Cage fine = withMap(reference, mesh), driver = withMap(cage, mesh);
  reduction_->nodeTets = scenes::tetsOfNodes(mesh, driver, fine);
  return reduction_;
}

}  // namespace tetskin::report
