// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/mesh/tet_geometry.h>
#include <tetskin/core/src/mesh/weld.h>
#include <tetskin/core/src/normals/normals.h>
#include <tetskin/core/src/skinning/skin_tasks.h>

namespace tetskin {
namespace {

/// How far an authored normal's length may be from 1.
constexpr float kUnitTolerance = 0.1f;

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

#define TETSKIN_INSTANTIATE(Scalar)                                                                              \
  template void transformDirections(const Embedding&, const DirectionFactors&, const QuadraticStencils<Scalar>*, \
                                    const EdgeVectors<Scalar>*, const PackedNodes<Scalar>&, PointView<float>,    \
                                    VertexOrder, float*, ParallelFor*, const std::uint8_t*);
TETSKIN_INSTANTIATE(float)
TETSKIN_INSTANTIATE(double)
#undef TETSKIN_INSTANTIATE
}  // namespace tetskin
