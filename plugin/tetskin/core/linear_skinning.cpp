// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// This work is based on:
//   Matthias Müller, "100 x Simulation Speedup with Mesh Embedding", Ten Minute Physics 12, 2022
#include <tetskin/core/linear_skinning.h>

namespace tetskin {

template <class Scalar>
bool packNodes(PointView<const Scalar> positions, PackedNodes<Scalar>& packed) {
  assert(positions.size() == packed.size());
  Scalar sum = 0;  // stays 0 unless a coordinate is infinite or not a number
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Scalar* p = positions[i];
    packed[i] = {p[0], p[1], p[2], Scalar(0)};
    sum += p[0] * 0 + p[1] * 0 + p[2] * 0;
  }
  return sum == 0;
}

template <class Scalar, class Out>
Box3 skinLinear(const Embedding& embedding, const PackedNodes<Scalar>& nodes, const Eigen::Matrix<Scalar, 3, 1>& origin,
                PointView<Out> out) {
  assert(nodes.size() == embedding.nodeCount());
  assert(out.size() == embedding.vertexCount());
  using Point = Eigen::Array<Scalar, 4, 1>;  // one register; the fourth lane is idle
  const Point shift(origin[0], origin[1], origin[2], Scalar(0));
  Point low = Point::Constant(std::numeric_limits<Scalar>::infinity()), high = -low;

  const std::vector<Embedding::Run>& runs = embedding.runs();
  const float *b0 = embedding.weights(0), *b1 = embedding.weights(1), *b2 = embedding.weights(2);
  const std::uint32_t* vertices = embedding.slotVertices().data();
  for (std::size_t r = 0; r + 1 < runs.size(); ++r) {
    const auto& n = runs[r].nodes;
    const Point p3 = nodes[n[3]].array() - shift;
    // Relative to a node: the differences are small and nearly exact even far from the origin, so a result is rounded
    // once, and the weights sum to 1 by construction.
    const Point e0 = nodes[n[0]].array() - nodes[n[3]].array();
    const Point e1 = nodes[n[1]].array() - nodes[n[3]].array();
    const Point e2 = nodes[n[2]].array() - nodes[n[3]].array();
    for (std::uint32_t slot = runs[r].firstSlot; slot < runs[r + 1].firstSlot; ++slot) {
      const Point x = p3 + (e0 * Scalar(b0[slot]) + e1 * Scalar(b1[slot]) + e2 * Scalar(b2[slot]));
      low = low.min(x);
      high = high.max(x);
      Out* target = out[vertices[slot]];
      target[0] = static_cast<Out>(x[0]);
      target[1] = static_cast<Out>(x[1]);
      target[2] = static_cast<Out>(x[2]);
    }
  }
  if (embedding.empty()) return {};
  return {low.template head<3>().template cast<double>(), high.template head<3>().template cast<double>()};
}

template bool packNodes(PointView<const float>, PackedNodes<float>&);
template bool packNodes(PointView<const double>, PackedNodes<double>&);
template Box3 skinLinear(const Embedding&, const PackedNodes<float>&, const Eigen::Vector3f&, PointView<float>);
template Box3 skinLinear(const Embedding&, const PackedNodes<float>&, const Eigen::Vector3f&, PointView<double>);
template Box3 skinLinear(const Embedding&, const PackedNodes<double>&, const Eigen::Vector3d&, PointView<float>);
template Box3 skinLinear(const Embedding&, const PackedNodes<double>&, const Eigen::Vector3d&, PointView<double>);

}  // namespace tetskin
