// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Heavily distorted cages: the surface stays with the nodes, and normals keep unit length.
#include "support/carried_points.h"
#include "support/odd_meshes.h"

#include <tetskin/core/cage.h>
#include <tetskin/core/mesh_skin.h>
#include <tetskin/core/src/base/mesh/tet_geometry.h>

#include <limits>
#include <ostream>

namespace tetskin::test {
namespace {

struct Crumpling {
  const char* name;
  Points (*apply)(Points nodes, double size);  ///< size  of the rest cage
};

Points permuted(Points nodes, double) {
  std::mt19937 generator(71);
  for (std::size_t k = nodes.size(); k > 1; --k) std::swap(nodes[k - 1], nodes[generator() % k]);
  return nodes;
}

Points scattered(Points nodes, double reach) {
  return test::randomPoints(nodes.size(), {Eigen::Vector3d::Constant(-reach), Eigen::Vector3d::Constant(reach)}, 72);
}

template <class Change>
Points each(Points nodes, Change&& change) {
  for (Eigen::Vector3d& p : nodes) change(p);
  return nodes;
}

const Crumpling kCrumplings[] = {
    {"OnAPlane", [](Points nodes, double) { return each(nodes, [](Eigen::Vector3d& p) { p.y() = 0.0; }); }},
    {"OnASlantedPlane",
     [](Points nodes, double) { return each(nodes, [](Eigen::Vector3d& p) { p.z() = 0.3 * p.x() - 0.7 * p.y(); }); }},
    {"OnALine",
     [](Points nodes, double) { return each(nodes, [](Eigen::Vector3d& p) { p.y() = p.z() = 2 * p.x(); }); }},
    {"AtOnePoint",
     [](Points nodes, double size) {
       return each(nodes, [size](Eigen::Vector3d& p) { p = size * Eigen::Vector3d(0.2, 0.3, 0.4); });
     }},
    {"Permuted", permuted},
    {"Mirrored", [](Points nodes, double) { return each(nodes, [](Eigen::Vector3d& p) { p.x() = -p.x(); }); }},
    {"OneNodeFarAway",
     [](Points nodes, double size) {
       nodes[nodes.size() / 2] += 100.0 * size * Eigen::Vector3d(0.6, -0.64, 0.48);
       return nodes;
     }},
    {"ScatteredWithin", scattered},
    {"ScatteredFar", [](Points nodes, double size) { return scattered(nodes, 1e6 * size); }},
    {"ScatteredToTheEndOfTheWorld", [](Points nodes, double) { return scattered(nodes, 1e18); }},
    {"FoldedInHalf",
     [](Points nodes, double size) {
       return each(nodes, [size](Eigen::Vector3d& p) { p.x() = std::abs(p.x() - 0.5 * size); });
     }},
};

struct Case {
  Crumpling crumpling;
  double size;

  std::string name() const { return std::string(crumpling.name) + (size == 1.0 ? "" : size < 1.0 ? "Tiny" : "Huge"); }
};
void PrintTo(const Case& value, std::ostream* out) {
  *out << value.name();
}

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const Crumpling& crumpling : kCrumplings) {
    for (const double size : {1.0, 1e-4, 1e4}) all.push_back({crumpling, size});
  }
  return all;
}

class Crumpled : public testing::TestWithParam<Case> {
 protected:
  /// Lattices of each kind and a thin one, in the case's size.
  static std::vector<Cage> cages() {
    std::vector<Cage> all;
    for (const test::LatticeKind& kind : test::latticeKinds()) {
      // The unit has little to do with the lattice: for units other than 1, two lattices are enough.
      if (GetParam().size == 1.0 || kind.name == "Mirrored" || kind.name == "BodyCentredJittered") {
        all.push_back(kind.make(4));
      }
    }
    if (GetParam().size == 1.0) all.push_back(test::latticeCage(4, 1, 4, 0.25));
    all.push_back(refineQuadratic(test::latticeCage(2, 2, 2, 0.5)).value());
    for (Cage& cage : all) {
      for (Eigen::Vector3d& p : cage.mesh.nodes) p *= GetParam().size;
    }
    return all;
  }
  static Points vertices() {
    const double size = GetParam().size;
    return test::randomPoints(600, {Eigen::Vector3d::Constant(-0.2 * size), Eigen::Vector3d::Constant(1.2 * size)}, 73);
  }

  static double shortestEdge(const TetCorners& p) {
    double shortest = std::numeric_limits<double>::infinity();
    for (int a = 0; a < 3; ++a) {
      for (int b = a + 1; b < 4; ++b) shortest = std::min(shortest, (p[a] - p[b]).norm());
    }
    return shortest;
  }

