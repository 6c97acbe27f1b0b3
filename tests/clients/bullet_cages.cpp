// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Binds surfaces 1 % of the diagonal inside and outside of each cage's boundary, moves the nodes first at random and
// then with Bullet, and compares every vertex with brute force in double precision after every update. See
// tests/clients/run.
#include <tetskin/bullet/soft_body_skin.h>
#include <tetskin/core/src/base/mesh/tet_geometry.h>
#include <tetskin/core/src/search/tolerances.h>
#include <tetskin/io/files.h>

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "bullet/worlds.h"
#include "support/brute_force.h"
#include "support/cage_surface.h"

namespace tetskin::test {
namespace {

using Points = std::vector<Eigen::Vector3d>;

/// Relative to the cage's diagonal.
constexpr double kDistance = 0.01, kJitter = 0.01;
/// No vertex may deviate by more under the default rule: besides the largest weight there may be an equal one of the
/// opposite sign, and the boundary also moves.
constexpr double kMaxStrayed = 10.0 * kJitter;
static_assert(2.0 * kMaxWeight + 2.0 <= 10.0);
constexpr int kSteps = 60;
/// Error of a weighted sum in float, relative to the sum of the weights' and coordinates' absolute values.
constexpr double kFloatError = 0x1p-21;

/// The inner and the outer surface in one mesh.
TriangleMesh surfacesBeside(const TetMesh& cage, double distance) {
  const int cuts = cage.nodeCount() < 1000 ? 1 : 0;
  TriangleMesh mesh = surfaceBeside(cage, -distance, cuts);
  const TriangleMesh outer = surfaceBeside(cage, distance, cuts);
  const int shift = static_cast<int>(mesh.vertexCount());
  mesh.positions.insert(mesh.positions.end(), outer.positions.begin(), outer.positions.end());
  for (const auto& [a, b, c] : outer.triangles) mesh.triangles.push_back({a + shift, b + shift, c + shift});
  return mesh;
}

/// The vertices' positions by the tets and weights that brute force finds, all in double precision.
class Oracle {
 public:
  Oracle(const TetMesh& cage, const Points& vertices, OutsideRule rule)
      : cage_(cage), hits_(bruteForce(cage, vertices, rule)) {
    for (std::size_t v = 0; v < vertices.size(); ++v) {
      weights_.push_back(BarycentricMap(cornersOf(cage, cage.tets[hits_[v].tet]))(vertices[v]));
    }
  }

  bool agrees(const Embedding& embedding) const {
    const auto bindings = embedding.bindings();
    return std::equal(hits_.begin(), hits_.end(), bindings.begin(), bindings.end(),
                      [](const BruteHit& a, const VertexBinding& b) { return a.tet == b.tet && a.inside == b.inside; });
  }
  bool agrees(PointView<const btScalar> positions, const Points& nodes) const {
    const double extent = maxCoordinate(boundingBox(nodes));
    for (std::size_t v = 0; v < hits_.size(); ++v) {
      const TetCorners p = cornersOf({nodes, {}}, cage_.tets[hits_[v].tet]);
      const Eigen::Vector4d& b = weights_[v];
      const Eigen::Vector3d expected = b[0] * p[0] + b[1] * p[1] + b[2] * p[2] + b[3] * p[3];
      const Eigen::Vector3d actual(positions[v][0], positions[v][1], positions[v][2]);
      if (!((actual - expected).norm() <= kFloatError * b.cwiseAbs().sum() * extent)) return false;
    }
    return true;
  }

