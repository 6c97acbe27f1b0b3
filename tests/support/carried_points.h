// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Points in a cage, and the positions that skinning gives them.
#pragma once

#include <tetskin/core/cage.h>
#include <tetskin/core/src/base/embedding/embedding_data.h>
#include <tetskin/core/src/skinning/quadratic_skinning.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "support/embed_into.h"

namespace tetskin::test {

using Points = std::vector<Eigen::Vector3d>;

/// Points that are skinned with nodes of one scalar type and written in the same type.
template <class Scalar>
class CarriedPoints {
 public:
  CarriedPoints(const Cage& restCage, const Points& vertices, const EmbedOptions& options = {})
      : cage(restCage.mesh), quadraticTets(tetskin::quadraticTets(restCage).value()) {
    fit = embedInto(cage, viewOf(vertices), options, embedding);
    prepare();
  }
  /// tetOf  as for embeddingFromTets
  CarriedPoints(const Cage& restCage, const Points& vertices, const std::vector<std::int32_t>& tetOf)
      : cage(restCage.mesh),
        quadraticTets(tetskin::quadraticTets(restCage).value()),
        embedding(embeddingFromTets(restCage.mesh, viewOf(vertices), tetOf)) {
    prepare();
  }

  /// Sets the nodes' current positions.
  void move(const Points& positions) {
    std::vector<Eigen::Matrix<Scalar, 3, 1>> rounded;
    for (const Eigen::Vector3d& p : positions) rounded.push_back(p.cast<Scalar>());
    finite = nodes.pack(viewOf(std::as_const(rounded))) == nodes.size();
    (void)edges.update(stencils, nodes);
  }
  Points linear() const {
    std::vector<Eigen::Matrix<Scalar, 3, 1>> out(embedding.vertexCount());
    skinPoints(embedding, nodes, {}, SkinOutput<Scalar, Scalar>{viewOf(out)});
    return inDouble(out);
  }
  Points quadratic() const {
    std::vector<Eigen::Matrix<Scalar, 3, 1>> out(embedding.vertexCount());
    skinPoints(embedding, nodes, {&stencils, &edges}, SkinOutput<Scalar, Scalar>{viewOf(out)});
    return inDouble(out);
  }

  TetMesh cage;
  std::vector<QuadraticTet> quadraticTets;
  Embedding embedding;
  Fit fit;
  QuadraticStencils<Scalar> stencils;
  EdgeVectors<Scalar> edges;
  PackedNodes<Scalar> nodes;
  std::vector<VertexBinding> bindings;
  /// By vertex: the point that its weights stand for; the weights are stored in float.
  Points rest;
  bool finite = true;

 private:
  void prepare() {
    stencils = QuadraticStencils<Scalar>(cage, embedding, {}, quadraticTets);
    edges = EdgeVectors<Scalar>(stencils);
    nodes = PackedNodes<Scalar>(cage.nodeCount());
    bindings = embedding.bindings();
    for (const VertexBinding& b : bindings) {
      const Tet& t = cage.tets[b.tet];
      Eigen::Vector3d p = cage.nodes[t[3]];
      for (int k = 0; k < 3; ++k) p += static_cast<double>(b.weights[k]) * (cage.nodes[t[k]] - cage.nodes[t[3]]);
      rest.push_back(p);
    }
  }
  static Points inDouble(const std::vector<Eigen::Matrix<Scalar, 3, 1>>& points) {
    Points result;
    for (const auto& p : points) result.push_back(p.template cast<double>());
    return result;
  }
};

/// Largest and root mean square distance of points from where they should be.
struct Distances {
  double longest = 0.0;
  double rms = 0.0;
};
inline Distances distances(const Points& points, const Points& expected) {
  Distances d;
  for (std::size_t v = 0; v < points.size(); ++v) {
    const double length = (points[v] - expected[v]).norm();
    d.longest = length <= d.longest ? d.longest : length;  // NaN counts as the largest
    d.rms += length * length;
  }
  d.rms = std::sqrt(d.rms / static_cast<double>(points.size()));
  return d;
}

}  // namespace tetskin::test
