// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include "bullet/worlds.h"
#include "support/odd_meshes.h"

#include <gtest/gtest.h>
#include <tetskin/solver/deformable_body.h>
#include <tetskin/solver/deformable_world.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

namespace tetskin::test {

/// A deformable world without a body.
class EmptyWorld : public DeformableWorldBase {
 public:
  explicit EmptyWorld(std::unique_ptr<btDeformableBodySolver> bodySolver = std::make_unique<btDeformableBodySolver>())
      : DeformableWorldBase(std::move(bodySolver)) {}
  btDeformableMultiBodyDynamicsWorld& deformable() { return *soft; }
  operator btDeformableMultiBodyDynamicsWorld&() { return *soft; }
};

/// A deformable world without a body, with the library's solver.
class TetskinWorld : public EmptyWorld {
 public:
  TetskinWorld() : EmptyWorld(std::make_unique<DeformableSolver>()) {}
  DeformableSolver& bodySolver() { return static_cast<DeformableSolver&>(*softSolver); }
};

/// A world with the library's solver where the force needs it, otherwise with Bullet's.
inline std::unique_ptr<EmptyWorld> worldFor(ForceModel model) {
  if (model == ForceModel::Corotated) return std::make_unique<TetskinWorld>();
  return std::make_unique<EmptyWorld>();
}

inline std::unique_ptr<DeformableBody> added(EmptyWorld& world, const TetMesh& cage,
                                             const SoftBodyOptions& options = {}) {
  Result<std::unique_ptr<DeformableBody>> body = DeformableBody::add(world.deformable(), cage, oneKilogram(options));
  EXPECT_TRUE(body.ok()) << body.status().message;
  return std::move(body).value();
}

inline double lowest(const btSoftBody& body) {
  double y = HUGE_VAL;
  for (int n = 0; n < body.m_nodes.size(); ++n) y = std::min<double>(y, body.m_nodes[n].m_x.y());
  return y;
}

inline double rmsSpeed(const btSoftBody& body) {
  double squared = 0.0;
  for (int n = 0; n < body.m_nodes.size(); ++n) squared += body.m_nodes[n].m_v.length2();
  return std::sqrt(squared / body.m_nodes.size());
}

inline double fastestOf(const btSoftBody& body) {
  btScalar squared = 0;
  for (int n = 0; n < body.m_nodes.size(); ++n) squared = std::max(squared, body.m_nodes[n].m_v.length2());
  return std::sqrt(static_cast<double>(squared));
}
inline std::vector<btVector3> nodesOf(const btSoftBody& body) {
  std::vector<btVector3> nodes;
  for (int n = 0; n < body.m_nodes.size(); ++n) nodes.push_back(body.m_nodes[n].m_x);
  return nodes;
}
inline btVector3 momentumOf(const btSoftBody& body) {
  btVector3 sum(0, 0, 0);
  for (int n = 0; n < body.m_nodes.size(); ++n) {
    if (body.m_nodes[n].m_im > 0) sum += body.m_nodes[n].m_v / body.m_nodes[n].m_im;
  }
  return sum;
}

inline btVector3 centreOf(const btSoftBody& body) {
  btVector3 sum(0, 0, 0);
  for (int n = 0; n < body.m_nodes.size(); ++n) sum += body.m_nodes[n].m_x;
  return sum / static_cast<btScalar>(body.m_nodes.size());
}
inline double kineticEnergyOf(const btSoftBody& body) {
  double energy = 0.0;
  for (int n = 0; n < body.m_nodes.size(); ++n) {
    const btSoftBody::Node& node = body.m_nodes[n];
    if (node.m_im > 0) energy += 0.5 * static_cast<double>(node.m_v.length2() / node.m_im);
  }
  return energy;
}

/// The elastic energy of all bodies.
inline double elasticEnergyIn(EmptyWorld& world) {
  double energy = 0.0;
  const auto& forces = *static_cast<btDeformableBodySolver&>(*world.softSolver).getLagrangianForceArray();
  for (int f = 0; f < forces.size(); ++f) energy += forces[f]->totalElasticEnergy(btScalar(1) / 240);
  return energy;
}

inline void step(EmptyWorld& world, int frames) {
  for (int f = 0; f < frames; ++f) world.deformable().stepSimulation(btScalar(1) / 60, 4, btScalar(1) / 240);
}

inline TetMesh cageAbove(double height) {
  return lifted(latticeCage(5, 4, 5, 0.2), height);
}

/// A cage of a tenth as many tets, for tests that do not depend on their number.
inline TetMesh smallCageAbove(double height) {
  return lifted(latticeCage(2, 2, 3, 0.3), height);
}

/// The cage and a copy of it three units along x; the two share no node.
inline TetMesh twoComponents(TetMesh cage) {
  const int first = static_cast<int>(cage.nodeCount());
  for (int n = 0; n < first; ++n) cage.nodes.push_back(cage.nodes[n] + Eigen::Vector3d(3, 0, 0));
  const std::vector<Tet> tets = cage.tets;
  for (const Tet& t : tets) cage.tets.push_back({t[0] + first, t[1] + first, t[2] + first, t[3] + first});
  return cage;
}

}  // namespace tetskin::test
