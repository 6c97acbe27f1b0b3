// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "replay_models.h"

#include <map>
#include <utility>

namespace tetskin::test {
namespace {

using Integers = std::array<int, 3>;

/// Cubes of six tets each, which go from corner to opposite corner along the axes in one of their orders.
TetMesh latticeOf(const Integers& cubes, double edge) {
  TetMesh mesh;
  const Integers nodes{cubes[0] + 1, cubes[1] + 1, cubes[2] + 1};
  const auto number = [&](const Integers& p) { return p[0] + nodes[0] * (p[1] + nodes[1] * p[2]); };
  for (int n = 0; n < nodes[0] * nodes[1] * nodes[2]; ++n) {
    const Integers p{n % nodes[0], n / nodes[0] % nodes[1], n / (nodes[0] * nodes[1])};
    mesh.nodes.emplace_back(0.5 * edge * (2 * p[0] - cubes[0]), 0.5 * edge * (2 * p[1] - cubes[1]),
                            0.5 * edge * (2 * p[2] - cubes[2]));
  }
  constexpr int kOrders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
  for (int n = 0; n < cubes[0] * cubes[1] * cubes[2]; ++n) {
    const Integers low{n % cubes[0], n / cubes[0] % cubes[1], n / (cubes[0] * cubes[1])};
    for (const auto& order : kOrders) {
      Integers corner = low;
      Tet tet{number(corner)};
      for (int k = 0; k < 3; ++k) {
        ++corner[order[k]];
        tet[k + 1] = number(corner);
      }
      const bool even = (order[0] + 1) % 3 == order[1];
      if (!even) std::swap(tet[2], tet[3]);
      mesh.tets.push_back(tet);
    }
  }
  return mesh;
}

/// The surface of a box of squares with integer corners from 0 to `squares`.
struct BoxSurface {
  std::vector<Integers> corners;
  std::vector<std::array<int, 3>> triangles;
};

BoxSurface boxSurface(const Integers& squares) {
  BoxSurface made;
  std::map<Integers, int> numbers;
  const auto number = [&](const Integers& p) {
    const auto [found, added] = numbers.try_emplace(p, static_cast<int>(made.corners.size()));
    if (added) made.corners.push_back(p);
    return found->second;
  };
  for (int side = 0; side < 6; ++side) {
    const int axis = side / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (int n = 0; n < squares[u] * squares[v]; ++n) {
      std::array<int, 4> square{};
      for (int k = 0; k < 4; ++k) {
        Integers p{};
        p[axis] = side % 2 * squares[axis];
        p[u] = n % squares[u] + (k == 1 || k == 2);
        p[v] = n / squares[u] + (k >= 2);
        square[k] = number(p);
      }
      if (side % 2 == 0) std::swap(square[1], square[3]);
      made.triangles.push_back({square[0], square[1], square[2]});
      made.triangles.push_back({square[0], square[2], square[3]});
    }
  }
  return made;
}

void bind(ReplayModel& model) {
  model.binding = SoftBodyBinding::create(model.cage, model.mesh).value();
}

}  // namespace

const std::shared_ptr<const ContactShape>& ReplayModel::shape() {
  if (!shape_) {
    ContactShapeOptions options;
    options.gridResolution = 16;
    options.sampleCount = 250;
    shape_ = ContactShape::create(cage, mesh, options).value();
  }
  return shape_;
}

ReplayModel ballModel(int cubes, int squares) {
  ReplayModel model;
  model.cage = latticeOf({cubes, cubes, cubes}, 1.0 / cubes);
  BoxSurface surface = boxSurface({squares, squares, squares});
  for (const Integers& p : surface.corners) {
    const Integers q{2 * p[0] - squares, 2 * p[1] - squares, 2 * p[2] - squares};
    const double radius = 0.46875 / std::sqrt(static_cast<double>(q[0] * q[0] + q[1] * q[1] + q[2] * q[2]));
    model.mesh.positions.emplace_back(radius * q[0], radius * q[1], radius * q[2]);
  }
  model.mesh.triangles = std::move(surface.triangles);
  bind(model);
  return model;
}

ReplayModel barModel(int length, int width, double edge) {
  ReplayModel model;
  model.cage = latticeOf({length, width, width}, edge);
  const Integers squares{2 * length, 2 * width, 2 * width};
  BoxSurface surface = boxSurface(squares);
  for (const Integers& p : surface.corners) {
    Eigen::Vector3d position;
    for (int k = 0; k < 3; ++k) {
      const int inset = p[k] == 0 ? 1 : p[k] == squares[k] ? -1 : 0;
      position[k] = edge * (3 * (p[k] - squares[k] / 2) + inset) / 6;
    }
    model.mesh.positions.push_back(position);
  }
  model.mesh.triangles = std::move(surface.triangles);
  bind(model);
  return model;
}

TetMesh movedBy(TetMesh mesh, const Eigen::Vector3d& offset) {
  for (Eigen::Vector3d& p : mesh.nodes) p += offset;
  return mesh;
}

}  // namespace tetskin::test
