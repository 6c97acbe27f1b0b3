// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/mesh.h>
#include <tetskin/core/src/base/mesh/mesh_checks.h>
#include <tetskin/core/types.h>

#include <limits>
#include <set>
#include <stdexcept>

namespace tetskin {
namespace {

TEST(StatusCode, EveryCodeHasItsOwnName) {
  std::set<std::string> names;
  constexpr int kCodes = static_cast<int>(StatusCode::Cancelled) + 1;
  for (int c = 0; c < kCodes; ++c) names.insert(toString(static_cast<StatusCode>(c)));
  EXPECT_EQ(names.size(), static_cast<std::size_t>(kCodes));
  EXPECT_EQ(names.count("unknown status"), 0u);
}

TEST(Result, DoesNotConvertToItsValue) {
  static_assert(!std::is_convertible_v<Result<std::string>, std::string>);
  static_assert(!std::is_convertible_v<Result<int*>, bool>);
  const auto make = [] { return Result<std::string>(std::string("value")); };
  const std::string value = make().value();
  EXPECT_EQ(value, "value");
  EXPECT_TRUE(make().ok());
}

TEST(Result, OfAFailureKeepsTheMessage) {
  const Result<int*> failed(Status{StatusCode::Empty, "nothing there"});
  EXPECT_FALSE(failed.ok());
  EXPECT_EQ(failed.status().code, StatusCode::Empty);
  EXPECT_EQ(failed.status().message, "nothing there");
}

/// The message of the error with which the call stops; empty if it does not stop.
template <class Call>
std::string stoppedBy(Call&& call) {
  try {
    call();
  } catch (const std::logic_error& error) {
    return error.what();
  }
  return "";
}

TEST(Result, ValueOfAFailureStopsWithTheMessage) {
  Result<std::vector<int>> failed(Status{StatusCode::Empty, "nothing there"});
  const Result<std::vector<int>>& constant = failed;
  EXPECT_EQ(stoppedBy([&] { (void)failed.value(); }), "nothing there");
  EXPECT_EQ(stoppedBy([&] { (void)constant.value(); }), "nothing there");
  EXPECT_EQ(stoppedBy([&] { (void)std::move(failed).value(); }), "nothing there");
}

TEST(Result, CannotBeMadeOfAStatusThatIsOk) {
  EXPECT_NE(stoppedBy([] { (void)Result<int>(Status{}); }), "");
}

TEST(Result, HoldsValuesThatCannotBeMadeOfNothing) {
  struct Number {
    explicit Number(int n) : value(n) {}
    int value;
  };
  EXPECT_EQ(Result<Number>(Number(7)).value().value, 7);
  EXPECT_FALSE(Result<Number>(Status{StatusCode::Empty, "none"}).ok());
}

TEST(Result, HoldsMoveOnlyValues) {
  Result<std::unique_ptr<int>> result(std::make_unique<int>(7));
  const std::unique_ptr<int> value = std::move(result).value();
  EXPECT_EQ(*value, 7);
}

TEST(PointView, WalksAnInterleavedBuffer) {
  struct Vertex {
    float uv[2];
    float position[3];
  };
  std::vector<Vertex> buffer{{{9, 9}, {1, 2, 3}}, {{9, 9}, {4, 5, 6}}};
  const PointView<float> view(buffer[0].position, buffer.size(), sizeof(Vertex));
  EXPECT_EQ(view[1][2], 6.0f);
  view[0][0] = 7.0f;
  EXPECT_EQ(buffer[0].position[0], 7.0f);
  EXPECT_EQ(buffer[0].uv[1], 9.0f);
}

TEST(PointView, FindsTheFirstPointThatIsNotFinite) {
  std::vector<Eigen::Vector3f> points(5, Eigen::Vector3f::Zero());
  EXPECT_EQ(firstNonFinite(viewOf(std::as_const(points))), 5u);
  points[3].y() = -std::numeric_limits<float>::infinity();
  EXPECT_EQ(firstNonFinite(viewOf(std::as_const(points))), 3u);
  points[2].z() = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(firstNonFinite(viewOf(std::as_const(points))), 2u);
}

TEST(PointView, FindsTheFirstPointThatNoSurfaceCanFollow) {
  const std::vector<Eigen::Vector3f> good = {{1e18f, -1e18f, 0}, {1, 2, 3}};
  EXPECT_EQ(firstUnusable(viewOf(good)), 2u);
  for (const float bad : {1.01e18f, -1e30f, std::numeric_limits<float>::infinity(), std::nanf("")}) {
    for (int k = 0; k < 3; ++k) {
      std::vector<Eigen::Vector3f> points = good;
      points[1][k] = bad;
      EXPECT_EQ(firstUnusable(viewOf(std::as_const(points))), 1u);
    }
  }
}

TEST(PointView, BoundingBoxOfNothingIsEmpty) {
  EXPECT_TRUE(boundingBox(std::vector<Eigen::Vector3d>{}).isEmpty());
  const Box3 box = boundingBox(std::vector<Eigen::Vector3d>{{1, -2, 3}, {0, 5, 3}});
  EXPECT_EQ(box.min(), Eigen::Vector3d(0, -2, 3));
  EXPECT_EQ(box.max(), Eigen::Vector3d(1, 5, 3));
}

TEST(TriangleMesh, CheckNamesTheFirstFault) {
  TriangleMesh mesh;
  EXPECT_EQ(validate(mesh).code, StatusCode::Empty);
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  EXPECT_TRUE(validate(mesh).ok());
  mesh.triangles.push_back({0, 1, 3});
  const Status outOfRange = validate(mesh);
  EXPECT_EQ(outOfRange.code, StatusCode::IndexOutOfRange);
  EXPECT_NE(outOfRange.message.find("triangle 1"), std::string::npos);
  mesh.positions[1].x() = std::numeric_limits<double>::quiet_NaN();
  const Status notFinite = validate(mesh);
  EXPECT_EQ(notFinite.code, StatusCode::NonFinite);
  EXPECT_NE(notFinite.message.find("vertex 1"), std::string::npos);
}

TEST(CheckTriangleCounts, RefusesMoreThanItsIndicesCanNumber) {
  EXPECT_TRUE(checkTriangleCounts(2147483647, Limits::kMaxTriangles).ok());
  const Status vertices = checkTriangleCounts(2147483648, 1);
  EXPECT_EQ(vertices.code, StatusCode::TooLarge);
  EXPECT_NE(vertices.message.find("2147483648 vertices, more than the 2147483647"), std::string::npos);
  const Status triangles = checkTriangleCounts(3, Limits::kMaxTriangles + 1);
  EXPECT_EQ(triangles.code, StatusCode::TooLarge);
  EXPECT_NE(triangles.message.find("477218589 triangles, more than the 477218588"), std::string::npos);
}

}  // namespace
}  // namespace tetskin
