// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/contact/src/soft/shape_data.h>
#include <tetskin/contact/src/soft/surface_samples.h>

#include <numeric>
#include <set>

#include "contact_test.h"
#include "soft_fixtures.h"

namespace tetskin::test {
namespace {

using namespace contact_detail;

std::vector<int> all(const TriangleMesh& mesh) {
  std::vector<int> triangles(mesh.triangleCount());
  std::iota(triangles.begin(), triangles.end(), 0);
  return triangles;
}

TEST(SurfaceSamples, AreAboutAsManyAsWishedForAndOnTheSurface) {
  for (const int rings : {4, 60}) {
    const TriangleMesh mesh = sphere(rings, 1.0, Eigen::Vector3d::Zero());
    const std::vector<SurfaceSample> samples = sampleSurface(mesh, all(mesh), 1000);
    EXPECT_GT(samples.size(), 660u) << rings;
    EXPECT_LT(samples.size(), 1500u) << rings;
    const TriangleBvh tree(mesh);
    for (const SurfaceSample& s : samples) EXPECT_LT(tree.nearest(s.point).squaredDistance, 1e-20);
  }
}

TEST(SurfaceSamples, KeepTipsAndLeaveNeighboursOut) {
  TriangleMesh mesh = sphere(60, 1.0, Eigen::Vector3d::Zero());
  mesh.positions[700] *= 1.1;
  const std::vector<SurfaceSample> samples = sampleSurface(mesh, all(mesh), 200);
  EXPECT_TRUE(std::any_of(samples.begin(), samples.end(), [](const SurfaceSample& s) { return s.vertex == 700; }));
}

TEST(ContactShape, CarriesEachSampleInItsTet) {
  const ShapeData& data = dataOf(*ball().shape);
  std::size_t count = 0;
  for (const SampleRun& run : data.runs) {
    for (int s = run.first; s < run.last; ++s, ++count) {
      const EmbeddedPoint<btScalar>& sample = data.samples[s];
      EXPECT_EQ(sample.tet, run.tet);
      EXPECT_EQ(sample.nodes, data.tets[run.tet]);
      const btVector3 p = sample.position([&](int node) { return data.nodes[node]; });
      btScalar sum = 0;
      for (const btScalar weight : sample.clampedWeights) {
        sum += weight;
        EXPECT_GE(weight, 0);
      }
      EXPECT_NEAR((p - data.sampleRest[s]).length(), 0, 1e-5);
      EXPECT_NEAR(sum, 1, 1e-5);
    }
  }
  EXPECT_EQ(count, data.samples.size());
}

TEST(ContactShape, RunsBoundTheWeightsOfTheirSamples) {
  const ShapeData& data = dataOf(*ball().shape);
  btScalar largest = 1;
  for (std::size_t r = 0; r < data.runs.size(); ++r) {
    const TetSubregion& part = data.runRegions[r];
    btScalar outside = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      btScalar least = 1;
      for (int s = data.runs[r].first; s < data.runs[r].last; ++s) least = std::min(least, data.samples[s].weights[k]);
      EXPECT_LT(part.minimum[k], least);
      EXPECT_GT(part.minimum[k], least - btScalar(0.01));
      outside += std::max(btScalar(0), -part.minimum[k]);
    }
    EXPECT_NEAR(part.spread(), 1 + 2 * outside, 1e-5);
    largest = std::max(largest, part.spread());
  }
  EXPECT_EQ(data.largestSpread, largest);
}

TEST(ContactShape, NeighboursOfARunAreThoseThatTestingAllTetsFinds) {
  const ShapeData& data = dataOf(*ball().shape);
  std::size_t count = 0;
  for (std::size_t r = 0; r < data.runs.size(); ++r) {
    std::set<int> near, all;
    for (const NearGroup& group : data.nearGroups[r]) {
      for (std::size_t k = 0; k < kLanes; ++k) {
        if (group.near[k]) near.insert(data.groups[group.group][k]);
      }
    }
    for (const TetGroup& group : data.groups) {
      for (const int tet : group) {
        if (tet < 0) continue;
        const btScalar apart = (data.centroids[tet] - data.centroids[data.runs[r].tet]).length();
        if (apart < 2 * data.edge) all.insert(tet);
      }
    }
    EXPECT_EQ(near, all);
    count += all.size();
  }
  EXPECT_GT(count, data.runs.size());
}

TEST(ContactShape, ATreeVisitsTheLeavesThatTestingAllTetsFinds) {
  const ShapeData& data = dataOf(*ball().shape);
  std::vector<ContactBox> boxes;
  data.tetTree.tree.fit(boxes, [&](int index) {
    ContactBox box;
    for (const int n : data.tets[data.tetTree.tree.item(index)]) box.extend(data.nodes[n]);
    return box;
  });
  for (const Eigen::Vector3d& p : randomPoints(100, around(ball().cage, 1.0), 8)) {
    ContactBox sought;
    sought.extend(toBullet(p));
    std::set<int> visited, all;
    data.tetTree.visitLeaves([&](std::size_t node) { return boxes[node].collides(sought); },
                             [&](std::size_t node) { visited.insert(data.tetTree.leafOf[node]); });
    for (std::size_t g = 0; g < data.groups.size(); ++g) {
      ContactBox box;
      for (const int tet : data.groups[g]) {
        if (tet < 0) continue;
        for (const int n : data.tets[tet]) box.extend(data.nodes[n]);
      }
      if (box.collides(sought)) all.insert(static_cast<int>(g));
    }
    EXPECT_EQ(visited, all);
  }
}

TEST(ContactShape, FilledPartsHoldAllThatIsInside) {
  const Ball& model = ball();
  const ShapeData& data = dataOf(*model.shape);
  for (const Eigen::Vector3d& p : randomPoints(2000, around(model.cage, 1.0), 6)) {
    if ((p - Eigen::Vector3d(0.5, 0.5, 0.5)).norm() > Ball::kRadius) continue;
    for (std::size_t t = 0; t < data.tets.size(); ++t) {
      const Eigen::Vector4d w = BarycentricMap(cornersOf(model.cage, model.cage.tets[t]))(p);
      if (w.minCoeff() < 0.0) continue;
      for (int k = 0; k < 4; ++k) EXPECT_GE(w[k], data.filled[t].minimum[k] - 1e-5);
    }
  }
}

TEST(ContactShape, LeavesOutWhatIsHiddenInOtherParts) {
  TriangleMesh mesh = sphere(20, 0.4, Eigen::Vector3d(0.5, 0.5, 0.5));
  const TriangleMesh inner = sphere(12, 0.2, Eigen::Vector3d(0.5, 0.5, 0.5));
  const int first = static_cast<int>(mesh.vertexCount());
  mesh.positions.insert(mesh.positions.end(), inner.positions.begin(), inner.positions.end());
  for (const auto& [a, b, c] : inner.triangles) mesh.triangles.push_back({a + first, b + first, c + first});
  const auto shape = ContactShape::create(latticeCage(5, 5, 5, 0.2), mesh).value();
  for (const btVector3& rest : dataOf(*shape).sampleRest) {
    EXPECT_GT((rest - btVector3(0.5, 0.5, 0.5)).length(), 0.35);
  }
  GridDistance at;
  ASSERT_TRUE(dataOf(*shape).grid.at(btVector3(0.7, 0.5, 0.5), at));
  EXPECT_NEAR(at.distance, -0.2, 0.02);
}

/// A box of 8 vertices, or a ball, in a cage of cubes of edge 0.2.
std::size_t samplesOf(const TriangleMesh& mesh, const TetMesh& cage, const ContactShapeOptions& options = {}) {
  ContactShapeOptions coarse = options;
  coarse.gridResolution = 16;  // on which samples do not depend
  const auto made = ContactShape::create(cage, mesh, coarse);
  EXPECT_TRUE(made.ok()) << made.status().message;
  return made.value()->sampleCount();
}

TEST(ContactShape, HasAsManySamplesByDefaultAsItsCageCanUse) {
  const auto boxIn = [](const TetMesh& cage) {
    TriangleMesh box = plate().mesh;
    const Eigen::Vector3d low = box.positions.front(), size = box.positions.back() - low;
    const Eigen::Vector3d far = cage.nodes.back();
    for (Eigen::Vector3d& p : box.positions) {
      p = Eigen::Vector3d::Constant(0.01) +
          (p - low).cwiseQuotient(size).cwiseProduct(far - Eigen::Vector3d::Constant(0.02));
    }
    return box;
  };
  const TetMesh small = latticeCage(2, 2, 2, 0.2), large = latticeCage(6, 6, 6, 0.2),
                huge = latticeCage(10, 10, 10, 0.2);
  const std::size_t few = samplesOf(boxIn(small), small), more = samplesOf(boxIn(large), large),
                    most = samplesOf(boxIn(huge), huge);
  EXPECT_GT(few, 800U);
  EXPECT_LE(few, 2000U);
  // 30 for each of 7^3 - 5^3 nodes.
  EXPECT_GT(more, 6540U * 2 / 3);
  EXPECT_LT(more, 6540U * 4 / 3);
  EXPECT_GT(most, 8000U * 2 / 3);
  EXPECT_LT(most, 8000U * 4 / 3);
}

TEST(ContactShape, HasAsManySamplesByDefaultAsVerticesWithinBounds) {
  const auto ballOf = [](int rings) { return sphere(rings, 0.19, Eigen::Vector3d::Constant(0.2)); };
  const TetMesh cage = latticeCage(2, 2, 2, 0.2);
  for (const int rings : {8, 48, 110}) {
    const TriangleMesh mesh = ballOf(rings);
    const std::size_t wanted = std::clamp(mesh.vertexCount(), std::size_t{2000}, std::size_t{8000});
    const std::size_t found = samplesOf(mesh, cage);
    EXPECT_GT(found, wanted * 2 / 3);
    EXPECT_LT(found, wanted * 4 / 3);
  }
}

TEST(ContactShape, HasTheNumberOfSamplesThatIsAskedFor) {
  for (const std::size_t count : {300, 1500}) {
    ContactShapeOptions options;
    options.sampleCount = count;
    const std::size_t found = samplesOf(ball().mesh, ball().cage, options);
    EXPECT_GT(found, count * 2 / 3);
    EXPECT_LT(found, count * 4 / 3);
  }
}

/// A sheet of 1 : 1 : thickness, in a cage of one layer of cubes, with the middle of its shape inside it.
TEST(ContactShape, HasCellsThatSeeAThinBody) {
  const auto sheet = [](double thickness, double height = 0.0) {
    TriangleMesh box = test::boxMesh(Eigen::Vector3d(0.5, thickness / 2, 0.5));
    for (Eigen::Vector3d& p : box.positions) p.y() += height;
    return box;
  };
  TetMesh cage = latticeCage(8, 1, 8, 0.125);
  for (Eigen::Vector3d& p : cage.nodes)
    p = (p - Eigen::Vector3d(0.5, 0.0625, 0.5)).cwiseProduct(Eigen::Vector3d(1, 0.25, 1));
  for (const double thickness : {0.018, 0.013}) {
    const auto made = ContactShape::create(cage, sheet(thickness));
    ASSERT_TRUE(made.ok()) << made.status().message;
    GridDistance at;
    ASSERT_TRUE(dataOf(*made.value()).grid.at(btVector3(0.1, 0, 0.1), at));
    EXPECT_LT(at.distance, -0.2 * thickness) << thickness;
    EXPECT_LE(dataOf(*made.value()).grid.spacing(), 0.51 * thickness);
  }
  const Status thin = ContactShape::create(cage, sheet(1e-4, 1.1e-3)).status();
  EXPECT_EQ(thin.code, StatusCode::Degenerate);
  EXPECT_NE(thin.message.find("gridResolution"), std::string::npos) << thin.message;
  // Shapes that are thick enough keep the usual ones, whatever sticks out of them.
  EXPECT_NEAR(dataOf(*ContactShape::create(ball().cage, ball().mesh).value()).grid.spacing(),
              boundingBox(ball().cage.nodes).sizes().maxCoeff() / 64, 1e-6);
}

TEST(ContactShape, SaysWhatIsWrong) {
  const Ball& model = ball();
  const auto codeOf = [](const Cage& cage, const TriangleMesh& mesh, const ContactShapeOptions& options = {}) {
    return ContactShape::create(cage, mesh, options).status().code;
  };
  ContactShapeOptions options;
  options.gridResolution = 0;
  EXPECT_EQ(codeOf(model.cage, model.mesh, options), StatusCode::InvalidOption);
  options = {};
  for (const std::size_t count : {0, 10'000'001}) {
    options.sampleCount = count;
    EXPECT_EQ(codeOf(model.cage, model.mesh, options), StatusCode::InvalidOption) << count;
  }
  EXPECT_EQ(codeOf(TetMesh{}, model.mesh), StatusCode::Empty);
  EXPECT_EQ(codeOf(model.cage, TriangleMesh{}), StatusCode::Empty);
  TriangleMesh points = model.mesh;
  points.triangles.clear();
  EXPECT_EQ(codeOf(model.cage, points), StatusCode::Empty);
  TriangleMesh bad = model.mesh;
  bad.triangles[0][1] = 100000;
  EXPECT_EQ(codeOf(model.cage, bad), StatusCode::IndexOutOfRange);
  bad = model.mesh;
  bad.positions[3].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(codeOf(model.cage, bad), StatusCode::NonFinite);
  bad = model.mesh;
  for (auto& p : bad.positions) p.y() = 0.5;
  EXPECT_EQ(codeOf(model.cage, bad), StatusCode::Degenerate) << "encloses no volume";
  bad = model.mesh;
  for (auto& triangle : bad.triangles) std::swap(triangle[0], triangle[1]);
  EXPECT_NE(ContactShape::create(model.cage, bad).status().message.find("face inwards"), std::string::npos);
}

/// A U made of cubes, whose legs are closer to each other than two edges.
TEST(OtherParts, AreNearButFarAlongTheBody) {
  const TetMesh block = latticeCage(3, 6, 1, 0.2);
  TetMesh cage = block;
  cage.tets.clear();
  const auto centroidOf = [&](const Tet& t) -> Eigen::Vector3d {
    return (block.nodes[t[0]] + block.nodes[t[1]] + block.nodes[t[2]] + block.nodes[t[3]]) / 4.0;
  };
  for (const Tet& t : block.tets) {
    const Eigen::Vector3d at = centroidOf(t);
    if (at.y() < 0.2 || std::abs(at.x() - 0.3) > 0.1) cage.tets.push_back(t);
  }
  TriangleMesh mesh;
  mesh.positions = cage.nodes;
  mesh.triangles = boundaryFaces(cage);
  const auto made = ContactShape::create(cage, mesh);
  ASSERT_TRUE(made.ok()) << made.status().message;
  const contact_detail::ShapeData& data = dataOf(*made.value());
  std::size_t listed = 0;
  for (std::size_t r = 0; r < data.runs.size(); ++r) {
    const Eigen::Vector3d from = centroidOf(cage.tets[static_cast<std::size_t>(data.runs[r].tet)]);
    for (const int tet : data.otherComponents[r]) {
      const Eigen::Vector3d to = centroidOf(cage.tets[static_cast<std::size_t>(tet)]);
      EXPECT_GT(std::abs(from.x() - to.x()), 0.2);  // in the other leg
      EXPECT_GT(from.y() + to.y(), 0.4);
      ++listed;
    }
    // Points not listed are in the same leg, or far away, or near the bottom.
    const std::set<int> others(data.otherComponents[r].begin(), data.otherComponents[r].end());
    for (std::size_t t = 0; t < cage.tets.size(); ++t) {
      const Eigen::Vector3d to = centroidOf(cage.tets[t]);
      const bool near = (to - from).norm() < 1.9 * static_cast<double>(data.edge);
      if (near && std::abs(to.x() - from.x()) > 0.2 && std::min(from.y(), to.y()) > 0.8) {
        EXPECT_EQ(others.count(static_cast<int>(t)), 1u);
      }
    }
  }
  EXPECT_GT(listed, 0u);
}

}  // namespace
}  // namespace tetskin::test
