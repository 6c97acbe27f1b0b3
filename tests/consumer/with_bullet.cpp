// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/bullet/soft_body.h>
#include <tetskin/bullet/soft_body_skin.h>

#include <cstdio>
#include <memory>

#ifdef WITH_ALL_PARTS
#include <tetskin/cage/create_cage.h>
#include <tetskin/io/files.h>
#include <tetskin/threads/thread_pool.h>
#endif

int main() {
  tetskin::Cage cage(tetskin::TetMesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2, 3}}});
  tetskin::TriangleMesh mesh;
  mesh.positions = {{0.1, 0.1, 0.1}, {0.2, 0.1, 0.1}, {0.1, 0.2, 0.1}};
  mesh.triangles = {{0, 1, 2}};
#ifdef WITH_ALL_PARTS
  if (tetskin::loadMesh("no such file.obj").ok()) return 1;
  tetskin::Result<tetskin::Cage> built = tetskin::createCage(mesh);
  if (!built.ok()) return 2;
  cage = std::move(built).value();
#endif
  btSoftBodyWorldInfo worldInfo;
  const std::unique_ptr<btSoftBody> body = tetskin::createSoftBody(cage, worldInfo).value();
  tetskin::SkinOptions options;
#ifdef WITH_ALL_PARTS
  tetskin::ThreadPool pool;
  options.threads = &pool;
#endif
  tetskin::SoftBodySkin skin;
  const tetskin::Result<tetskin::EmbedReport> fit = skin.bind(*body, cage, mesh, options);
  std::printf("%s", fit.value().describe().c_str());
  body->translate(btVector3(0, 5, 0));
  const bool moved = skin.update() == tetskin::StatusCode::Ok && skin.bounds().min().y() > 5;
  return fit.ok() && fit.value().inside == 3 && moved ? 0 : 3;
}
