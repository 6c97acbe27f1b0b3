// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/disjoint_sets.h>
#include <tetskin/core/src/base/mesh/weld.h>
#include <tetskin/elastic/src/dynamics/pressure_surface.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>
#include <type_traits>

namespace tetskin::elastic_detail {
namespace {

using Eigen::Vector3d;
using Corners = std::array<int, 3>;

/// Faces, or vertices, of a task.
constexpr std::size_t kPerTask = 2048;

std::size_t taskCount(std::size_t items) {
  return (items + kPerTask - 1) / kPerTask;
}

/// Runs call(k) for each item.
template <class Call>
void forItems(ParallelFor* threads, std::size_t items, Call&& call) {
  runTasks(threads, taskCount(items), [&](std::size_t task) {
    for (std::size_t k = kPerTask * task; k < std::min(items, kPerTask * (task + 1)); ++k) call(k);
  });
}

/// The faces of tets that no other tet shares. Key: sorted corners; of an odd number of faces, one is left.
template <class Face>
std::vector<Face> unshared(const std::vector<Face>& faces) {
  const auto keyOf = [&](std::size_t k) {
    Corners key = {static_cast<int>(faces[k][0]), static_cast<int>(faces[k][1]), static_cast<int>(faces[k][2])};
    std::sort(key.begin(), key.end());
    return key;
  };
  std::vector<std::pair<Corners, std::size_t>> order(faces.size());
  for (std::size_t k = 0; k < faces.size(); ++k) order[k] = {keyOf(k), k};
  std::sort(order.begin(), order.end());
  std::vector<Face> left;
  for (std::size_t k = 0, next = 0; k < order.size(); k = next) {
    while (next < order.size() && order[next].first == order[k].first) ++next;
    if ((next - k) % 2 == 1) left.push_back(faces[order[next - 1].second]);
  }
  return left;
}

/// An edge of a face.
struct Edge {
  std::array<int, 2> ends;  ///< ascending
  std::size_t face;
  int direction;  ///< 1 or -1
};

std::vector<Edge> sortedEdges(const std::vector<Corners>& faces) {
  std::vector<Edge> edges;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = faces[f][k], b = faces[f][(k + 1) % 3];
      edges.push_back({{std::min(a, b), std::max(a, b)}, f, a < b ? 1 : -1});
    }
  }
  std::sort(edges.begin(), edges.end(),
            [](const Edge& a, const Edge& b) { return a.ends != b.ends ? a.ends < b.ends : a.face < b.face; });
  return edges;
}

/// Numbers of the closed parts that edges of two faces join. Where four or more faces meet, as where two hollows touch,
/// parts stay apart if each of them is closed.
/// open  becomes the number of edges at which the surface ends
std::vector<int> closedParts(const std::vector<Corners>& faces, std::size_t& open) {
  const std::vector<Edge> edges = sortedEdges(faces);
  DisjointSets parts(faces.size());
  open = 0;
  for (const bool crossings : {false, true}) {
    for (std::size_t k = 0, next = 0; k < edges.size(); k = next) {
      while (next < edges.size() && edges[next].ends == edges[k].ends) ++next;
      if ((next - k > 2) != crossings) continue;
      std::map<int, int> balance;
      int sum = 0;
      for (std::size_t e = k; e < next; ++e) {
        balance[parts.find(static_cast<int>(edges[e].face))] += edges[e].direction;
        sum += edges[e].direction;
      }
      open += sum != 0;
      std::vector<int> joined;
      for (std::size_t e = k; e < next; ++e) {
        const int face = static_cast<int>(edges[e].face);
        if (!crossings || balance[parts.find(face)] != 0) joined.push_back(face);
      }
      for (const int face : joined) parts.unite(joined[0], face);
    }
  }
  return parts.numbers();
}

/// Points and weights, a third each, of a rule of degree 4 on a triangle: weights of corners (1 - 2 b, b, b).
struct FaceRule {
  double b, weight;
};
/// Dunavant's rule of six points.
constexpr FaceRule kFaceRules[2] = {{0.445948490915965, 0.223381589678011}, {0.091576213509771, 0.109951743655322}};

