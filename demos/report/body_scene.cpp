// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "report/body_scene.h"

#include "scenes/input_error.h"

namespace tetskin::report {
namespace {

constexpr double kFloorHalfSide = 10.0;
constexpr double kEarth = 9.81;
/// Of a whole body as large as the reference, kg. Nothing but contacts depends on it.
constexpr double kReferenceMass = 1.0;
constexpr double kMarginShare = 0.02;  ///< of the size
/// Young's modulus over density x gravity x size. The standing serpent nods by a tenth of its size.
constexpr double kSagStiffness = 150.0, kDropStiffness = 50.0;
/// Damping in substeps. Half of one is the least that is stable at any stiffness.
constexpr double kDampingSubsteps = 0.6;
constexpr int kSubsteps = 4, kMostSubsteps = 64;

/// The stiffness that a landing of this cage can have with so many substeps, at most the one wished for.
double landingStiffness(const TetMesh& cage, double wish, int substeps) {
  scenes::DeformableWorld world;
  SoftBodyOptions options;
  options.density = kReferenceMass / totalVolume(cage);
  options.relativeStiffness = wish / (options.density * kEarth * boundingBox(cage.nodes).sizes().maxCoeff());
  options.timeStep = 1.0 / (kFrameRate * substeps);
  Result<std::unique_ptr<DeformableBody>> body = DeformableBody::add(world.world(), cage, options);
  scenes::require(body.status());
  return body.value()->youngsModulus();
}

SoftBodyOptions optionsOf(const SceneSetup& setup, const Material& material) {
  SoftBodyOptions options;
  options.forceModel = material.forceModel;
  options.density = material.density;
  options.margin = material.margin;
  options.youngsModulus = material.youngsModulus;
  options.poissonRatio = material.poissonRatio;
  options.damping = material.damping;
  options.implicit = material.implicit;
  options.pinned = setup.held;
  return options;
}

}  // namespace

Material materialOf(SceneKind kind, const TetMesh& reference, double relativeStiffness, bool implicit) {
  const bool drop = kind == SceneKind::Drop;
  Material material;
  material.density = kReferenceMass / totalVolume(reference);
  material.margin = kMarginShare * kSize;
  material.implicit = implicit;
  material.substeps = kSubsteps;
  const double relative = relativeStiffness > 0.0 ? relativeStiffness : drop ? kDropStiffness : kSagStiffness;
  material.youngsModulus = relative * material.density * kEarth * kSize;
  if (!drop) {
    material.damping = kDampingSubsteps / (kFrameRate * kSubsteps);
    return material;
  }
  material.forceModel = ForceModel::NeoHookean;
  material.damping = SoftBodyOptions().damping;
  constexpr double kReached = 0.999;
  double stiffness = landingStiffness(reference, material.youngsModulus, material.substeps);
  while (stiffness < kReached * material.youngsModulus && material.substeps < kMostSubsteps) {
    material.substeps *= 2;
    stiffness = landingStiffness(reference, material.youngsModulus, material.substeps);
  }
  material.youngsModulus = stiffness;
  return material;
}

BodyScene::BodyScene(const SceneSetup& setup, const TetMesh& cage, const Material& material)
    : setup_(setup),
      substeps_(material.substeps),
      rest_(cage.nodes),
      world_(btVector3(0, static_cast<btScalar>(-setup.gravity), 0)) {
  for (std::size_t n = 0; setup.held && n < rest_.size(); ++n) {
    if (setup.held(rest_[n])) held_.push_back(static_cast<int>(n));
  }
  if (setup.held && held_.empty()) throw scenes::InputError("the scene holds no node of the cage");
  if (setup.floor) {
    const btVector3 half(kFloorHalfSide, 1, kFloorHalfSide);
    const btVector3 centre(0, static_cast<btScalar>(setup.floorY) - 1, 0);
    world_.addStaticBox(half, btTransform(btQuaternion::getIdentity(), centre));
  }
  Result<std::unique_ptr<DeformableBody>> body = DeformableBody::add(world_.world(), cage, optionsOf(setup, material));
  scenes::require(body.status());
  body_ = std::move(body).value();
  body_->body().setActivationState(DISABLE_DEACTIVATION);  // a body that sleeps costs less, and is not compared
}

void BodyScene::step(int frame) {
  const double substep = 1.0 / (kFrameRate * substeps_);
  if (!setup_.twist) {
    world_.world().stepSimulation(static_cast<btScalar>(1.0 / kFrameRate), substeps_, static_cast<btScalar>(substep));
    return;
  }
  for (int k = 1; k <= substeps_; ++k) {
    moveHeldNodes(frame - 1 + static_cast<double>(k) / substeps_, substep);
    world_.world().stepSimulation(static_cast<btScalar>(substep), 0);
  }
}

void BodyScene::moveHeldNodes(double frame, double seconds) {
  scenes::Twist twist = *setup_.twist;
  twist.turn = setup_.turnAt(frame);
  for (const int n : held_) scenes::moveHeldNode(body().m_nodes[n], twist.point(rest_[n]), seconds);
}

}  // namespace tetskin::report
