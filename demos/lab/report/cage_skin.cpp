// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "report/cage_skin.h"

#include "scenes/input_error.h"

namespace tetskin::report {

MeshSkin<double> skinOf(const Cage& cage, const TriangleMesh& mesh, const BindingOptions& options) {
  SkinOptions all;
  static_cast<BindingOptions&>(all) = options;
  MeshSkin<double> skin;
  scenes::require(skin.bind(cage, mesh, all).status());
  return skin;
}

}  // namespace tetskin::report
