// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "support/carried_points.h"
#include "support/odd_meshes.h"
#include "support/smooth_maps.h"

#include <tetskin/core/src/exported/quadratic_point.h>

namespace tetskin::test {
namespace {

const Eigen::Vector3d kCageCentre = Eigen::Vector3d::Constant(0.5);

/// Points in and around a jittered cage, skinned all at once and singly.
template <class Scalar>
class QuadraticPoints : public testing::Test {
 protected:
  static constexpr double kRounding = sizeof(Scalar) == 4 ? 3e-6 : 5e-15;

  /// The positions of all vertices, computed one by one.
  Points oneByOne(const CarriedPoints<Scalar>& carried, const Points& nodes) const {
    const NodePositions<Scalar> positionOf = [&](int node) -> Eigen::Matrix<Scalar, 3, 1> {
      return nodes[static_cast<std::size_t>(node)].cast<Scalar>();
    };
    Points result;
    for (std::size_t v = 0; v < vertices.size(); ++v) {
      const EmbeddedPoint<Scalar> point = all.embedding.template at<Scalar>(v);
      const auto position = quadraticPosition(point, carried.embedding, carried.stencils, positionOf);
      result.push_back(position.template cast<double>());
    }
    return result;
  }

  const TetMesh cage = jittered(latticeCage(4, 4, 4, 0.25), 0.04, 9);
  const Points vertices = randomPoints(500, around(cage, 1.3), 10);
  CarriedPoints<Scalar> all{cage, vertices};
};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(QuadraticPoints, Scalars);

TYPED_TEST(QuadraticPoints, AreWhereQuadraticSkinningDrawsAllVertices) {
  for (const SmoothMap& map : smoothMaps(kCageCentre)) {
    const Points nodes = map(this->cage.nodes);
    this->all.move(nodes);
    const Points expected = this->all.quadratic();
    EXPECT_LT(distances(this->oneByOne(this->all, nodes), expected).longest, this->kRounding) << map.name;
    EXPECT_GT(distances(this->all.linear(), expected).longest, 1e-3) << map.name;
  }
}

TYPED_TEST(QuadraticPoints, AreWhereTheSurfaceOfQuadraticTetsIs) {
  const Cage whole = refineQuadratic(jittered(latticeCage(2, 2, 2, 0.5), 0.04, 9)).value();
  Cage mixed = whole;
  for (int& number : mixed.quadraticTet) number = number < 30 ? number : -1;
  for (const Cage& rest : {whole, mixed}) {
    CarriedPoints<TypeParam> carried(rest, this->vertices);
    this->all = carried;
    for (const SmoothMap& map : smoothMaps(kCageCentre)) {
      const Points nodes = map(rest.mesh.nodes);
      carried.move(nodes);
      EXPECT_LT(distances(this->oneByOne(carried, nodes), carried.quadratic()).longest, this->kRounding) << map.name;
    }
  }
}

TYPED_TEST(QuadraticPoints, AreBoundedAsTheirSurfaceIs) {
  const Points nodes = randomPoints(this->cage.nodeCount(), around(this->cage, 3.0), 11);  // a crumpled cage
  this->all.move(nodes);
  EXPECT_LT(distances(this->oneByOne(this->all, nodes), this->all.quadratic()).longest, 20 * this->kRounding);
}

TYPED_TEST(QuadraticPoints, AreLinearInTetsWithoutVerticesOfTheEmbedding) {
  const CarriedPoints<TypeParam> few(this->cage, Points(this->vertices.begin(), this->vertices.begin() + 3));
  const Points nodes = smoothMaps(kCageCentre)[0](this->cage.nodes);
  this->all.move(nodes);
  const Points linear = this->all.linear(), quadratic = this->all.quadratic();
  const Points found = this->oneByOne(few, nodes);
  std::size_t bent = 0;
  for (std::size_t v = 0; v < found.size(); ++v) {
    const bool known = std::any_of(few.bindings.begin(), few.bindings.end(), [&](const VertexBinding& binding) {
      return binding.tet == this->all.bindings[v].tet;
    });
    EXPECT_LT((found[v] - (known ? quadratic : linear)[v]).norm(), this->kRounding) << v;
    bent += known;
  }
  EXPECT_GE(bent, 3u);
  EXPECT_LT(bent, found.size() / 2);
}

}  // namespace
}  // namespace tetskin::test
