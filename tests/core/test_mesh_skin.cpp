// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "support/odd_meshes.h"
#include "support/smooth_maps.h"

#include <tetskin/core/mesh_skin.h>
#include <tetskin/core/src/exported/skin_binding.h>

#include <limits>

namespace tetskin {
namespace {

using Nodes = std::vector<Eigen::Vector3f>;

class MeshSkins : public testing::Test {
 protected:
  MeshSkins() {
    mesh.tangents.assign(mesh.vertexCount(), {0.6f, 0.0f, 0.8f, -1.0f});
    const test::SmoothMap twist = test::smoothMaps(Eigen::Vector3d::Constant(0.5))[0];
    for (const Eigen::Vector3d& p : cage.nodes) {
      rest.push_back(p.cast<float>());
      twisted.push_back(twist.at(p).cast<float>());
    }
  }

  static SkinOptions everything(Normals normals) {
    SkinOptions options;
    options.interpolation = Interpolation::Quadratic;
    options.normals = normals;
    return options;
  }
  static PointView<const float> view(const Nodes& nodes) { return viewOf(nodes); }
  void update(MeshSkin<float>& skin, const Nodes& nodes) { ASSERT_EQ(skin.update(view(nodes)), StatusCode::Ok); }
  static Eigen::Vector3f at(PointView<const float> points, std::size_t v) {
    return Eigen::Map<const Eigen::Vector3f>(points[v]);
  }

