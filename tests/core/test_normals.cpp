// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "support/odd_meshes.h"
#include "support/smooth_maps.h"

#include <gtest/gtest.h>
#include <tetskin/core/mesh_skin.h>

#include <algorithm>
#include <cmath>

namespace tetskin {
namespace {

using Points = std::vector<Eigen::Vector3d>;

constexpr double kDegrees = 180.0 / 3.14159265358979323846;
const Eigen::Vector3d kCentre = Eigen::Vector3d::Constant(0.5);

Eigen::Matrix3d cofactors(const Eigen::Matrix3d& m) {
  Eigen::Matrix3d c;
  c << m.col(1).cross(m.col(2)), m.col(2).cross(m.col(0)), m.col(0).cross(m.col(1));
  return c;
}

double angle(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return kDegrees * std::atan2(a.cross(b).norm(), a.dot(b));
}

/// A sphere with exact normals, and tangents along its circles of latitude.
TriangleMesh authoredSphere(int rings, double radius) {
  TriangleMesh mesh = test::sphere(rings, radius, kCentre);
  for (const Eigen::Vector3d& p : mesh.positions) {
    const Eigen::Vector3d n = (p - kCentre).normalized();
    mesh.normals.push_back(n.cast<float>());
    const Eigen::Vector3d t = std::abs(n.y()) > 0.999 ? Eigen::Vector3d::UnitX() : n.cross(Eigen::Vector3d::UnitY());
    mesh.tangents.emplace_back(static_cast<float>(t.normalized().x()), static_cast<float>(t.normalized().y()),
                               static_cast<float>(t.normalized().z()), -1.0f);
  }
  return mesh;
}

/// A unit cube whose faces share no vertices, each corner with its face's normal if `authored`.
TriangleMesh box(bool authored) {
  TriangleMesh mesh;
  for (int axis = 0; axis < 3; ++axis) {
    for (int side = 0; side < 2; ++side) {
      const int first = static_cast<int>(mesh.vertexCount());
      for (int c = 0; c < 4; ++c) {
        Eigen::Vector3d p;
        p[axis] = side;
        p[(axis + 1) % 3] = c == 1 || c == 2;
        p[(axis + 2) % 3] = c >= 2;
        mesh.positions.push_back(p);
        if (authored) mesh.normals.push_back((2.0f * static_cast<float>(side) - 1.0f) * Eigen::Vector3f::Unit(axis));
      }
      const int second = side == 1 ? 1 : 3, last = side == 1 ? 3 : 1;
      mesh.triangles.push_back({first, first + second, first + 2});
      mesh.triangles.push_back({first, first + 2, first + last});
    }
  }
  return mesh;
}

template <class Scalar>
class Carried {
 public:
  Carried(const TetMesh& cage, const TriangleMesh& mesh, Normals normals,
          Interpolation interpolation = Interpolation::Quadratic, double hardEdgeDegrees = kHardEdgeDegrees) {
    SkinOptions options;
    options.normals = normals;
    options.interpolation = interpolation;
    options.hardEdgeDegrees = hardEdgeDegrees;
    fit = skin.bind(cage, mesh, options);
    EXPECT_TRUE(fit.ok()) << fit.describe();
  }
  void move(const Points& places) {
    std::vector<Eigen::Matrix<Scalar, 3, 1>> nodes;
    for (const Eigen::Vector3d& p : places) nodes.push_back(p.cast<Scalar>());
    ASSERT_EQ(skin.update(viewOf(std::as_const(nodes))), nodes.size());
  }
  Eigen::Vector3d normal(std::size_t v) const {
    return Eigen::Map<const Eigen::Vector3f>(skin.normals()[v]).template cast<double>();
  }
  Eigen::Vector3d tangent(std::size_t v) const {
    return Eigen::Map<const Eigen::Vector3f>(skin.tangents()[v]).template cast<double>();
  }

