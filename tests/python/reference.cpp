// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The drop of test_drop.py, in C++ with the same Bullet: its positions must be the same to the bit. Also the cost of
// overhead.py's calls here.
//   tetskin_reference MESH TETS FRAMES POSITIONS   writes the surface after FRAMES as floats; prints microseconds
#include <tetskin/cage/create_cage.h>
#include <tetskin/io/files.h>
#include <tetskin/world/world.h>

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
  const auto mesh = std::make_shared<tetskin::TriangleMesh>(tetskin::loadMesh(argv[1]).value());
  tetskin::CageOptions options;
  options.targetTets = std::strtoul(argv[2], nullptr, 10);
  const auto cage = std::make_shared<tetskin::Cage>(tetskin::createCage(*mesh, options).value());

  tetskin::WorldOptions recorded;
  recorded.recordForces = true;
  tetskin::World world(recorded), empty(recorded);
  (void)world.addRigidBody(std::make_shared<btStaticPlaneShape>(btVector3(0, 1, 0), btScalar(0)), 0,
                           btTransform::getIdentity());
  tetskin::WorldBodyOptions soft;
  soft.material.faceTree = false;
  const auto body = world.addBody(cage, mesh, soft, Eigen::Affine3d(Eigen::Translation3d(0, 2, 0))).value();
  for (int frame = std::atoi(argv[3]); frame > 0; --frame) (void)world.step(1.0 / 60).value();
  std::ofstream file(argv[4], std::ios::binary);
  file.write(reinterpret_cast<const char*>(body->positions.data()),
             static_cast<std::streamsize>(body->positions.size() * sizeof(float)));

  tetskin::MeshSkin<double> free;
  if (!free.bind(*cage, *mesh).ok()) return 1;
  std::printf("step %.3f\n",
              microseconds(4001, [&] { empty.bullet().stepSimulation(btScalar(1) / 60, 4, btScalar(1) / 60 / 4); }));
  std::printf("update %.3f\n", microseconds(4001, [&] { (void)free.update(tetskin::viewOf(cage->mesh.nodes)); }));
  return file.good() ? 0 : 1;
} catch (const std::exception& fault) {
  return std::puts(fault.what()), 2;
}
