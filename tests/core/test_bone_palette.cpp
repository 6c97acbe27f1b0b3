// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "support/allocation_count.h"
#include "support/carried_points.h"
#include "support/drawn_by_bones.h"
#include "support/odd_meshes.h"
#include "support/shuffled_threads.h"
#include "support/smooth_maps.h"
#include "support/two_plates.h"

#include <tetskin/core/bone_palette.h>
#include <tetskin/core/src/base/kernels/instruction_set.h>

#include <limits>
#include <numeric>

#include "carried_normals.h"

namespace tetskin::test {
namespace {

using PointList = test::Points;

/// Of positions in a cage of size 1 that is mapped to at most four times that.
constexpr double kRounding = 2e-6;

SkinOptions optionsFor(Interpolation interpolation) {
  SkinOptions options;
  options.interpolation = interpolation;
  return options;
}

/// A mesh in a cage, drawn by its skin and by bones.
template <class Scalar>
struct Drawn {
  Drawn(const Cage& cage, const TriangleMesh& mesh, const SkinOptions& skinOptions, const PaletteOptions& options = {})
      : rest(mesh.positions) {
    EXPECT_TRUE(skin.bind(cage, mesh, skinOptions).ok());
    skinned = skinnedMeshOf(*skin.binding()).value();
    palette = BonePalette<Scalar>::create(skin.binding(), options).value();
  }

  void move(const PointList& nodes) {
    std::vector<Eigen::Matrix<Scalar, 3, 1>> rounded;
    for (const Eigen::Vector3d& p : nodes) rounded.push_back(p.cast<Scalar>());
    ASSERT_EQ(skin.update(viewOf(std::as_const(rounded))), StatusCode::Ok);
    bones = bonesFor(palette, nodes);
  }
  PointList bySkin() const {
    PointList points;
    for (std::size_t v = 0; v < rest.size(); ++v) {
      const Scalar* p = skin.positions()[v];
      points.emplace_back(p[0], p[1], p[2]);
    }
    return points;
  }
  PointList byBones() const { return drawnBy(bones, skinned, rest); }
  double difference() const { return distances(byBones(), bySkin()).longest; }

