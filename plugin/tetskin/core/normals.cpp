// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/normals.h>
#include <tetskin/core/skin_tasks.h>
#include <tetskin/core/tet_geometry.h>
#include <tetskin/core/weld.h>

namespace tetskin {
namespace {

using skin_tasks::firstItem;
using skin_tasks::taskCount;

constexpr std::size_t kTrianglesPerTask = 16384;
constexpr std::size_t kGroupsPerTask = 8192;
/// How far an authored normal's length may be from 1.
constexpr float kUnitTolerance = 0.1f;
constexpr double kDegree = 3.14159265358979323846 / 180.0;

/// A sum of face vectors as a unit vector; false where nothing is left of it.
template <class Scalar>
bool normalise(Eigen::Matrix<Scalar, 3, 1>& sum) {
  Scalar squared = sum.squaredNorm();
  if (!(squared > std::numeric_limits<Scalar>::min() && std::isfinite(squared))) {
    // Tiny or huge triangles: scale first, where there is anything to scale.
    const Scalar size = sum.cwiseAbs().maxCoeff();
    if (!(size > Scalar(0) && std::isfinite(size))) return false;
    sum /= size;
    squared = sum.squaredNorm();
    if (!std::isfinite(squared)) return false;  // the largest coordinate may not tell of another that is NaN
  }
  sum /= std::sqrt(squared);
  return true;
}

/// Squares between this and its inverse are far from the ends of float's range.
constexpr float kOrdinary = 1e-30f;

/// Vertices that share a normal, as lists: those at one position whose rest normals are within an angle of each other.
std::vector<std::uint32_t> smoothGroups(const TriangleMesh& mesh, double hardEdgeDegrees, std::size_t& groupCount) {
  const std::vector<std::uint32_t> first = weldCoincident(viewOf(mesh.positions));
  const bool authored = mesh.normals.size() == mesh.vertexCount();
  const auto limit = static_cast<float>(std::cos(hardEdgeDegrees * kDegree));
  constexpr std::uint32_t kNone = 0xFFFFFFFFu;
  // The groups at one position are chained by their first vertices.
  std::vector<std::uint32_t> groupOf(mesh.vertexCount(), kNone), next(mesh.vertexCount(), kNone);
  groupCount = 0;
  for (std::uint32_t v = 0; v < mesh.vertexCount(); ++v) {
    std::uint32_t other = first[v];
    std::uint32_t lastOther = kNone;
    while (other != kNone && other != v) {
      if (!authored || mesh.normals[v].dot(mesh.normals[other]) >= limit) break;
      lastOther = other;
      other = next[other];
    }
    if (other != kNone && other != v) {
      groupOf[v] = groupOf[other];
      continue;
    }
    if (lastOther != kNone) next[lastOther] = v;
    groupOf[v] = static_cast<std::uint32_t>(groupCount++);
  }
  return groupOf;
}

/// Starts of lists from their lengths, which come one place late.
void accumulate(std::vector<std::uint32_t>& starts) {
  for (std::size_t k = 1; k < starts.size(); ++k) starts[k] += starts[k - 1];
}

}  // namespace

std::vector<Eigen::Vector3d> restNormals(const TriangleMesh& mesh) {
  std::vector<Eigen::Vector3d> normals(mesh.vertexCount(), Eigen::Vector3d::Zero());
  const std::vector<std::uint32_t> first = weldCoincident(viewOf(mesh.positions));
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3d& a = mesh.positions[t[0]];
    const Eigen::Vector3d area = (mesh.positions[t[1]] - a).cross(mesh.positions[t[2]] - a);
    for (const int v : t) normals[first[v]] += area;
  }
  for (std::size_t v = 0; v < normals.size(); ++v) {
    if (first[v] < v) {
      normals[v] = normals[first[v]];  // already a unit vector
    } else if (!normalise(normals[v])) {
      normals[v] = Eigen::Vector3d::UnitY();
    }
  }
  if (mesh.normals.size() != mesh.vertexCount()) return normals;
  for (std::size_t v = 0; v < normals.size(); ++v) {
    const Eigen::Vector3f& n = mesh.normals[v];
    if (std::abs(n.norm() - 1.0f) < kUnitTolerance) normals[v] = n.cast<double>().normalized();
  }
  return normals;
}