  template <class Scalar>
  static void expectTheSurfaceStaysWithTheNodes(const Cage& rest) {
    const TetMesh& cage = rest.mesh;
    const double edge = 0.2 * GetParam().size;  // shorter than most edges
    CarriedPoints<Scalar> points(rest, vertices());
    ASSERT_GT(points.fit.inside, 30u);
    ASSERT_GT(points.fit.outside, 50u);
    const Points nodes = GetParam().crumpling.apply(cage.nodes, GetParam().size);
    points.move(nodes);
    ASSERT_TRUE(points.finite);
    const Box3 box = boundingBox(nodes);
    // The weights of vertices outside have either sign and magnitudes of up to a few units.
    const double rounding = 32 * std::numeric_limits<Scalar>::epsilon() * boundingBox(nodes).sizes().maxCoeff() +
                            8 * std::numeric_limits<Scalar>::epsilon() * box.max().cwiseAbs().maxCoeff();
    const Points linear = points.linear(), quadratic = points.quadratic();
    const Box3 grown(box.min() - Eigen::Vector3d::Constant(edge + rounding),
                     box.max() + Eigen::Vector3d::Constant(edge + rounding));
    for (std::size_t v = 0; v < quadratic.size(); ++v) {
      ASSERT_TRUE(quadratic[v].allFinite()) << "vertex " << v;
      if (points.bindings[v].inside) {
        EXPECT_TRUE(grown.contains(quadratic[v])) << "vertex " << v << " at " << quadratic[v].transpose();
      } else {
        const double shortest = shortestEdge(cornersOf(cage, cage.tets[points.bindings[v].tet]));
        EXPECT_LE((quadratic[v] - linear[v]).norm(), 1.001 * shortest + rounding) << "vertex " << v;
      }
    }
  }

  template <class Scalar>
  static void expectEdgeVectorsAreShort(const Cage& rest) {
    const TetMesh& cage = rest.mesh;
    CarriedPoints<Scalar> points(rest, vertices());
    points.move(GetParam().crumpling.apply(cage.nodes, GetParam().size));
    for (std::size_t e = 0; e < points.stencils.edgeCount(); ++e) {
      using Vector = Eigen::Matrix<Scalar, 3, 1>;
      const auto restLength = static_cast<double>(points.stencils.restLengths()[e]);
      const double length = static_cast<double>(Eigen::Map<const Vector>(points.edges.data() + 4 * e).stableNorm());
      EXPECT_LE(length, 0.500001 * restLength) << "edge " << e;
    }
  }

  template <class Scalar>
  static void expectNormalsStayUnitVectors(const Cage& cage, Interpolation interpolation, Normals normals) {
    const double size = GetParam().size;
    TriangleMesh mesh = test::sphere(12, 0.52 * size, Eigen::Vector3d::Constant(0.5 * size));
    for (std::size_t v = 0; v < mesh.vertexCount(); ++v) mesh.tangents.emplace_back(0.6f, 0.8f, 0.0f, 1.0f);
    SkinOptions options;
    options.interpolation = interpolation;
    options.normals = normals;
    MeshSkin<Scalar> skin;
    ASSERT_TRUE(skin.bind(cage, mesh, options).ok());
    std::vector<Eigen::Matrix<Scalar, 3, 1>> nodes;
    for (const Eigen::Vector3d& p : GetParam().crumpling.apply(cage.mesh.nodes, size))
      nodes.push_back(p.cast<Scalar>());
    ASSERT_EQ(skin.update(viewOf(std::as_const(nodes))), StatusCode::Ok);
    ASSERT_EQ(skin.normals().size(), mesh.vertexCount());
    for (const PointView<const float>& directions : {skin.normals(), skin.tangents()}) {
      for (std::size_t v = 0; v < directions.size(); ++v) {
        // A NaN fails this comparison.
        EXPECT_NEAR(Eigen::Map<const Eigen::Vector3f>(directions[v]).norm(), 1.0f, 1e-5f) << "vertex " << v;
      }
    }
  }
};

INSTANTIATE_TEST_SUITE_P(Cage, Crumpled, testing::ValuesIn(cases()),
                         [](const auto& test) { return test.param.name(); });

TEST_P(Crumpled, SurfaceStaysWithTheNodes) {
  for (const Cage& cage : cages()) {
    expectTheSurfaceStaysWithTheNodes<float>(cage);
    expectTheSurfaceStaysWithTheNodes<double>(cage);
  }
}

TEST_P(Crumpled, NoEdgeVectorIsLongerThanHalfItsEdgeAtRest) {
  for (const Cage& cage : cages()) {
    expectEdgeVectorsAreShort<float>(cage);
    expectEdgeVectorsAreShort<double>(cage);
  }
}

TEST_P(Crumpled, NormalsStayUnitVectors) {
  for (const Cage& cage : {cages().front(), cages().back()}) {
    for (const Normals normals : {Normals::Transformed, Normals::Recomputed}) {
      for (const Interpolation interpolation : {Interpolation::Linear, Interpolation::Quadratic}) {
        expectNormalsStayUnitVectors<float>(cage, interpolation, normals);
        expectNormalsStayUnitVectors<double>(cage, interpolation, normals);
      }
    }
  }
}

}  // namespace
}  // namespace tetskin::test
