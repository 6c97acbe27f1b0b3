// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A rubber ring, whose wall is of tets, lies limp under a crate; from the second second on gas fills it, and lifts the
// crate. Writes out/inflate/frame_0000.obj, frame_0010.obj, ..., in the folder in which it is called.
#include <btBulletDynamicsCommon.h>
#include <tetskin/bullet/soft_body_skin.h>
#include <tetskin/contact/surface_contact.h>
#include <tetskin/io/obj_sequence.h>
#include <tetskin/solver/deformable_body.h>
#include <tetskin/solver/deformable_world.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <vector>

namespace {

constexpr double kRing = 0.6, kOuter = 0.2, kInner = 0.165;  // radii: of the ring, and of its tube
constexpr double kHeight = 0.24;                             // of its centre at first

/// A point of the tube's surface: `along` and `around` from 0 to 1.
Eigen::Vector3d pointOf(double along, double around, double radius) {
  const double a = 6.2831853 * along, b = 6.2831853 * around, distance = kRing + radius * std::cos(b);
  return {distance * std::cos(a), kHeight + radius * std::sin(b), distance * std::sin(a)};
}

/// A hollow ring of tets: a wall of one layer, of prisms whose sides are cut along the diagonal from the lower node.
tetskin::TetMesh makeCage() {
  constexpr int kAlong = 32, kAround = 14;
  tetskin::TetMesh cage;
  for (const double radius : {kInner, kOuter}) {
    for (int k = 0; k < kAlong * kAround; ++k) {
      cage.nodes.push_back(pointOf(double(k / kAround) / kAlong, double(k % kAround) / kAround, radius));
    }
  }
  for (int i = 0; i < kAlong; ++i) {
    for (int k = 0; k < kAround; ++k) {
      const auto node = [&](int di, int dk) { return (i + di) % kAlong * kAround + (k + dk) % kAround; };
      const int a = node(0, 0), b = node(1, 0), c = node(0, 1), d = node(1, 1);
      for (std::array<int, 3> face : {std::array<int, 3>{a, b, d}, std::array<int, 3>{a, d, c}}) {
        std::sort(face.begin(), face.end());
        const int up = kAlong * kAround, p = face[0], q = face[1], r = face[2];
        cage.tets.push_back({p, q, r, r + up});
        cage.tets.push_back({p, q, q + up, r + up});
        cage.tets.push_back({p, p + up, q + up, r + up});
      }
    }
  }
  (void)tetskin::repairTetMesh(cage);  // orients them
  return cage;
}

/// What is seen: the outside of the ring, finer than the cage.
tetskin::TriangleMesh makeSurface() {
  constexpr int kAlong = 128, kAround = 56;
  tetskin::TriangleMesh ring;
  for (int k = 0; k < kAlong * kAround; ++k) {
    ring.positions.push_back(pointOf(double(k / kAround) / kAlong, double(k % kAround) / kAround, kOuter));
  }
  for (int i = 0; i < kAlong; ++i) {
    for (int k = 0; k < kAround; ++k) {
      const auto vertex = [&](int di, int dk) { return (i + di) % kAlong * kAround + (k + dk) % kAround; };
      ring.triangles.push_back({vertex(0, 0), vertex(0, 1), vertex(1, 1)});
      ring.triangles.push_back({vertex(0, 0), vertex(1, 1), vertex(1, 0)});
    }
  }
  return ring;
}

}  // namespace

int main() try {
  const tetskin::TetMesh cage = makeCage();
  const tetskin::TriangleMesh ring = makeSurface();
  tetskin::DeformableWorld world;
  btStaticPlaneShape ground(btVector3(0, 1, 0), 0);
  const btVector3 half(btScalar(0.75), btScalar(0.12), btScalar(0.75));
  btBoxShape crateShape(half);
  btVector3 inertia;
  constexpr btScalar kMass = 40;
  crateShape.calculateLocalInertia(kMass, inertia);
  btRigidBody floor(0, nullptr, &ground), crate(kMass, nullptr, &crateShape, inertia);
  btTransform above = btTransform::getIdentity();
  above.setOrigin(btVector3(0, btScalar(kHeight + kOuter + 0.14), 0));
  crate.setWorldTransform(above);
  world.addRigidBody(&floor);
  world.addRigidBody(&crate);

  tetskin::SoftBodyOptions rubber;
  rubber.density = 200;
  rubber.youngsModulus = 4e4;
  rubber.stiffnessDamping = 0.03;
  const auto body = tetskin::DeformableBody::add(world, cage, rubber).value();
  tetskin::SoftBodySkin skin;
  skin.bind(body->body(), cage, ring).value();
  const auto contact = tetskin::SurfaceContact::add(world, body->body(), *skin.binding(), ring).value();

  // The crate's corners follow the ring's vertices.
  tetskin::TriangleMesh seen = ring;
  const int first = static_cast<int>(ring.vertexCount());
  for (int corner = 0; corner < 8; ++corner) seen.positions.emplace_back(0, 0, 0);
  constexpr int kSides[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  for (const auto& s : kSides) {
    seen.triangles.push_back({first + s[0], first + s[1], first + s[2]});
    seen.triangles.push_back({first + s[0], first + s[2], first + s[3]});
  }
  auto files = tetskin::ObjSequenceWriter::create("out/inflate", tetskin::ObjLayout::create(seen)).value();

  const auto height = [&] { return static_cast<double>(crate.getWorldTransform().getOrigin().y()); };
  double limp = 0.0;
  const btScalar dt = btScalar(1) / 60;
  for (int frame = 0; frame <= 300; ++frame) {
    // A pump that fills it in two seconds: each call sets the amount of gas that has this pressure at present.
    const double filled = std::min((frame - 60) / 120.0, 1.0);
    if (frame == 60) limp = height();
    if (filled > 0.0 && frame <= 180) {
      if (const tetskin::Status set = body->setGas(1500 * filled); !set.ok()) throw std::runtime_error(set.message);
    }
    if (frame % 10 == 0) {
      std::vector<float> points(skin.positions().data(), skin.positions().data() + 3 * ring.vertexCount());
      for (int corner = 0; corner < 8; ++corner) {
        const btVector3 own((corner & 1 ? 1 : -1) * half.x(), (corner & 2 ? 1 : -1) * half.y(),
                            (corner & 4 ? 1 : -1) * half.z());
        const btVector3 at = crate.getWorldTransform() * own;
        for (int k = 0; k < 3; ++k) points.push_back(static_cast<float>(at[k]));
      }
      const tetskin::Status written =
          files.write(frame, tetskin::PointView<const float>(points.data(), points.size() / 3));
      if (!written.ok()) throw std::runtime_error(written.message);
      std::printf("%s: %.0f Pa in %.1f litres, the crate at %.3f\n", files.framePath(frame).c_str(), body->pressure(),
                  1000 * body->volume(), height());
    }
    world.stepSimulation(dt, 4, dt / 4);
    if (skin.update() == tetskin::StatusCode::NonFinite) throw std::runtime_error("the ring has exploded");
  }
  const bool lifted = height() > limp + 0.1;
  std::printf("the gas lifts the crate from %.3f to %.3f: %s\n", limp, height(), lifted ? "yes" : "no");
  world.removeRigidBody(&crate);
  world.removeRigidBody(&floor);
  return lifted ? 0 : 1;
} catch (const std::exception& fault) {  // value() of a failed result: what, where, and the cure
  return std::puts(fault.what()), 2;
}