/// Of a quadratic triangle at a point: the shape functions, and their derivatives by the second and the third weight.
struct FaceShape {
  double value[6], byU[6], byV[6];
};
FaceShape shapeAt(double l0, double l1, double l2) {
  return {{l0 * (2 * l0 - 1), l1 * (2 * l1 - 1), l2 * (2 * l2 - 1), 4 * l0 * l1, 4 * l1 * l2, 4 * l2 * l0},
          {1 - 4 * l0, 4 * l1 - 1, 0, 4 * (l0 - l1), 4 * l2, -4 * l2},
          {1 - 4 * l0, 0, 4 * l2 - 1, -4 * l1, 4 * l1, 4 * (l0 - l2)}};
}

Vector3d at(const std::vector<double>& points, std::size_t k) {
  return Vector3d(points[3 * k], points[3 * k + 1], points[3 * k + 2]);
}

Status invalid(const std::string& message) {
  return {StatusCode::InvalidOption, message};
}

/// Triangles of a tet's faces, outwards; and of a quadratic tet's: nodes of each face, corners first.
constexpr int kFaces[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
/// A ray from the origin, in no direction that meshes often have.
constexpr double kRay[3] = {0.3819660112501051, 0.2360679774997897, 1.0};

/// Seen along the ray: twice the area that the origin spans with an edge. Opposite for the opposite edge, to the bit,
/// so that a ray between two faces meets one of them.
double besideRay(const Vector3d& a, const Vector3d& b, bool ascending) {
  if (!ascending) return -besideRay(b, a, true);
  const double ax = a[0] - kRay[0] * a[2], ay = a[1] - kRay[1] * a[2];
  const double bx = b[0] - kRay[0] * b[2], by = b[1] - kRay[1] * b[2];
  return ax * by - ay * bx;
}

/// 1 if the ray leaves a solid through this face, -1 if it enters it, and 0 if it does not meet the face. The sum over
/// a closed surface is how often it encloses the origin.
int crossing(const Vector3d (&x)[3], const Corners& corners) {
  double sides[3];  // by the corner opposite
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t a = (k + 1) % 3, b = (k + 2) % 3;
    sides[k] = besideRay(x[a], x[b], corners[a] < corners[b]);
    if (std::signbit(sides[k]) != std::signbit(sides[0])) return 0;
  }
  const double area = sides[0] + sides[1] + sides[2];
  const double ahead = sides[0] * x[0][2] + sides[1] * x[1][2] + sides[2] * x[2][2];  // times the area
  return area > 0.0 ? ahead > 0.0 : ahead < 0.0 ? -1 : 0;
}

/// By two corners: the number of the node between.
constexpr int kMiddles[4][4] = {{-1, 4, 5, 6}, {4, -1, 7, 8}, {5, 7, -1, 9}, {6, 8, 9, -1}};

}  // namespace

// ---- the surface of a body

Result<PressureSurface> PressureSurface::ofTets(const RestTets& rest) {
  if (rest.nodes.empty()) {
    return invalid("pressure needs a body whose tets fit together at rest: this one's shapes at rest were changed");
  }
  std::vector<QuadraticFace> quadratic;
  std::vector<Triangle> triangles;
  const auto node = [](int n) { return static_cast<std::uint32_t>(n); };
  const auto isPositive = [&](int a, int b, int c, int d) {
    const auto x = [&](int n) -> const Vector3d& { return rest.nodes[static_cast<std::size_t>(n)]; };
    return (x(b) - x(a)).cross(x(c) - x(a)).dot(x(d) - x(a)) > 0.0;
  };
  for (const RestQuadraticTet& tet : rest.quadratic) {
    const bool positive = isPositive(tet.nodes[0], tet.nodes[1], tet.nodes[2], tet.nodes[3]);
    for (const auto& face : kFaces) {
      const int a = face[0], b = face[positive ? 1 : 2], c = face[positive ? 2 : 1];
      const auto of = [&](int k) { return node(tet.nodes[static_cast<std::size_t>(k)]); };
      quadratic.push_back({of(a), of(b), of(c), of(kMiddles[a][b]), of(kMiddles[b][c]), of(kMiddles[c][a])});
    }
  }
  // Beside linear tets, quadratic faces would not meet theirs.
  if (!rest.tets.empty()) {
    for (const auto& [a, b, c, ab, bc, ca] : quadratic) {
      for (const Triangle& part : {Triangle{a, ab, ca}, Triangle{ab, b, bc}, Triangle{ca, bc, c}, Triangle{ab, bc, ca}})
        triangles.push_back(part);
    }
    quadratic.clear();
  }
  for (const Tet& tet : rest.tets) {
    const bool positive = isPositive(tet[0], tet[1], tet[2], tet[3]);
    for (const auto& face : kFaces) {
      triangles.push_back({node(tet[static_cast<std::size_t>(face[0])]),
                           node(tet[static_cast<std::size_t>(face[positive ? 1 : 2])]),
                           node(tet[static_cast<std::size_t>(face[positive ? 2 : 1])])});
    }
  }
  PressureSurface surface;
  surface.triangles_ = unshared(triangles);
  surface.quadratic_ = unshared(quadratic);
  for (const Vector3d& x : rest.nodes) surface.points_.insert(surface.points_.end(), x.data(), x.data() + 3);
  if (Status status = surface.choose("the boundary of the body's tets"); !status.ok()) return status;
  surface.index(nullptr);
  return surface;
}

