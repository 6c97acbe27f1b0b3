// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "carried_normals.h"

namespace tetskin::test {
namespace {

using Points = std::vector<Eigen::Vector3d>;

class NormalsOnLattices : public testing::TestWithParam<test::LatticeKind> {};
INSTANTIATE_TEST_SUITE_P(Normals, NormalsOnLattices, testing::ValuesIn(test::latticeKinds()),
                         [](const auto& test) { return test.param.name; });

TEST_P(NormalsOnLattices, TransformedByTheQuadraticSurfaceAreSixTimesCloser) {
  const TetMesh cage = GetParam().make(12);
  // The second sphere sticks out of the sides of the cage.
  for (const double radius : {0.47, 0.52}) {
    const TriangleMesh mesh = authoredSphere(24, radius);
    Carried<float> linear(cage, mesh, Normals::Transformed, Interpolation::Linear);
    Carried<float> quadratic(cage, mesh, Normals::Transformed);
    EXPECT_EQ(quadratic.fit.outside > 0, radius > 0.5);
    for (const test::SmoothMap& map : test::smoothMaps(kCentre)) {
      linear.move(map(cage.nodes));
      quadratic.move(map(cage.nodes));
      double sums[4] = {};
      for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
        const Eigen::Matrix3d g = map.gradient(mesh.positions[v]);
        const Eigen::Vector3d normal = cofactors(g) * mesh.normals[v].cast<double>();
        const Eigen::Vector3d tangent = g * mesh.tangents[v].head<3>().cast<double>();
        sums[0] += angle(linear.normal(v), normal);
        sums[1] += angle(quadratic.normal(v), normal);
        sums[2] += angle(linear.tangent(v), tangent);
        sums[3] += angle(quadratic.tangent(v), tangent);
      }
      EXPECT_LT(sums[1], sums[0] / 6.0) << map.name << " " << radius;
      EXPECT_LT(sums[3], sums[2] / 6.0) << map.name << " " << radius;
    }
  }
}

/// For affine maps the result is known for both kinds of normals: the cofactor matrix, of either sign.
TEST_P(NormalsOnLattices, RecomputedOnesEqualTransformedOnesOnAffineMaps) {
  const TetMesh cage = GetParam().make(4);
  const TriangleMesh mesh = test::sphere(16, 0.52, kCentre);
  const std::vector<Eigen::Vector3d> rest = restNormals(mesh);
  int mirrored = 0;
  for (const Interpolation interpolation : {Interpolation::Linear, Interpolation::Quadratic}) {
    Carried<float> transformed(cage, mesh, Normals::Transformed, interpolation);
    Carried<double> inDouble(cage, mesh, Normals::Transformed, interpolation);
    Carried<float> recomputed(cage, mesh, Normals::Recomputed, interpolation);
    for (unsigned seed = 1; seed <= 6; ++seed) {
      const test::SmoothMap map = test::affineMap(seed);
      const Eigen::Matrix3d cofactor = cofactors(map.gradient(kCentre));
      mirrored += map.gradient(kCentre).determinant() < 0.0;
      // An error in the map's gradient turns a normal by up to this factor times that error.
      const double condition = map.gradient(kCentre).squaredNorm() / cofactor.jacobiSvd().singularValues()[2];
      transformed.move(map(cage.nodes));
      inDouble.move(map(cage.nodes));
      recomputed.move(map(cage.nodes));
      for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
        const Eigen::Vector3d expected = (cofactor * rest[v]).normalized();
        EXPECT_LT((transformed.normal(v) - expected).norm(), 4e-6 * condition);
        EXPECT_LT((inDouble.normal(v) - expected).norm(), 1e-6 * condition);
        EXPECT_LT((recomputed.normal(v) - expected).norm(), 2e-5 * condition);
      }
    }
  }
  EXPECT_GT(mirrored, 0);  // some of the maps turn the cage inside out
}

TEST(Transformed, TangentsStayInTheSurface) {
  const TetMesh cage = test::latticeCage(6, 6, 6, 1.0 / 6.0);
  const TriangleMesh mesh = authoredSphere(20, 0.52);
  Carried<float> carried(cage, mesh, Normals::Transformed);
  for (const test::SmoothMap& map : test::smoothMaps(kCentre)) {
    carried.move(map(cage.nodes));
    for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
      EXPECT_LT(std::abs(carried.normal(v).dot(carried.tangent(v))), 1e-5);
    }
  }
}