  PointList rest;
  MeshSkin<Scalar> skin;
  SkinnedMesh skinned;
  BonePalette<Scalar> palette;
  std::vector<Bone> bones;
};

TriangleMesh cloud(PointList points) {
  TriangleMesh mesh;
  mesh.positions = std::move(points);
  return mesh;
}

TriangleMesh pointsAround(double factor, std::size_t count, const TetMesh& cage) {
  return cloud(test::randomPoints(count, test::around(cage, factor), 41));
}

template <class Scalar>
class BonePalettes : public testing::Test {
 protected:
  const TetMesh cage = test::jittered(test::latticeCage(4, 4, 4, 0.25), 0.04, 9);
  /// Deformations in which no edge's vector is as long as half its edge.
  const std::vector<test::SmoothMap> maps = test::smoothMaps(test::kCentre);
};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(BonePalettes, Scalars);

TYPED_TEST(BonePalettes, DrawTheQuadraticSurfaceInsideTheCage) {
  const TriangleMesh mesh = cloud(test::pointsIn(this->cage, {0, 5, 17, 100, 200, 300, 383}, 42));
  Drawn<TypeParam> drawn(this->cage, mesh, optionsFor(Interpolation::Quadratic));
  Drawn<TypeParam> linear(this->cage, mesh, optionsFor(Interpolation::Linear));
  EXPECT_EQ(drawn.palette.interpolation(), Interpolation::Quadratic);
  for (const test::SmoothMap& map : this->maps) {
    drawn.move(map(this->cage.nodes));
    linear.move(map(this->cage.nodes));
    EXPECT_LT(drawn.difference(), kRounding) << map.name;
    EXPECT_GT(distances(linear.bySkin(), drawn.bySkin()).longest, 1e-3) << "there is something to tell apart";
  }
}

TYPED_TEST(BonePalettes, DrawTheLinearSurfaceInsideAndOutside) {
  const TriangleMesh mesh = pointsAround(1.5, 500, this->cage);
  PaletteOptions disabled;
  disabled.disableQuadratic = true;
  Drawn<TypeParam> drawn(this->cage, mesh, optionsFor(Interpolation::Linear));
  auto ofQuadratic = SkinBinding<TypeParam>::create(this->cage, mesh, optionsFor(Interpolation::Quadratic)).value();
  auto palette = BonePalette<TypeParam>::create(ofQuadratic, disabled).value();
  EXPECT_EQ(palette.interpolation(), Interpolation::Linear);
  for (const test::SmoothMap& map : this->maps) {
    drawn.move(map(this->cage.nodes));
    EXPECT_LT(drawn.difference(), kRounding) << map.name;
    EXPECT_EQ(bonesFor(palette, map(this->cage.nodes)), drawn.bones) << map.name;
  }
}

TYPED_TEST(BonePalettes, AreExactForAffineMapsInsideAndOutside) {
  Drawn<TypeParam> drawn(this->cage, pointsAround(1.5, 500, this->cage), optionsFor(Interpolation::Quadratic));
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const test::SmoothMap map = test::affineMap(seed);
    drawn.move(map(this->cage.nodes));
    EXPECT_LT(distances(drawn.byBones(), map(drawn.rest)).longest, 2 * kRounding) << seed;
  }
}

/// Outside, the bones' surface is a polynomial of degree 2, the skin's its first-order continuation from the closest
/// point of the tet: with d the difference of the weights there, they differ by the sum of d_i d_j e_ij.
TYPED_TEST(BonePalettes, DifferFromTheSkinToSecondOrderOutside) {
  const double distances[] = {0.1, 0.05, 0.025};
  std::vector<double> differences;
  for (const double distance : distances) {
    PointList points;
    for (int k = 1; k < 20; ++k) points.emplace_back(0.05 * k, 0.31 + 0.02 * k, 1.0 + distance);
    Drawn<TypeParam> drawn(test::latticeCage(4, 4, 4, 0.25), cloud(points), optionsFor(Interpolation::Quadratic));
    drawn.move(this->maps[0](test::latticeCage(4, 4, 4, 0.25).nodes));
    differences.push_back(drawn.difference());
  }
  EXPECT_GT(differences[0], 100 * kRounding);
  EXPECT_NEAR(differences[0] / differences[1], 4.0, 0.1);
  EXPECT_NEAR(differences[1] / differences[2], 4.0, 0.1);
}

/// With the length of the edges' vectors limited, the skin differs from the bones by the part that was cut off.
TYPED_TEST(BonePalettes, DifferFromTheSkinWhereItsVectorsAreLimited) {
  const std::vector<int> tets = {0, 5, 17, 100, 200, 300, 383};
  const PointList points = test::pointsIn(this->cage, tets, 43);
  Drawn<TypeParam> drawn(this->cage, cloud(points), optionsFor(Interpolation::Quadratic));
  PointList nodes = this->maps[0](this->cage.nodes);
  for (std::size_t n = 0; n < nodes.size(); n += 7) nodes[n] += Eigen::Vector3d(0.2, -0.3, 0.25);
  drawn.move(nodes);
  const PointList bySkin = drawn.bySkin(), byBones = drawn.byBones();
  std::size_t limited = 0;
  for (std::size_t v = 0; v < points.size(); ++v) {
    Eigen::Vector3d cut = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = i + 1; j < 4; ++j) {
        const std::size_t a = drawn.skinned.bones[v][i], b = drawn.skinned.bones[v][j];
        const Eigen::Vector3d edge = this->cage.nodes[b] - this->cage.nodes[a];
        const Eigen::Matrix3d half = (drawn.bones[a] - drawn.bones[b]).template leftCols<3>().template cast<double>();
        const Eigen::Vector3d vector = half * edge;
        const double excess = vector.norm() - 0.5 * edge.norm();
        const double weight = static_cast<double>(drawn.skinned.weights[v][i] * drawn.skinned.weights[v][j]);
        if (excess > 0.0) cut += weight * excess * vector.normalized();
      }
    }
    limited += cut.norm() > 100 * kRounding;
    EXPECT_LT((byBones[v] - bySkin[v] - cut).norm(), 2 * kRounding) << v;
  }
  EXPECT_GT(limited, 0u);
  EXPECT_LT(limited, points.size());
}