Result<PressureSurface> PressureSurface::ofMesh(const std::vector<std::array<double, 3>>& positions,
                                                const std::vector<std::array<int, 3>>& triangles,
                                                const std::vector<SurfaceVertex>& vertices) {
  assert(positions.size() == vertices.size());
  PressureSurface surface;
  std::vector<Vector3d> points;
  for (const auto& x : positions) {
    surface.points_.insert(surface.points_.end(), x.begin(), x.end());
    points.emplace_back(x[0], x[1], x[2]);
  }
  const std::vector<std::uint32_t> first = weldCoincident(PointReader(viewOf(std::as_const(points))));
  for (const auto& face : triangles) {
    Triangle welded{};
    for (std::size_t k = 0; k < 3; ++k) welded[k] = first[static_cast<std::size_t>(face[k])];
    const bool flat = welded[0] == welded[1] || welded[1] == welded[2] || welded[2] == welded[0];
    if (!flat) surface.triangles_.push_back(welded);
  }
  if (Status status = surface.choose("the surface of the pressure"); !status.ok()) return status;
  surface.index(&vertices);
  return surface;
}

/// Hollows have walls that face into them: seen as solids, their volume is below 0, and they lie in others. What lies
/// outside was only wound the other way.
Status PressureSurface::choose(const std::string& name) {
  std::vector<Corners> faces;
  const auto corners = [](const auto& face) {
    return Corners{static_cast<int>(face[0]), static_cast<int>(face[1]), static_cast<int>(face[2])};
  };
  for (const Triangle& face : triangles_) faces.push_back(corners(face));
  for (const QuadraticFace& face : quadratic_) faces.push_back(corners(face));
  std::size_t open = 0;
  const std::vector<int> parts = closedParts(faces, open);
  if (open > 0) {
    return invalid(name + " is not closed: it ends at " + std::to_string(open) +
                   " edges, or its triangles do not all face the same way");
  }
  std::vector<double> volumes(faces.size(), 0.0);
  double size = 0.0;
  const Vector3d origin =
      faces.empty() ? Vector3d(Vector3d::Zero()) : at(points_, static_cast<std::size_t>(faces[0][0]));
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const auto x = [&](std::size_t k) { return Vector3d(at(points_, static_cast<std::size_t>(faces[f][k])) - origin); };
    const double volume = x(0).dot(x(1).cross(x(2))) / 6.0;
    volumes[static_cast<std::size_t>(parts[f])] += volume;
    size += std::abs(volume);
  }
  constexpr double kNothing = 1e-9;  // share of all pyramids over the faces, below which a part encloses nothing
  std::vector<char> hollows(faces.size(), 0), seen(faces.size(), 0);  // by part
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const auto part = static_cast<std::size_t>(parts[f]);
    if (std::exchange(seen[part], char(1)) || !(volumes[part] < -kNothing * size)) continue;
    // The middle of a face: its corners may be those of other parts.
    Vector3d from = Vector3d::Zero();
    for (const int corner : faces[f]) from += at(points_, static_cast<std::size_t>(corner)) / 3.0;
    int winding = 0;
    for (std::size_t g = 0; g < faces.size(); ++g) {
      const auto x = [&](std::size_t k) { return Vector3d(at(points_, static_cast<std::size_t>(faces[g][k])) - from); };
      if (volumes[static_cast<std::size_t>(parts[g])] > 0.0) winding += crossing({x(0), x(1), x(2)}, faces[g]);
    }
    hollows[part] = winding > 0;
  }
  const bool hollow = std::find(hollows.begin(), hollows.end(), 1) != hollows.end();
  hollow_ = hollow;
  const auto acts = [&](std::size_t f) {
    const auto part = static_cast<std::size_t>(parts[f]);
    return hollow ? hollows[part] != 0 : std::abs(volumes[part]) > kNothing * size;
  };
  const auto keep = [&](auto& list, std::size_t firstFace) {
    std::size_t kept = 0;
    for (std::size_t k = 0; k < list.size(); ++k) {
      if (!acts(firstFace + k)) continue;
      auto face = list[k];
      if (volumes[static_cast<std::size_t>(parts[firstFace + k])] < 0.0) {
        std::swap(face[1], face[2]);
        constexpr std::size_t nodes = std::tuple_size_v<std::decay_t<decltype(face)>>;
        if constexpr (nodes > 3) std::swap(face[3], face[5]);
      }
      list[kept++] = face;
    }
    list.resize(kept);
  };
  const std::size_t linear = triangles_.size();
  keep(triangles_, 0);
  keep(quadratic_, linear);
  if (faceCount() == 0) return invalid(name + " encloses no volume");
  return {};
}