 private:
  const TetMesh& cage_;
  std::vector<BruteHit> hits_;
  std::vector<Eigen::Vector4d> weights_;
};

Points nodesOf(const btSoftBody& body) {
  Points nodes;
  for (int n = 0; n < body.m_nodes.size(); ++n) {
    const btVector3& p = body.m_nodes[n].m_x;
    nodes.emplace_back(p.x(), p.y(), p.z());
  }
  return nodes;
}

/// The output for one cage under one rule, and its faults.
struct Row {
  EmbedReport fit;
  double strayed = 0.0;  ///< relative to the diagonal
  std::string failure;
};

/// How far the surface of a skin deviates from where the boundary takes it.
double strayed(PointView<const btScalar> positions, const Points& expected) {
  double longest = 0.0;
  for (std::size_t v = 0; v < expected.size(); ++v) {
    const double length = (Eigen::Vector3d(positions[v][0], positions[v][1], positions[v][2]) - expected[v]).norm();
    longest = length <= longest ? longest : length;  // NaN counts as the largest
  }
  return longest;
}

void setNodes(btSoftBody& body, const Points& nodes) {
  for (int n = 0; n < body.m_nodes.size(); ++n) body.m_nodes[n].m_x = toBullet(nodes[n]);
}

Row check(const TetMesh& cage, OutsideRule rule) {
  Row row;
  const double diagonal = boundingBox(cage.nodes).diagonal().norm();
  const TriangleMesh mesh = surfacesBeside(cage, kDistance * diagonal);
  const Oracle oracle(cage, mesh.positions, rule);
  RigidWorld world(cage);
  btSoftBody& body = world.body();
  SkinOptions options;
  options.outside = rule;
  SoftBodySkin alone, connected;  // bound without triangles, and with them
  const Result<EmbedReport> fit = alone.bind(body, cage, viewOf(mesh.positions), options);
  const Result<EmbedReport> report = connected.bind(body, cage, mesh, options);
  if (!fit.ok() || !report.ok()) return row.failure = fit.status().message + report.status().message, row;
  row.fit = fit.value();
  if (!oracle.agrees(alone.binding()->embedding())) return row.failure = "tets are not those of brute force", row;

  const auto updated = [&](const char* when) {
    const bool done = alone.update() == StatusCode::Ok && connected.update() == StatusCode::Ok;
    if (!done || !oracle.agrees(alone.positions(), nodesOf(body))) {
      row.failure = std::string("positions are not those of brute force ") + when;
    }
    return row.failure.empty();
  };
  setNodes(body, movedAtRandom(cage.nodes, kJitter * diagonal, 1));
  if (!updated("with nodes moved at random")) return row;
  const Points expected = BoundaryFollower(cage, mesh.positions).positions(nodesOf(body));
  row.strayed = std::max(strayed(alone.positions(), expected), strayed(connected.positions(), expected)) / diagonal;
  if (rule == OutsideRule::Nearest && !(row.strayed <= kMaxStrayed)) row.failure = "strays too far";

  setNodes(body, cage.nodes);
  body.translate(btVector3(0, btScalar(0.05 * diagonal - boundingBox(cage.nodes).min().y()), 0));
  for (int step = 0; step < kSteps && row.failure.empty(); ++step) {
    world.world->stepSimulation(btScalar(1) / 60, 0);
    updated("after a step of Bullet's");
  }
  return row;
}

/// Prints the row of a cage, and returns whether it has no fault.
bool report(const std::string& path) {
  const std::string name = path.substr(path.find_last_of('/') + 1);
  Result<TetMesh> read = loadTetMesh(path);
  if (!read.ok()) return std::printf("%-24s FAILED: %s\n", name.c_str(), read.status().message.c_str()), false;
  TetMesh cage = std::move(read).value();
  (void)repairTetMesh(cage);
  const Row nearest = check(cage, OutsideRule::Nearest), barycentric = check(cage, OutsideRule::Barycentric);
  const std::string& failure = nearest.failure.empty() ? barycentric.failure : nearest.failure;
  std::printf("%-24s %6zu %7zu %7zu %7zu %9.3g %9.4f %11.4f  %s\n", name.c_str(), cage.tetCount(), nearest.fit.inside,
              nearest.fit.outside, nearest.fit.reassignedByWeight, nearest.fit.maxWeight, nearest.strayed,
              barycentric.strayed, failure.empty() ? "ok" : ("FAILED: " + failure).c_str());
  return failure.empty();
}

}  // namespace
}  // namespace tetskin::test

int main(int count, char** arguments) {
  std::printf("%-24s %6s %7s %7s %7s %9s %9s %11s\n", "cage", "tets", "inside", "outside", "rescued", "weight",
              "nearest", "barycentric");
  int failures = 0;
  for (int k = 1; k < count; ++k) failures += !tetskin::test::report(arguments[k]);
  std::printf("%d cages, %d failed\n", count - 1, failures);
  return failures > 0;
}
