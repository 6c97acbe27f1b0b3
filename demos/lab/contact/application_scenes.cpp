// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Scenes found in an application; each has bodies made of a few cubes.
#include <BulletSoftBody/btDeformableMousePickingForce.h>
#include <btBulletDynamicsCommon.h>

#include <cmath>
#include <vector>

#include "contact/scene_list.h"
#include "measure/extremes.h"
#include "measure/measuring_world.h"

namespace tetskin::contact_demo {
namespace {

using namespace measure;
using Eigen::Vector3d;
using Eigen::Vector3i;

constexpr double kRigidFriction = 0.5;

BodyOptions applicationBody(double youngsModulus, bool byNodes) {
  BodyOptions options;
  options.youngsModulus = youngsModulus;
  options.byNodes = byNodes;
  return options;
}

/// A world set up as in that application.
class ApplicationWorld : public MeasuringWorld {
 public:
  explicit ApplicationWorld(Run& run) : MeasuringWorld(run) { bullet().getSolverInfo().m_numIterations = 50; }

  btRigidBody& addPlate(double y, double mass) {
    btRigidBody& plate = addBox({0, y, 0}, {0.4, 0.1, 0.4}, mass);
    plate.setFriction(static_cast<btScalar>(kRigidFriction));
    return plate;
  }
  void addGround() { addFloor().setFriction(static_cast<btScalar>(kRigidFriction)); }
};

double speedOf(const btRigidBody& body) {
  return toEigen(body.getLinearVelocity()).norm();
}

/// A bar of 1 kg, pinned at its top, carries a box of 1 kg by Bullet's anchors at its lowest nodes.
void anchor(Run& run) {
  ApplicationWorld world(run);
  BodyOptions options = applicationBody(2e4, true);
  options.pinned = [](const Vector3d& p) { return p.y() > 0.49; };
  SoftObject& bar = world.addSoft(makeLattice({2, 8, 2}, 0.125), options, Vector3d(0, 2.5, 0));
  btRigidBody& box = world.addBox({0, 1.79, 0}, {0.2, 0.2, 0.2}, 1);
  // The box hangs from the anchors, and must not collide with the bar.
  world.bullet().removeRigidBody(&box);
  world.bullet().addRigidBody(&box, 64, 0);
  btSoftBody& soft = bar.soft();
  std::vector<int> lowest;
  for (int n = 0; n < soft.m_nodes.size(); ++n) {
    if (soft.m_nodes[n].m_x.y() < btScalar(2.01)) lowest.push_back(n);
  }
  for (const int n : lowest) soft.appendDeformableAnchor(n, &box);
  world.simulate(7);
  double speed = 0.0, turn = 0.0, stretch = 0.0;
  world.simulate(1, [&] {
    raise(speed, speedOf(box));
    raise(turn, toEigen(box.getAngularVelocity()).norm());
    for (const int n : lowest) stretch += (2.0 - toEigen(soft.m_nodes[n].m_x).y()) / (240.0 * lowest.size());
  });
  // (M + m / 2) g L / (E A)
  constexpr double kByHand = 1.5 * scenes::kEarth / (2e4 * 0.0625);
  run.report("stretch over analytic value", stretch / kByHand);
  run.report("speed, m/s", speed);
  run.report("angular speed, rad/s", turn);
}

/// A soft box of 1 kg on a dynamic plate that lies on the ground.
void stackOfTwo(Run& run, double plateMass, bool byNodes) {
  ApplicationWorld world(run);
  world.addGround();
  btRigidBody& plate = world.addPlate(0.11, plateMass);
  SoftObject& soft = world.addSoft(makeLattice({3, 3, 3}, 0.2), applicationBody(4e4, byNodes), Vector3d(0, 0.54, 0));
  double lowest = HUGE_VAL, speed = 0.0;
  int step = 0;
  world.simulate(10, [&] {
    if (++step > 480) lower(lowest, toEigen(plate.getCenterOfMassPosition()).y());
    if (step <= 1920) return;
    raise(speed, speedOf(plate));
    raise(speed, soft.fastest());
  });
  run.report("speed, m/s", speed);
  run.report("downward displacement, m", 0.5 - soft.motion().centroid.y());
  run.report("plate sinks, m", 0.1 - lowest);
}

/// A stack: rigid, soft, rigid, soft, rigid.
void stack(Run& run, double mass, bool byNodes) {
  ApplicationWorld world(run);
  world.addGround();
  const ModelPtr model = makeLattice({3, 3, 3}, 0.2);
  std::vector<btRigidBody*> plates;
  std::vector<SoftObject*> bodies;
  double y = 0.0;
  for (int k = 0; k < 3; ++k) {
    plates.push_back(&world.addPlate(y + 0.12, mass));
    y += 0.24;
    if (k == 2) break;
    bodies.push_back(&world.addSoft(model, applicationBody(4e4, byNodes), Vector3d(0, y + 0.32, 0)));
    y += 0.64;
  }
  world.simulate(5);
  double speed = 0.0;
  world.simulate(1, [&] {
    for (const btRigidBody* plate : plates) raise(speed, speedOf(*plate));
    for (const SoftObject* body : bodies) raise(speed, body->fastest());
  });
  run.report("speed, m/s", speed);
  constexpr double kTop = 3 * 0.2 + 2 * 0.6 - 0.1;
  run.report("downward displacement, m", kTop - toEigen(plates.back()->getCenterOfMassPosition()).y());
}

/// A soft box of 1 kg on a slope, with a friction coefficient of 0.5: it would slide at more than 26.6 degrees.
/// Measures whether it is awake after ten seconds, and how fast it moved in the last of them.
struct OnSlope {
  bool awake = true;
  double speed = 0.0;
};

OnSlope lieOnSlope(Run& run, double degrees, bool byNodes, bool sleeps) {
  ApplicationWorld world(run);
  const btTransform turn(btQuaternion(btVector3(0, 0, 1), static_cast<btScalar>(degrees * EIGEN_PI / 180)));
  world.addRigid(std::make_unique<btBoxShape>(btVector3(30, 1, 10)), turn);
  BodyOptions options = applicationBody(5e4, byNodes);
  options.sleeps = sleeps;
  Eigen::Isometry3d at(Eigen::AngleAxisd(degrees * EIGEN_PI / 180, Vector3d::UnitZ()));
  at.translation() = at.linear() * Vector3d(0, 1.52, 0);
  SoftObject& body = world.addSoft(makeLattice({4, 4, 4}, 0.25), options, at);
  world.simulate(9);
  const Vector3d before = body.motion().centroid;
  world.simulate(1);
  return {body.soft().isActive(), (body.motion().centroid - before).norm()};
}

/// A body that is kept awake shows what sleep would hide.
void slope(Run& run, double degrees, bool byNodes) {
  run.report("speed, m/s", lieOnSlope(run, degrees, byNodes, false).speed);
  run.report("asleep", lieOnSlope(run, degrees, byNodes, true).awake ? 0.0 : 1.0);
}

/// Bullet's mouse force drags a face of a body at rest.
void mouse(Run& run) {
  MeasuringWorld world(run, Vector3d::Zero());
  world.bullet().getSolverInfo().m_numIterations = 50;
  SoftObject& body = world.addSoft(makeLattice({4, 4, 4}, 0.25), applicationBody(2e4, true), Vector3d(0, 2.5, 0));
  btSoftBody::Face& face = body.soft().m_faces[0];
  const btVector3 target = (face.m_n[0]->m_x + face.m_n[1]->m_x + face.m_n[2]->m_x) / 3;
  btDeformableMousePickingForce force(100, btScalar(0.5), face, target, 20);
  world.bullet().addForce(&body.soft(), &force);
  double fastest = 0.0, atRest = 0.0;
  int step = 0;
  world.simulate(3, [&] {
    raise(fastest, body.fastest());
    if (++step > 480) raise(atRest, body.fastest());
  });
  world.bullet().removeForce(&body.soft(), &force);
  run.report("speed, m/s", atRest);
  run.report("fastest node ever, m/s", fastest);
}

}  // namespace

void addApplicationScenes(ContactScenes& scenes) {
  scenes.push_back({"application/anchor", anchor});
  scenes.push_back({"application/plate and soft/2kg/nodes", [](Run& run) { stackOfTwo(run, 2, true); }});
  scenes.push_back({"application/plate and soft/0.3kg", [](Run& run) { stackOfTwo(run, 0.3, false); }});
  scenes.push_back({"application/stack of five/nodes", [](Run& run) { stack(run, 0.5, true); }});
  scenes.push_back({"application/stack of five", [](Run& run) { stack(run, 0.5, false); }});
  for (const double degrees : {15.0, 20.0, 22.0, 24.0, 25.5}) {
    scenes.push_back({"application/slope/" + text(degrees), [=](Run& run) { slope(run, degrees, false); }});
  }
  for (const double degrees : {15.0, 24.0}) {
    scenes.push_back({"application/slope/" + text(degrees) + "/nodes", [=](Run& run) { slope(run, degrees, true); }});
  }
  scenes.push_back({"application/mouse", mouse});
}

}  // namespace tetskin::contact_demo
