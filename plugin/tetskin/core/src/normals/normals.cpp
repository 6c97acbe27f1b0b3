// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/instantiate.h>
#include <tetskin/core/src/base/mesh/tet_geometry.h>
#include <tetskin/core/src/normals/normals.h>
#include <tetskin/core/src/skinning/skin_tasks.h>

#include <cassert>

namespace tetskin {
template <class Factor>
DirectionFactors::DirectionFactors(const TetMesh& cage, const Embedding& embedding, bool normals, Factor&& factor)
    : normals_(normals) {
  for (std::vector<float>& plane : planes_) plane.resize(embedding.vertexCount() + EmbeddingData::kPadding);
  for (std::size_t r = 0; r + 1 < dataOf(embedding).runs.size(); ++r) {
    const TetCorners p = cornersOf(cage, cage.tets[dataOf(embedding).runs[r].tet]);
    for (std::uint32_t slot = dataOf(embedding).runs[r].firstSlot; slot < dataOf(embedding).runs[r + 1].firstSlot;
         ++slot) {
      const Eigen::Vector3d m = factor(p, embedding.slotVertices()[slot]);
      for (int k = 0; k < 3; ++k) planes_[static_cast<std::size_t>(k)][slot] = static_cast<float>(m[k]);
    }
  }
}

/// With E the current and P the rest edges (p0-p3, p1-p3, p2-p3), the gradient is G = E P^-1, and its cofactor matrix
/// cof(E) P^T / det(P). So a normal is cof(E) times the factors P^T n / det(P); the columns of cof(E) are cross
/// products of E's.
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
void transformDirections(const Embedding& embedding, const DirectionFactors& factors, const Bends<Scalar>& bends,
                         const PackedNodes<Scalar>& nodes, PointView<float> out, VertexOrder order, float* scratch,
                         ParallelFor* threads) {
  assert(out.size() == embedding.vertexCount());
  if (embedding.empty()) return;
  auto work = skin_tasks::workFor(dataOf(embedding), nodes);
  bends.addTo(work);
  kernels::DirectionPlanes planes;
  planes.kind = factors.areNormals() ? kernels::Direction::Normal : kernels::Direction::Tangent;
  assert(factors.plane(0));
  for (int k = 0; k < 3; ++k) planes.factors[k] = factors.plane(k);
  const bool direct = skin_tasks::isDirect<float>(out, order);
  std::vector<float> ownScratch;
  if (!direct && !scratch) {
    ownScratch.resize(scratchSize(out.size()));
    scratch = ownScratch.data();
    skin_tasks::collect(dataOf(embedding), out, order, scratch);
  }
  float* sorted = direct ? out.data() : scratch;
  const kernels::Table<Scalar>& table = kernels::tableInUse<Scalar>();
  skin_tasks::forAllRuns(dataOf(embedding), work, threads, [&](const kernels::Work<Scalar>& part, std::size_t) {
    table.directions(part, planes, sorted);
  });
  if (!direct) skin_tasks::place(dataOf(embedding), sorted, out, order, threads);
}

#define TETSKIN_INSTANTIATE(Scalar)                                                                  \
  template void transformDirections(const Embedding&, const DirectionFactors&, const Bends<Scalar>&, \
                                    const PackedNodes<Scalar>&, PointView<float>, VertexOrder, float*, ParallelFor*);
TETSKIN_FOR_SCALARS(TETSKIN_INSTANTIATE)
#undef TETSKIN_INSTANTIATE
}  // namespace tetskin
