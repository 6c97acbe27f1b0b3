// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "component_models.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>

namespace tetskin::test {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;

constexpr double kPi = 3.14159265358979323846;

// --- Components

/// By element: a point that names its component, or -1 for an element that is not beyond the plane. Elements are
/// connected by the points that they share.
template <std::size_t Size>
std::vector<int> componentsOf(const std::vector<std::array<int, Size>>& elements, const std::vector<Vector3d>& points,
                              const std::optional<Plane>& plane) {
  std::vector<int> parent(points.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int p) {
    while (parent[p] != p) p = parent[p] = parent[parent[p]];
    return p;
  };
  std::vector<int> components(elements.size(), -1);
  for (std::size_t e = 0; e < elements.size(); ++e) {
    Vector3d sum = Vector3d::Zero();
    for (const int p : elements[e]) sum += points[p];
    if (plane && plane->signedDistance(Vector3d(sum / static_cast<double>(Size))) <= 0.0) continue;
    components[e] = elements[e][0];
    for (const int p : elements[e]) parent[root(p)] = root(elements[e][0]);
  }
  for (int& component : components) component = component < 0 ? component : root(component);
  return components;
}

template <std::size_t Size>
int countComponents(const std::vector<std::array<int, Size>>& elements, const std::vector<Vector3d>& points,
                    const std::optional<Plane>& plane) {
  std::vector<int> components = componentsOf(elements, points, plane);
  std::sort(components.begin(), components.end());
  components.erase(std::unique(components.begin(), components.end()), components.end());
  return static_cast<int>(
      std::count_if(components.begin(), components.end(), [](int component) { return component >= 0; }));
}

// --- Shapes

void addQuad(TriangleMesh& mesh, int a, int b, int c, int d) {
  mesh.triangles.push_back({a, b, c});
  mesh.triangles.push_back({a, c, d});
}

void append(TriangleMesh& mesh, const TriangleMesh& other) {
  const auto offset = static_cast<int>(mesh.vertexCount());
  mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
  for (const auto& t : other.triangles) mesh.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
}

/// The boundary of some cells of a grid of `size` cells.
/// toPosition  gives the positions of the grid's corners; keeps orientation
TriangleMesh cellSurface(const Vector3i& size, const std::function<bool(const Vector3i&)>& filled,
                         const std::function<Vector3d(const Vector3i&)>& toPosition) {
  TriangleMesh mesh;
  std::map<std::array<int, 3>, int> numbers;
  const auto corner = [&](const Vector3i& c) {
    const auto [found, isNew] = numbers.try_emplace({c.x(), c.y(), c.z()}, static_cast<int>(mesh.vertexCount()));
    if (isNew) mesh.positions.push_back(toPosition(c));
    return found->second;
  };
  const auto isFilled = [&](const Vector3i& c) {
    return (c.array() >= 0).all() && (c.array() < size.array()).all() && filled(c);
  };
  for (int index = 0; index < size.prod(); ++index) {
    const Vector3i c(index % size.x(), index / size.x() % size.y(), index / (size.x() * size.y()));
    if (!isFilled(c)) continue;
    for (int axis = 0; axis < 3; ++axis) {
      const Vector3i n = Vector3i::Unit(axis), u = Vector3i::Unit((axis + 1) % 3), v = Vector3i::Unit((axis + 2) % 3);
      const Vector3i far = c + n;
      if (!isFilled(c - n)) addQuad(mesh, corner(c), corner(c + v), corner(c + u + v), corner(c + u));
      if (!isFilled(far)) addQuad(mesh, corner(far), corner(far + u), corner(far + u + v), corner(far + v));
    }
  }
  return mesh;
}

/// A box of cells of edge `edge`, centred at the origin.
TriangleMesh cellBox(const Vector3i& size, double edge) {
  return cellSurface(
      size, [](const Vector3i&) { return true; },
      [&](const Vector3i& c) -> Vector3d { return edge * (c - size / 2).cast<double>(); });
}

struct Tube {
  std::function<Vector3d(double)> centre;  ///< argument from 0 to 1
  std::function<double(double)> radius;
  Vector3d up;          ///< nowhere parallel to the tube
  bool closed = false;  ///< the end meets the start; otherwise both ends are flat
  int rings = 64;
};

TriangleMesh surfaceOf(const Tube& tube) {
  constexpr int kColumns = 24;
  constexpr double kStep = 1e-5;
  TriangleMesh mesh;
  const int rings = tube.closed ? tube.rings : tube.rings + 1;
  for (int ring = 0; ring < rings; ++ring) {
    const double t = static_cast<double>(ring) / tube.rings;
    const Vector3d along = (tube.centre(t + kStep) - tube.centre(t - kStep)).normalized();
    const Vector3d up = (tube.up - tube.up.dot(along) * along).normalized(), side = along.cross(up);
    for (int column = 0; column < kColumns; ++column) {
      const double angle = 2.0 * kPi * column / kColumns;
      mesh.positions.push_back(tube.centre(t) + tube.radius(t) * (std::cos(angle) * up + std::sin(angle) * side));
    }
  }
  const auto at = [&](int ring, int column) { return ring % rings * kColumns + column % kColumns; };
  for (int ring = 0; ring < tube.rings; ++ring) {
    for (int k = 0; k < kColumns; ++k)
      addQuad(mesh, at(ring, k), at(ring, k + 1), at(ring + 1, k + 1), at(ring + 1, k));
  }
  if (tube.closed) return mesh;
  for (const int ring : {0, tube.rings}) {
    const auto pole = static_cast<int>(mesh.vertexCount());
    mesh.positions.push_back(tube.centre(ring == 0 ? 0.0 : 1.0));
    for (int k = 0; k < kColumns; ++k) {
      if (ring == 0) mesh.triangles.push_back({pole, at(ring, k + 1), at(ring, k)});
      if (ring != 0) mesh.triangles.push_back({pole, at(ring, k), at(ring, k + 1)});
    }
  }
  return mesh;
}

std::function<double(double)> constant(double value) {
  return [value](double) { return value; };
}

/// A zigzag from -1 to 1 of period 4, rising from 0.
double zigzag(double x) {
  const double phase = x - 4.0 * std::floor(0.25 * x);
  return phase < 1.0 ? phase : phase < 3.0 ? 2.0 - phase : phase - 4.0;
}

TriangleMesh square(double y) {
  constexpr int kCells = 20;
  TriangleMesh mesh;
  for (int i = 0; i <= kCells; ++i) {
    for (int j = 0; j <= kCells; ++j) mesh.positions.emplace_back(2.0 * j / kCells - 1.0, y, 2.0 * i / kCells - 1.0);
  }
  const auto at = [](int i, int j) { return i * (kCells + 1) + j; };
  for (int i = 0; i < kCells; ++i) {
    for (int j = 0; j < kCells; ++j) addQuad(mesh, at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
  }
  return mesh;
}

}  // namespace

int countComponentsBeyond(const TetMesh& cage, const std::optional<Plane>& plane) {
  return countComponents(cage.tets, cage.nodes, plane);
}

int countComponentsBeyond(const TriangleMesh& mesh, const std::optional<Plane>& plane) {
  return countComponents(mesh.triangles, mesh.positions, plane);
}

std::vector<int> componentsBeyond(const TetMesh& cage, const Plane& plane) {
  return componentsOf(cage.tets, cage.nodes, plane);
}

ComponentModel twoPlates(double gap) {
  constexpr double kEdge = 0.1;
  constexpr int kThick = 3, kWide = 20;
  const auto filled = [](const Vector3i& c) { return c.y() != kThick; };
  const auto toPosition = [gap](const Vector3i& c) -> Vector3d {
    const double y = c.y() <= kThick ? kEdge * c.y() : kEdge * (c.y() - 1) + gap;
    return {kEdge * c.x() - 1.0, y, kEdge * c.z() - 1.0};
  };
  return {"two plates", cellSurface({kWide, 2 * kThick + 1, kWide}, filled, toPosition), {}, 2, gap};
}

ComponentModel jaw(double gap) {
  constexpr double kEdge = 0.1, kHalfHeight = 0.5, kTooth = kEdge;
  constexpr int kLong = 40, kHinge = 8, kThick = 4, kWide = 10;
  const auto filled = [](const Vector3i& c) { return c.x() < kHinge || c.y() != kThick; };
  const auto toPosition = [gap](const Vector3i& c) -> Vector3d {
    const bool lower = c.y() <= kThick;
    // The teeth's flanks are at 45 degrees: the gap across them is less than that upwards.
    const double tooth = c.x() <= kHinge ? 0.0 : kTooth * zigzag(c.x() - kHinge);
    const double inner = tooth + std::sqrt(0.5) * (lower ? -gap : gap), outer = lower ? -kHalfHeight : kHalfHeight;
    const double fraction = (lower ? c.y() : 2 * kThick + 1 - c.y()) / static_cast<double>(kThick);
    return {kEdge * c.x(), outer + fraction * (inner - outer), kEdge * c.z()};
  };
  constexpr double kPlaneX = 1.2;
  return {"jaw", cellSurface({kLong, 2 * kThick + 1, kWide}, filled, toPosition),
          Plane(Vector3d::UnitX(), kPlaneX * Vector3d::UnitX()), 2, gap};
}

ComponentModel claw(double gap) {
  constexpr double kRoot = 0.3, kTip = 0.1, kPlaneX = 0.4;
  const double turn = 2.0 * kPi - std::asin(gap / (1.0 - kTip));
  const auto centre = [=](double t) { return Vector3d(std::cos(turn * t), std::sin(turn * t), 0.0); };
  const auto radius = [=](double t) { return kRoot + t * (kTip - kRoot); };
  return {"claw", surfaceOf({centre, radius, Vector3d::UnitZ()}), Plane(Vector3d::UnitX(), kPlaneX * Vector3d::UnitX()),
          2, gap};
}

ComponentModel chain(int rings, double gap) {
  constexpr double kThin = 0.25;
  const double step = 2.0 - 2.0 * kThin - gap;
  ComponentModel model{"chain", {}, {}, rings, gap};
  for (int ring = 0; ring < rings; ++ring) {
    const Vector3d across = ring % 2 == 0 ? Vector3d::UnitY() : Vector3d::UnitZ();
    const auto centre = [=](double t) -> Vector3d {
      return (step * ring + std::cos(2.0 * kPi * t)) * Vector3d::UnitX() + std::sin(2.0 * kPi * t) * across;
    };
    append(model.mesh, surfaceOf({centre, constant(kThin), across.cross(Vector3d::UnitX()), true}));
  }
  return model;
}

ComponentModel coil(int turns, double gap) {
  constexpr double kThin = 0.2;
  constexpr int kRingsOfTurn = 48;
  const double between = 2.0 * kThin + gap;  // distance of turns, perpendicular to them
  const double rise = between / std::sqrt(1.0 - std::pow(between / (2.0 * kPi), 2.0));
  const auto centre = [=](double t) {
    const double angle = 2.0 * kPi * turns * t;
    return Vector3d(std::cos(angle), std::sin(angle), rise * turns * t);
  };
  // The coil starts and ends in the middle of a half turn beyond the plane.
  return {"coil", surfaceOf({centre, constant(kThin), Vector3d::UnitZ(), false, kRingsOfTurn * turns}),
          Plane(Vector3d::UnitX(), Vector3d::Zero()), turns + 1, gap};
}

ComponentModel sheet() {
  return {"sheet", square(0.0), {}, 1};
}

ComponentModel twoSheets(double gap) {
  ComponentModel model{"two sheets", square(0.0), {}, 2, gap};
  append(model.mesh, square(gap));
  return model;
}

ComponentModel crossedBoxes() {
  ComponentModel model{"crossed boxes", cellBox({30, 10, 10}, 0.1), {}, 1};
  append(model.mesh, cellBox({8, 24, 8}, 0.11));
  return model;
}

std::vector<ComponentModel> componentModels() {
  constexpr double kGap = 0.04;
  return {twoPlates(kGap), jaw(kGap), claw(kGap),      chain(3, kGap),
          coil(4, kGap),   sheet(),   twoSheets(kGap), crossedBoxes()};
}

}  // namespace tetskin::test