TEST(Transformed, RestNormalsAreReproduced) {
  const TetMesh cage = test::bodyCentredCage(4, 4, 4, 0.25);
  const TriangleMesh mesh = authoredSphere(16, 0.52);
  for (const Interpolation interpolation : {Interpolation::Linear, Interpolation::Quadratic}) {
    Carried<float> carried(cage, mesh, Normals::Transformed, interpolation);
    for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
      EXPECT_LT((carried.normal(v) - mesh.normals[v].cast<double>()).norm(), 4e-6);
      EXPECT_LT((carried.tangent(v) - mesh.tangents[v].head<3>().cast<double>()).norm(), 4e-6);
    }
  }
}

TEST(Transformed, SeamsWithEqualNormalsGetIdenticalBits) {
  const TetMesh cage = test::latticeCage(4, 4, 4, 0.25);
  TriangleMesh mesh = authoredSphere(12, 0.52);
  const std::size_t count = mesh.vertexCount();
  mesh.positions.insert(mesh.positions.end(), mesh.positions.begin(), mesh.positions.begin() + count);
  mesh.normals.insert(mesh.normals.end(), mesh.normals.begin(), mesh.normals.begin() + count);
  mesh.tangents.insert(mesh.tangents.end(), mesh.tangents.begin(), mesh.tangents.begin() + count);
  Carried<float> carried(cage, mesh, Normals::Transformed);
  carried.move(test::smoothMaps(kCentre)[3](cage.nodes));
  for (std::size_t v = 0; v < count; ++v) {
    EXPECT_EQ(carried.normal(v), carried.normal(v + count));
    EXPECT_EQ(carried.tangent(v), carried.tangent(v + count));
  }
}

/// Two cages, one of which collapses to a point: the normals of that one keep their last values.
template <class Scalar>
void expectCollapsedKeepsTheLastGoodNormal(Normals normals, Interpolation interpolation) {
  TetMesh cage = test::latticeCage(3, 3, 3, 1.0 / 3.0);
  const int half = static_cast<int>(cage.nodeCount());
  const TetMesh other = cage;
  for (const Eigen::Vector3d& p : other.nodes) cage.nodes.push_back(p + Eigen::Vector3d(2, 0, 0));
  for (Tet tet : other.tets) {
    for (int& n : tet) n += half;
    cage.tets.push_back(tet);
  }
  TriangleMesh mesh = authoredSphere(10, 0.45);
  const int count = static_cast<int>(mesh.vertexCount());
  const TriangleMesh second = mesh;
  for (int v = 0; v < count; ++v) {
    mesh.positions.push_back(second.positions[v] + Eigen::Vector3d(2, 0, 0));
    mesh.normals.push_back(second.normals[v]);
    mesh.tangents.push_back(second.tangents[v]);
  }
  for (auto t : second.triangles) {
    for (int& v : t) v += count;
    mesh.triangles.push_back(t);
  }

  Carried<Scalar> carried(cage, mesh, normals, interpolation);
  const test::SmoothMap twist = test::smoothMaps(kCentre)[0], bend = test::smoothMaps(kCentre)[1];
  const Points good = twist(cage.nodes);
  carried.move(good);
  std::vector<Eigen::Vector3d> before;
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) before.push_back(carried.normal(v));
  Points collapsed = bend(cage.nodes);
  for (std::size_t n = half; n < collapsed.size(); ++n) collapsed[n] = {3, 4, 5};
  carried.move(collapsed);
  double turned = 0.0;
  for (int v = 0; v < count; ++v) {
    turned = std::max(turned, angle(carried.normal(v), before[v]));
    EXPECT_EQ(carried.normal(v + count), before[v + count]) << "vertex " << v;
  }
  EXPECT_GT(turned, 10.0);  // the other half kept moving
  carried.move(good);
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) EXPECT_EQ(carried.normal(v), before[v]);
}