  TetMesh cage = test::latticeCage(4, 4, 4, 0.25);
  TriangleMesh mesh = test::sphere(20, 0.52, Eigen::Vector3d::Constant(0.5));
  Nodes rest, twisted;
};

TEST_F(MeshSkins, AreAtRestRightAfterBind) {
  MeshSkin<float> skin;
  EXPECT_FALSE(skin.bound());
  ASSERT_TRUE(skin.bind(cage, mesh, everything(Normals::Transformed)).ok());
  EXPECT_TRUE(skin.bound());
  const std::vector<Eigen::Vector3d> normals = restNormals(mesh);
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
    EXPECT_LT((at(skin.positions(), v).cast<double>() - mesh.positions[v]).norm(), 1e-6);
    EXPECT_LT((at(skin.normals(), v).cast<double>() - normals[v]).norm(), 4e-6);
    EXPECT_LT((at(skin.tangents(), v) - mesh.tangents[v].head<3>()).norm(), 4e-6f);
  }
}

TEST_F(MeshSkins, NothingIsMadeThatIsNotAskedFor) {
  SkinOptions options;
  options.bounds = false;
  MeshSkin<float> skin;
  ASSERT_TRUE(skin.bind(cage, mesh, options).ok());
  EXPECT_TRUE(skin.normals().empty());
  EXPECT_TRUE(skin.tangents().empty());
  EXPECT_TRUE(skin.bounds().isEmpty());
  EXPECT_FALSE(dataOf(*skin.binding()).quadratic);
  EXPECT_FALSE(dataOf(*skin.binding()).normals);
  EXPECT_FALSE(dataOf(*skin.binding()).tangents);
  EXPECT_FALSE(dataOf(*skin.binding()).recomputed);
  ASSERT_TRUE(skin.bind(cage, mesh, everything(Normals::Recomputed)).ok());
  EXPECT_FALSE(dataOf(*skin.binding()).normals);
  EXPECT_TRUE(skin.tangents().empty());
  mesh.tangents.clear();
  ASSERT_TRUE(skin.bind(cage, mesh, everything(Normals::Transformed)).ok());
  EXPECT_FALSE(dataOf(*skin.binding()).tangents);
  EXPECT_TRUE(skin.tangents().empty());
}

TEST_F(MeshSkins, SortedOrderIsTheMeshsPermutedToTheLastBit) {
  for (const Normals normals : {Normals::Transformed, Normals::Recomputed}) {
    SkinOptions options = everything(normals);
    MeshSkin<float> expected, sorted;
    ASSERT_TRUE(expected.bind(cage, mesh, options).ok());
    options.order = VertexOrder::Sorted;
    ASSERT_TRUE(sorted.bind(cage, mesh, options).ok());
    update(expected, twisted);
    update(sorted, twisted);
    const auto& slotVertices = sorted.binding()->embedding().slotVertices();
    for (std::size_t slot = 0; slot < mesh.vertexCount(); ++slot) {
      EXPECT_EQ(at(sorted.positions(), slot), at(expected.positions(), slotVertices[slot]));
      EXPECT_EQ(at(sorted.normals(), slot), at(expected.normals(), slotVertices[slot]));
      if (normals == Normals::Recomputed) continue;
      EXPECT_EQ(at(sorted.tangents(), slot), at(expected.tangents(), slotVertices[slot]));
    }
    EXPECT_EQ(sorted.bounds().min(), expected.bounds().min());
    EXPECT_EQ(sorted.bounds().max(), expected.bounds().max());
  }
}

TEST_F(MeshSkins, WriteIntoTheCallersInterleavedBuffer) {
  struct Vertex {
    float before;
    float position[3];
    float normal[3];
    float between;
    float tangent[4];  // the caller provides the sign
  };
  const Vertex untouched{1, {}, {}, 2, {0, 0, 0, 3}};
  for (const Normals normals : {Normals::Transformed, Normals::Recomputed}) {
    for (const VertexOrder order : {VertexOrder::Mesh, VertexOrder::Sorted}) {
      std::vector<Vertex> buffer(mesh.vertexCount(), untouched);
      SkinOptions options = everything(normals);
      options.order = order;
      MeshSkin<float> own, into;
      ASSERT_TRUE(own.bind(cage, mesh, options).ok());
      options.target = PointView<float>(buffer[0].position, buffer.size(), sizeof(Vertex));
      options.normalTarget = PointView<float>(buffer[0].normal, buffer.size(), sizeof(Vertex));
      options.tangentTarget = PointView<float>(buffer[0].tangent, buffer.size(), sizeof(Vertex));
      ASSERT_TRUE(into.bind(cage, mesh, options).ok());
      EXPECT_TRUE(into.positions().empty());
      EXPECT_TRUE(into.normals().empty());
      EXPECT_TRUE(into.tangents().empty());
      update(own, twisted);
      update(into, twisted);
      for (std::size_t v = 0; v < buffer.size(); ++v) {
        for (int k = 0; k < 3; ++k) {
          EXPECT_EQ(buffer[v].position[k], own.positions()[v][k]);
          EXPECT_EQ(buffer[v].normal[k], own.normals()[v][k]);
          EXPECT_EQ(buffer[v].tangent[k], normals == Normals::Transformed ? own.tangents()[v][k] : 0.0f);
        }
        EXPECT_EQ(buffer[v].before, 1.0f);
        EXPECT_EQ(buffer[v].between, 2.0f);
        EXPECT_EQ(buffer[v].tangent[3], 3.0f);
      }
    }
  }
}

TEST_F(MeshSkins, WriteDoublesFromFloatNodesAndTheOtherWayRound) {
  std::vector<Eigen::Vector3d> doubles(mesh.vertexCount());
  std::vector<Eigen::Vector3f> floats(mesh.vertexCount());
  SkinOptions options = everything(Normals::Recomputed);
  MeshSkin<float> own, single;
  ASSERT_TRUE(own.bind(cage, mesh, options).ok());
  options.target = viewOf(doubles);
  ASSERT_TRUE(single.bind(cage, mesh, options).ok());
  options.target = viewOf(floats);
  MeshSkin<double> twice;
  ASSERT_TRUE(twice.bind(cage, mesh, options).ok());
  std::vector<Eigen::Vector3d> nodes;
  for (const Eigen::Vector3f& p : twisted) nodes.push_back(p.cast<double>());
  update(own, twisted);
  update(single, twisted);
  ASSERT_EQ(twice.update(viewOf(std::as_const(nodes))), StatusCode::Ok);
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
    EXPECT_LT((doubles[v] - at(own.positions(), v).cast<double>()).norm(), 1e-6);
    EXPECT_LT((doubles[v] - floats[v].cast<double>()).norm(), 1e-6);
    EXPECT_LT((at(single.normals(), v) - at(own.normals(), v)).norm(), 1e-4f);
    EXPECT_LT((at(twice.normals(), v) - at(own.normals(), v)).norm(), 1e-4f);
  }
}

