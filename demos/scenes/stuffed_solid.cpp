// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "scenes/stuffed_solid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <unordered_map>

namespace tetskin::scenes {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;

/// A node that is this near to where the surface cuts an edge, as a share of the edge, is moved there, as the tets cut
/// off would be flat. The values are those of the paper, with which no tet is inverted.
constexpr double kNearLongEdge = 0.249, kNearShort = 0.411;

enum class Wanted { Everything, Surface };

/// The nodes, in units of half a cube's side: corners have even coordinates, centres odd ones.
class Lattice {
 public:
  Lattice(const Box3& box, double spacing)
      : origin_(box.min() - Vector3d::Constant(spacing)),
        half_(0.5 * spacing),
        cubes_((box.sizes() / spacing).array().ceil().cast<int>() + 3) {}

  const Vector3i& cubes() const { return cubes_; }
  std::size_t nodeCount() const { return 2 * corners(); }
  std::size_t index(const Vector3i& node) const {
    const Vector3i cube = node / 2;
    const auto x = static_cast<std::size_t>(cube.x()), y = static_cast<std::size_t>(cube.y());
    const auto z = static_cast<std::size_t>(cube.z());
    return 2 * ((z * side(1) + y) * side(0) + x) + static_cast<std::size_t>(node.x() % 2);
  }
  Vector3d point(const Vector3i& node) const { return origin_ + half_ * node.cast<double>(); }

  /// All nodes, in order of their indices.
  template <class Visit>
  void forEachNode(const Visit& visit) const {
    for (int z = 0; z < cubes_.z(); ++z) {
      for (int y = 0; y < cubes_.y(); ++y) {
        for (int x = 0; x < cubes_.x(); ++x) {
          visit(Vector3i(2 * x, 2 * y, 2 * z));
          visit(Vector3i(2 * x + 1, 2 * y + 1, 2 * z + 1));
        }
      }
    }
  }

  /// The tets around the box: four around every two neighbouring centres.
  template <class Visit>
  void forEachTet(const Visit& visit) const {
    for (int z = 1; z < cubes_.z(); ++z) {
      for (int y = 1; y < cubes_.y(); ++y) {
        for (int x = 1; x < cubes_.x(); ++x) {
          const Vector3i centre = Vector3i(2 * x, 2 * y, 2 * z) - Vector3i::Ones();
          for (int axis = 0; axis < 3; ++axis) visitAround(centre, axis, visit);
        }
      }
    }
  }

 private:
  std::size_t side(int axis) const { return static_cast<std::size_t>(cubes_[axis]); }
  std::size_t corners() const { return side(0) * side(1) * side(2); }

  template <class Visit>
  void visitAround(const Vector3i& centre, int axis, const Visit& visit) const {
    const Vector3i d = Vector3i::Unit(axis), u = Vector3i::Unit((axis + 1) % 3), v = Vector3i::Unit((axis + 2) % 3);
    const std::array<Vector3i, 4> ring = {d - u - v, d + u - v, d + u + v, d - u + v};
    for (int k = 0; k < 4; ++k) {
      visit(std::array<Vector3i, 4>{centre, centre + 2 * d, centre + ring[k], centre + ring[(k + 1) % 4]});
    }
  }

  Vector3d origin_;
  double half_;
  Vector3i cubes_;
};

class Stuffing {
 public:
  Stuffing(const ImplicitSolid& solid, double spacing) : solid_(solid), lattice_(solid.box, spacing) {
    values_.reserve(lattice_.nodeCount());
    lattice_.forEachNode([&](const Vector3i& node) { values_.push_back(solid_.value(lattice_.point(node))); });
    snapNodes();
  }

  void fill(Wanted wanted) {
    lattice_.forEachTet([&](const std::array<Vector3i, 4>& nodes) { fillTet(nodes, wanted); });
  }
  const TetMesh& mesh() const { return mesh_; }
  bool onSurface(int node) const { return onSurface_[static_cast<std::size_t>(node)]; }

 private:
  double value(const Vector3i& node) const { return values_[lattice_.index(node)]; }

  /// The position at which the surface cuts an edge of the lattice, as a share from `a`, by regula falsi.
  double cut(const Vector3i& a, const Vector3i& b) const {
    constexpr int kSteps = 8;
    const Vector3d start = lattice_.point(a), edge = lattice_.point(b) - start;
    double low = 0.0, high = 1.0, atLow = value(a), atHigh = value(b), fraction = 0.0;
    for (int step = 0; step < kSteps; ++step) {
      fraction = (low * atHigh - high * atLow) / (atHigh - atLow);
      const double found = solid_.value(start + fraction * edge);
      if (found == 0.0) break;
      if ((found < 0.0) == (atLow < 0.0)) {
        low = fraction, atLow = found, atHigh *= 0.5;
      } else {
        high = fraction, atHigh = found, atLow *= 0.5;
      }
    }
    return fraction;
  }

