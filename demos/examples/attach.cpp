// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A fine mesh on a btSoftBody that Bullet itself has made from TetGen's data, in Bullet's own world:
//
//   tetskin_attach [MESH NODE_FILE ELE_FILE]
//
// The files are a mesh, and TetGen's tets around it, numbered from 0 (tetgen -z), as Bullet wants them; without them, a
// tube in a bar. The left end is held. Writes out/attach/frame_0000.obj, frame_0020.obj, ..., in the folder in which it
// is called. In a project of yours:
// find_package(tetskin REQUIRED COMPONENTS bullet io), and link tetskin::bullet and tetskin::io.
#include <BulletSoftBody/btSoftBodyHelpers.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>
#include <tetskin/bullet/soft_body_skin.h>
#include <tetskin/io/files.h>
#include <tetskin/io/obj_sequence.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>

namespace {

/// A bar of 10 cubes, of six tets each, in TetGen's formats.
void makeBar(std::string& nodes, std::string& tets) {
  std::ostringstream node, ele;
  node << "44 3 0 0\n", ele << "60 4 0\n";
  for (int i = 0; i < 44; ++i) {
    const int slice = i / 4;
    node << i << ' ' << 0.2 * slice << ' ' << 0.5 * (i & 1) - 0.25 << ' ' << 0.25 * (i & 2) - 0.25 << '\n';
  }
  const int way[6][2] = {{4, 5}, {1, 3}, {2, 6}, {5, 1}, {3, 2}, {6, 4}};  // from one corner of a cube to the other
  for (int t = 0; t < 60; ++t) {
    const int first = 4 * (t / 6), *on = way[t % 6];
    ele << t << ' ' << first << ' ' << first + on[0] << ' ' << first + on[1] << ' ' << first + 7 << '\n';
  }
  nodes = node.str(), tets = ele.str();
}

tetskin::TriangleMesh makeTube() {
  tetskin::TriangleMesh tube;
  for (int i = 0; i < 200 * 100; ++i) {
    const int ring = i / 100;
    const double x = 2.0 * ring / 199, radius = 0.2 + 0.03 * std::sin(40 * x), angle = 6.2831853 * (i % 100) / 100;
    tube.positions.emplace_back(x, radius * std::cos(angle), radius * std::sin(angle));
    if (ring == 0) continue;
    const int next = 100 * ring + (i + 1) % 100;
    tube.triangles.push_back({i - 100, next - 100, next});
    tube.triangles.push_back({i - 100, next, i});
  }
  return tube;
}

std::string textOf(const char* path) {
  const std::ifstream file(path);
  if (!file) throw std::runtime_error(std::string(path) + ": cannot be opened");
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 1 && argc != 4) throw std::runtime_error("usage: tetskin_attach [MESH NODE_FILE ELE_FILE]");
  std::string nodes, tets;
  tetskin::TriangleMesh mesh;
  if (argc == 4) {
    mesh = tetskin::loadMesh(argv[1]).value();
    nodes = textOf(argv[2]), tets = textOf(argv[3]);
  } else {
    mesh = makeTube();
    makeBar(nodes, tets);
  }

  // The application's part: nothing here is tetskin's.
  btSoftBodyRigidBodyCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btSoftRigidDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
  world.getWorldInfo().m_sparsesdf.Initialize();
  const std::unique_ptr<btSoftBody> body(btSoftBodyHelpers::CreateFromTetGenData(
      world.getWorldInfo(), tets.c_str(), nullptr, nodes.c_str(), false, true, true));
  body->m_cfg.piterations = 10;
  body->m_materials[0]->m_kLST = btScalar(0.1);  // soft links
  body->setTotalMass(1);
  body->updateBounds();
  const btScalar left = body->m_bounds[0].x(), right = body->m_bounds[1].x();
  for (int i = 0; i < body->m_nodes.size(); ++i) {
    if (body->m_nodes[i].m_x.x() < left + btScalar(0.2) * (right - left)) body->setMass(i, 0);
  }
  world.addSoftBody(body.get());
  const auto leave = [&world](btSoftBody* added) { world.removeSoftBody(added); };
  const std::unique_ptr<btSoftBody, decltype(leave)> inWorld(body.get(), leave);

  // The mesh on it.
  tetskin::SoftBodySkin attached;
  std::puts(attached.bind(*body, mesh).value().describe().c_str());  // once, while they fit each other
  auto files = tetskin::ObjSequenceWriter::create("out/attach", tetskin::ObjLayout::create(mesh)).value();
  for (int frame = 0; frame <= 60; ++frame) {
    if (frame % 20 == 0) {  // or draw
      const tetskin::Status written = files.write(frame, attached.positions());
      if (!written.ok()) throw std::runtime_error(written.message);
      std::printf("%s: lowest point at y = %.3f\n", files.framePath(frame).c_str(), attached.bounds().min().y());
    }
    world.stepSimulation(btScalar(1) / 60, 4, btScalar(1) / 240);
    if (attached.update() == tetskin::StatusCode::NonFinite) throw std::runtime_error("the body has exploded");
  }
} catch (const std::exception& fault) {  // value() of a failed result: what, where, and the cure
  return std::puts(fault.what()), 2;
}