TEST_F(MeshSkins, BoundsAreThoseOfThePositions) {
  SkinOptions options = everything(Normals::None);
  options.origin = Eigen::Vector3d(3, -2, 1);
  MeshSkin<float> skin;
  ASSERT_TRUE(skin.bind(cage, mesh, options).ok());
  update(skin, twisted);
  const Box3 box = boundingBox(skin.positions());
  EXPECT_LT((skin.bounds().min() - box.min()).norm(), 2e-6);
  EXPECT_LT((skin.bounds().max() - box.max()).norm(), 2e-6);
  EXPECT_LT(skin.bounds().max().x(), -1.0);
  ASSERT_TRUE(skin.setOrigin({0, 0, 0}).ok());
  update(skin, twisted);
  EXPECT_LT((skin.bounds().min() - box.min() - Eigen::Vector3d(3, -2, 1)).norm(), 2e-6);
}

TEST_F(MeshSkins, KeepTheirOriginWhereTheNewOneIsNotFinite) {
  SkinOptions options;
  options.origin = Eigen::Vector3d(3, -2, 1);
  MeshSkin<float> skin;
  ASSERT_TRUE(skin.bind(cage, mesh, options).ok());
  const Eigen::Vector3f before = at(skin.positions(), 9);
  using Limits = std::numeric_limits<double>;
  for (const double bad : {Limits::quiet_NaN(), Limits::infinity(), -1.1e18}) {
    EXPECT_FALSE(skin.setOrigin({0, bad, 0}).ok());
    update(skin, rest);
    EXPECT_EQ(at(skin.positions(), 9), before);
  }
  EXPECT_TRUE(skin.setOrigin({4, -2, 1}).ok());
  update(skin, rest);
  EXPECT_NEAR(at(skin.positions(), 9).x(), before.x() - 1.0f, 1e-6f);
}

TEST_F(MeshSkins, ANodeThatIsNotFiniteOrTooFarChangesNothing) {
  for (const Normals normals : {Normals::Transformed, Normals::Recomputed}) {
    MeshSkin<float> skin;
    ASSERT_TRUE(skin.bind(cage, mesh, everything(normals)).ok());
    update(skin, twisted);
    std::vector<Eigen::Vector3f> before;
    for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
      before.push_back(at(skin.positions(), v));
      before.push_back(at(skin.normals(), v));
    }
    using Limits = std::numeric_limits<float>;
    // Finite coordinates that are so large that weighted sums or normals overflow are refused as well.
    for (const float bad : {Limits::quiet_NaN(), -Limits::infinity(), 1.1e18f, -Limits::max()}) {
      Nodes broken = rest;
      broken[70].z() = bad;
      broken[90].x() = bad;
      EXPECT_EQ(skin.update(view(broken)), StatusCode::NonFinite);
      EXPECT_EQ(skin.firstNonFiniteNode(), 70u);
      for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
        EXPECT_EQ(at(skin.positions(), v), before[2 * v]);
        EXPECT_EQ(at(skin.normals(), v), before[2 * v + 1]);
      }
    }
    update(skin, rest);
    EXPECT_LT((at(skin.positions(), 9).cast<double>() - mesh.positions[9]).norm(), 1e-6);
  }
}

