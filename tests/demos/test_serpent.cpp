// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "scenes/serpent.h"

#include <map>
#include <utility>

#include "scenes/serpent_shape.h"

namespace tetskin::scenes {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kDetailed = 6000;  ///< triangles that are enough to resolve every detail

/// By vertex: the first vertex at the same position.
std::vector<int> welded(const TriangleMesh& mesh) {
  std::map<std::array<double, 3>, int> firsts;
  std::vector<int> weld;
  for (const Vector3d& p : mesh.positions) {
    weld.push_back(
        firsts.emplace(std::array<double, 3>{p.x(), p.y(), p.z()}, static_cast<int>(weld.size())).first->second);
  }
  return weld;
}

/// How often each directed edge of the welded surface is used.
std::map<std::pair<int, int>, int> directedEdges(const TriangleMesh& mesh, const std::vector<int>& weld) {
  std::map<std::pair<int, int>, int> uses;
  for (const std::array<int, 3>& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) ++uses[{weld[t[k]], weld[t[(k + 1) % 3]]}];
  }
  return uses;
}

/// Number of connected components.
int countComponents(const TriangleMesh& mesh, const std::vector<int>& weld) {
  std::vector<int> parent = weld;
  const auto root = [&](int v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  for (const std::array<int, 3>& t : mesh.triangles) {
    parent[root(t[0])] = root(t[2]);
    parent[root(t[1])] = root(t[2]);
  }
  int components = 0;
  for (std::size_t v = 0; v < parent.size(); ++v) components += root(static_cast<int>(v)) == static_cast<int>(v);
  return components;
}

class SerpentOfSize : public testing::TestWithParam<std::size_t> {};

TEST_P(SerpentOfSize, HasTheTrianglesWishedFor) {
  const TriangleMesh mesh = makeSerpent({GetParam()});
  const double wish = static_cast<double>(GetParam());
  EXPECT_NEAR(static_cast<double>(mesh.triangleCount()), wish, 0.02 * wish);
  EXPECT_TRUE(validate(mesh).ok());
}

INSTANTIATE_TEST_SUITE_P(Sizes, SerpentOfSize,
                         testing::Values(2000, 2345, 3000, 5000, 10000, 33333, 60000, 300000, 2000000));

TEST(Serpent, IsClosedAndConsistentlyOrientedWhenWelded) {
  for (std::size_t triangles : {kMinSerpentTriangles, kDetailed, std::size_t{60000}}) {
    const TriangleMesh mesh = makeSerpent({triangles});
    const std::vector<int> weld = welded(mesh);
    const auto edges = directedEdges(mesh, weld);
    for (const auto& [edge, uses] : edges) {
      EXPECT_EQ(uses, 1);
      EXPECT_EQ(edges.count({edge.second, edge.first}), 1u);
    }
    const auto seams = std::count_if(mesh.texcoords.begin(), mesh.texcoords.end(),
                                     [](const Eigen::Vector2f& uv) { return uv.x() == 1.0f; });
    const auto vertices = static_cast<long>(mesh.vertexCount()) - seams;
    const auto euler = vertices - static_cast<long>(edges.size() / 2) + static_cast<long>(mesh.triangleCount());
    EXPECT_EQ(euler, 2 * countComponents(mesh, weld)) << "every part is a sphere";
  }
}

TEST(Serpent, EnclosesVolumeInEveryGroup) {
  const TriangleMesh mesh = makeSerpent({kDetailed});
  const auto volumeOf = [&](std::size_t first, std::size_t count) {
    double volume = 0.0;
    for (std::size_t t = first; t < first + count; ++t) {
      const auto& [a, b, c] = mesh.triangles[t];
      volume += mesh.positions[a].dot(mesh.positions[b].cross(mesh.positions[c])) / 6.0;
    }
    return volume;
  };
  const TriangleGroup& body = mesh.groups[mesh.groups.size() - 2];
  ASSERT_EQ(body.name, "body");
  EXPECT_NEAR(volumeOf(body.firstTriangle, mesh.triangleCount() - body.firstTriangle), 0.3, 0.05);
  for (std::size_t g = 0; g + 2 < mesh.groups.size(); ++g) {
    EXPECT_GT(volumeOf(mesh.groups[g].firstTriangle, mesh.groups[g].triangleCount), 0.0) << mesh.groups[g].name;
  }
}

TEST(Serpent, RepeatsVerticesAtTheTextureSeamBitForBit) {
  const TriangleMesh mesh = makeSerpent({kDetailed});
  ASSERT_EQ(mesh.texcoords.size(), mesh.vertexCount());
  const std::vector<int> weld = welded(mesh);
  for (std::size_t v = 0; v < weld.size(); ++v) {
    const bool repeated = weld[v] != static_cast<int>(v);
    EXPECT_EQ(repeated, mesh.texcoords[v].x() == 1.0f) << "vertex " << v;
    if (!repeated) continue;
    EXPECT_EQ(mesh.texcoords[weld[v]].x(), 0.0f);
    EXPECT_EQ(mesh.texcoords[weld[v]].y(), mesh.texcoords[v].y());
    EXPECT_EQ(mesh.normals[weld[v]], mesh.normals[v]);
  }
}

TEST(Serpent, BendsLessThanItIsThick) {
  constexpr double kStep = 1e-3;
  const SerpentShape shape;
  for (double t = kStep; t < 1.0 - kStep; t += kStep) {
    const Vector3d bend = shape.spine().frame(t + kStep).tangent - shape.spine().frame(t - kStep).tangent;
    const double bendRadius = 2.0 * kStep * shape.spine().length() / bend.norm();
    EXPECT_GT(bendRadius, 1.5 * shape.radius(t)) << "t = " << t;
  }
}

TEST(Serpent, HasStrandsThatComeCloseButDoNotTouch) {
  constexpr int kSamples = 600;
  constexpr double kFarApart = 6.0;  ///< radii along the spine
  const SerpentShape shape;
  double closest = 1e9;  // relative to the thickness
  for (int i = 0; i < kSamples; ++i) {
    for (int j = 0; j < i; ++j) {
      const double a = (i + 0.5) / kSamples, b = (j + 0.5) / kSamples;
      const double thickness = shape.radius(a) + shape.radius(b);
      if ((a - b) * shape.spine().length() < kFarApart * std::max(shape.radius(a), shape.radius(b))) continue;
      const double distance = (shape.spine().frame(a).origin - shape.spine().frame(b).origin).norm();
      closest = std::min(closest, (distance - thickness) / thickness);
    }
  }
  EXPECT_GT(closest, 0.3);
  EXPECT_LT(closest, 0.6);
}

}  // namespace
}  // namespace tetskin::scenes
