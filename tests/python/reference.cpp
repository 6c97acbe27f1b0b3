// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The drop of test_drop.py, in C++ with the same Bullet: its positions must be the same to the bit. Also the cost of
// test_overhead.py's calls here.
//   tetskin_reference MESH TETS FRAMES POSITIONS   writes the surface after FRAMES as floats; prints microseconds
#include <BulletCollision/CollisionShapes/btStaticPlaneShape.h>
#include <tetskin/bullet/soft_body_skin.h>
#include <tetskin/cage/create_cage.h>
#include <tetskin/contact/surface_contact.h>
#include <tetskin/io/files.h>
#include <tetskin/solver/deformable_body.h>
#include <tetskin/solver/deformable_world.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>

namespace {

/// The median time of the call, in microseconds.
template <class Call>
double microseconds(int count, Call&& call) {
  std::vector<double> times;
  for (int i = 0; i < count; ++i) {
    const auto start = std::chrono::steady_clock::now();
    call();
    times.push_back(std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start).count());
  }
  std::nth_element(times.begin(), times.begin() + count / 2, times.end());
  return times[count / 2];
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 5) return std::puts("usage: tetskin_reference MESH TETS FRAMES POSITIONS"), 2;
  const tetskin::TriangleMesh mesh = tetskin::loadMesh(argv[1]).value();
  tetskin::CageOptions options;
  options.targetTets = std::strtoul(argv[2], nullptr, 10);
  const tetskin::Cage cage = tetskin::createCage(mesh, options).value();

  tetskin::DeformableWorld world, empty;
  const auto record = tetskin::ForceRecord::add(world).value();
  const auto other = tetskin::ForceRecord::add(empty).value();
  btStaticPlaneShape shape(btVector3(0, 1, 0), 0);
  btRigidBody ground(0, nullptr, &shape);
  world.addRigidBody(&ground);
  tetskin::SoftBodyOptions material;
  material.faceTree = false;
  tetskin::Cage placed = cage;
  for (Eigen::Vector3d& node : placed.mesh.nodes) node.y() += 2.0;
  const auto body = tetskin::DeformableBody::add(world, placed, material).value();
  const auto binding = tetskin::SoftBodyBinding::create(cage, mesh).value();
  tetskin::SoftBodySkin skin;
  if (!skin.bind(body->body(), binding).ok()) return 1;
  const auto contact = tetskin::SurfaceContact::add(world, body->body(), *binding, mesh).value();
  tetskin::SoftBodySkin* skins[] = {&skin};
  for (int frame = std::atoi(argv[3]); frame > 0; --frame) {
    world.stepSimulation(btScalar(1) / 60, 4, btScalar(1) / 60 / 4);
    tetskin::SoftBodySkin::updateAll(skins, 1);
  }
  const tetskin::PointView<const btScalar> positions = skin.positions();
  std::ofstream file(argv[4], std::ios::binary);
  file.write(reinterpret_cast<const char*>(positions.data()),
             static_cast<std::streamsize>(positions.size() * 3 * sizeof(float)));

  tetskin::MeshSkin<double> free;
  if (!free.bind(cage, mesh).ok()) return 1;
  std::printf("step %.3f\n",
              microseconds(4001, [&] { empty.stepSimulation(btScalar(1) / 60, 4, btScalar(1) / 60 / 4); }));
  std::printf("update %.3f\n", microseconds(4001, [&] { (void)free.update(tetskin::viewOf(cage.mesh.nodes)); }));
  world.removeRigidBody(&ground);
  return file.good() ? 0 : 1;
} catch (const std::exception& fault) {
  return std::puts(fault.what()), 2;
}