  MeshSkin<Scalar> skin;
  EmbedReport fit;
};

class NormalsOnLattices : public testing::TestWithParam<test::LatticeKind> {};
INSTANTIATE_TEST_SUITE_P(Normals, NormalsOnLattices, testing::ValuesIn(test::latticeKinds()),
                         [](const auto& test) { return test.param.name; });

TEST_P(NormalsOnLattices, TransformedByTheQuadraticSurfaceAreSixTimesCloser) {
  const TetMesh cage = GetParam().make(12);
  // The second sphere pokes through the sides of the cage.
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

/// What affine maps do to both kinds of normals is known: the cofactor matrix, of either sign.
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
      // An error of the map's gradient turns a normal by up to this many times as much.
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
  EXPECT_GT(mirrored, 0);  // among them are maps that turn the cage inside out
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

TEST(Recomputed, AreThoseOfTheDeformedTriangles) {
  const TetMesh cage = test::latticeCage(4, 4, 4, 0.25);
  const TriangleMesh mesh = test::sphere(16, 0.45, kCentre);
  Carried<double> carried(cage, mesh, Normals::Recomputed);
  const test::SmoothMap twist = test::smoothMaps(kCentre)[0];
  carried.move(twist(cage.nodes));
  std::vector<Eigen::Vector3d> expected(mesh.vertexCount(), Eigen::Vector3d::Zero());
  for (const auto& t : mesh.triangles) {
    Eigen::Vector3d corner[3];
    for (int k = 0; k < 3; ++k) corner[k] = Eigen::Map<const Eigen::Vector3d>(carried.skin.positions()[t[k]]);
    for (const int v : t) expected[v] += (corner[1] - corner[0]).cross(corner[2] - corner[0]);
  }
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
    EXPECT_LT((carried.normal(v) - expected[v].normalized()).norm(), 1e-6);
    EXPECT_LT(angle(carried.normal(v), cofactors(twist.gradient(mesh.positions[v])) * (mesh.positions[v] - kCentre)),
              12.0);
  }
}

TEST(Recomputed, AuthoredHardEdgesAreKept) {
  const TetMesh cage = test::latticeCage(3, 3, 3, 1.0 / 3.0);
  const TriangleMesh mesh = box(true);
  Carried<float> carried(cage, mesh, Normals::Recomputed);
  const test::SmoothMap map = test::affineMap(4);
  carried.move(map(cage.nodes));
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
    EXPECT_LT(angle(carried.normal(v), cofactors(map.gradient(kCentre)) * mesh.normals[v].cast<double>()), 0.1);
  }
}

TEST(Recomputed, WithoutAuthoredNormalsTheCornersOfABoxAreSmooth) {
  const TetMesh cage = test::latticeCage(3, 3, 3, 1.0 / 3.0);
  for (const auto& [authored, hardEdgeDegrees] : {std::pair{false, kHardEdgeDegrees}, std::pair{true, 91.0}}) {
    const TriangleMesh mesh = box(authored);
    Carried<float> carried(cage, mesh, Normals::Recomputed, Interpolation::Linear, hardEdgeDegrees);
    for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
      const Eigen::Vector3d corner = mesh.positions[v] - kCentre;  // one or two triangles of each face meet here
      EXPECT_LT(angle(carried.normal(v), corner), 36.0);
      EXPECT_GT((carried.normal(v).cwiseProduct(corner)).minCoeff(), 0.1);
      for (std::size_t w = 0; w < v; ++w) {
        if (mesh.positions[v] == mesh.positions[w]) {
          EXPECT_EQ(carried.normal(v), carried.normal(w));
        }
      }
    }
  }
}

