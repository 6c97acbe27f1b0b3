// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "support/carried_points.h"
#include "support/odd_meshes.h"
#include "support/smooth_maps.h"

#include <tetskin/core/mesh_skin.h>

#include <limits>
#include <numeric>

namespace tetskin::test {
namespace {

/// Points in and around the unit cube.
Points pointsAround(std::size_t count, unsigned seed) {
  return test::randomPoints(count, {Eigen::Vector3d::Constant(-0.2), Eigen::Vector3d::Constant(1.2)}, seed);
}

std::vector<int> allTets(const TetMesh& cage) {
  std::vector<int> tets(cage.tetCount());
  std::iota(tets.begin(), tets.end(), 0);
  return tets;
}

/// These properties hold on every lattice, jittered or not.
class OnLattices : public testing::TestWithParam<test::LatticeKind> {};
INSTANTIATE_TEST_SUITE_P(Quadratic, OnLattices, testing::ValuesIn(test::latticeKinds()),
                         [](const auto& test) { return test.param.name; });

/// tolerance  relative to the size of the cage, which is about 1, for maps that send it to at most four times that
template <class Scalar>
void expectAffineMapsExact(const TetMesh& cage, double tolerance) {
  CarriedPoints<Scalar> points(cage, pointsAround(800, 51));
  EXPECT_GT(points.fit.outside, 100u);
  EXPECT_GT(points.fit.inside, 100u);
  for (unsigned seed = 0; seed <= 8; ++seed) {
    // The first one is the rest position itself.
    const test::SmoothMap map = test::affineMap(seed);
    const auto moved = [&](const Points& p) { return seed == 0 ? p : map(p); };
    points.move(moved(cage.nodes));
    EXPECT_LT(distances(points.linear(), moved(points.rest)).longest, tolerance) << map.name;
    EXPECT_LT(distances(points.quadratic(), moved(points.rest)).longest, tolerance) << map.name;
  }
}

TEST_P(OnLattices, AffineMapsAreExactInsideAndOutside) {
  const TetMesh cage = GetParam().make(4);
  expectAffineMapsExact<float>(cage, 4e-6);
  expectAffineMapsExact<double>(cage, 1e-12);
}

/// Compares with the vertices themselves, not only with the points that their weights in float stand for.
TEST_P(OnLattices, RestIsReproducedInFloat) {
  const TetMesh cage = GetParam().make(4);
  const Points vertices = pointsAround(800, 52);
  CarriedPoints<float> points(cage, vertices);
  points.move(cage.nodes);
  EXPECT_LT(distances(points.quadratic(), vertices).longest, 1e-6);
}

TEST_P(OnLattices, QuadraticMapsAreExactInsideUpToTheBoundary) {
  const TetMesh cage = GetParam().make(4);
  const std::vector<int> boundary = test::boundaryTets(cage);
  ASSERT_LT(boundary.size(), cage.tetCount());
  const std::vector<int> tets = allTets(cage);  // interior and boundary tets
  const Points vertices = test::pointsIn(cage, tets, 53);
  CarriedPoints<double> points(cage, vertices, tets);
  CarriedPoints<float> rounded(cage, vertices, tets);
  EXPECT_EQ(points.stencils.gradientCount(), cage.nodeCount());
  EXPECT_EQ(points.stencils.thinCount(), 0u);
  EXPECT_EQ(points.stencils.plainCount(), 0u);
  for (unsigned seed = 1; seed <= 8; ++seed) {
    const test::SmoothMap map = test::quadraticMap(seed, 0.25);
    points.move(map(cage.nodes));
    rounded.move(map(cage.nodes));
    EXPECT_LT(distances(points.quadratic(), map(points.rest)).longest, 1e-12);
    EXPECT_LT(distances(rounded.quadratic(), map(vertices)).longest, 4e-6);
    EXPECT_GT(distances(points.linear(), map(points.rest)).rms, 5e-4);
  }
}

/// The formula as D. James gives it: x(v) = sum_i b_i (x_i + F_i (v - X_i) / 2).
TEST_P(OnLattices, EdgeFormIsTheDirectFormula) {
  const TetMesh cage = GetParam().make(3);
  const Points vertices = test::pointsIn(cage, allTets(cage), 54);
  CarriedPoints<double> points(cage, vertices, allTets(cage));
  const QuadraticStencils<double>& stencils = points.stencils;
  ASSERT_EQ(stencils.gradientCount(), cage.nodeCount());
  for (const test::SmoothMap& whole : test::smoothMaps(Eigen::Vector3d::Constant(0.5))) {
    const test::SmoothMap map = test::partOf(whole, 0.3);  // gentle enough that no edge vector is limited
    const Points nodes = map(cage.nodes);
    points.move(nodes);
    std::vector<Eigen::Matrix3d> gradients;
    for (std::size_t n = 0; n < cage.nodeCount(); ++n) {
      Eigen::Matrix3d f = Eigen::Matrix3d::Zero();
      for (std::uint32_t e = stencils.starts()[n]; e < stencils.starts()[n + 1]; ++e) {
        const Eigen::Map<const Eigen::RowVector3d> factor(stencils.entryFactors().data() + 3 * std::size_t{e});
        f += nodes[stencils.entryNodes()[e]] * factor;
      }
      gradients.push_back(f);
    }
    Points expected;
    for (std::size_t v = 0; v < vertices.size(); ++v) {
      const Tet& tet = cage.tets[points.bindings[v].tet];
      Eigen::Vector4d b;
      for (int k = 0; k < 3; ++k) b[k] = static_cast<double>(points.bindings[v].weights[k]);
      b[3] = 1.0 - b[0] - b[1] - b[2];
      Eigen::Vector3d x = Eigen::Vector3d::Zero();
      for (int k = 0; k < 4; ++k) {
        x += b[k] * (nodes[tet[k]] + 0.5 * gradients[tet[k]] * (points.rest[v] - cage.nodes[tet[k]]));
      }
      expected.push_back(x);
    }
    EXPECT_LT(distances(points.quadratic(), expected).longest, 1e-12) << map.name;
  }
}

/// The largest difference between two surfaces whose points are the same but bound to the tets on either side.
template <class Scalar>
double worstJump(const TetMesh& cage) {
  Points vertices;
  std::vector<std::int32_t> oneSide, otherSide;
  for (std::size_t s = 0; s < cage.tetCount(); ++s) {
    for (std::size_t t = s + 1; t < cage.tetCount(); ++t) {
      Points shared;
      for (const int n : cage.tets[s]) {
        if (std::find(cage.tets[t].begin(), cage.tets[t].end(), n) != cage.tets[t].end()) {
          shared.push_back(cage.nodes[n]);
        }
      }
      if (shared.size() != 3) continue;
      vertices.push_back(0.25 * shared[0] + 0.5 * shared[1] + 0.25 * shared[2]);
      oneSide.push_back(static_cast<std::int32_t>(s));
      otherSide.push_back(static_cast<std::int32_t>(t));
    }
  }
  EXPECT_GT(vertices.size(), cage.tetCount());
  CarriedPoints<Scalar> one(cage, vertices, oneSide), other(cage, vertices, otherSide);
  double worst = 0.0;
  for (const test::SmoothMap& map : test::smoothMaps(Eigen::Vector3d::Constant(0.5))) {
    one.move(map(cage.nodes));
    other.move(map(cage.nodes));
    EXPECT_GT(distances(one.quadratic(), one.linear()).rms, 1e-4);
    worst = std::max(worst, distances(one.quadratic(), other.quadratic()).longest);
  }
  return worst;
}

TEST_P(OnLattices, SurfaceIsContinuousAcrossFaces) {
  const TetMesh cage = GetParam().make(3);
  EXPECT_LT(worstJump<float>(cage), 2e-6);
  EXPECT_LT(worstJump<double>(cage), 4e-7);  // weights are float
}

/// By map: the root mean square errors of the linear and the quadratic surface, for points in some of a cage's tets.
struct Errors {
  std::vector<double> linear, quadratic;
};
Errors errorsIn(const TetMesh& cage, const std::vector<int>& tets) {
  Errors errors;
  const std::vector<int> chosen = test::someOf(tets, 300, 55);
  CarriedPoints<double> points(cage, test::pointsIn(cage, chosen, 56), chosen);
  EXPECT_EQ(points.stencils.thinCount() + points.stencils.plainCount(), 0u);
  for (const test::SmoothMap& map : test::smoothMaps(Eigen::Vector3d::Constant(0.5))) {
    points.move(map(cage.nodes));
    errors.linear.push_back(distances(points.linear(), map(points.rest)).rms);
    errors.quadratic.push_back(distances(points.quadratic(), map(points.rest)).rms);
  }
  return errors;
}

TEST_P(OnLattices, ErrorsFallWithTheCubeOfTheSpacingOnTheBoundaryToo) {
  std::vector<Errors> everywhere, onBoundary;
  for (int across = 3; across <= 24; across *= 2) {
    const TetMesh cage = GetParam().make(across);
    everywhere.push_back(errorsIn(cage, allTets(cage)));
    onBoundary.push_back(errorsIn(cage, test::boundaryTets(cage)));
  }
  for (const std::vector<Errors>& levels : {everywhere, onBoundary}) {
    for (std::size_t map = 0; map < levels[0].linear.size(); ++map) {
      EXPECT_GT(std::log2(levels[0].quadratic[map] / levels[3].quadratic[map]) / 3.0, 2.7) << "map " << map;
      for (std::size_t level = 0; level < 3; ++level) {  // a single refinement depends more on the choice of points
        EXPECT_GT(std::log2(levels[level].quadratic[map] / levels[level + 1].quadratic[map]), 2.4)
            << "map " << map << ", refinement " << level;
      }
      EXPECT_NEAR(std::log2(levels[0].linear[map] / levels[3].linear[map]) / 3.0, 2.0, 0.2) << "map " << map;
    }
  }
}

/// The errors are measured everywhere on the surface that a user looks at.
TEST_P(OnLattices, SurfaceIsManyTimesCloserThanTheLinearOne) {
  const TetMesh cage = GetParam().make(8);
  const Points vertices = test::sphere(20, 0.47, Eigen::Vector3d::Constant(0.5)).positions;
  CarriedPoints<float> points(cage, vertices);
  const double gains[] = {15.0, 30.0, 18.0, 9.0};
  std::size_t k = 0;
  for (const test::SmoothMap& map : test::smoothMaps(Eigen::Vector3d::Constant(0.5))) {
    points.move(map(cage.nodes));
    const auto linear = distances(points.linear(), map(vertices)),
               quadratic = distances(points.quadratic(), map(vertices));
    EXPECT_LT(quadratic.rms, linear.rms / gains[k++]) << map.name;
    EXPECT_LT(quadratic.longest, linear.longest) << map.name;
  }
}

/// Points up to half a cell outside are still better than with extrapolation of the linear map.
TEST_P(OnLattices, VerticesOutsideGainToo) {
  const TetMesh cage = GetParam().make(8);
  const Points vertices = test::sphere(20, 0.75, Eigen::Vector3d::Constant(0.5)).positions;
  Points outside;
  for (const Eigen::Vector3d& p : vertices) {
    const Eigen::Vector3d q = (p - Eigen::Vector3d::Constant(0.5)).cwiseMax(-0.54).cwiseMin(0.54);
    outside.push_back(q + Eigen::Vector3d::Constant(0.5));
  }
  CarriedPoints<float> points(cage, outside);
  EXPECT_GT(points.fit.outside, outside.size() / 4);
  for (const test::SmoothMap& map : test::smoothMaps(Eigen::Vector3d::Constant(0.5))) {
    points.move(map(cage.nodes));
    const auto linear = distances(points.linear(), map(outside)),
               quadratic = distances(points.quadratic(), map(outside));
    EXPECT_LT(quadratic.rms, linear.rms / 4.0) << map.name;
    EXPECT_LT(quadratic.longest, linear.longest) << map.name;
  }
}

/// Outside, the map is continued to first order from the closest point: the raw products would grow with the square of
/// the distance.
TEST(QuadraticOutside, ContinuesTheMapToFirstOrderFromTheClosestPoint) {
  const TetMesh cage = test::latticeCage(4, 4, 4, 0.25);
  const Eigen::Vector3d face(0.51, 1.0, 0.43), step(0.0, 0.05, 0.0);
  const Points line{face, face + step, face + 2 * step, face + 3 * step};
  CarriedPoints<double> points(cage, line,
                               std::vector<std::int32_t>(4, CarriedPoints<double>(cage, line).bindings[1].tet));
  // Binding from tets treats these vertices as inside; a search finds three of them outside.
  CarriedPoints<double> found(cage, line);
  ASSERT_EQ(found.fit.outside, 3u);
  const test::SmoothMap map = test::quadraticMap(3, 0.3);
  found.move(map(cage.nodes));
  points.move(map(cage.nodes));
  const Points x = found.quadratic();
  EXPECT_LT((x[2] - x[1] - (x[1] - x[0])).norm(), 1e-6);
  EXPECT_LT((x[3] - x[2] - (x[1] - x[0])).norm(), 1e-6);
  EXPECT_LT((x[1] - x[0] - map.gradient(face) * step).norm(), 2e-3 * step.norm());
  const Points raw = points.quadratic();
  EXPECT_GT((raw[3] - 2 * raw[2] + raw[1]).norm(), 1e-4);  // the raw line bends
}

/// Of a layer one cell thick.
void expectNoWorseThanLinear(CarriedPoints<double>& points, const TetMesh& cage) {
  for (const test::SmoothMap& map : test::smoothMaps({0.75, 0.125, 0.75})) {
    points.move(map(cage.nodes));
    const Points expected = map(points.rest);
    EXPECT_LE(distances(points.quadratic(), expected).rms, distances(points.linear(), expected).rms) << map.name;
    EXPECT_LE(distances(points.quadratic(), expected).longest, distances(points.linear(), expected).longest)
        << map.name;
  }
}

TEST(QuadraticReport, CountsTheNodesOfACageOneCellThick) {
  for (const TetMesh& cage : {test::latticeCage(6, 1, 6, 0.25), test::plainLatticeCage(6, 1, 6, 0.25)}) {
    const std::vector<int> tets = allTets(cage);
    CarriedPoints<double> points(cage, test::pointsIn(cage, tets, 58), tets);
    EXPECT_EQ(points.stencils.thinCount(), cage.nodeCount());
    EXPECT_EQ(points.stencils.plainCount(), 0u);
    expectNoWorseThanLinear(points, cage);
  }
}

/// If the offsets across the layer differ, they almost determine second derivatives: the fit must not trust these.
TEST(QuadraticReport, AnUnevenCageOneCellThickIsNoWorseThanLinear) {
  for (const double jitter : {0.1, 0.25}) {
    for (unsigned seed = 1; seed <= 5; ++seed) {
      for (const TetMesh& even : {test::latticeCage(6, 1, 6, 0.25), test::plainLatticeCage(6, 1, 6, 0.25)}) {
        const TetMesh cage = test::jittered(even, 0.25 * jitter, seed);
        const std::vector<int> tets = allTets(cage);
        CarriedPoints<double> points(cage, test::pointsIn(cage, tets, 61), tets);
        EXPECT_GT(points.stencils.thinCount(), 0u);
        expectNoWorseThanLinear(points, cage);
      }
    }
  }
}

TEST(QuadraticReport, CountsNodesEdgesAndNeighbours) {
  const TetMesh cage = test::singleTet();
  CarriedPoints<double> points(cage, {{0.1, 0.2, 0.3}});
  EXPECT_EQ(points.stencils.gradientCount(), 4u);
  EXPECT_EQ(points.stencils.thinCount(), 4u);
  EXPECT_EQ(points.stencils.edgeCount(), 6u);
  TriangleMesh mesh;
  mesh.positions = {{0.1, 0.2, 0.3}};
  BindingOptions options;
  options.interpolation = Interpolation::Quadratic;
  const QuadraticReport report = SkinBinding<double>::create(cage, mesh, options).value()->quadraticReport();
  EXPECT_EQ(report.nodes, 4u);
  EXPECT_EQ(report.underdeterminedNodes, 4u);
  EXPECT_EQ(report.edges, 6u);
  EXPECT_EQ(report.meanNeighbours, 3.0);
  EXPECT_GT(report.milliseconds, 0.0);
  EXPECT_NE(report.describe().find("4 nodes in thin regions"), std::string::npos) << report.describe();
  // One vertex in a large cage needs four nodes, not all of them.
  CarriedPoints<double> one(test::latticeCage(6, 6, 6, 0.2), {{0.51, 0.52, 0.53}});
  EXPECT_EQ(one.stencils.gradientCount(), 4u);
  EXPECT_EQ(one.stencils.edgeCount(), 6u);
  EXPECT_EQ(one.stencils.thinCount(), 0u);
}

/// Independent noise in the nodes must not be magnified.
TEST_P(OnLattices, NoiseOfTheNodesIsHardlyMagnified) {
  const TetMesh cage = GetParam().make(6);
  CarriedPoints<double> points(cage, test::sphere(24, 0.47, Eigen::Vector3d::Constant(0.5)).positions);
  constexpr double kDeviation = 1e-4;
  std::mt19937 generator(59);
  std::normal_distribution<double> noise(0.0, kDeviation);
  double linear = 0.0, quadratic = 0.0;
  constexpr int kTrials = 10;
  for (int trial = 0; trial < kTrials; ++trial) {
    Points nodes = cage.nodes;
    for (Eigen::Vector3d& p : nodes) p += Eigen::Vector3d(noise(generator), noise(generator), noise(generator));
    points.move(nodes);
    linear += std::pow(distances(points.linear(), points.rest).rms, 2) / kTrials;
    quadratic += std::pow(distances(points.quadratic(), points.rest).rms, 2) / kTrials;
  }
  EXPECT_LT(std::sqrt(quadratic), 1.3 * kDeviation);
  EXPECT_LT(std::sqrt(linear), 1.2 * kDeviation);
  EXPECT_GT(std::sqrt(linear), 1.0 * kDeviation);
}

/// Both precisions of nodes, combined with both precisions of output.
template <class Types>
class QuadraticOutput : public testing::Test {};
using Precisions = testing::Types<std::pair<float, float>, std::pair<float, double>, std::pair<double, float>,
                                  std::pair<double, double>>;
TYPED_TEST_SUITE(QuadraticOutput, Precisions);

TYPED_TEST(QuadraticOutput, IsTheSameInEveryOrderAndStride) {
  using Scalar = typename TypeParam::first_type;
  using Out = typename TypeParam::second_type;
  using Point = Eigen::Matrix<Out, 3, 1>;
  const TetMesh cage = test::bodyCentredCage(4, 4, 4, 0.25);
  CarriedPoints<Scalar> points(cage, pointsAround(1003, 60));
  const test::SmoothMap waves = test::smoothMaps(Eigen::Vector3d::Constant(0.5))[3];
  points.move(waves(cage.nodes));
  const std::size_t count = points.embedding.vertexCount();
  const Eigen::Matrix<Scalar, 3, 1> origin(Scalar(0.5), Scalar(-2), Scalar(1));
  const auto skin = [&](VertexOrder order, std::size_t step, Box3& bounds) {
    // Nothing between the points or beyond the last one is written.
    std::vector<Point> out(step * count + 20, Point::Constant(-77));
    const SkinOutput<Scalar, Out> output{{out.front().data(), count, step * sizeof(Point)}, order, origin};
    skinPoints(points.embedding, points.nodes, {&points.stencils, &points.edges}, output, &bounds);
    std::vector<Point> result;
    for (std::size_t k = 0; k < out.size(); ++k) {
      if (k % step == 0 && k < step * count) {
        result.push_back(out[k]);
      } else {
        EXPECT_EQ(out[k], Point::Constant(-77));
      }
    }
    return result;
  };
  Box3 bounds, others;
  const std::vector<Point> expected = skin(VertexOrder::Mesh, 1, bounds);
  EXPECT_EQ(skin(VertexOrder::Mesh, 2, others), expected);
  for (const std::size_t step : {1, 2}) {
    const std::vector<Point> sorted = skin(VertexOrder::Sorted, step, others);
    for (std::size_t slot = 0; slot < count; ++slot) {
      EXPECT_EQ(sorted[slot], expected[points.embedding.slotVertices()[slot]]);
    }
    EXPECT_EQ(others.min(), bounds.min());
    EXPECT_EQ(others.max(), bounds.max());
  }
  const Box3 box = boundingBox(viewOf(expected));
  EXPECT_LT((bounds.min() - box.min()).norm(), 1e-6);
  EXPECT_LT((bounds.max() - box.max()).norm(), 1e-6);
  const Points surface = points.quadratic();
  for (std::size_t v = 0; v < count; ++v) {
    const Eigen::Vector3d there = expected[v].template cast<double>() + origin.template cast<double>();
    EXPECT_LT((there - surface[v]).norm(), 1e-6);
  }
}

}  // namespace
}  // namespace tetskin::test