  void snapNodes() {
    std::vector<Vector3i> around;
    for (int axis = 0; axis < 3; ++axis) {
      for (int sign : {-2, 2}) around.push_back(sign * Vector3i::Unit(axis));
    }
    for (int bits = 0; bits < 8; ++bits) around.emplace_back(bits & 1 ? 1 : -1, bits & 2 ? 1 : -1, bits & 4 ? 1 : -1);
    lattice_.forEachNode([&](const Vector3i& node) { snap(node, around); });
  }

  void snap(const Vector3i& node, const std::vector<Vector3i>& around) {
    double& own = values_[lattice_.index(node)];
    double nearest = std::numeric_limits<double>::infinity();
    for (const Vector3i& step : around) {
      const Vector3i other = node + step;
      if ((other.array() < 0).any() || ((other / 2).array() >= lattice_.cubes().array()).any()) continue;
      if (value(other) * own >= 0.0) continue;
      const double fraction = cut(node, other);
      if (fraction > (step.squaredNorm() == 4 ? kNearLongEdge : kNearShort)) continue;
      const Vector3d edge = lattice_.point(other) - lattice_.point(node);
      if (fraction * edge.norm() >= nearest) continue;
      nearest = fraction * edge.norm();
      snapped_[lattice_.index(node)] = lattice_.point(node) + fraction * edge;
    }
    if (std::isfinite(nearest)) own = 0.0;
  }

  int append(const Vector3d& latticePoint, bool onSurface) {
    mesh_.nodes.push_back(solid_.position(latticePoint));
    onSurface_.push_back(onSurface);
    return static_cast<int>(mesh_.nodes.size()) - 1;
  }

  int nodeAt(const Vector3i& node) {
    const std::size_t index = lattice_.index(node);
    const auto [found, isNew] = nodes_.try_emplace(index, 0);
    if (!isNew) return found->second;
    const auto moved = snapped_.find(index);
    return found->second =
               append(moved == snapped_.end() ? lattice_.point(node) : moved->second, values_[index] == 0.0);
  }

  int nodeOn(const Vector3i& inside, const Vector3i& outside) {
    const auto [found, isNew] =
        cuts_.try_emplace(lattice_.index(inside) * lattice_.nodeCount() + lattice_.index(outside), 0);
    if (!isNew) return found->second;
    const Vector3d start = lattice_.point(inside);
    return found->second = append(start + cut(inside, outside) * (lattice_.point(outside) - start), true);
  }

  void fillTet(std::array<Vector3i, 4> nodes, Wanted wanted) {
    const auto inside =
        std::count_if(nodes.begin(), nodes.end(), [&](const Vector3i& node) { return value(node) < 0.0; });
    if (inside == 0 || (inside == 4 && wanted == Wanted::Surface)) return;
    std::sort(nodes.begin(), nodes.end(), [&](const Vector3i& a, const Vector3i& b) { return value(a) < value(b); });
    /// The node, or the vertex where the surface cuts the edge to it.
    const auto end = [&](const Vector3i& from, const Vector3i& node) {
      return value(node) > 0.0 ? nodeOn(from, node) : nodeAt(node);
    };
    const auto& [a, b, c, d] = nodes;
    if (inside == 1 || value(d) <= 0.0) {
      addTet({nodeAt(a), end(a, b), end(a, c), end(a, d)});
    } else if (inside == 2) {
      addPrism({nodeAt(a), end(a, c), end(a, d), nodeAt(b), end(b, c), end(b, d)});
    } else {
      addPrism({nodeAt(a), nodeAt(b), nodeAt(c), end(a, d), end(b, d), end(c, d)});
    }
  }

  /// A prism with two triangles, corner k opposite corner k + 3: as three tets, with the diagonal of each side from the
  /// corner with the lowest index, so that neighbours agree. If both triangles share a corner, flat tets are left out.
  void addPrism(std::array<int, 6> p) {
    const auto first = std::min_element(p.begin(), p.end()) - p.begin();
    if (first >= 3) std::swap_ranges(p.begin(), p.begin() + 3, p.begin() + 3);
    std::rotate(p.begin(), p.begin() + first % 3, p.begin() + 3);
    std::rotate(p.begin() + 3, p.begin() + 3 + first % 3, p.end());
    addTet({p[0], p[4], p[5], p[3]});
    if (std::min(p[1], p[5]) < std::min(p[2], p[4])) {
      addTet({p[0], p[1], p[2], p[5]});
      addTet({p[0], p[1], p[5], p[4]});
    } else {
      addTet({p[0], p[1], p[2], p[4]});
      addTet({p[0], p[4], p[2], p[5]});
    }
  }

