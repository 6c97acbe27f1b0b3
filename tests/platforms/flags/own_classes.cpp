// An application that derives from Bullet's classes, and is compiled without type information: none of its objects may
// be asked for their types.
#include <BulletSoftBody/btDeformableGravityForce.h>
#include <BulletSoftBody/btDeformableMultiBodyConstraintSolver.h>
#include <BulletSoftBody/btSoftBodyHelpers.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <btBulletDynamicsCommon.h>
#include <tetskin/tetskin.h>

#include <cstdio>

class Wind : public btDeformableGravityForce {
 public:
  Wind() : btDeformableGravityForce(btVector3(2, 0, 0)) {}
  void addScaledForces(btScalar scale, TVStack& force) override {
    btDeformableGravityForce::addScaledForces(scale, force);
    ++calls;
  }
  void addScaledExplicitForce(btScalar scale, TVStack& force) override { addScaledForces(scale, force); }
  int calls = 0;
};

class World : public btDeformableMultiBodyDynamicsWorld {
  using btDeformableMultiBodyDynamicsWorld::btDeformableMultiBodyDynamicsWorld;
};

class Dispatcher : public btCollisionDispatcher {
 public:
  using btCollisionDispatcher::btCollisionDispatcher;
  bool needsCollision(const btCollisionObject* a, const btCollisionObject* b) override {
    ++calls;
    return btCollisionDispatcher::needsCollision(a, b);
  }
  int calls = 0;
};

class Cloth : public btSoftBody {
  using btSoftBody::btSoftBody;
};

tetskin::TriangleMesh makeBox() {
  tetskin::TriangleMesh box;
  for (int corner = 0; corner < 8; ++corner) box.positions.emplace_back(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
  box.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                   {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return box;
}

int failed(const tetskin::Status& status) {
  std::fprintf(stderr, "%s\n", status.message.c_str());
  return 1;
}

int main() {
  btSoftBodyRigidBodyCollisionConfiguration configuration;
  Dispatcher dispatcher(&configuration);
  btDbvtBroadphase broadphase;
  tetskin::DeformableSolver bodySolver;
  btDeformableMultiBodyConstraintSolver solver;
  solver.setDeformableSolver(&bodySolver);
  World world(&dispatcher, &broadphase, &solver, &configuration, &bodySolver);
  world.setGravity(btVector3(0, btScalar(-9.81), 0));
  btStaticPlaneShape floorShape(btVector3(0, 1, 0), 0);
  btRigidBody floor(btRigidBody::btRigidBodyConstructionInfo(0, nullptr, &floorShape));
  world.addRigidBody(&floor);

  const tetskin::TriangleMesh box = makeBox();
  tetskin::CageOptions cageOptions;
  cageOptions.targetTets = 200;
  const auto cage = tetskin::createCage(box, cageOptions);
  if (!cage.ok()) return failed(cage.status());
  auto body = tetskin::DeformableBody::add(world, cage.value());
  if (!body.ok()) return failed(body.status());
  btSoftBody& soft = body.value()->body();
  soft.translate(btVector3(0, btScalar(0.1), 0));
  tetskin::SoftBodySkin skin;
  if (const auto fit = skin.bind(soft, cage.value(), box); !fit.ok()) return failed(fit.status());
  auto contact = tetskin::SurfaceContact::add(world, soft, *skin.binding(), box);
  if (!contact.ok()) return failed(contact.status());
  auto contacts = tetskin::SoftContacts::add(world);
  if (!contacts.ok()) return failed(contacts.status());
  auto* wind = new Wind;
  world.addForce(&soft, wind);
  const btVector3 corners[2] = {{5, 1, 0}, {6, 1, 0}};
  const btScalar masses[2] = {0, 1};
  Cloth cloth(&world.getWorldInfo(), 2, corners, masses);
  cloth.appendLink(0, 1);
  world.addSoftBody(&cloth);
  if (tetskin::SurfaceContact::add(world, cloth, *skin.binding(), box).ok()) return 1;

  const btScalar dt = btScalar(1) / 240;
  for (int step = 0; step < 240; ++step) world.stepSimulation(dt, 0);
  const btVector3 centre = (soft.m_bounds[0] + soft.m_bounds[1]) / 2;
  std::printf("%.3f %.3f, %d and %d calls\n", double(centre.x()), double(centre.y()), wind->calls, dispatcher.calls);
  const bool well =
      centre.y() > 0.4 && centre.y() < 0.6 && centre.x() > 0.45 && wind->calls > 0 && dispatcher.calls > 0;
  world.removeSoftBody(&cloth);
  return well ? 0 : 1;
}
