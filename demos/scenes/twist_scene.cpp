// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "scenes/twist_scene.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "scenes/options.h"

namespace tetskin::scenes {
namespace {

/// Share of the length that is held at either end.
constexpr double kHeldShare = 0.1;
/// Seconds. Bullet measures the rate of deformation in a frame that does not turn with the body, so its damping holds
/// up turning as well: with the default of five times this, all of the twist would gather at the moved end, where the
/// body slips through itself and is untwisted again.
constexpr double kDamping = 0.004;

using Clock = std::chrono::steady_clock;

double millisecondsSince(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

Twist betweenHeldEnds(const Box3& cage) {
  Twist twist = twistOf(cage, 0.0);
  const double held = kHeldShare * (twist.to - twist.from);
  twist.from += held;
  twist.to -= held;
  return twist;
}

}  // namespace

Twist twistOf(const Box3& box, double turn) {
  Twist twist;
  box.sizes().maxCoeff(&twist.axis);
  twist.centre = box.center();
  twist.from = box.min()[twist.axis];
  twist.to = box.max()[twist.axis];
  twist.turn = turn;
  return twist;
}

TwistScene::TwistScene(const Model& model, const SkinOptions& skin)
    : cage_(model.cage),
      diagonal_(boundingBox(model.mesh.positions).diagonal().norm()),
      twist_(betweenHeldEnds(boundingBox(model.cage.nodes))),
      scale_(kSize / boundingBox(model.cage.nodes).sizes().maxCoeff()) {
  TetMesh placed = cage_;
  for (Eigen::Vector3d& p : placed.nodes) p = scale_ * (p - twist_.centre);
  const auto heldAt = [&](double x) { return x <= twist_.from || x >= twist_.to; };
  for (std::size_t n = 0; n < cage_.nodeCount(); ++n) {
    if (heldAt(cage_.nodes[n][twist_.axis])) held_.push_back(static_cast<int>(n));
  }
  SoftBodyOptions options;
  options.damping = kDamping;
  options.pinned = [&](const Eigen::Vector3d& p) {
    return heldAt(p[twist_.axis] / scale_ + twist_.centre[twist_.axis]);
  };
  Result<std::unique_ptr<DeformableBody>> body = DeformableBody::add(world_.world(), placed, options);
  require(body.status());
  body_ = std::move(body).value();
  body_->body().setActivationState(DISABLE_DEACTIVATION);  // it shall not fall asleep while it is held still

  SkinOptions skinOptions = skin;
  skinOptions.interpolation = Interpolation::Quadratic;
  fit_ = quadratic_.bind(body_->body(), cage_, model.mesh, skinOptions);
  if (!fit_.ok()) return;
  skinOptions.interpolation = Interpolation::Linear;
  require(linear_.bind(body_->body(), quadratic_.binding(), skinOptions));
  readSurface(linear_, linearSurface_);
  readSurface(quadratic_, quadraticSurface_);
}

bool TwistScene::step(double turn) {
  const double before = twist_.turn, substep = 1.0 / (kFrameRate * kSubsteps);
  const auto start = Clock::now();
  for (int k = 1; k <= kSubsteps; ++k) {
    twist_.turn = before + (turn - before) * k / kSubsteps;
    moveHeldNodes(substep);
    world_.world().stepSimulation(static_cast<btScalar>(substep), 0);
  }
  simulationMs_ = millisecondsSince(start);
  return updateSkins();
}

void TwistScene::moveHeldNodes(double seconds) {
  for (const int n : held_) {
    const Eigen::Vector3d target = scale_ * (twist_.point(cage_.nodes[n]) - twist_.centre);
    moveHeldNode(body_->body().m_nodes[n], target, seconds);
  }
}

void TwistScene::release() {
  btSoftBody& body = body_->body();
  const std::vector<double> masses = lumpedMasses(cage_, SoftBodyOptions().mass);
  const auto moved = [&](int n) { return cage_.nodes[n][twist_.axis] >= twist_.to; };
  for (const int n : held_) {
    if (moved(n)) body.setMass(n, static_cast<btScalar>(masses[n]));
  }
  held_.erase(std::remove_if(held_.begin(), held_.end(), moved), held_.end());
  body.m_bUpdateRtCst = false;  // or Bullet builds its tree of faces, see makeSoftBody
}

double TwistScene::nodesOffTwist() const {
  double squared = 0.0;
  for (std::size_t n = 0; n < cage_.nodeCount(); ++n) {
    const Eigen::Vector3d now = toModel(body_->body().m_nodes[static_cast<int>(n)].m_x.m_floats);
    squared += (now - twist_.point(cage_.nodes[n])).squaredNorm();
  }
  return std::sqrt(squared / static_cast<double>(cage_.nodeCount())) / diagonal_;
}

Eigen::Vector3d TwistScene::toModel(const btScalar* p) const {
  const Eigen::Vector3d simulated(static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2]));
  return simulated / scale_ + twist_.centre;
}

bool TwistScene::updateSkins() {
  auto start = Clock::now();
  const UpdateStatus linear = linear_.update();
  linearUs_ = 1e3 * millisecondsSince(start);
  start = Clock::now();
  const UpdateStatus quadratic = quadratic_.update();
  quadraticUs_ = 1e3 * millisecondsSince(start);
  readSurface(linear_, linearSurface_);
  readSurface(quadratic_, quadraticSurface_);
  return linear == UpdateStatus::Updated && quadratic == UpdateStatus::Updated;
}

void TwistScene::readSurface(const SoftBodySkin& skin, std::vector<Eigen::Vector3d>& surface) const {
  const PointView<const btScalar> positions = skin.positions();
  surface.resize(positions.size());
  for (std::size_t v = 0; v < positions.size(); ++v) surface[v] = toModel(positions[v]);
}

}  // namespace tetskin::scenes