TYPED_TEST(BonePalettes, FollowEachCopyOfASplitCage) {
  for (const double joinedUntil : {-1.0, 1.0}) {
    const test::TwoPlates plates = test::platesOfCopies(joinedUntil);
    Drawn<TypeParam> drawn(plates.cage, plates.mesh, optionsFor(Interpolation::Quadratic));
    PointList nodes = plates.cage.mesh.nodes;
    for (std::size_t n = plates.cage.mesh.nodeCount() / 2; n < nodes.size(); ++n) {
      nodes[n] += Eigen::Vector3d(0.0, 0.02 * nodes[n].x() * nodes[n].x(), 0.1);
    }
    drawn.move(nodes);
    EXPECT_LT(drawn.difference(), 2 * kRounding);
    EXPECT_GT(distances(drawn.byBones(), plates.mesh.positions).longest, 0.1);
  }
}

TYPED_TEST(BonePalettes, TurnNormalsAsTheGradientDoes) {
  const TriangleMesh mesh = test::authoredSphere(16, 0.45);
  SkinOptions options = optionsFor(Interpolation::Quadratic);
  options.normals = Normals::Transformed;
  PaletteOptions gradients;
  gradients.disableQuadratic = gradients.gradients = true;
  Drawn<TypeParam> quadratic(this->cage, mesh, options), linear(this->cage, mesh, options, gradients);
  const auto expectNormals = [&](const test::SmoothMap& map, double degrees) {
    quadratic.move(map(this->cage.nodes));
    linear.move(map(this->cage.nodes));
    for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
      const Eigen::Vector3d rest = mesh.normals[v].template cast<double>();
      const Eigen::Vector3d expected = map.gradient(mesh.positions[v]).inverse().transpose() * rest;
      for (const Drawn<TypeParam>* drawn : {&quadratic, &linear}) {
        EXPECT_LT(test::angle(normalBy(drawn->bones, drawn->skinned, v, rest), expected), degrees) << map.name;
      }
    }
  };
  for (unsigned seed = 1; seed <= 3; ++seed) expectNormals(test::quadraticMap(seed, 0.0), 0.01);
  expectNormals(this->maps[0], 5.0);  // up to which node gradients are exact
  EXPECT_GT(test::angle(normalBy(linear.bones, linear.skinned, 40, mesh.normals[40].template cast<double>()),
                        mesh.normals[40].template cast<double>()),
            5.0)
      << "there is something to turn";
}

/// The shader of this kind of bones adds the weighted translations to the rest position.
TYPED_TEST(BonePalettes, CarryGradientsBesideTheDisplacementsOfALinearSurface) {
  PaletteOptions gradients;
  gradients.disableQuadratic = gradients.gradients = true;
  const TriangleMesh mesh = pointsAround(1.2, 300, this->cage);
  Drawn<TypeParam> drawn(this->cage, mesh, optionsFor(Interpolation::Quadratic), gradients);
  Drawn<TypeParam> linear(this->cage, mesh, optionsFor(Interpolation::Linear));
  drawn.move(this->maps[1](this->cage.nodes));
  linear.move(this->maps[1](this->cage.nodes));
  for (std::size_t n = 0; n < drawn.bones.size(); ++n) EXPECT_EQ(drawn.bones[n].col(3), linear.bones[n].col(3)) << n;
  PointList points;
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
    points.push_back(drawn.rest[v] + blended(drawn.skinned, v, drawn.bones).col(3));
  }
  EXPECT_LT(distances(points, linear.bySkin()).longest, kRounding);
}

