// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "support/odd_meshes.h"

#include <tetskin/core/src/base/kernels/instruction_set.h>
#include <tetskin/core/src/search/tet_filter.h>

#include <set>

namespace tetskin {
namespace {

using Points = std::vector<Eigen::Vector3d>;

/// Points in, on and near a tet: mixtures of its corners, some beyond a face only by the last bits.
Points pointsAbout(const TetCorners& p, unsigned seed) {
  Points points(p.begin(), p.end());
  for (const Eigen::Vector3d& w : test::randomPoints(400, {Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones()}, seed)) {
    const double a = w[0] < 0.2 ? 0.0 : w[0], b = w[1] < 0.3 ? 0.0 : w[1], c = w[2];
    const Eigen::Vector3d q =
        p[3] + a * (p[0] - p[3]) + (1.0 - a) * b * (p[1] - p[3]) + (1.0 - a) * (1.0 - b) * c * (p[2] - p[3]);
    points.push_back(q);
    points.push_back(p[0] + p[1] - q);
    points.emplace_back(std::nextafter(q[0], 1e300), q[1], std::nextafter(q[2], -1e300));
  }
  return points;
}

/// Regular tets, needles, slivers and wedges of size about 1, the worst of them just above kFlatTet.
std::vector<TetCorners> oddTets() {
  return {{Eigen::Vector3d{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
          {Eigen::Vector3d{0, 0, 0}, {1e-4, 0, 0}, {0, 1e-4, 0}, {0.3, 0.4, 1}},
          {Eigen::Vector3d{0, 0, 0}, {1, 0.1, 0}, {0.2, 1, 0}, {0.9, 0.8, 3e-9}},
          {Eigen::Vector3d{0, 0, 0}, {1, 0, 0}, {0.5, 1e-5, 0}, {0.5, 0, 2e-4}}};
}

TetCorners moved(const TetCorners& p, double scale, const Eigen::Vector3d& offset) {
  TetCorners q;
  for (std::size_t i = 0; i < 4; ++i) q[i] = scale * p[i] + offset;
  return q;
}

std::set<std::uint32_t> selected(const TetFilter& filter, const SpatialHash& hash, const float* limits) {
  std::vector<std::uint32_t> passed;
  const std::size_t count = filter.select(hash, {{0, static_cast<std::uint32_t>(hash.size())}}, limits, passed);
  std::set<std::uint32_t> points;
  for (std::size_t k = 0; k < count; ++k) points.insert(hash.ids()[passed[k]]);
  EXPECT_EQ(points.size(), count);
  return points;
}

/// Runs with the kernels of each instruction set.
class TetFilters : public testing::TestWithParam<InstructionSet> {
 protected:
  TetFilters() { setInstructionSet(GetParam()); }
  ~TetFilters() override { setInstructionSet(before_); }

 private:
  InstructionSet before_ = instructionSet();
};

INSTANTIATE_TEST_SUITE_P(All, TetFilters, testing::ValuesIn(availableInstructionSets()), [](const auto& test) {
  std::string name = toString(test.param);
  name.erase(std::remove(name.begin(), name.end(), '-'), name.end());
  return name;
});

/// Every point that the test in double precision puts in the tet passes; within a box of the tet's own size, few others
/// do.
void expectNothingLost(const TetCorners& p, const Box3& frame) {
  if (isFlat(p)) return;
  const Points points = pointsAbout(p, 51);
  const BarycentricMap map(p);
  const SpatialHash hash(viewOf(points), frame, 0.1 * frame.sizes().maxCoeff());
  const std::set<std::uint32_t> passed = selected(TetFilter::ofWeights(map, hash.frame()), hash, nullptr);
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    if (!frame.contains(points[i]) || map(points[i]).minCoeff() < 0.0) continue;
    EXPECT_EQ(passed.count(i), 1u) << "point " << i;
  }
}

/// Every point closer than its limit passes.
void expectNoneNearLost(const TetCorners& p, const Box3& frame, double reach) {
  if (isFlat(p)) return;
  const Points points = pointsAbout(p, 52);
  const BarycentricMap map(p);
  const SpatialHash hash(viewOf(points), frame, 0.1 * frame.sizes().maxCoeff());
  const std::vector<float> limits(hash.size() + SpatialHash::kPadding,
                                  static_cast<float>(reach * hash.frame().scale * 1.000001));
  const std::set<std::uint32_t> passed = selected(TetFilter::ofDistance(map, hash.frame()), hash, limits.data());
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    if (!frame.contains(points[i]) || distanceToTet(points[i], p, map(points[i])) > reach) continue;
    EXPECT_EQ(passed.count(i), 1u) << "point " << i;
  }
}

Box3 boxOf(const TetCorners& p, double border) {
  Box3 box;
  for (const Eigen::Vector3d& corner : p) box.extend(corner);
  const Eigen::Vector3d b = Eigen::Vector3d::Constant(border * box.sizes().maxCoeff());
  return {box.min() - b, box.max() + b};
}

TEST_P(TetFilters, LosesNothingAtAnyScaleAndOffset) {
  for (const TetCorners& unit : oddTets()) {
    for (const double scale : {1e-12, 1e-3, 1.0, 1e12}) {
      for (const double offset : {0.0, 1e3, -1e6}) {
        const TetCorners p = moved(unit, scale, Eigen::Vector3d(offset, -0.7 * offset, 0.3) * scale);
        expectNothingLost(p, boxOf(p, 0.5));
        expectNoneNearLost(p, boxOf(p, 1.0), 0.1 * scale);
      }
    }
  }
}

TEST_P(TetFilters, LosesNothingInABoxManyTimesItsSize) {
  for (const TetCorners& p : oddTets()) {
    for (const double border : {1e3, 1e6, 1e12, 1e29}) {
      expectNothingLost(p, boxOf(p, border));
      expectNoneNearLost(p, boxOf(p, border), 0.1);
      expectNoneNearLost(p, boxOf(p, border), 0.0);
    }
  }
}

TEST_P(TetFilters, LetsFewStrangersPass) {
  const TetCorners p = oddTets()[0];
  const Points points = test::randomPoints(20000, {Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones()}, 53);
  const BarycentricMap map(p);
  const SpatialHash hash(viewOf(points), boxOf(p, 50.0), 0.3);
  const auto passed = selected(TetFilter::ofWeights(map, hash.frame()), hash, nullptr);
  const auto inside =
      std::count_if(points.begin(), points.end(), [&](const Eigen::Vector3d& q) { return map(q).minCoeff() >= 0.0; });
  EXPECT_LE(passed.size(), static_cast<std::size_t>(inside) + 10);
}

TEST_P(TetFilters, SelectsOnlyWithinTheRanges) {
  const TetCorners p = oddTets()[0];
  const Points points(11, Eigen::Vector3d::Constant(0.2));
  const SpatialHash hash(viewOf(points), boxOf(p, 0.1), 1.0);
  std::vector<std::uint32_t> passed;
  const TetFilter filter = TetFilter::ofWeights(BarycentricMap(p), hash.frame());
  ASSERT_EQ(filter.select(hash, {{1, 3}, {5, 11}}, nullptr, passed), 8u);
  passed.resize(8);
  EXPECT_EQ(passed, (std::vector<std::uint32_t>{1, 2, 5, 6, 7, 8, 9, 10}));
}

}  // namespace
}  // namespace tetskin