/// Every triangle with vertices of its own, as in an STL file; normals of one position differ by a little.
TEST(Recomputed, SeamsAreSmoothToTheLastBit) {
  const TetMesh cage = test::latticeCage(4, 4, 4, 0.25);
  const TriangleMesh whole = authoredSphere(12, 0.52);
  TriangleMesh cut;
  for (const auto& t : whole.triangles) {
    for (const int v : t) {
      cut.positions.push_back(whole.positions[v]);
      // A degree or so off, as if from a coarse file.
      const float off = 0.01f * static_cast<float>(cut.normals.size() % 3);
      cut.normals.push_back((whole.normals[v] + off * Eigen::Vector3f::UnitX()).normalized());
    }
    const int last = static_cast<int>(cut.vertexCount());
    cut.triangles.push_back({last - 3, last - 2, last - 1});
  }
  const test::SmoothMap waves = test::smoothMaps(kCentre)[3];
  Carried<float> expected(cage, whole, Normals::Recomputed), carried(cage, cut, Normals::Recomputed);
  EXPECT_EQ(carried.skin.binding()->recomputed->groupCount(), whole.vertexCount());
  expected.move(waves(cage.nodes));
  carried.move(waves(cage.nodes));
  for (std::size_t t = 0; t < whole.triangleCount(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(carried.normal(3 * t + k), expected.normal(whole.triangles[t][k]));
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

TEST(NormalTopology, SplitsAPositionByTheFirstNormalOfEachGroup) {
  TriangleMesh mesh;
  mesh.positions.assign(5, {0.1, 0.2, 0.3});
  const auto tilted = [](double degrees) -> Eigen::Vector3f {
    return Eigen::Vector3d(std::sin(degrees / kDegrees), std::cos(degrees / kDegrees), 0.0).cast<float>();
  };
  for (const double degrees : {0.0, 60.0, 3.0, 63.0, 120.0}) mesh.normals.push_back(tilted(degrees));
  const NormalTopology topology(mesh, {});
  EXPECT_EQ(topology.groupCount(), 3u);
  EXPECT_EQ(topology.places(), (std::vector<std::uint32_t>{0, 2, 1, 3, 4}));
  EXPECT_EQ(topology.groupPlaces(), (std::vector<std::uint32_t>{0, 2, 4, 5}));
  EXPECT_EQ(NormalTopology(mesh, {}, 61.0).groupCount(), 2u);
  mesh.normals.clear();
  EXPECT_EQ(NormalTopology(mesh, {}).groupCount(), 1u);
}

/// Two cages, of which one collapses to a point: its normals stay what they were.
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
  EXPECT_GT(turned, 10.0);  // the other half went on
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
  // Powers of two, so that all vertices keep their tets and weights.
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

/// Squares of such areas are beyond a float.
TEST(NormalsOfAnyScale, AreNeverNaNWhenAreasOverflow) {
  const TetMesh cage = test::latticeCage(4, 4, 4, 0.25);
  const TriangleMesh mesh = authoredSphere(12, 0.52);
  // In space, and near each plane, where only one coordinate of an area overflows.
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
  mesh.positions.push_back({5, 5, 5});  // in no triangle
  std::vector<Eigen::Vector3d> normals = restNormals(mesh);
  for (std::size_t v = 0; v + 1 < mesh.vertexCount(); ++v) EXPECT_LT(angle(normals[v], mesh.positions[v]), 10.0);
  EXPECT_EQ(normals.back(), Eigen::Vector3d::UnitY());
  mesh.normals.assign(mesh.vertexCount(), Eigen::Vector3f(0.0f, 0.0f, 0.95f));
  mesh.normals[3].setZero();
  normals = restNormals(mesh);
  EXPECT_EQ(normals[2], Eigen::Vector3d::UnitZ());
  EXPECT_LT(angle(normals[3], mesh.positions[3]), 10.0);
}

/// Coincident vertices are one for this purpose, also the ones that no triangle of their own adds to.
TEST(RestNormals, AreSmoothAcrossSeams) {
  const TriangleMesh mesh = box(false);
  const std::vector<Eigen::Vector3d> normals = restNormals(mesh);
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
    EXPECT_NEAR(normals[v].norm(), 1.0, 1e-12);
    EXPECT_GT(normals[v].cwiseProduct(mesh.positions[v] - kCentre).minCoeff(), 0.1);
  }
}

}  // namespace
}  // namespace tetskin
