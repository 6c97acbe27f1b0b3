// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "support/odd_meshes.h"

#include <cmath>
#include <random>

namespace tetskin::test {
namespace {

double uniform(std::mt19937& generator) {
  return static_cast<double>(generator()) / 4294967296.0;  // the same on every standard library
}

TetMesh lattice(const std::vector<double>& xs, const std::vector<double>& ys, const std::vector<double>& zs) {
  TetMesh mesh;
  const int nx = static_cast<int>(xs.size()), ny = static_cast<int>(ys.size());
  for (const double z : zs) {
    for (const double y : ys) {
      for (const double x : xs) mesh.nodes.emplace_back(x, y, z);
    }
  }
  // Kuhn's six tets: from corner 0 to corner 7 along each order of the three axes.
  constexpr int kOrders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
  for (int k = 0; k + 1 < static_cast<int>(zs.size()); ++k) {
    for (int j = 0; j + 1 < ny; ++j) {
      for (int i = 0; i + 1 < nx; ++i) {
        for (const auto& order : kOrders) {
          std::array<int, 3> corner{i % 2, j % 2, k % 2};  // mirrored in odd cubes
          Tet tet{};
          for (int n = 0; n < 4; ++n) {
            if (n > 0) corner[order[n - 1]] ^= 1;
            tet[n] = (i + corner[0]) + nx * ((j + corner[1]) + ny * (k + corner[2]));
          }
          mesh.tets.push_back(tet);
        }
      }
    }
  }
  static_cast<void>(repairTetMesh(mesh));
  return mesh;
}

std::vector<double> steps(int count, double edge) {
  std::vector<double> values(count + 1);
  for (int i = 0; i <= count; ++i) values[i] = i * edge;
  return values;
}

}  // namespace

TetMesh singleTet() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2, 3}}};
}

TetMesh latticeCage(int nx, int ny, int nz, double edge) {
  return lattice(steps(nx, edge), steps(ny, edge), steps(nz, edge));
}

TetMesh randomTets(std::size_t count, double size, unsigned seed) {
  std::mt19937 generator(seed);
  TetMesh mesh;
  for (std::size_t t = 0; t < count; ++t) {
    const Eigen::Vector3d base(uniform(generator), uniform(generator), uniform(generator));
    for (int k = 0; k < 4; ++k) {
      const Eigen::Vector3d offset(uniform(generator), uniform(generator), uniform(generator));
      mesh.nodes.push_back(base + size * (offset - Eigen::Vector3d::Constant(0.5)));
    }
    const int n = static_cast<int>(4 * t);
    mesh.tets.push_back({n, n + 1, n + 2, n + 3});
  }
  static_cast<void>(repairTetMesh(mesh));
  return mesh;
}

TetMesh gradedCage() {
  std::vector<double> values(11);
  for (int i = 0; i <= 10; ++i) values[i] = std::pow(i / 10.0, 3.0);
  return lattice(values, values, values);
}

TetMesh thinLayerCage(double thickness) {
  return lattice(steps(4, 0.25), {0.0, 0.25, 0.5, 0.5 + thickness}, steps(4, 0.25));
}

TetMesh overlappingCage() {
  TetMesh mesh = latticeCage(4, 4, 4, 0.25);
  const TetMesh second = mesh;
  const int shift = static_cast<int>(mesh.nodeCount());
  for (const Eigen::Vector3d& p : second.nodes) mesh.nodes.push_back(p + Eigen::Vector3d(0.13, 0.11, 0.12));
  for (Tet tet : second.tets) {
    for (int& n : tet) n += shift;
    mesh.tets.push_back(tet);
  }
  return mesh;
}

TriangleMesh sphere(int rings, double radius, const Eigen::Vector3d& centre) {
  constexpr double kPi = 3.14159265358979323846;
  TriangleMesh mesh;
  const int around = rings + 1;
  mesh.positions.push_back(centre + Eigen::Vector3d(0, radius, 0));
  for (int r = 1; r < rings; ++r) {
    for (int a = 0; a < around; ++a) {
      const double theta = kPi * r / rings, phi = 2.0 * kPi * a / around;
      mesh.positions.push_back(centre + radius * Eigen::Vector3d(std::sin(theta) * std::cos(phi), std::cos(theta),
                                                                 std::sin(theta) * std::sin(phi)));
    }
  }
  mesh.positions.push_back(centre - Eigen::Vector3d(0, radius, 0));
  const int last = static_cast<int>(mesh.vertexCount()) - 1;
  const auto at = [&](int r, int a) { return 1 + (r - 1) * around + a % around; };
  for (int a = 0; a < around; ++a) {
    mesh.triangles.push_back({0, at(1, a + 1), at(1, a)});
    for (int r = 1; r + 1 < rings; ++r) {
      mesh.triangles.push_back({at(r, a), at(r, a + 1), at(r + 1, a)});
      mesh.triangles.push_back({at(r, a + 1), at(r + 1, a + 1), at(r + 1, a)});
    }
    mesh.triangles.push_back({at(rings - 1, a), at(rings - 1, a + 1), last});
  }
  return mesh;
}

std::vector<Eigen::Vector3d> randomPoints(std::size_t count, const Box3& box, unsigned seed) {
  std::mt19937 generator(seed);
  std::vector<Eigen::Vector3d> points(count);
  for (Eigen::Vector3d& p : points) {
    const Eigen::Vector3d u(uniform(generator), uniform(generator), uniform(generator));
    p = box.min() + u.cwiseProduct(box.sizes());
  }
  return points;
}

std::vector<Eigen::Vector3d> scaledAndMoved(std::vector<Eigen::Vector3d> points, double scale,
                                            const Eigen::Vector3d& offset) {
  for (Eigen::Vector3d& p : points) p = scale * p + offset;
  return points;
}

}  // namespace tetskin::test