TYPED_TEST(BonePalettes, AreCloseToTheOriginFarFromTheWorlds) {
  using Node = Eigen::Matrix<TypeParam, 3, 1>;
  const Node far = Node::Constant(TypeParam(1 << 14));
  PaletteOptions options;
  options.origin = far.template cast<double>();
  const TriangleMesh mesh = cloud(test::pointsIn(this->cage, {1, 2, 3}, 44));
  Drawn<TypeParam> drawn(this->cage, mesh, optionsFor(Interpolation::Quadratic), options);
  PointList moved;
  std::vector<Node> rounded;
  for (const Eigen::Vector3d& p : this->maps[1](this->cage.nodes)) {
    rounded.push_back(p.template cast<TypeParam>() + far);
    moved.push_back((rounded.back() - far).template cast<double>());
  }
  std::vector<Bone> bones(drawn.palette.boneCount());
  ASSERT_EQ(drawn.palette.update(viewOf(std::as_const(rounded)), {bones.front().data(), bones.size()}), StatusCode::Ok);
  drawn.move(moved);
  EXPECT_LT(distances(drawnBy(bones, drawn.skinned, drawn.rest), drawn.bySkin()).longest, 1e-5);
  ASSERT_TRUE(drawn.palette.setOrigin(Eigen::Vector3d::Zero()).ok());
  EXPECT_EQ(drawn.palette.setOrigin(Eigen::Vector3d(0, NAN, 0)).code, StatusCode::InvalidOption);
  ASSERT_EQ(drawn.palette.update(viewOf(std::as_const(rounded)), {bones.front().data(), bones.size()}), StatusCode::Ok);
  EXPECT_GT(bones[0](0, 3), 16000.0f);
}

TYPED_TEST(BonePalettes, ColumnsAreTheRowsTransposedAtAnyStride) {
  const TriangleMesh mesh = pointsAround(1.0, 100, this->cage);
  Drawn<TypeParam> drawn(this->cage, mesh, optionsFor(Interpolation::Quadratic));
  drawn.move(this->maps[0](this->cage.nodes));
  PaletteOptions options;
  options.layout = BoneLayout::Columns;
  auto palette = BonePalette<TypeParam>::create(drawn.skin.binding(), options).value();
  std::vector<Eigen::Matrix<TypeParam, 3, 1>> nodes;
  for (const Eigen::Vector3d& p : this->maps[0](this->cage.nodes)) nodes.push_back(p.template cast<TypeParam>());
  constexpr std::size_t kStride = 19;
  std::vector<float> memory(kStride * nodes.size(), -7.0f);
  const BoneView view{memory.data(), nodes.size(), kStride * sizeof(float)};
  ASSERT_EQ(palette.update(viewOf(std::as_const(nodes)), view), StatusCode::Ok);
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const float* bone = &memory[kStride * n];
    const Eigen::Map<const Eigen::Matrix4f> columns(bone);
    EXPECT_EQ(columns.topRows<3>(), drawn.bones[n]) << n;
    EXPECT_EQ(columns.row(3), Eigen::RowVector4f(0, 0, 0, 1)) << n;
    EXPECT_EQ(std::count(bone + 16, bone + kStride, -7.0f), 3) << "memory between bones is not written";
  }
}

/// Only some nodes have vertices, and gradients.
TYPED_TEST(BonePalettes, OfNodesWithoutVerticesAreTranslations) {
  const TetMesh plain = test::latticeCage(6, 6, 6, 0.25);
  Drawn<TypeParam> drawn(plain, cloud({{0.1, 0.1, 0.1}, {0.2, 0.15, 0.1}}), optionsFor(Interpolation::Quadratic));
  const PointList nodes = this->maps[0](plain.nodes);
  drawn.move(nodes);
  EXPECT_LT(drawn.difference(), kRounding);
  const std::size_t last = nodes.size() - 1;
  const Eigen::Vector3d moved = drawn.bones[last].template cast<double>() * plain.nodes[last].homogeneous();
  EXPECT_LT((moved - nodes[last]).norm(), kRounding);
  EXPECT_EQ((drawn.bones[last].template leftCols<3>()), 0.5f * Eigen::Matrix3f::Identity());
}

