// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "scenes/drop_scene.h"

#include <chrono>
#include <cmath>

#include "scenes/input_error.h"

namespace tetskin::scenes {
namespace {

/// Height of the lowest node over the highest obstacle at the start, simulated space.
constexpr double kDropHeight = 0.6;
/// Contacts are at nodes alone, so obstacles are large and round or flat: a body of few nodes falls around an edge.
constexpr double kDomeRadius = 1.2;
constexpr double kDomeHeight = 0.3;
constexpr double kRampSlope = 0.3;  ///< radians
constexpr double kFloorHalfSide = 10.0;

double millisecondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

/// Appends vertices and faces to a mesh as one named group.
void append(TriangleMesh& mesh, const char* name, const std::vector<Eigen::Vector3d>& positions,
            const std::vector<std::array<int, 3>>& triangles) {
  const int first = static_cast<int>(mesh.vertexCount());
  mesh.groups.push_back({name, "", mesh.triangleCount(), triangles.size()});
  mesh.positions.insert(mesh.positions.end(), positions.begin(), positions.end());
  for (const auto& t : triangles) mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
}

}  // namespace

DropScene::DropScene(const TriangleMesh& mesh, const TetMesh& cage, const SkinOptions& skin) : restCage_(cage) {
  const Box3 box = boundingBox(cage.nodes);
  centre_ = box.center();
  scale_ = kSize / box.sizes().maxCoeff();
  start_ = {0.0, kDomeHeight + kDropHeight + 0.5 * scale_ * box.sizes().y(), 0.0};
  addObstacles();

  TetMesh placed = cage;
  for (Eigen::Vector3d& p : placed.nodes) p = scale_ * (p - centre_) + start_;
  Result<std::unique_ptr<DeformableBody>> body = DeformableBody::add(world_.world(), placed);
  require(body.status());
  body_ = std::move(body).value();

  fit_ = skin_.bind(body_->body(), cage, mesh, skin);
  if (fit_.ok()) readSurface();
}

bool DropScene::step() {
  const auto dt = static_cast<btScalar>(1.0 / kFrameRate);
  auto start = std::chrono::steady_clock::now();
  const int substeps = world_.world().stepSimulation(dt, kSubsteps, dt / kSubsteps);
  simulationMs_ = millisecondsSince(start);

  start = std::chrono::steady_clock::now();
  const UpdateStatus status = substeps > 0 ? skin_.update() : UpdateStatus::Asleep;
  skinUs_ = 1e3 * millisecondsSince(start);
  readSurface();
  return status == UpdateStatus::Updated || status == UpdateStatus::Asleep;
}

Box3 DropScene::bounds() const {
  return {toModel(skin_.bounds().min()), toModel(skin_.bounds().max())};
}

TetMesh DropScene::currentCage() const {
  TetMesh cage = tetMeshOf(body_->body());
  for (Eigen::Vector3d& p : cage.nodes) p = toModel(p);
  return cage;
}

TriangleMesh DropScene::obstacles() const {
  TriangleMesh mesh = obstacles_;
  for (Eigen::Vector3d& p : mesh.positions) p = toModel(p);
  return mesh;
}

double DropScene::floorY() const {
  return toModel(Eigen::Vector3d::Zero()).y();
}

double DropScene::margin() const {
  return static_cast<double>(body_->body().getCollisionShape()->getMargin()) / scale_;
}

double DropScene::nodeSpeed() const {
  const btSoftBody& body = body_->body();
  double squared = 0.0;
  for (int n = 0; n < body.m_nodes.size(); ++n) squared += toEigen(body.m_nodes[n].m_v).squaredNorm();
  return std::sqrt(squared / body.m_nodes.size()) / kSize;
}

Eigen::Vector3d DropScene::toModel(const Eigen::Vector3d& simulated) const {
  return (simulated - start_) / scale_ + centre_;
}

void DropScene::addObstacles() {
  addBox({0.0, -1.0, 0.0}, {kFloorHalfSide, 1.0, kFloorHalfSide}, 0.0);
  addBox({-1.4, -0.35, 0.0}, {1.2, 0.5, 2.0}, -kRampSlope);  // its upper side leads down to the right
  addSphere({0.6, kDomeHeight - kDomeRadius, 0.0}, kDomeRadius);
}

void DropScene::addBox(const Eigen::Vector3d& centre, const Eigen::Vector3d& halfExtents, double slope) {
  const btQuaternion turn(btVector3(0, 0, 1), static_cast<btScalar>(slope));
  world_.addStaticBox(toBullet(halfExtents), btTransform(turn, toBullet(centre)));
  const Eigen::AngleAxisd rotation(slope, Eigen::Vector3d::UnitZ());
  std::vector<Eigen::Vector3d> corners;
  for (int k = 0; k < 8; ++k) {
    const Eigen::Vector3d sign(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1);
    corners.push_back(centre + rotation * sign.cwiseProduct(halfExtents));
  }
  append(obstacles_, "box", corners,
         {{0, 2, 3},
          {0, 3, 1},
          {4, 5, 7},
          {4, 7, 6},
          {0, 1, 5},
          {0, 5, 4},
          {2, 6, 7},
          {2, 7, 3},
          {0, 4, 6},
          {0, 6, 2},
          {1, 3, 7},
          {1, 7, 5}});
}

void DropScene::addSphere(const Eigen::Vector3d& centre, double radius) {
  world_.addStaticSphere(static_cast<btScalar>(radius), toBullet(centre));
  constexpr double kPi = 3.14159265358979323846;
  constexpr int kRings = 24, kAround = 48;
  std::vector<Eigen::Vector3d> points;
  std::vector<std::array<int, 3>> triangles;
  for (int r = 0; r <= kRings; ++r) {
    for (int a = 0; a < kAround; ++a) {
      const double theta = kPi * r / kRings, phi = 2.0 * kPi * a / kAround;
      points.push_back(centre + radius * Eigen::Vector3d(std::sin(theta) * std::cos(phi), std::cos(theta),
                                                         std::sin(theta) * std::sin(phi)));
      const int next = (a + 1) % kAround, row = kAround * r;
      if (r > 0) triangles.push_back({row - kAround + a, row - kAround + next, row + a});
      if (r > 0) triangles.push_back({row - kAround + next, row + next, row + a});
    }
  }
  append(obstacles_, "sphere", points, triangles);
}

void DropScene::readSurface() {
  const PointView<const btScalar> positions = skin_.positions();
  surface_.resize(positions.size());
  for (std::size_t v = 0; v < positions.size(); ++v) {
    const btScalar* p = positions[v];
    surface_[v] = toModel({static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])});
  }
}

}  // namespace tetskin::scenes