template <class Factor>
DirectionFactors::DirectionFactors(const TetMesh& cage, const Embedding& embedding, bool normals, Factor&& factor)
    : normals_(normals) {
  for (std::vector<float>& plane : planes_) plane.resize(embedding.vertexCount() + Embedding::kPadding);
  for (std::size_t r = 0; r + 1 < embedding.runs().size(); ++r) {
    const TetCorners p = cornersOf(cage, cage.tets[embedding.runs()[r].tet]);
    for (std::uint32_t slot = embedding.runs()[r].firstSlot; slot < embedding.runs()[r + 1].firstSlot; ++slot) {
      const Eigen::Vector3d m = factor(p, embedding.slotVertices()[slot]);
      for (int k = 0; k < 3; ++k) planes_[static_cast<std::size_t>(k)][slot] = static_cast<float>(m[k]);
    }
  }
}

/// With E the current and P the rest edges (p0-p3, p1-p3, p2-p3), the gradient is G = E P^-1, and its cofactor matrix
/// cof(E) P^T / det(P): so a normal is cof(E) times the factors P^T n / det(P), whose columns are cross products of
/// E's.
DirectionFactors DirectionFactors::ofNormals(const TetMesh& cage, const Embedding& embedding,
                                             const std::vector<Eigen::Vector3d>& normals) {
  assert(normals.size() == embedding.vertexCount());
  return DirectionFactors(cage, embedding, true, [&](const TetCorners& p, std::uint32_t v) -> Eigen::Vector3d {
    Eigen::Matrix3d edges;
    edges << p[0] - p[3], p[1] - p[3], p[2] - p[3];
    return edges.transpose() * normals[v] / edges.determinant();
  });
}

/// A tangent is E times P^-1 t.
DirectionFactors DirectionFactors::ofTangents(const TetMesh& cage, const Embedding& embedding,
                                              const std::vector<Eigen::Vector3d>& tangents) {
  assert(tangents.size() == embedding.vertexCount());
  return DirectionFactors(cage, embedding, false, [&](const TetCorners& p, std::uint32_t v) -> Eigen::Vector3d {
    const BarycentricMap map(p);
    return {map.rows[0].dot(tangents[v]), map.rows[1].dot(tangents[v]), map.rows[2].dot(tangents[v])};
  });
}

template <class Scalar>
void transformDirections(const Embedding& embedding, const DirectionFactors& factors,
                         const QuadraticStencils<Scalar>* stencils, const EdgeVectors<Scalar>* edges,
                         const PackedNodes<Scalar>& nodes, PointView<float> out, VertexOrder order, float* scratch,
                         ParallelFor* threads, const std::uint8_t* movedRuns) {
  assert(out.size() == embedding.vertexCount());
  assert(!stencils == !edges);
  if (embedding.empty()) return;
  auto work = skin_tasks::workFor(embedding, nodes);
  work.surface = stencils ? kernels::Surface::Quadratic : kernels::Surface::Linear;
  if (stencils) {
    work.edges = edges->data();
    work.runEdges = stencils->runEdges().data();
  }
  kernels::DirectionPlanes planes;
  planes.kind = factors.areNormals() ? kernels::Direction::Normal : kernels::Direction::Tangent;
  for (int k = 0; k < 3; ++k) planes.factors[k] = factors.plane(k);
  const bool direct = skin_tasks::isDirect<float>(out, order);
  std::vector<float> ownScratch;
  if (!direct && !scratch) {
    ownScratch.resize(scratchSize(out.size()));
    scratch = ownScratch.data();
    skin_tasks::collect(embedding, out, order, scratch);
  }
  float* sorted = direct ? out.data() : scratch;
  const kernels::Table<Scalar>& table = kernels::tableInUse<Scalar>();
  skin_tasks::forAllRuns(embedding, work, movedRuns, threads, [&](const kernels::Work<Scalar>& part, std::size_t) {
    table.directions(part, planes, sorted);
  });
  if (!direct) skin_tasks::place(embedding, sorted, out, order, threads);
}