TYPED_TEST(BonePalettes, AreTheSameForAnyNumberOfThreads) {
  const TetMesh large = test::latticeCage(26, 26, 26, 0.04);
  const TriangleMesh mesh = cloud(test::randomPoints(20000, test::around(large, 1.0), 45));
  auto binding = SkinBinding<TypeParam>::create(large, mesh, optionsFor(Interpolation::Quadratic)).value();
  const PointList nodes = this->maps[0](large.nodes);
  auto alone = BonePalette<TypeParam>::create(binding).value();
  test::ShuffledThreads threads(3);
  PaletteOptions options;
  options.threads = &threads;
  auto together = BonePalette<TypeParam>::create(binding, options).value();
  EXPECT_EQ(bonesFor(alone, nodes), bonesFor(together, nodes));
  EXPECT_EQ(threads.runs, 2) << "for the gradients, and for the bones";
}

TYPED_TEST(BonePalettes, AgreeOnEveryInstructionSet) {
  Drawn<TypeParam> drawn(this->cage, pointsAround(1.2, 300, this->cage), optionsFor(Interpolation::Quadratic));
  const InstructionSet before = instructionSet();
  for (const InstructionSet set : availableInstructionSets()) {
    setInstructionSet(set);
    const std::vector<Bone> bones = bonesFor(drawn.palette, this->maps[0](this->cage.nodes));
    drawn.move(this->maps[0](this->cage.nodes));
    setInstructionSet(before);
    drawn.move(this->maps[0](this->cage.nodes));
    for (std::size_t n = 0; n < bones.size(); ++n) {
      EXPECT_LT((bones[n] - drawn.bones[n]).norm(), 1e-5f) << toString(set) << " " << n;
    }
  }
}

TYPED_TEST(BonePalettes, UpdatesAllocateNothing) {
  Drawn<TypeParam> drawn(this->cage, pointsAround(1.0, 100, this->cage), optionsFor(Interpolation::Quadratic));
  std::vector<Eigen::Matrix<TypeParam, 3, 1>> nodes;
  for (const Eigen::Vector3d& p : this->cage.nodes) nodes.push_back(p.template cast<TypeParam>());
  std::vector<Bone> bones(nodes.size());
  const std::size_t before = test::allocationCount();
  const StatusCode code = drawn.palette.update(viewOf(std::as_const(nodes)), {bones.front().data(), bones.size()});
  EXPECT_EQ(test::allocationCount(), before);
  EXPECT_EQ(code, StatusCode::Ok);
}

TYPED_TEST(BonePalettes, RefuseWhatTheyCannotFollow) {
  using Node = Eigen::Matrix<TypeParam, 3, 1>;
  BonePalette<TypeParam> none;
  EXPECT_EQ(none.update({}, {}), StatusCode::Unbound);
  EXPECT_EQ(none.boneCount(), 0u);
  EXPECT_EQ(BonePalette<TypeParam>::create(nullptr).status().code, StatusCode::Empty);
  const TriangleMesh mesh = pointsAround(1.0, 100, this->cage);
  auto binding = SkinBinding<TypeParam>::create(this->cage, mesh, optionsFor(Interpolation::Linear)).value();
  PaletteOptions options;
  options.gradients = true;
  EXPECT_EQ(BonePalette<TypeParam>::create(binding, options).status().code, StatusCode::InvalidOption);
  options.gradients = false;
  options.origin.x() = 1e19;
  EXPECT_EQ(BonePalette<TypeParam>::create(binding, options).status().code, StatusCode::InvalidOption);

  auto palette = BonePalette<TypeParam>::create(binding).value();
  std::vector<Node> nodes(this->cage.nodeCount(), Node::Ones());
  const Bone untouched = Bone::Constant(-7.0f);
  std::vector<Bone> bones(nodes.size() + 1, untouched);
  const PointView<const TypeParam> view = viewOf(std::as_const(nodes));
  EXPECT_EQ(palette.update({view.data(), view.size() - 1}, {bones.front().data(), nodes.size()}),
            StatusCode::TopologyChanged);
  EXPECT_EQ(palette.update(view, {bones.front().data(), bones.size()}), StatusCode::SizeMismatch);
  nodes[11].y() = std::numeric_limits<TypeParam>::quiet_NaN();
  EXPECT_EQ(palette.update(view, {bones.front().data(), nodes.size()}), StatusCode::NonFinite);
  EXPECT_EQ(palette.firstNonFiniteNode(), 11u);
  EXPECT_EQ(bones, std::vector<Bone>(bones.size(), untouched));
}