  void addTet(Tet tet) {
    for (int k = 0; k < 4; ++k) {
      if (std::count(tet.begin(), tet.end(), tet[k]) > 1) return;
    }
    const auto edge = [&](int corner) -> Vector3d { return mesh_.nodes[tet[corner]] - mesh_.nodes[tet[0]]; };
    if (edge(1).cross(edge(2)).dot(edge(3)) < 0.0) std::swap(tet[2], tet[3]);
    mesh_.tets.push_back(tet);
  }

  const ImplicitSolid& solid_;
  Lattice lattice_;
  std::vector<double> values_;  ///< by node of the lattice; 0: it is moved to the surface
  std::unordered_map<std::size_t, Vector3d> snapped_;
  std::unordered_map<std::size_t, int> nodes_, cuts_;  ///< indices in the mesh
  TetMesh mesh_;
  std::vector<bool> onSurface_;  ///< nodeCount of the mesh
};

std::size_t countOf(const TriangleMesh& mesh) {
  return mesh.triangleCount();
}
std::size_t countOf(const TetMesh& mesh) {
  return mesh.tetCount();
}

/// A mesh with the requested number of triangles or tets, which is roughly proportional to a power of the spacing.
template <class Make>
auto meshOf(std::size_t wish, double power, double maxSpacing, const Make& make) {
  constexpr double kFirst = 1.7, kNearEnough = 0.03;
  constexpr int kTrials = 5;
  double spacing = maxSpacing / kFirst;
  auto mesh = make(spacing);
  for (int trial = 1; trial < kTrials; ++trial) {
    const double ratio = static_cast<double>(countOf(mesh)) / static_cast<double>(wish);
    if (std::abs(ratio - 1.0) < kNearEnough) break;
    spacing = std::min(maxSpacing, spacing * std::pow(ratio, 1.0 / power));
    mesh = make(spacing);
  }
  return mesh;
}

}  // namespace

TetMesh tetsOf(const ImplicitSolid& solid, double spacing) {
  Stuffing stuffing(solid, spacing);
  stuffing.fill(Wanted::Everything);
  return stuffing.mesh();
}

TriangleMesh surfaceOf(const ImplicitSolid& solid, double spacing) {
  Stuffing stuffing(solid, spacing);
  stuffing.fill(Wanted::Surface);
  TriangleMesh mesh;
  std::unordered_map<int, int> vertices;
  for (std::array<int, 3> face : boundaryFaces(stuffing.mesh())) {
    // The other boundary of a layer of tets is inside the solid.
    if (!std::all_of(face.begin(), face.end(), [&](int node) { return stuffing.onSurface(node); })) continue;
    for (int& corner : face) {
      const auto [vertex, isNew] = vertices.try_emplace(corner, static_cast<int>(mesh.positions.size()));
      if (isNew) mesh.positions.push_back(stuffing.mesh().nodes[corner]);
      corner = vertex->second;
    }
    mesh.triangles.push_back(face);
  }
  return mesh;
}

TetMesh tetsOf(const ImplicitSolid& solid, std::size_t tets, double maxSpacing) {
  return meshOf(tets, 3.0, maxSpacing, [&](double spacing) { return tetsOf(solid, spacing); });
}

TriangleMesh surfaceOf(const ImplicitSolid& solid, std::size_t triangles, double maxSpacing) {
  return meshOf(triangles, 2.0, maxSpacing, [&](double spacing) { return surfaceOf(solid, spacing); });
}

void matchVolume(TetMesh& mesh, const std::function<double(const Vector3d&)>& distance) {
  std::vector<Vector3d> normals(mesh.nodeCount(), Vector3d::Zero());
  std::vector<double> areas(mesh.nodeCount(), 0.0), missing(mesh.nodeCount(), 0.0);
  for (const auto& face : boundaryFaces(mesh)) {
    const Vector3d &a = mesh.nodes[face[0]], &b = mesh.nodes[face[1]], &c = mesh.nodes[face[2]];
    const Vector3d normal = (b - a).cross(c - a);
    // The middles of the edges are a rule that is exact for the squares of what curves.
    const double gap = -(distance(0.5 * (a + b)) + distance(0.5 * (b + c)) + distance(0.5 * (c + a))) / 3.0;
    for (const int n : face) {
      normals[n] += normal;
      areas[n] += normal.norm();
      missing[n] += normal.norm() * gap;
    }
  }
  for (std::size_t n = 0; n < normals.size(); ++n) {
    if (areas[n] > 0.0) mesh.nodes[n] += missing[n] / areas[n] * normals[n].normalized();
  }
}

}  // namespace tetskin::scenes