void PressureSurface::index(const std::vector<SurfaceVertex>* vertices) {
  // Vertices that faces use get new numbers.
  std::map<std::uint32_t, std::uint32_t> numbers;
  const auto forVertices = [&](auto&& call) {
    for (Triangle& face : triangles_) std::for_each(face.begin(), face.end(), call);
    for (QuadraticFace& face : quadratic_) std::for_each(face.begin(), face.end(), call);
  };
  forVertices([&](std::uint32_t v) { numbers[v] = 0; });
  std::vector<SurfaceVertex> used;
  std::vector<double> points;
  std::map<std::uint32_t, std::uint32_t> places;
  for (auto& [vertex, number] : numbers) {
    number = static_cast<std::uint32_t>(used.size());
    used.push_back(vertices ? (*vertices)[vertex] : SurfaceVertex{{{static_cast<int>(vertex), 1.0}}});
    for (std::size_t k = 0; k < 3; ++k) points.push_back(points_[3 * vertex + k]);
    for (const auto& [node, weight] : used.back()) {
      if (weight != 0.0) places[static_cast<std::uint32_t>(node)] = 0;
    }
  }
  forVertices([&](std::uint32_t& v) { v = numbers[v]; });
  for (auto& [node, place] : places) {
    place = static_cast<std::uint32_t>(nodes_.size());
    nodes_.push_back(node);
  }
  std::vector<Entry> ofVertices, ofNodes, corners;
  for (std::uint32_t v = 0; v < used.size(); ++v) {
    for (const auto& [node, weight] : used[v]) {
      if (weight == 0.0) continue;
      const std::uint32_t place = places[static_cast<std::uint32_t>(node)];
      ofVertices.push_back({v, place, weight});
      ofNodes.push_back({place, v, weight});
    }
  }
  std::uint32_t corner = 0;
  for (const Triangle& face : triangles_) {
    for (const std::uint32_t v : face) corners.push_back({v, corner, 1.0});
    ++corner;
  }
  for (const QuadraticFace& face : quadratic_) {
    for (const std::uint32_t v : face) corners.push_back({v, corner++, 1.0});
  }
  if (vertices) nodesOf_ = listsOf(ofVertices, used.size());
  if (vertices) verticesOf_ = listsOf(ofNodes, nodes_.size());
  cornersOf_ = listsOf(corners, used.size());
  corners_.assign(3 * corner, 0.0);
  vectors_.assign(3 * used.size(), 0.0);
  positions_.assign(3 * nodes_.size(), 0.0);
  derivative_ = positions_;
  partial_.assign(taskCount(faceCount()), 0.0);
  points_ = std::move(points);
  restVolume_ = sumOfFaces(nullptr);
}

PressureSurface::Lists PressureSurface::listsOf(std::vector<Entry> entries, std::size_t owners) {
  std::stable_sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.owner < b.owner; });
  Lists lists;
  lists.starts.assign(owners + 1, 0);
  for (const Entry& entry : entries) {
    ++lists.starts[entry.owner + 1];
    lists.items.push_back(entry.item);
    lists.factors.push_back(entry.factor);
  }
  std::partial_sum(lists.starts.begin(), lists.starts.end(), lists.starts.begin());
  return lists;
}

