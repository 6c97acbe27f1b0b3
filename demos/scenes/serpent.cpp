// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "scenes/serpent.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>

#include "scenes/angles.h"
#include "scenes/serpent_shape.h"
#include "scenes/serpent_tube.h"

namespace tetskin::scenes {
namespace {

using Eigen::Vector3d;

constexpr int kScaleColumns = 12;         ///< scales around the body
constexpr double kScaleRows = 165.0;      ///< approximate number of scales along it
constexpr double kBodySlenderness = 9.5;  ///< rings over columns: four quads per scale along the body, four around it
constexpr double kHeadDensity = 2.2;      ///< rings per radius on the head, relative to the body
constexpr double kThinnest = 0.05;        ///< radius below which rings get no closer
constexpr double kThinnestSnout = 0.008;  ///< the same limit on the head, as the mouth goes around the tip
constexpr double kBackCrowding = 0.25;    ///< columns are this much denser on the back, and sparser on the belly
constexpr double kTrimFraction = 0.13;    ///< share of all triangles that is spent on spikes, horns, teeth and eyes

/// A curved, tapering spike. Directions are given as (outwards, to the tail, across) of the surface at its root;
/// "across" is up on the flanks, and is mirrored together with the spike.
struct Thorn {
  double t = 0.0, theta = 0.0;  ///< root; theta in degrees
  double length = 0.0;
  double breadth = 0.0;   ///< half the width at the root, towards the tail
  double flatness = 1.0;  ///< thickness over breadth
  Vector3d from, to;      ///< directions at root and tip
  double detail = 1.0;    ///< number of triangles relative to a spike on the back
  double inset = 0.0;     ///< depth of the root below the surface
};

void appendThorn(TriangleMesh& mesh, const SerpentShape& shape, const Thorn& thorn, double triangles) {
  constexpr double kSunk = 0.3;  ///< share of the length below the surface, so that relief does not lift it off
  constexpr double kSlenderness = 1.0;
  const SurfacePoint root = shape.surface(thorn.t, thorn.theta * kDegree);
  const double mirror = thorn.theta > 180.0 ? -1.0 : 1.0;
  const Vector3d across = mirror * root.normal.cross(root.backward);
  const auto inSpace = [&](const Vector3d& d) {
    return (d.x() * root.normal + d.y() * root.backward + d.z() * across).normalized();
  };
  const Vector3d from = inSpace(thorn.from), to = inSpace(thorn.to);
  const Vector3d start = root.position - thorn.inset * root.normal - kSunk * thorn.length * from;
  const TubeGrid grid = tubeGrid(triangles, kSlenderness);
  appendTube(mesh, grid, [&](int ring, int column) -> Vector3d {
    const double x = static_cast<double>(ring) / (grid.rings + 1);
    const Vector3d axis = start + thorn.length * ((1.0 + kSunk) * x * from + 0.5 * x * x * (to - from));
    const Vector3d direction = ((1.0 + kSunk) * from + x * (to - from)).normalized();
    const Vector3d along = (root.backward - root.backward.dot(direction) * direction).normalized();
    const double angle = 2.0 * kPi * column / grid.columns;
    const bool pole = ring == 0 || ring > grid.rings;
    const double radius = pole ? 0.0 : thorn.breadth * (1.0 - x);
    return axis + radius * (std::cos(angle) * along + thorn.flatness * std::sin(angle) * direction.cross(along));
  });
}

/// An eye: an ellipsoid that protrudes from the head.
struct Ball {
  double sunk = 0.0;    ///< depth of the centre below the surface
  Vector3d radii;       ///< outwards, to the tail, across
  double detail = 1.0;  ///< as in Thorn
};
constexpr double kEyePosition = 0.51, kEyeAngle = 113.0;  ///< share of the head's length; degrees

void appendBall(TriangleMesh& mesh, const SerpentShape& shape, const Ball& ball, double theta, double triangles) {
  const SurfacePoint root = shape.surface(shape.inHead(kEyePosition), theta * kDegree);
  const Vector3d centre = root.position - ball.sunk * root.normal, across = root.normal.cross(root.backward);
  const TubeGrid grid = tubeGrid(triangles, 0.5);
  appendTube(mesh, grid, [&](int ring, int column) -> Vector3d {
    const double polar = kPi * ring / (grid.rings + 1), angle = 2.0 * kPi * column / grid.columns;
    const bool pole = ring == 0 || ring > grid.rings;
    const double wide = pole ? 0.0 : std::sin(polar);
    return centre - ball.radii.x() * std::cos(polar) * root.normal +
           wide * (ball.radii.y() * std::cos(angle) * root.backward + ball.radii.z() * std::sin(angle) * across);
  });
}

double ringDensity(const SerpentShape& shape, double t) {
  const double head = smoothStep(-0.15, 0.1, (t - shape.headStart()) / (1.0 - shape.headStart()));
  const auto blend = [&](double body, double skull) { return body + head * (skull - body); };
  return blend(1.0, kHeadDensity) / std::max(shape.radius(t), blend(kThinnest, kThinnestSnout));
}

/// Makes whole numbers of columns per scale and of rings per row of scales, so that scales have crisp edges on coarse
/// meshes.
TubeGrid bodyGrid(double triangles) {
  const double columns = std::sqrt(triangles / 2.0 / kBodySlenderness);
  const int perScale = std::max(1, static_cast<int>(std::lround(columns / kScaleColumns)));
  TubeGrid grid;
  grid.columns = kScaleColumns * perScale;
  grid.rings = static_cast<int>(std::lround(triangles / 2.0 / grid.columns));
  return grid;
}

/// Adds the body with its head. Returns the number of triangles before the head.
std::size_t appendBody(TriangleMesh& mesh, const SerpentShape& shape, const TubeGrid& grid) {
  const std::vector<double> positions =
      spread(static_cast<std::size_t>(grid.rings) + 2, 0.0, 1.0, [&](double t) { return ringDensity(shape, t); });
  const double ringsPerScale = std::max(1.0, std::round(grid.rings / kScaleRows));
  const int columnsPerScale = grid.columns / kScaleColumns;
  const double legible = smoothStep(1.0, 3.0, std::min(2.0 * ringsPerScale, 1.0 * columnsPerScale));
  appendTube(mesh, grid, [&](int ring, int column) -> Vector3d {
    const double t = positions[ring], turn = static_cast<double>(column) / grid.columns;
    const double theta = 2.0 * kPi * turn + kBackCrowding * std::sin(2.0 * kPi * turn);
    const double scale = scalePattern((ring + 0.5) / ringsPerScale, turn * kScaleColumns, kScaleColumns);
    const double relief = shape.headRelief(t, theta) + legible * shape.scaleHeight(t) * scale;
    const SurfacePoint base = shape.surface(t, theta);
    return base.position + relief * base.normal;
  });
  const auto head = std::lower_bound(positions.begin(), positions.end(), shape.headStart());
  return grid.trianglesUpTo(static_cast<int>(head - positions.begin()));
}

std::vector<Thorn> spikes(const SerpentShape& shape) {
  constexpr std::size_t kCount = 52;
  constexpr double kFirst = 0.03, kLastInHead = 0.05, kBreadth = 0.42, kFlatness = 0.32;
  std::vector<Thorn> thorns;
  const auto density = [&](double t) { return 1.0 / std::max(shape.radius(t), kThinnest); };
  for (double t : spread(kCount, kFirst, shape.inHead(kLastInHead), density)) {
    const double length = shape.spikeLength(t) * (thorns.size() % 2 == 0 ? 1.0 : 0.72);
    thorns.push_back({t, 180.0, length, kBreadth * length, kFlatness, {1.0, 0.35, 0.0}, {0.55, 1.0, 0.0}});
  }
  return thorns;
}

/// The thorns and their mirror images on the other side.
std::vector<Thorn> mirrored(std::vector<Thorn> thorns) {
  const std::size_t count = thorns.size();
  for (std::size_t i = 0; i < count; ++i) {
    if (thorns[i].theta == 0.0 || thorns[i].theta == 180.0) continue;
    thorns.push_back(thorns[i]);
    thorns.back().theta = 360.0 - thorns[i].theta;
  }
  return thorns;
}

std::vector<Thorn> horns(const SerpentShape& shape) {
  const auto at = [&](double h) { return shape.inHead(h); };
  return mirrored({
      {at(0.20), 146.0, 0.260, 0.034, 0.9, {0.9, 0.8, 0.0}, {0.1, 1.0, 0.25}, 3.0},
      {at(0.16), 118.0, 0.150, 0.026, 0.7, {0.8, 0.8, 0.1}, {0.3, 1.0, 0.2}, 1.5},
      {at(0.13), 92.0, 0.120, 0.022, 0.6, {0.8, 0.9, 0.0}, {0.2, 1.0, 0.0}, 1.0},
      {at(0.14), 68.0, 0.090, 0.020, 0.6, {0.8, 0.9, 0.0}, {0.2, 1.0, -0.1}, 1.0},
      {at(0.84), 180.0, 0.060, 0.022, 0.6, {1.0, 0.2, 0.0}, {0.9, 0.8, 0.0}, 0.7},
      {at(0.72), 0.0, 0.060, 0.018, 0.5, {1.0, 0.5, 0.0}, {0.3, 1.0, 0.0}, 0.7},
      {at(0.56), 0.0, 0.050, 0.018, 0.5, {1.0, 0.5, 0.0}, {0.3, 1.0, 0.0}, 0.7},
  });
}

std::vector<Thorn> teeth(const SerpentShape& shape) {
  const auto at = [&](double h) { return shape.inHead(h); };
  const Vector3d down(-0.25, 0.0, -1.0), downBack(-0.3, 0.3, -1.0), up(-0.25, 0.0, 1.0), upBack(-0.3, 0.3, 1.0);
  return mirrored({
      {at(0.88), 106.0, 0.065, 0.013, 0.8, down, downBack, 0.5, 0.012},
      {at(0.79), 108.0, 0.036, 0.010, 0.8, down, downBack, 0.4, 0.010},
      {at(0.72), 108.0, 0.032, 0.010, 0.8, down, downBack, 0.4, 0.010},
      {at(0.65), 108.0, 0.030, 0.010, 0.8, down, downBack, 0.4, 0.010},
      {at(0.58), 106.0, 0.026, 0.009, 0.8, down, downBack, 0.4, 0.010},
      {at(0.835), 66.0, 0.045, 0.011, 0.8, up, upBack, 0.4, 0.012},
      {at(0.69), 66.0, 0.028, 0.009, 0.8, up, upBack, 0.4, 0.010},
  });
}

/// A group of components that are sunk into the body.
struct Trim {
  std::string name, material;
  std::vector<Thorn> thorns;
  std::vector<Ball> balls;  ///< one on each side
};

/// Ends the group that began where the previous one ended.
void closeGroup(TriangleMesh& mesh, const std::string& name, const std::string& material, std::size_t end) {
  const std::size_t begin =
      mesh.groups.empty() ? 0 : mesh.groups.back().firstTriangle + mesh.groups.back().triangleCount;
  mesh.groups.push_back({name, material, begin, end - begin});
}

}  // namespace

TriangleMesh makeSerpent(const SerpentOptions& options) {
  const SerpentShape shape;
  const double wish = static_cast<double>(std::clamp(options.triangles, kMinSerpentTriangles, kMaxSerpentTriangles));
  const std::vector<Trim> trims = {{"spikes", "horn", spikes(shape), {}},
                                   {"horns", "horn", horns(shape), {}},
                                   {"teeth", "ivory", teeth(shape), {}},
                                   {"eyes", "eye", {}, {{0.015, {0.025, 0.026, 0.024}, 2.0}}},
                                   {"pupils", "pupil", {}, {{0.013, {0.0255, 0.006, 0.020}, 0.7}}}};
  double fractions = 0.0;
  for (const Trim& trim : trims) {
    for (const Thorn& thorn : trim.thorns) fractions += thorn.detail;
    for (const Ball& ball : trim.balls) fractions += 2.0 * ball.detail;
  }
  const double each = kTrimFraction * wish / fractions;

  TriangleMesh mesh;
  for (const Trim& trim : trims) {
    for (const Thorn& thorn : trim.thorns) appendThorn(mesh, shape, thorn, thorn.detail * each);
    for (const Ball& ball : trim.balls) {
      for (double theta : {kEyeAngle, 360.0 - kEyeAngle}) appendBall(mesh, shape, ball, theta, ball.detail * each);
    }
    closeGroup(mesh, trim.name, trim.material, mesh.triangleCount());
  }
  const std::size_t beforeBody = mesh.triangleCount();
  const TubeGrid grid = bodyGrid(wish - static_cast<double>(beforeBody));
  const std::size_t beforeHead = beforeBody + appendBody(mesh, shape, grid);
  closeGroup(mesh, "body", "scales", beforeHead);
  closeGroup(mesh, "head", "scales", mesh.triangleCount());
  return mesh;
}

}  // namespace tetskin::scenes
