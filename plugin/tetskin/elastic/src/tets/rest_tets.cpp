// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/mesh/tet_geometry.h>
#include <tetskin/elastic/src/tets/rest_tets.h>

#include <cassert>
#include <cmath>

namespace tetskin::elastic_detail {

RestTets restTets(const Cage& cage, const std::vector<QuadraticTet>& quadratic,
                  const std::vector<double>& stiffnessScale) {
  assert(stiffnessScale.empty() || stiffnessScale.size() == cage.mesh.tetCount());
  const std::vector<double> scale = stiffnessScale.empty() ? cage.stiffnessScale() : stiffnessScale;
  std::vector<char> isLinear(cage.mesh.tetCount(), 1);
  for (const QuadraticTet& tet : quadratic) {
    for (const int t : tet.tets) isLinear[static_cast<std::size_t>(t)] = 0;
  }
  RestTets rest;
  rest.quadratic = restQuadraticTets(cage, quadratic, stiffnessScale);
  for (std::size_t t = 0; t < cage.mesh.tetCount(); ++t) {
    if (!isLinear[t]) continue;
    const TetCorners corners = cornersOf(cage.mesh, cage.mesh.tets[t]);
    const std::array<Eigen::Vector3d, 4> gradients = BarycentricMap(corners).gradients();
    std::array<double, 9>& g = rest.gradients.emplace_back();
    for (std::size_t k = 0; k < 9; ++k) g[k] = gradients[1 + k / 3][static_cast<Eigen::Index>(k % 3)];
    rest.tets.push_back(cage.mesh.tets[t]);
    rest.volumes.push_back((scale.empty() ? 1.0 : scale[t]) * std::abs(signedVolume(corners)));
  }
  return rest;
}

}  // namespace tetskin::elastic_detail