TEST(CollapsedNeighbourhood, KeepsTheLastGoodNormal) {
  for (const Normals normals : {Normals::Transformed, Normals::Recomputed}) {
    for (const Interpolation interpolation : {Interpolation::Linear, Interpolation::Quadratic}) {
      expectCollapsedKeepsTheLastGoodNormal<float>(normals, interpolation);
      expectCollapsedKeepsTheLastGoodNormal<double>(normals, interpolation);
    }
  }
}

TEST(NormalsOfAnyScale, NeedNoUnit) {
  const TriangleMesh mesh = authoredSphere(12, 0.45);
  const TetMesh cage = test::latticeCage(4, 4, 4, 0.25);
  // The factors are powers of two, so that all vertices keep their tets and weights.
  for (const double scale : {0x1p-40, 0x1p-10, 0x1p10, 0x1p40}) {
    TriangleMesh scaled = mesh;
    TetMesh scaledCage = cage;
    for (Eigen::Vector3d& p : scaled.positions) p *= scale;
    for (Eigen::Vector3d& p : scaledCage.nodes) p *= scale;
    for (const Normals normals : {Normals::Transformed, Normals::Recomputed}) {
      Carried<float> expected(cage, mesh, normals), carried(scaledCage, scaled, normals);
      Points bent = test::smoothMaps(kCentre)[1](cage.nodes);
      expected.move(bent);
      for (Eigen::Vector3d& p : bent) p *= scale;
      carried.move(bent);
      for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
        EXPECT_LT((carried.normal(v) - expected.normal(v)).norm(), 1e-6) << scale;
      }
    }
  }
}

/// The squares of such areas exceed the range of a float.
TEST(NormalsOfAnyScale, AreNeverNaNWhenAreasOverflow) {
  const TetMesh cage = test::latticeCage(4, 4, 4, 0.25);
  const TriangleMesh mesh = authoredSphere(12, 0.52);
  // Nodes far away in all three coordinates, and near each plane, where only one coordinate of an area overflows.
  for (const Eigen::Vector3d& reach :
       {Eigen::Vector3d(1e10, 1e10, 1e10), Eigen::Vector3d(1e18, 1e18, 1e18), Eigen::Vector3d(1, 1e18, 1e18),
        Eigen::Vector3d(1e18, 1, 1e18), Eigen::Vector3d(1e18, 1e18, 1)}) {
    const Points far = test::randomPoints(cage.nodeCount(), {-reach, reach}, 74);
    for (const Normals normals : {Normals::Transformed, Normals::Recomputed}) {
      for (const Interpolation interpolation : {Interpolation::Linear, Interpolation::Quadratic}) {
        Carried<float> carried(cage, mesh, normals, interpolation);
        carried.move(far);
        for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
          EXPECT_NEAR(carried.normal(v).norm(), 1.0, 1e-5) << "vertex " << v << ", " << reach.transpose();
        }
      }
    }
  }
}

TEST(RestNormals, AreTheAuthoredOnesOrElseThoseOfTheTriangles) {
  TriangleMesh mesh = test::sphere(10, 1.0, Eigen::Vector3d::Zero());
  mesh.positions.push_back({5, 5, 5});  // belongs to no triangle
  std::vector<Eigen::Vector3d> normals = restNormals(mesh);
  for (std::size_t v = 0; v + 1 < mesh.vertexCount(); ++v) EXPECT_LT(angle(normals[v], mesh.positions[v]), 10.0);
  EXPECT_EQ(normals.back(), Eigen::Vector3d::UnitY());
  mesh.normals.assign(mesh.vertexCount(), Eigen::Vector3f(0.0f, 0.0f, 0.95f));
  mesh.normals[3].setZero();
  normals = restNormals(mesh);
  EXPECT_EQ(normals[2], Eigen::Vector3d::UnitZ());
  EXPECT_LT(angle(normals[3], mesh.positions[3]), 10.0);
}

/// Coincident vertices count as one for this purpose, including those to which none of their own triangles contributes.
TEST(RestNormals, AreSmoothAcrossSeams) {
  const TriangleMesh mesh = box(false);
  const std::vector<Eigen::Vector3d> normals = restNormals(mesh);
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
    EXPECT_NEAR(normals[v].norm(), 1.0, 1e-12);
    EXPECT_GT(normals[v].cwiseProduct(mesh.positions[v] - kCentre).minCoeff(), 0.1);
  }
}

}  // namespace
}  // namespace tetskin::test