NormalTopology::NormalTopology(const TriangleMesh& mesh, const std::vector<std::uint32_t>& places,
                               double hardEdgeDegrees) {
  assert(places.empty() || places.size() == mesh.vertexCount());
  const auto placeOf = [&](std::size_t v) { return places.empty() ? static_cast<std::uint32_t>(v) : places[v]; };
  std::size_t groups = 0;
  const std::vector<std::uint32_t> groupOf = smoothGroups(mesh, hardEdgeDegrees, groups);

  groupTriangles_.assign(groups + 1, 0);
  groupPlaces_.assign(groups + 1, 0);
  for (const auto& t : mesh.triangles) {
    for (const int v : t) {
      triangles_.push_back(placeOf(static_cast<std::size_t>(v)));
      ++groupTriangles_[groupOf[v] + 1];
    }
  }
  for (const std::uint32_t group : groupOf) ++groupPlaces_[group + 1];
  accumulate(groupTriangles_);
  accumulate(groupPlaces_);

  corners_.resize(triangles_.size());
  places_.resize(mesh.vertexCount());
  std::vector<std::uint32_t> next(groupTriangles_.begin(), groupTriangles_.end() - 1);
  for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
    for (const int v : mesh.triangles[t]) corners_[next[groupOf[v]]++] = static_cast<std::uint32_t>(t);
  }
  next.assign(groupPlaces_.begin(), groupPlaces_.end() - 1);
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) places_[next[groupOf[v]]++] = placeOf(v);
}

template <class Scalar>
void recomputeNormals(const NormalTopology& topology, PointView<const Scalar> positions,
                      std::vector<float>& faceVectors, PointView<float> out, ParallelFor* threads) {
  assert(faceVectors.size() == 4 * topology.triangleCount());
  assert(positions.size() == topology.places().size() && out.size() == positions.size());
  const std::uint32_t* triangle = topology.triangles().data();
  std::size_t tasks = taskCount(topology.triangleCount(), kTrianglesPerTask);
  runTasks(threads, tasks, [&](std::size_t task) {
    const std::size_t last = firstItem(topology.triangleCount(), tasks, task + 1);
    for (std::size_t t = firstItem(topology.triangleCount(), tasks, task); t < last; ++t) {
      const Scalar* a = positions[triangle[3 * t]];
      const Scalar* b = positions[triangle[3 * t + 1]];
      const Scalar* c = positions[triangle[3 * t + 2]];
      const Scalar u[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]}, w[3] = {c[0] - a[0], c[1] - a[1], c[2] - a[2]};
      float* face = faceVectors.data() + 4 * t;
      face[0] = static_cast<float>(u[1] * w[2] - u[2] * w[1]);
      face[1] = static_cast<float>(u[2] * w[0] - u[0] * w[2]);
      face[2] = static_cast<float>(u[0] * w[1] - u[1] * w[0]);
    }
  });

  tasks = taskCount(topology.groupCount(), kGroupsPerTask);
  runTasks(threads, tasks, [&](std::size_t task) {
    const std::size_t last = firstItem(topology.groupCount(), tasks, task + 1);
    for (std::size_t g = firstItem(topology.groupCount(), tasks, task); g < last; ++g) {
      using Padded = Eigen::Array4f;
      Padded sum = Padded::Zero();
      for (std::uint32_t k = topology.groupTriangles()[g]; k < topology.groupTriangles()[g + 1]; ++k) {
        sum += Eigen::Map<const Padded>(faceVectors.data() + 4 * static_cast<std::size_t>(topology.corners()[k]));
      }
      Eigen::Vector3f normal(sum[0], sum[1], sum[2]);
      const float squared = normal.squaredNorm();
      if (squared > kOrdinary && squared < 1.0f / kOrdinary) {
        normal *= 1.0f / std::sqrt(squared);
      } else if (!normalise(normal)) {
        continue;
      }
      for (std::uint32_t k = topology.groupPlaces()[g]; k < topology.groupPlaces()[g + 1]; ++k) {
        float* target = out[topology.places()[k]];
        for (int i = 0; i < 3; ++i) target[i] = normal[i];
      }
    }
  });
}

#define TETSKIN_INSTANTIATE(Scalar)                                                                              \
  template void transformDirections(const Embedding&, const DirectionFactors&, const QuadraticStencils<Scalar>*, \
                                    const EdgeVectors<Scalar>*, const PackedNodes<Scalar>&, PointView<float>,    \
                                    VertexOrder, float*, ParallelFor*, const std::uint8_t*);
TETSKIN_INSTANTIATE(float)
TETSKIN_INSTANTIATE(double)
#undef TETSKIN_INSTANTIATE
template void recomputeNormals(const NormalTopology&, PointView<const float>, std::vector<float>&, PointView<float>,
                               ParallelFor*);
template void recomputeNormals(const NormalTopology&, PointView<const double>, std::vector<float>&, PointView<float>,
                               ParallelFor*);

}  // namespace tetskin
