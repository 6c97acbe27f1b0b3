// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "support/odd_meshes.h"
#include "support/smooth_maps.h"

#include <tetskin/core/mesh_skin.h>
#include <tetskin/core/src/base/kernels/instruction_set.h>

namespace tetskin {
namespace {

class InstructionSets : public testing::Test {
 protected:
  ~InstructionSets() override { setInstructionSet(before_); }

 private:
  InstructionSet before_ = instructionSet();
};

TEST_F(InstructionSets, TheWidestIsUsedUnlessAnotherIsChosen) {
  const std::vector<InstructionSet> sets = availableInstructionSets();
  ASSERT_FALSE(sets.empty());
  EXPECT_EQ(sets.front(), InstructionSet::Plain);
  EXPECT_TRUE(std::is_sorted(sets.begin(), sets.end()));
  EXPECT_EQ(instructionSet(), sets.back());
  for (const InstructionSet set : sets) {
    setInstructionSet(set);
    EXPECT_EQ(instructionSet(), set);
  }
}

TEST_F(InstructionSets, EachHasAName) {
  EXPECT_STREQ(toString(InstructionSet::Plain), "plain");
  EXPECT_STREQ(toString(InstructionSet::Baseline), "baseline");
  EXPECT_STREQ(toString(InstructionSet::Avx2), "AVX2");
  EXPECT_STREQ(toString(InstructionSet::Avx512), "AVX-512");
}

/// Everything that may differ between instruction sets, for a surface with vertices inside and outside.
template <class Scalar, class Out>
struct Results {
  std::vector<VertexBinding> bindings;
  std::vector<Eigen::Matrix<Out, 3, 1>> positions;
  std::vector<Eigen::Vector3f> normals, tangents;
  Box3 bounds;

