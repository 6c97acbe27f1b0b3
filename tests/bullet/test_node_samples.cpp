// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "support/odd_meshes.h"

#include <tetskin/bullet/src/skins/node_samples.h>

#include <set>

namespace tetskin {

using namespace bullet_detail;

namespace {

struct Sampled {
  FourNodes nodes;
  std::size_t looks = 0;
};

Sampled sampled(const std::vector<Eigen::Vector3d>& nodes) {
  Sampled result;
  result.nodes = nodesToSample(nodes.size(), 400, [&](std::size_t n) {
    ++result.looks;
    return nodes[n];
  });
  return result;
}

double volume(const std::vector<Eigen::Vector3d>& nodes, const FourNodes& n) {
  const Eigen::Vector3d& o = nodes[n[0]];
  return std::abs((nodes[n[1]] - o).cross(nodes[n[2]] - o).dot(nodes[n[3]] - o));
}

TEST(NodeSamples, AreNotInOnePlane) {
  for (const int cells : {1, 2, 5, 12}) {
    const std::vector<Eigen::Vector3d> nodes = test::latticeCage(cells, cells, cells, 1.0).nodes;
    EXPECT_GT(volume(nodes, sampled(nodes).nodes), 0.5) << cells;
  }
}

TEST(NodeSamples, OfAFlatBodyAreAnyFour) {
  std::vector<Eigen::Vector3d> nodes = test::latticeCage(4, 4, 4, 1.0).nodes;
  for (Eigen::Vector3d& p : nodes) p.z() = 0;
  const FourNodes four = sampled(nodes).nodes;
  for (const int n : four) EXPECT_LT(n, static_cast<int>(nodes.size()));
  EXPECT_EQ(std::set<int>(four.begin(), four.end()).size(), 4u);
}

TEST(NodeSamples, AreChosenInOneLookAtAFewLayersHoweverManyNodesThereAre) {
  const std::vector<Eigen::Vector3d> nodes = test::latticeCage(40, 40, 40, 1.0).nodes;
  EXPECT_LT(sampled(nodes).looks, 64 * 2 * 41 * 41);  // from every possible start it would be 120,000,000
}

TEST(NodeSamples, OfNodesThatAreNearlyAllInOnePlaneAreStillFoundInLinearTime) {
  std::vector<Eigen::Vector3d> nodes =
      test::randomPoints(20000, Box3(Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones()), 1);
  for (std::size_t n = 0; n + 1 < nodes.size(); ++n) nodes[n].z() = 0;
  const Sampled four = sampled(nodes);
  EXPECT_GT(volume(nodes, four.nodes), 0.0);
  EXPECT_LE(four.looks, 64 * nodes.size());
}

}  // namespace
}  // namespace tetskin
