// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "report/cage_skin.h"

#include "scenes/input_error.h"

namespace tetskin::report {

MeshSkin<double> skinOf(const Cage& cage, const TriangleMesh& mesh, const BindingOptions& options) {
  // A MeshSkin that is given a cage itself takes it for a TetMesh, without the map.
  auto binding = SkinBinding<double>::make(cage, mesh, options);
  scenes::require(binding.status());
  MeshSkin<double> skin;
  scenes::require(skin.bind(std::move(binding).value(), viewOf(cage.nodes)));
  return skin;
}

}  // namespace tetskin::report