  Results(Interpolation interpolation, VertexOrder order) {
    const TetMesh cage = test::jittered(test::bodyCentredCage(5, 5, 5, 0.2), 0.04, 82);
    TriangleMesh mesh = test::sphere(30, 0.52, Eigen::Vector3d::Constant(0.5));
    mesh.tangents.assign(mesh.vertexCount(), {0.6f, 0.0f, 0.8f, 1.0f});
    positions.resize(mesh.vertexCount());
    normals.resize(mesh.vertexCount());
    tangents.resize(mesh.vertexCount());
    SkinOptions options;
    options.interpolation = interpolation;
    options.normals = Normals::Transformed;
    options.order = order;
    options.target = viewOf(positions);
    options.normalTarget = viewOf(normals);
    options.tangentTarget = viewOf(tangents);
    MeshSkin<Scalar> skin;
    const Result<EmbedReport> fit = skin.bind(cage, mesh, options);
    EXPECT_GT(fit.value().inside, 100u);
    EXPECT_GT(fit.value().outside, 100u);
    std::vector<Eigen::Matrix<Scalar, 3, 1>> nodes;
    const test::SmoothMap twist = test::smoothMaps(Eigen::Vector3d::Constant(0.5))[0];
    for (const Eigen::Vector3d& p : cage.nodes) nodes.push_back(twist.at(p).template cast<Scalar>());
    EXPECT_EQ(skin.update(viewOf(std::as_const(nodes))), StatusCode::Ok);
    bindings = skin.binding()->embedding().bindings();
    bounds = skin.bounds();
  }
};

template <class Points>
double farthest(const Points& a, const Points& b) {
  double longest = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    const double length = static_cast<double>((a[k] - b[k]).norm());
    longest = length <= longest ? longest : length;  // NaN counts as the largest
  }
  return longest;
}

template <class Scalar, class Out>
void expectAgreement(InstructionSet set) {
  for (const Interpolation interpolation : {Interpolation::Linear, Interpolation::Quadratic}) {
    for (const VertexOrder order : {VertexOrder::Mesh, VertexOrder::Sorted}) {
      setInstructionSet(InstructionSet::Baseline);
      const Results<Scalar, Out> expected(interpolation, order);
      const double diagonal = boundingBox(viewOf(expected.positions)).diagonal().norm();
      setInstructionSet(set);
      const Results<Scalar, Out> result(interpolation, order);
      for (std::size_t v = 0; v < result.bindings.size(); ++v) {
        EXPECT_EQ(result.bindings[v].tet, expected.bindings[v].tet);
        EXPECT_EQ(result.bindings[v].weights, expected.bindings[v].weights);
      }
      EXPECT_LT(farthest(result.positions, expected.positions), 1e-6 * diagonal);
      EXPECT_LT(farthest(result.normals, expected.normals), 1e-5);
      EXPECT_LT(farthest(result.tangents, expected.tangents), 1e-5);
      EXPECT_LT((result.bounds.min() - expected.bounds.min()).norm(), 1e-6 * diagonal);
      EXPECT_LT((result.bounds.max() - expected.bounds.max()).norm(), 1e-6 * diagonal);
    }
  }
}

/// Instruction sets that the processor lacks are reported as skipped, not silently omitted.
class Kernels : public InstructionSets, public testing::WithParamInterface<InstructionSet> {};

TEST_P(Kernels, ChooseTheSameTetsAndAgreeOnPositionsAndNormals) {
  const std::vector<InstructionSet> sets = availableInstructionSets();
  if (std::find(sets.begin(), sets.end(), GetParam()) == sets.end()) GTEST_SKIP() << "not on this processor";
  expectAgreement<float, float>(GetParam());
  expectAgreement<float, double>(GetParam());
  expectAgreement<double, float>(GetParam());
  expectAgreement<double, double>(GetParam());
}

INSTANTIATE_TEST_SUITE_P(InstructionSets, Kernels,
                         testing::Values(InstructionSet::Plain, InstructionSet::Baseline, InstructionSet::Avx2,
                                         InstructionSet::Avx512),
                         [](const auto& set) {
                           std::string name = toString(set.param);
                           name.erase(std::remove(name.begin(), name.end(), '-'), name.end());
                           return name;
                         });

/// The lanes of a vector belong to different vertices: a count that is no multiple of the number of lanes leaves some
/// unused.
TEST_F(InstructionSets, WriteAsManyPointsAsThereAre) {
  const TetMesh cage = test::singleTet();
  const auto vertices = test::randomPoints(40, {Eigen::Vector3d::Zero(), Eigen::Vector3d::Constant(0.3)}, 83);
  for (const InstructionSet set : availableInstructionSets()) {
    setInstructionSet(set);
    for (std::size_t count = 1; count <= vertices.size(); ++count) {
      TriangleMesh mesh;
      mesh.positions.assign(vertices.begin(), vertices.begin() + static_cast<std::ptrdiff_t>(count));
      std::vector<Eigen::Vector3f> positions(count + 16, Eigen::Vector3f::Constant(-77.0f)), normals = positions;
      SkinOptions options;
      options.normals = Normals::Transformed;
      options.interpolation = Interpolation::Quadratic;
      options.order = VertexOrder::Sorted;
      options.target = PointView<float>(positions.front().data(), count);
      options.normalTarget = PointView<float>(normals.front().data(), count);
      MeshSkin<float> skin;
      ASSERT_TRUE(skin.bind(cage, mesh, options).ok());
      for (std::size_t v = 0; v < positions.size(); ++v) {
        if (v < count) {
          EXPECT_LT((positions[v].cast<double>() - vertices[v]).norm(), 1e-6);
          EXPECT_LT((normals[v] - Eigen::Vector3f::UnitY()).norm(), 1e-6f);
        } else {
          EXPECT_EQ(positions[v], Eigen::Vector3f::Constant(-77.0f));
          EXPECT_EQ(normals[v], Eigen::Vector3f::Constant(-77.0f));
        }
      }
    }
  }
}

}  // namespace
}  // namespace tetskin