class SkinnedMeshes : public testing::Test {
 protected:
  const TetMesh cage = test::jittered(test::latticeCage(4, 4, 4, 0.25), 0.04, 9);
};

TEST_F(SkinnedMeshes, HaveTheNodesAndWeightsOfTheBindingInItsOrder) {
  const TriangleMesh mesh = pointsAround(1.2, 300, cage);
  for (const VertexOrder order : {VertexOrder::Mesh, VertexOrder::Sorted}) {
    BindingOptions options;
    options.order = order;
    const auto binding = SkinBinding<float>::create(cage, mesh, options).value();
    const SkinnedMesh skinned = skinnedMeshOf(*binding).value();
    ASSERT_EQ(skinned.vertexCount(), mesh.vertexCount());
    ASSERT_EQ(skinned.weights.size(), mesh.vertexCount());
    for (std::size_t k = 0; k < mesh.vertexCount(); ++k) {
      const std::size_t v = order == VertexOrder::Mesh ? k : binding->embedding().slotVertices()[k];
      const EmbeddedPoint<float> point = binding->embedding().at<float>(v);
      EXPECT_EQ(skinned.weights[k], point.weights) << k;
      for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(skinned.bones[k][i], point.nodes[i]) << k;
    }
  }
}

/// For a twisted cube of size 1 with tets a quarter as long: inside, the rounding of 16 bits; outside, weights below 0
/// are left out, and a vertex is off by up to about its distance from the cube.
TEST_F(SkinnedMeshes, MoveByLittleWithWeightsOf16BitsUnlessOutside) {
  const TetMesh cube = test::latticeCage(4, 4, 4, 0.25);
  for (const Interpolation interpolation : {Interpolation::Linear, Interpolation::Quadratic}) {
    Drawn<double> drawn(cube, pointsAround(1.5, 2000, cube), optionsFor(interpolation));
    drawn.move(test::smoothMaps(test::kCentre)[0](cube.nodes));
    const PointList exact = drawn.byBones();
    const auto weights = drawn.skinned.normalisedWeights();
    for (std::size_t v = 0; v < weights.size(); ++v) {
      EXPECT_EQ(std::accumulate(weights[v].begin(), weights[v].end(), 0), 65535) << v;
      for (std::size_t k = 0; k < 4; ++k) drawn.skinned.weights[v][k] = static_cast<float>(weights[v][k]) / 65535.0f;
    }
    const PointList rounded = drawn.byBones();
    double inside = 0.0, outside = 0.0;
    for (std::size_t v = 0; v < weights.size(); ++v) {
      const double error = (rounded[v] - exact[v]).norm();
      const double distance = (drawn.rest[v] - drawn.rest[v].cwiseMax(0.0).cwiseMin(1.0)).norm();
      (distance > 0.0 ? outside : inside) =
          std::max(distance > 0.0 ? outside : inside, distance > 0.0 ? error / distance : error);
    }
    EXPECT_LT(inside, 3e-5 * 0.25);
    EXPECT_GT(inside, 1e-7);
    EXPECT_LT(outside, 1.5);
    EXPECT_GT(outside, 0.5);
  }
}

TEST_F(SkinnedMeshes, TakeNoMoreBonesThan16BitsNumber) {
  TetMesh large = test::singleTet();
  large.nodes.resize(SkinnedMesh::kMaxBones, Eigen::Vector3d::Constant(0.5));
  const TriangleMesh mesh = cloud({Eigen::Vector3d::Constant(0.2)});
  EXPECT_TRUE(skinnedMeshOf(*SkinBinding<float>::create(large, mesh).value()).ok());
  large.nodes.emplace_back(0.5, 0.5, 0.5);
  const Status status = skinnedMeshOf(*SkinBinding<float>::create(large, mesh).value()).status();
  EXPECT_EQ(status.code, StatusCode::TooLarge);
  EXPECT_NE(status.message.find("65537 nodes"), std::string::npos) << status.message;
}

}  // namespace
}  // namespace tetskin::test
