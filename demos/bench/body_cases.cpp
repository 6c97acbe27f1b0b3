// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "bench/body_cases.h"

#include <BulletSoftBody/btSoftBody.h>
#include <benchmark/benchmark.h>
#include <tetskin/bullet/deformable_body.h>
#include <tetskin/bullet/src/body_trees.h>
#include <tetskin/cage/cage_builder.h>

#include <memory>
#include <string>
#include <vector>

#include "scenes/deformable_world.h"
#include "scenes/serpent.h"

namespace tetskin::bench {
namespace {

using benchmark::State;
using scenes::DeformableWorld;
using scenes::makeSerpent;

/// Trees of a body whose faces are a serpent's triangles.
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

TetMesh serpentCage(std::size_t tets, double shift = 0.0) {
  CageOptions options;
  options.targetTets = tets;
  TetMesh cage = buildCage(makeSerpent(), options).value();
  for (Eigen::Vector3d& p : cage.nodes) p.y() += shift;
  return cage;
}

/// A cage of two parts that share no node.
TetMesh twoSerpents(std::size_t tets) {
  TetMesh cage = serpentCage(tets);
  const TetMesh other = serpentCage(tets, 10.0);
  const int first = static_cast<int>(cage.nodeCount());
  cage.nodes.insert(cage.nodes.end(), other.nodes.begin(), other.nodes.end());
  for (const Tet& t : other.tets) cage.tets.push_back({t[0] + first, t[1] + first, t[2] + first, t[3] + first});
  return cage;
}

/// The first ray after a step through a body of two parts, for which Bullet's own builder would never come back.
void castRay(State& state) {
  DeformableWorld world(btVector3(0, 0, 0));
  const auto body = DeformableBody::add(world.world(), twoSerpents(3000)).value();
  const btVector3 node = body->body().m_nodes[0].m_x, aside(btScalar(0.01), 50, btScalar(0.02));
  const btVector3 from = node + aside, to = node - aside;
  world.world().stepSimulation(btScalar(1) / 240, 1, btScalar(1) / 240);
  bool met = false;
  for (auto _ : state) {
    btCollisionWorld::ClosestRayResultCallback hit(from, to);
    world.world().rayTest(from, to, hit);
    met = hit.hasHit();
  }
  state.counters["met"] = met;
  state.counters["faces"] = static_cast<double>(body->body().m_faces.size());
}

/// A frame of four substeps of bodies that float beside each other.
void step(State& state, int bodies, bool faceTree) {
  DeformableWorld world(btVector3(0, 0, 0));
  SoftBodyOptions options;
  options.faceTree = faceTree;
  std::vector<std::unique_ptr<DeformableBody>> floating;
  for (int k = 0; k < bodies; ++k) {
    floating.push_back(DeformableBody::add(world.world(), serpentCage(3000, 0.1 * k), options).value());
    floating.back()->body().setActivationState(DISABLE_DEACTIVATION);
  }
  for (auto _ : state) world.world().stepSimulation(btScalar(1) / 60, 4, btScalar(1) / 240);
}

}  // namespace

void registerBodyCases() {
  benchmark::RegisterBenchmark("FaceTree/60000", [](State& state) {
    buildFaceTree(state, 60000);
  })->Unit(benchmark::kMillisecond);
  benchmark::RegisterBenchmark("Ray/two_parts", castRay)->Unit(benchmark::kMicrosecond);
  for (const int bodies : {1, 2}) {
    for (const bool faceTree : {true, false}) {
      const std::string name = std::string("Step/face_tree:") + (faceTree ? "yes" : "no") + "/bodies:";
      benchmark::RegisterBenchmark((name + std::to_string(bodies)).c_str(), [bodies, faceTree](State& state) {
        step(state, bodies, faceTree);
      })->Unit(benchmark::kMillisecond);
    }
  }
}

}  // namespace tetskin::bench
