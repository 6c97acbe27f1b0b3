// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Data that a search keeps only for speed changes no bit: a run that drops it continues like one that keeps it.
#include <tetskin/contact/src/soft/soft_contact_rows.h>

#include "soft_fixtures.h"

namespace tetskin::test {
namespace {

using namespace contact_detail;
using Eigen::Vector3d;

/// Which steps begin without candidates.
enum class Dropped { Never, Always, Sometimes };

/// A scene of bodies of several shapes, and its contacts, which are entered in the world's list of forces.
struct DroppingScene {
  std::unique_ptr<TetskinWorld> world = worldWith(btVector3(0, -10, 0));
  SoftContactRows* rows = nullptr;
  std::unique_ptr<SoftContacts> contacts = contactsIn(*world);
  std::vector<std::unique_ptr<DeformableBody>> bodies;
  std::mt19937 random{5};

  DroppingScene() {
    auto& forces = *world->bodySolver().getLagrangianForceArray();
    for (int f = 0; f < forces.size(); ++f) {
      bullet_detail::InactiveForce* force = bullet_detail::inactiveForce(forces[f]);
      if (force) rows = static_cast<SoftContactRows*>(force);
    }
  }

  void add(const TetMesh& cage, const std::shared_ptr<const ContactShape>& shape, double stiffness,
           const btVector3& velocity = btVector3(0, 0, 0), bool self = false, const Box3& pinned = {}) {
    SoftBodyOptions options;
    options.youngsModulus = stiffness;
    options.margin = 0.002;
    if (!pinned.isEmpty()) options.pinned = pinnedIn(pinned);
    bodies.push_back(added(*world, cage, options));
    bodies.back()->body().setActivationState(DISABLE_DEACTIVATION);
    bodies.back()->body().setVelocity(velocity);
    EXPECT_TRUE(contacts->add(bodies.back()->body(), shape, self).ok());
  }
  void step(Dropped dropped) {
    if (dropped == Dropped::Always || (dropped == Dropped::Sometimes && random() % 3 == 0)) rows->dropCandidates();
    world->deformable().stepSimulation(btScalar(1) / 240, 1, btScalar(1) / 240);
  }
};

/// First step in which a bit differs; -1: none.
int firstDifference(const std::function<void(DroppingScene&)>& build, Dropped dropped, int steps) {
  DroppingScene kept, forgetful;
  build(kept);
  build(forgetful);
  std::size_t contacts = 0;
  for (int k = 0; k < steps; ++k) {
    kept.step(Dropped::Never);
    forgetful.step(dropped);
    contacts += kept.contacts->contacts().size();
    for (std::size_t b = 0; b < kept.bodies.size(); ++b) {
      const auto &nodes = kept.bodies[b]->body().m_nodes, &others = forgetful.bodies[b]->body().m_nodes;
      for (int n = 0; n < nodes.size(); ++n) {
        for (int axis = 0; axis < 3; ++axis) {
          if (nodes[n].m_x[axis] != others[n].m_x[axis] || nodes[n].m_v[axis] != others[n].m_v[axis]) return k;
        }
      }
    }
  }
  EXPECT_GT(contacts, static_cast<std::size_t>(steps) / 2) << "they meet";
  return -1;
}

void expectSameBits(const std::function<void(DroppingScene&)>& build, int steps) {
  EXPECT_EQ(firstDifference(build, Dropped::Always, steps), -1);
  EXPECT_EQ(firstDifference(build, Dropped::Sometimes, steps), -1);
}

TetMesh movedCage(TetMesh cage, const Vector3d& by, double angle = 0.0) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(angle, Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  for (Vector3d& p : cage.nodes) p = turn * p + by;
  return cage;
}

/// All of the plate is held.
void addFloor(DroppingScene& scene, double y) {
  scene.add(movedCage(plate().cage, Vector3d(0, y, 0)), plate().shape, 1e4, btVector3(0, 0, 0), false,
            Box3(Vector3d::Constant(-9), Vector3d::Constant(9)));
}

/// Coarse balls, which are tested faster.
const std::shared_ptr<const ContactShape>& coarseBall() {
  static const std::shared_ptr<const ContactShape> shape = ball().makeShape({600, 24});
  return shape;
}

TEST(DroppedCandidates, OfFastBallsChangeNothing) {
  expectSameBits(
      [](DroppingScene& scene) {
        scene.add(movedCage(ball().cage, Vector3d(0, 0, 0)), coarseBall(), 1500, btVector3(4, 1, 0));
        scene.add(movedCage(ball().cage, Vector3d(1.2, 0.3, 0.1), 0.3), coarseBall(), 1500, btVector3(-6, 0, 1));
      },
      100);
}

TEST(DroppedCandidates, OfAHeapChangeNothing) {
  expectSameBits(
      [](DroppingScene& scene) {
        addFloor(scene, -0.3);
        for (int k = 0; k < 8; ++k) {
          const Vector3d at(0.2 * (k % 2), 0.6 * k, 0.15 * (k % 3));
          if (k % 3 == 2) {
            scene.add(movedCage(plate().cage, at, 0.1 * k), plate().shape, 5000);
          } else {
            scene.add(movedCage(ball().cage, at, 0.5 * k), coarseBall(), 1000 * (1 + k));
          }
        }
      },
      60);
}

}  // namespace
}  // namespace tetskin::test