TEST_F(MeshSkins, ShareABinding) {
  const SkinOptions options = everything(Normals::Transformed);
  const MeshSkin<float>::Binding binding = SkinBinding<float>::create(cage, mesh, options).value();
  ASSERT_TRUE(binding);
  EXPECT_GT(binding->quadraticReport().edges, 0u);
  MeshSkin<float> one, other;
  ASSERT_TRUE(one.bind(binding, view(rest)).ok());
  ASSERT_TRUE(other.bind(binding, view(twisted)).ok());
  EXPECT_EQ(one.binding(), other.binding());
  EXPECT_LT((at(one.positions(), 5).cast<double>() - mesh.positions[5]).norm(), 1e-6);
  EXPECT_GT((at(other.positions(), 5).cast<double>() - mesh.positions[5]).norm(), 0.01);
  update(one, twisted);
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
    EXPECT_EQ(at(one.positions(), v), at(other.positions(), v));
    EXPECT_EQ(at(one.normals(), v), at(other.normals(), v));
  }
}

TEST_F(MeshSkins, LeaveOutWhatTheyAreToldTo) {
  const MeshSkin<float>::Binding binding =
      SkinBinding<float>::create(cage, mesh, everything(Normals::Transformed)).value();
  MeshSkin<float> linear, expected, without;
  ASSERT_TRUE(expected.bind(cage, mesh).ok());
  update(expected, twisted);
  InstanceOptions options;
  options.disableQuadratic = true;
  ASSERT_TRUE(linear.bind(binding, view(twisted), options).ok());
  EXPECT_FALSE(linear.normals().empty());
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v)
    EXPECT_EQ(at(linear.positions(), v), at(expected.positions(), v));
  options = {};
  options.disableNormals = true;
  ASSERT_TRUE(without.bind(binding, view(twisted), options).ok());
  EXPECT_TRUE(without.normals().empty());
  EXPECT_TRUE(without.tangents().empty());
  EXPECT_NE(at(without.positions(), 5), at(expected.positions(), 5));
}

TEST_F(MeshSkins, RefuseInstanceOptionsThatDoNotFitTheBinding) {
  MeshSkin<float>::Binding binding = SkinBinding<float>::create(cage, mesh, {}).value();
  MeshSkin<float> skin;
  const auto refuses = [&](const InstanceOptions& options, StatusCode code, const char* mentions) {
    const Status status = skin.bind(binding, view(rest), options);
    EXPECT_EQ(status.code, code);
    EXPECT_NE(status.message.find(mentions), std::string::npos) << status.message;
    EXPECT_FALSE(skin.bound());
  };
  std::vector<Eigen::Vector3f> tooFew(7);
  InstanceOptions options;
  options.target = viewOf(tooFew);
  refuses(options, StatusCode::SizeMismatch, "7 points");
  options = {};
  options.normalTarget = viewOf(tooFew);
  refuses(options, StatusCode::SizeMismatch, "target for normals");
  options = {};
  options.tangentTarget = viewOf(tooFew);
  refuses(options, StatusCode::SizeMismatch, "target for tangents");
  binding = nullptr;
  refuses({}, StatusCode::Empty, "embedding is empty");
}

TEST_F(MeshSkins, RefuseOptionsThatMakeNoSenseBeforeAnythingIsEmbedded) {
  const auto refuses = [&](const SkinOptions& options, StatusCode code, const char* mentions) {
    MeshSkin<float> skin;
    const Result<EmbedReport> report = skin.bind(cage, mesh, options);
    EXPECT_EQ(report.status().code, code);
    EXPECT_NE(report.status().message.find(mentions), std::string::npos) << report.status().message;
    EXPECT_FALSE(skin.bound());
  };
  using Limits = std::numeric_limits<double>;
  for (const double bad : {Limits::quiet_NaN(), Limits::infinity(), -1.1e18}) {
    SkinOptions options = everything(Normals::Recomputed);
    options.origin.y() = bad;
    refuses(options, StatusCode::InvalidOption, "origin");
  }
  for (const double bad : {Limits::quiet_NaN(), -1.0, -Limits::infinity()}) {
    SkinOptions options = everything(Normals::Recomputed);
    options.hardEdgeDegrees = bad;
    refuses(options, StatusCode::InvalidOption, "hardEdgeDegrees");
    EmbedReport report;
    report.candidates = 7;
    EXPECT_FALSE(SkinBinding<float>::create(cage, mesh, options, &report).ok());
    EXPECT_EQ(report.candidates, 0u) << "nothing is even begun";
    EXPECT_EQ(report.unbound, mesh.vertexCount());
  }
  std::vector<Eigen::Vector3f> tooFew(7);
  SkinOptions options = everything(Normals::Recomputed);
  options.target = viewOf(tooFew);
  refuses(options, StatusCode::SizeMismatch, "7 points");
}

