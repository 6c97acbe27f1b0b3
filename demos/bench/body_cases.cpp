// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "bench/body_cases.h"

#include <BulletSoftBody/btSoftBody.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <benchmark/benchmark.h>
#include <tetskin/bullet/src/base/body_trees.h>
#include <tetskin/core/cage.h>
#include <tetskin/elastic/elastic_body.h>
#ifdef TETSKIN_BENCH_THREADS
#include <tetskin/threads/thread_pool.h>
#endif

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "measure/body_model.h"
#include "scenes/caged_mesh.h"
#include "scenes/serpent.h"
#include "scenes/table.h"

namespace tetskin::bench {

using namespace bullet_detail;

namespace {

using benchmark::State;
using scenes::makeSerpent;

/// Face trees of a body whose faces are a serpent's triangles.
void buildFaceTree(State& state, std::size_t triangles) {
  const TriangleMesh mesh = makeSerpent({triangles});
  std::vector<btVector3> nodes;
  for (const Eigen::Vector3d& p : mesh.positions) nodes.push_back(toBullet(p));
  btSoftBodyWorldInfo info;
  btSoftBody body(&info, static_cast<int>(nodes.size()), nodes.data(), nullptr);
  for (const auto& t : mesh.triangles) body.appendFace(t[0], t[1], t[2]);
  for (auto _ : state) buildTrees(body);
  state.counters["faces"] = static_cast<double>(body.m_faces.size());
}

TetMesh serpentCage(std::size_t tets) {
  return scenes::builtCage(makeSerpent(), tets).mesh;
}

/// A cage with two components that share no node.
TetMesh twoSerpents(std::size_t tets) {
  TetMesh cage = serpentCage(tets);
  const TetMesh other = cage;
  const int first = static_cast<int>(cage.nodeCount());
  for (const Eigen::Vector3d& p : other.nodes) cage.nodes.emplace_back(p.x(), p.y() + 10.0, p.z());
  for (const Tet& t : other.tets) cage.tets.push_back({t[0] + first, t[1] + first, t[2] + first, t[3] + first});
  return cage;
}

/// The first ray after a step, through a body with two components, for which Bullet's own builder would never return.
void castRay(State& state) {
  const auto scene = scenes::sceneNamed("float").make(twoSerpents(3000));
  const btVector3 node = scene->body().m_nodes[0].m_x, aside(btScalar(0.01), 50, btScalar(0.02));
  const btVector3 from = node + aside, to = node - aside;
  scene->step(1);
  bool met = false;
  for (auto _ : state) {
    btCollisionWorld::ClosestRayResultCallback hit(from, to);
    scene->world().bullet().rayTest(from, to, hit);
    met = hit.hasHit();
  }
  state.counters["met"] = met;
  state.counters["faces"] = static_cast<double>(scene->body().m_faces.size());
}

/// A frame with four substeps, of bodies that float beside each other.
void step(State& state, int bodies, bool faceTree) {
  scenes::SceneOptions options;
  options.bodies = static_cast<std::size_t>(bodies);
  options.body.faceTree = faceTree;
  const auto scene = scenes::sceneNamed("float").make(serpentCage(3000), options);
  for (auto _ : state) scene->step(1);
}

/// A step of a beam, 4 by 1 by 1, that is held at one end and swings.
/// across  cubes of six tets across the beam; with quadratic ones it has the nodes of twice as many with linear ones
void stepOfBeam(State& state, int across, bool quadratic) {
  constexpr double kSeconds = 1.0 / 240.0;
  Cage cage = measure::makeLattice({4 * across, across, across}, 1.0 / across)->cage;
  if (quadratic) cage = refineQuadratic(cage).value();
  ElasticOptions options;
  options.youngsModulus = 2e5;
  options.density = 100.0;
  auto body = ElasticBody<float>::create(cage, options).value();
  const double end = boundingBox(cage.mesh.nodes).min().x();
  for (std::size_t n = 0; n < body.nodeCount(); ++n) body.setPinned(n, cage.mesh.nodes[n].x() == end);
  int iterations = 0;
  for (auto _ : state) iterations += body.step(kSeconds, {0.0, -9.81, 0.0});
  state.counters["iterations"] = benchmark::Counter(iterations, benchmark::Counter::kAvgIterations);
  state.counters["nodes"] = static_cast<double>(body.nodeCount());
}

void registerBeams() {
  // Quadratic tets with 81 nodes are as good as linear ones with 2,673.
  for (const int across : {1, 2, 4}) {
    benchmark::RegisterBenchmark(("Step/beam/quadratic/across:" + std::to_string(across)).c_str(), stepOfBeam, across,
                                 true)
        ->Unit(benchmark::kMicrosecond);
  }
  for (const int across : {2, 4, 8}) {
    benchmark::RegisterBenchmark(("Step/beam/linear/across:" + std::to_string(across)).c_str(), stepOfBeam, across,
                                 false)
        ->Unit(benchmark::kMicrosecond);
  }
}

#ifdef TETSKIN_BENCH_THREADS
/// A step of a body that falls and wobbles, held at its lowest node: its elastic part alone, in wall time.
void stepWithThreads(State& state, std::size_t tets, std::size_t threads) {
  constexpr double kSeconds = 1.0 / 240.0;
  const TetMesh cage = serpentCage(tets);
  ElasticOptions options;
  options.youngsModulus = 1e3;
  auto body = ElasticBody<float>::create(cage, options).value();
  const auto lower = [](const Eigen::Vector3d& p, const Eigen::Vector3d& q) { return p.y() < q.y(); };
  const auto lowest = std::min_element(cage.nodes.begin(), cage.nodes.end(), lower);
  body.setPinned(static_cast<std::size_t>(lowest - cage.nodes.begin()));
  ThreadPool pool(threads);
  int iterations = 0;
  for (auto _ : state) iterations += body.step(kSeconds, {0.0, -9.81, 0.0}, threads > 1 ? &pool : nullptr);
  state.counters["iterations"] = benchmark::Counter(iterations, benchmark::Counter::kAvgIterations);
  state.counters["tets"] = static_cast<double>(cage.tetCount());
}

void registerThreads() {
  for (const std::size_t tets : {3000, 30000}) {
    for (const std::size_t threads : {1, 2, 4}) {
      const std::string name = "Step/threads:" + std::to_string(threads) + "/tets:" + std::to_string(tets);
      benchmark::RegisterBenchmark(name.c_str(), stepWithThreads, tets, threads)
          ->Unit(benchmark::kMicrosecond)
          ->UseRealTime();
    }
  }
}
#endif

}  // namespace

void registerBodyCases() {
#ifdef TETSKIN_BENCH_THREADS
  registerThreads();
#endif
  registerBeams();
  benchmark::RegisterBenchmark("FaceTree/60000", buildFaceTree, 60000)->Unit(benchmark::kMillisecond);
  benchmark::RegisterBenchmark("Ray/two_parts", castRay)->Unit(benchmark::kMicrosecond);
  for (const int bodies : {1, 2}) {
    for (const bool faceTree : {true, false}) {
      const std::string name = std::string("Step/face_tree:") + (faceTree ? "yes" : "no") + "/bodies:";
      benchmark::RegisterBenchmark((name + std::to_string(bodies)).c_str(), step, bodies, faceTree)
          ->Unit(benchmark::kMillisecond);
    }
  }
}

}  // namespace tetskin::bench
