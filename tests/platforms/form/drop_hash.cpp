// A ball that falls into a bowl and touches it with its surface, without files and without functions whose last bits
// differ between C libraries. Prints a hash of the nodes' positions for each instruction set.
#include <btBulletDynamicsCommon.h>
#include <tetskin/bullet/soft_body_skin.h>
#include <tetskin/cage/create_cage.h>
#include <tetskin/contact/surface_contact.h>
#include <tetskin/core/src/base/hash.h>
#include <tetskin/core/src/base/kernels/instruction_set.h>
#include <tetskin/solver/deformable_body.h>
#include <tetskin/solver/deformable_world.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <map>
#include <utility>

/// A cube with `n` x `n` squares on each side, pushed out onto a sphere, with furrows.
tetskin::TriangleMesh makeBall(int n) {
  tetskin::TriangleMesh ball;
  std::map<std::array<int, 3>, int> numbers;
  const auto number = [&](const std::array<int, 3>& at) {
    const auto [found, added] = numbers.try_emplace(at, static_cast<int>(ball.positions.size()));
    if (added) {
      const double x = 2.0 * at[0] / n - 1, y = 2.0 * at[1] / n - 1, z = 2.0 * at[2] / n - 1;
      const double radius = (at[1] / 4 % 2 == 0 ? 0.5 : 0.48) / std::sqrt(x * x + y * y + z * z);
      ball.positions.emplace_back(radius * x, radius * y + 1.0, radius * z);
    }
    return found->second;
  };
  for (int axis = 0; axis < 3; ++axis) {
    for (const int side : {0, n}) {
      for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
          const auto at = [&](int a, int b) {
            std::array<int, 3> p{};
            p[axis] = side;
            p[(axis + 1) % 3] = i + a;
            p[(axis + 2) % 3] = j + b;
            return number(p);
          };
          int q[4] = {at(0, 0), at(1, 0), at(1, 1), at(0, 1)};
          if (side == 0) std::swap(q[1], q[3]);
          ball.triangles.push_back({q[0], q[1], q[2]});
          ball.triangles.push_back({q[0], q[2], q[3]});
        }
      }
    }
  }
  return ball;
}

/// FNV-1a of the positions as floats.
std::uint64_t hashOf(const btSoftBody& body) {
  std::uint64_t hash = tetskin::kStateHashBasis;
  for (int n = 0; n < body.m_nodes.size(); ++n) {
    for (int k = 0; k < 3; ++k) {
      const auto x = static_cast<float>(body.m_nodes[n].m_x[k]);
      hash = tetskin::fnv1a(&x, sizeof x, hash);
    }
  }
  return hash;
}

int failed(const tetskin::Status& status) {
  std::fprintf(stderr, "%s\n", status.message.c_str());
  return 1;
}

int main(int argc, char** argv) {
  const bool print = argc > 1 && std::strcmp(argv[1], "--heights") == 0;
  const tetskin::TriangleMesh ball = makeBall(40);
  tetskin::CageOptions cageOptions;
  cageOptions.targetTets = 800;
  const auto cage = tetskin::createCage(ball, cageOptions);
  if (!cage.ok()) return failed(cage.status());
  for (const tetskin::InstructionSet set : tetskin::availableInstructionSets()) {
    tetskin::setInstructionSet(set);
    tetskin::DeformableWorld world;
    btSphereShape shape(btScalar(0.4));
    btStaticPlaneShape planeShape(btVector3(0, 1, 0), 0);
    btRigidBody plane(btRigidBody::btRigidBodyConstructionInfo(0, nullptr, &planeShape));
    btRigidBody sphere(btRigidBody::btRigidBodyConstructionInfo(0, nullptr, &shape));
    sphere.setWorldTransform(btTransform(btQuaternion::getIdentity(), btVector3(btScalar(0.3), 0, btScalar(0.1))));
    world.addRigidBody(&plane);
    world.addRigidBody(&sphere);
    {
      auto body = tetskin::DeformableBody::add(world, cage.value());
      if (!body.ok()) return failed(body.status());
      tetskin::SoftBodySkin skin;
      if (const auto fit = skin.bind(body.value()->body(), cage.value(), ball); !fit.ok()) return failed(fit.status());
      auto contact = tetskin::SurfaceContact::add(world, body.value()->body(), *skin.binding(), ball);
      if (!contact.ok()) return failed(contact.status());
      for (int frame = 0; frame < 60; ++frame) {
        world.stepSimulation(btScalar(1) / 60, 4, btScalar(1) / 240);
        if (print && frame % 20 == 19) std::printf("  y %.5f\n", double(body.value()->body().m_nodes[0].m_x.y()));
      }
      std::printf("%s %016llx\n", tetskin::toString(set),
                  static_cast<unsigned long long>(hashOf(body.value()->body())));
    }
    world.removeRigidBody(&sphere);
    world.removeRigidBody(&plane);
  }
  return 0;
}