TEST_F(MeshSkins, RefusedAfterEmbeddingAreNotBound) {
  for (Eigen::Vector3d& p : cage.nodes) p *= 1e20;  // larger than the nodes of a body may be
  for (Eigen::Vector3d& p : mesh.positions) p *= 1e20;
  MeshSkin<float> skin;
  const Result<EmbedReport> report = skin.bind(cage, mesh);
  EXPECT_FALSE(report.ok());
  EXPECT_FALSE(skin.bound());
}

TEST_F(MeshSkins, RefuseNodesThatDoNotFitTheBinding) {
  MeshSkin<float> skin;
  ASSERT_TRUE(skin.bind(cage, mesh).ok());
  const auto binding = skin.binding();
  Nodes nodes = rest;
  nodes[3].y() = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(skin.bind(binding, view(nodes)).code, StatusCode::NonFinite);
  nodes.resize(100);
  EXPECT_EQ(skin.bind(binding, view(nodes)).code, StatusCode::SizeMismatch);
  EXPECT_EQ(skin.binding(), binding);
  update(skin, twisted);  // the skin then works as before
}

TEST_F(MeshSkins, SayWhyThereIsNoUpdate) {
  MeshSkin<float> skin;
  EXPECT_EQ(skin.update(view(rest)), StatusCode::Unbound);
  EXPECT_EQ(skin.update(StepHistory<float>(), 0.5f), StatusCode::Unbound);
  EXPECT_EQ(skin.nodeCount(), 0u);
  EXPECT_EQ(skin.binding(), nullptr);
  ASSERT_TRUE(skin.bind(cage, mesh).ok());
  const Eigen::Vector3f before = at(skin.positions(), 9);
  Nodes fewer = twisted;
  fewer.pop_back();
  EXPECT_EQ(skin.update(view(fewer)), StatusCode::TopologyChanged);
  EXPECT_EQ(skin.update(StepHistory<float>(), 0.5f), StatusCode::TopologyChanged);
  EXPECT_EQ(at(skin.positions(), 9), before);
  MeshSkin<float> moved = std::move(skin);
  EXPECT_FALSE(skin.bound());  // NOLINT: its moved-from state
  update(moved, twisted);
}

TEST_F(MeshSkins, RefuseAMeshWithTooFewNormalsOrTangents) {
  const auto refuses = [&](const char* mentions) {
    MeshSkin<float> skin;
    const Result<EmbedReport> report = skin.bind(cage, mesh);
    EXPECT_EQ(report.status().code, StatusCode::SizeMismatch);
    EXPECT_NE(report.status().message.find(mentions), std::string::npos) << report.status().message;
    EXPECT_FALSE(skin.bound());
  };
  mesh.tangents.pop_back();
  refuses("tangents");
  mesh.normals.resize(4);
  refuses("4 normals");
}

TEST_F(MeshSkins, RefuseAVertexTooFarOutsideAndStayAsTheyWere) {
  MeshSkin<float> skin;
  ASSERT_TRUE(skin.bind(cage, mesh).ok());
  const auto binding = skin.binding();
  mesh.positions[12] = {0.5, 0.5, 1.75};
  SkinOptions options;
  options.maxDistance = 0.5;
  const Result<EmbedReport> report = skin.bind(cage, mesh, options);
  EXPECT_EQ(report.status().code, StatusCode::OutsideCage);
  EXPECT_NE(report.status().message.find("vertex 12"), std::string::npos) << report.status().message;
  EXPECT_EQ(skin.binding(), binding);
  options.maxDistance = 0.751;
  EXPECT_TRUE(skin.bind(cage, mesh, options).ok());
}

}  // namespace
}  // namespace tetskin
