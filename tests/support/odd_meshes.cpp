// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "support/odd_meshes.h"

#include <algorithm>
#include <cmath>
#include <ostream>
#include <random>

namespace tetskin::test {
namespace {

double uniform(std::mt19937& generator) {
  return static_cast<double>(generator()) / 4294967296.0;  // the same on every standard library
}

/// Draws one number after the other, because the compiler chooses the order in which a call's arguments are evaluated.
Eigen::Vector3d uniformVector(std::mt19937& generator) {
  const double z = uniform(generator), y = uniform(generator), x = uniform(generator);
  return {x, y, z};
}

TetMesh lattice(const std::vector<double>& xs, const std::vector<double>& ys, const std::vector<double>& zs,
                bool mirrored = true) {
  TetMesh mesh;
  const int odd = mirrored ? 2 : 1;
  const int nx = static_cast<int>(xs.size()), ny = static_cast<int>(ys.size());
  for (const double z : zs) {
    for (const double y : ys) {
      for (const double x : xs) mesh.nodes.emplace_back(x, y, z);
    }
  }
  // Kuhn's six tets: each goes from corner 0 to corner 7 along one order of the three axes.
  constexpr int kOrders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
  for (int k = 0; k + 1 < static_cast<int>(zs.size()); ++k) {
    for (int j = 0; j + 1 < ny; ++j) {
      for (int i = 0; i + 1 < nx; ++i) {
        for (const auto& order : kOrders) {
          std::array<int, 3> corner{i % odd, j % odd, k % odd};  // mirrored in odd cubes
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

TetMesh plainLatticeCage(int nx, int ny, int nz, double edge) {
  return lattice(steps(nx, edge), steps(ny, edge), steps(nz, edge), false);
}

TetMesh bodyCentredCage(int nx, int ny, int nz, double edge) {
  TetMesh mesh;
  const auto cornerAt = [&](int i, int j, int k) { return i + (nx + 1) * (j + (ny + 1) * k); };
  const auto centreAt = [&](int i, int j, int k) { return (nx + 1) * (ny + 1) * (nz + 1) + i + nx * (j + ny * k); };
  for (int k = 0; k <= nz; ++k) {
    for (int j = 0; j <= ny; ++j) {
      for (int i = 0; i <= nx; ++i) mesh.nodes.emplace_back(edge * i, edge * j, edge * k);
    }
  }
  for (int k = 0; k < nz; ++k) {
    for (int j = 0; j < ny; ++j) {
      for (int i = 0; i < nx; ++i) mesh.nodes.emplace_back(edge * (i + 0.5), edge * (j + 0.5), edge * (k + 0.5));
    }
  }
  const std::array<int, 3> cubes{nx, ny, nz};
  for (int k = 0; k < nz; ++k) {
    for (int j = 0; j < ny; ++j) {
      for (int i = 0; i < nx; ++i) {
        for (int axis = 0; axis < 3; ++axis) {
          for (int side = 0; side < 2; ++side) {
            // The face of this cube across `axis`; its corners go around in a circle.
            const int p = (axis + 1) % 3, q = (axis + 2) % 3;
            std::array<int, 4> around{};
            for (int c = 0; c < 4; ++c) {
              std::array<int, 3> at{i, j, k};
              at[axis] += side;
              at[p] += c == 1 || c == 2;
              at[q] += c >= 2;
              around[c] = cornerAt(at[0], at[1], at[2]);
            }
            std::array<int, 3> next{i, j, k};
            next[axis] += side == 0 ? -1 : 1;
            const int centre = centreAt(i, j, k);
            if (next[axis] < 0 || next[axis] >= cubes[axis]) {  // on the outside: half an octahedron, cut in two
              mesh.tets.push_back({centre, around[0], around[1], around[2]});
              mesh.tets.push_back({centre, around[0], around[2], around[3]});
            } else if (side == 1) {
              const int other = centreAt(next[0], next[1], next[2]);
              for (int c = 0; c < 4; ++c) mesh.tets.push_back({centre, other, around[c], around[(c + 1) % 4]});
            }
          }
        }
      }
    }
  }
  static_cast<void>(repairTetMesh(mesh));
  return mesh;
}

TetMesh jittered(TetMesh cage, double amount, unsigned seed) {
  std::mt19937 generator(seed);
  for (Eigen::Vector3d& p : cage.nodes) {
    const Eigen::Vector3d u = uniformVector(generator);
    p += amount * (2.0 * u - Eigen::Vector3d::Ones());
  }
  static_cast<void>(repairTetMesh(cage));
  return cage;
}

const std::vector<LatticeKind>& latticeKinds() {
  const auto kind = [](const char* name, TetMesh (*make)(int, int, int, double), double jitter) -> LatticeKind {
    return {name, [make, jitter](int across) {
              const double edge = 1.0 / across;
              return jittered(make(across, across, across, edge), jitter * edge, 7 + static_cast<unsigned>(across));
            }};
  };
  static const std::vector<LatticeKind> kinds{
      kind("Plain", plainLatticeCage, 0.0),        kind("Mirrored", latticeCage, 0.0),
      kind("BodyCentred", bodyCentredCage, 0.0),   kind("PlainJittered", plainLatticeCage, 0.25),
      kind("MirroredJittered", latticeCage, 0.25), kind("BodyCentredJittered", bodyCentredCage, 0.25),
  };
  return kinds;
}

void PrintTo(const LatticeKind& kind, std::ostream* out) {
  *out << kind.name;
}

std::vector<int> boundaryTets(const TetMesh& cage) {
  std::vector<bool> onBoundary(cage.nodeCount(), false);
  for (const auto& face : boundaryFaces(cage)) {
    for (const int n : face) onBoundary[n] = true;
  }
  std::vector<int> tets;
  for (std::size_t t = 0; t < cage.tetCount(); ++t) {
    const Tet& tet = cage.tets[t];
    if (std::any_of(tet.begin(), tet.end(), [&](int n) { return onBoundary[n]; })) tets.push_back(static_cast<int>(t));
  }
  return tets;
}

std::vector<Eigen::Vector3d> pointsIn(const TetMesh& cage, const std::vector<int>& tets, unsigned seed) {
  std::mt19937 generator(seed);
  std::vector<Eigen::Vector3d> points;
  for (const int t : tets) {
    Eigen::Vector4d b;
    for (int k = 0; k < 4; ++k) b[k] = -std::log(1.0 - uniform(generator));
    b /= b.sum();
    Eigen::Vector3d p = Eigen::Vector3d::Zero();
    for (int k = 0; k < 4; ++k) p += b[k] * cage.nodes[cage.tets[t][k]];
    points.push_back(p);
  }
  return points;
}

std::vector<int> someOf(const std::vector<int>& values, std::size_t count, unsigned seed) {
  std::mt19937 generator(seed);
  std::vector<int> chosen(count);
  for (int& c : chosen) c = values[static_cast<std::size_t>(uniform(generator) * static_cast<double>(values.size()))];
  return chosen;
}

TetMesh randomTets(std::size_t count, double size, unsigned seed) {
  std::mt19937 generator(seed);
  TetMesh mesh;
  for (std::size_t t = 0; t < count; ++t) {
    const Eigen::Vector3d base = uniformVector(generator);
    for (int k = 0; k < 4; ++k) {
      const Eigen::Vector3d offset = uniformVector(generator);
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

TriangleMesh sphere(int rings, double radius, const Eigen::Vector3d& centre, int around) {
  constexpr double kPi = 3.14159265358979323846;
  TriangleMesh mesh;
  if (around == 0) around = rings + 1;
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

Box3 around(const TetMesh& cage, double factor) {
  const Box3 box = boundingBox(cage.nodes);
  const Eigen::Vector3d half = 0.5 * factor * box.sizes();
  return {box.center() - half, box.center() + half};
}

std::vector<Eigen::Vector3d> randomPoints(std::size_t count, const Box3& box, unsigned seed) {
  std::mt19937 generator(seed);
  std::vector<Eigen::Vector3d> points(count);
  for (Eigen::Vector3d& p : points) {
    const Eigen::Vector3d u = uniformVector(generator);
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