// ---- the volume

/// Sums of vectors by lists.
void PressureSurface::gather(const Lists& lists, const std::vector<double>& from, std::vector<double>& to,
                             ParallelFor* threads) {
  forItems(threads, lists.starts.size() - 1, [&](std::size_t owner) {
    double x = 0.0, y = 0.0, z = 0.0;
    for (std::size_t k = lists.starts[owner]; k < lists.starts[owner + 1]; ++k) {
      const double factor = lists.factors[k], *v = &from[3 * lists.items[k]];
      x += factor * v[0];
      y += factor * v[1];
      z += factor * v[2];
    }
    to[3 * owner] = x;
    to[3 * owner + 1] = y;
    to[3 * owner + 2] = z;
  });
}

double PressureSurface::evaluate(bool derivative, ParallelFor* threads) {
  const bool ownNodes = nodesOf_.items.empty();  // vertices are nodes, in the same order
  if (ownNodes) std::copy(positions_.begin(), positions_.end(), points_.begin());
  if (!ownNodes) gather(nodesOf_, positions_, points_, threads);
  const double volume = sumOfFaces(threads);
  if (!derivative) return volume;
  gather(cornersOf_, corners_, ownNodes ? derivative_ : vectors_, threads);
  if (!ownNodes) gather(verticesOf_, vectors_, derivative_, threads);
  return volume;
}

void PressureSurface::takeAsRest() {
  const double volume = evaluate(false, nullptr);
  if (volume > 0.0) restVolume_ = volume;
}

double PressureSurface::sumOfFaces(ParallelFor* threads) {
  const std::size_t faces = faceCount();
  runTasks(threads, partial_.size(), [&](std::size_t task) {
    double sum = 0.0;
    for (std::size_t f = kPerTask * task; f < std::min(faces, kPerTask * (task + 1)); ++f) {
      const std::size_t k = f - triangles_.size();
      sum += f < triangles_.size() ? volumeOf(triangles_[f], &corners_[3 * f])
                                   : volumeOf(quadratic_[k], &corners_[3 * (triangles_.size() + 6 * k)]);
    }
    partial_[task] = sum;
  });
  return std::accumulate(partial_.begin(), partial_.end(), 0.0);
}

/// Of the pyramid from the first vertex to the face; a third of the area belongs to each corner.
double PressureSurface::volumeOf(const Triangle& face, double* corner) const {
  const double *o = points_.data(), *a = o + 3 * face[0], *b = o + 3 * face[1], *c = o + 3 * face[2];
  const double u[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]}, v[3] = {c[0] - a[0], c[1] - a[1], c[2] - a[2]};
  corner[0] = (u[1] * v[2] - u[2] * v[1]) / 6.0;
  corner[1] = (u[2] * v[0] - u[0] * v[2]) / 6.0;
  corner[2] = (u[0] * v[1] - u[1] * v[0]) / 6.0;
  return corner[0] * (a[0] - o[0]) + corner[1] * (a[1] - o[1]) + corner[2] * (a[2] - o[2]);
}

double PressureSurface::volumeOf(const QuadraticFace& face, double* corners) const {
  Vector3d x[6], sums[6];
  for (std::size_t n = 0; n < 6; ++n) {
    x[n] = at(points_, face[n]) - at(points_, 0);
    sums[n].setZero();
  }
  double volume = 0.0;
  for (const FaceRule& rule : kFaceRules) {
    for (int corner = 0; corner < 3; ++corner) {
      double l[3] = {rule.b, rule.b, rule.b};
      l[corner] = 1.0 - 2.0 * rule.b;
      const FaceShape shape = shapeAt(l[0], l[1], l[2]);
      Vector3d point = Vector3d::Zero(), u = point, v = point;
      for (int n = 0; n < 6; ++n) {
        point += shape.value[n] * x[n];
        u += shape.byU[n] * x[n];
        v += shape.byV[n] * x[n];
      }
      const Vector3d area = 0.5 * rule.weight * u.cross(v);
      for (int n = 0; n < 6; ++n) sums[n] += shape.value[n] * area;
      volume += area.dot(point) / 3.0;
    }
  }
  for (int n = 0; n < 6; ++n) std::copy_n(sums[n].data(), 3, corners + 3 * n);
  return volume;
}

}  // namespace tetskin::elastic_detail
