// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// An object that two fingers hold by friction does not slip while they shake it, as far as Coulomb's law allows, and
// slides by that law beyond.
#include "contact_test.h"
#include "solver/recorded_forces.h"

namespace tetskin::test {
namespace {

using Eigen::Vector3d;

constexpr int kFrames = 60;  // per second
constexpr btScalar kFriction = btScalar(0.6);
constexpr double kSqueeze = 0.05, kRate = 15.0, kHalf = 0.4;

/// 0 before, 1 after, smooth between.
double ramp(double x) {
  x = std::min(std::max(x, 0.0), 1.0);
  return x * x * (3.0 - 2.0 * x);
}

/// A soft box of 1 kg between two kinematic plates.
class Grip {
 public:
  /// perStep  the application moves the plates in each step, not once per frame
  Grip(bool bySurface, bool perStep, int substeps) : perStep_(perStep), substeps_(substeps) {
    world_.deformable().setGravity(btVector3(0, 0, 0));
    material_.friction = 1.0;
    material_.relativeStiffness = 200.0;
    const btVector3 begins(0, 5, 0);
    if (bySurface) {
      touching_ = std::make_unique<TouchingBody>(world_, boxMesh(Vector3d::Constant(kHalf)), begins,
                                                 SurfaceContactOptions{}, material_);
      body_ = &touching_->body->body();
    } else {
      TetMesh cage = latticeCage(4, 4, 4, kHalf / 2);
      for (Vector3d& p : cage.nodes) p += toEigen(begins) - Vector3d::Constant(kHalf);
      nodes_ = added(world_, cage, material_);
      body_ = &nodes_->body();
    }
    body_->setActivationState(DISABLE_DEACTIVATION);
    for (auto& finger : fingers_) {
      finger = std::make_unique<Obstacle>(world_, std::make_unique<btBoxShape>(btVector3(btScalar(0.1), 1, 5)),
                                          placeAt(btVector3(0, 50, 0)));
      finger->body().setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
      finger->body().setActivationState(DISABLE_DEACTIVATION);
      finger->body().setFriction(kFriction);
    }
    forces_ = forcesIn(world_);
    for (int k = 0; k < kFrames; ++k) frame([&](double t) { squeezed_ = kSqueeze * ramp(t); });
    simulate(0.5, [](double) {});
    limit_ = kFriction * 2.0 * std::abs(static_cast<double>(forceOn(0).x()));
  }

  /// Seconds; `move` sets the state that the fingers have at a time since this call.
  template <class Move>
  void simulate(double seconds, const Move& move) {
    const double began = time_;
    const int frames = static_cast<int>(std::round(seconds * kFrames));
    for (int k = 0; k < frames; ++k) frame([&](double t) { move(t - began); });
  }
  btVector3 forceOn(int finger) const { return forces_->forcesOn(fingers_[finger]->body()).total().force; }
  /// Of the body's centre in the space of the fingers.
  Vector3d held() const {
    Vector3d centre = Vector3d::Zero();  // of 1 kg
    for (int n = 0; n < body_->m_nodes.size(); ++n) centre += toEigen(body_->m_nodes[n].m_x / body_->m_nodes[n].m_im);
    return toEigen(btTransform(turned, at).inverse() * toBullet(centre));
  }
  /// The acceleration that friction can hold: the body has 1 kg.
  double limit() const { return limit_; }
  EmptyWorld& world() { return world_; }

  btVector3 at{0, 5, 0};
  btQuaternion turned = btQuaternion::getIdentity();

 private:
  template <class Move>
  void frame(const Move& move) {
    const auto length = btScalar(1) / kFrames;
    for (int s = 0; s < (perStep_ ? substeps_ : 1); ++s) {
      time_ += 1.0 / kFrames / (perStep_ ? substeps_ : 1);
      move(time_);
      for (int k = 0; k < 2; ++k) {
        const auto out = static_cast<btScalar>((k ? 1 : -1) * (kHalf + 0.12 - squeezed_));
        fingers_[k]->body().setWorldTransform(btTransform(turned, at + quatRotate(turned, btVector3(out, 0, 0))));
      }
      const btScalar step = length / static_cast<btScalar>(substeps_);
      world_.deformable().stepSimulation(perStep_ ? step : length, substeps_, step);
    }
  }

  bool perStep_;
  int substeps_;
  double time_ = 0.0, squeezed_ = 0.0, limit_ = 0.0;
  SoftBodyOptions material_;
  TetskinWorld world_;
  std::unique_ptr<TouchingBody> touching_;
  std::unique_ptr<DeformableBody> nodes_;
  btSoftBody* body_ = nullptr;
  std::array<std::unique_ptr<Obstacle>, 2> fingers_;
  std::unique_ptr<ForceRecord> forces_;
};

struct Shake {
  const char* name;
  btVector3 along;  ///< moved along this axis, or
  btVector3 about;  ///< turned about this one
};

TEST(ShakenGrip, KeepsWhatFrictionCanHold) {
  const Shake shakes[] = {{"along the normal", {1, 0, 0}, {0, 0, 0}},
                          {"up and down", {0, 1, 0}, {0, 0, 0}},
                          {"turned", {0, 0, 0}, {0, 0, 1}}};
  for (const bool bySurface : {true, false}) {
    for (const bool perStep : {true, false}) {
      for (const Shake& shake : shakes) {
        Grip grip(bySurface, perStep, 4);
        const double share = 0.5 * grip.limit();
        const double weight = 0.3 * share, way = 0.7 * share / (kRate * kRate);
        const auto gravity = static_cast<btScalar>(-weight);
        grip.simulate(0.5, [&](double t) {
          grip.world().deformable().setGravity(btVector3(0, gravity * static_cast<btScalar>(ramp(2 * t)), 0));
        });
        const Vector3d before = grip.held();
        const btVector3 from = grip.at;
        grip.simulate(2.5, [&](double t) {
          const auto size = static_cast<btScalar>(way * ramp(4 * t) * ramp(4 * (2.2 - t)) * std::sin(kRate * t));
          grip.at = from + size * shake.along;
          if (!shake.about.isZero()) grip.turned = btQuaternion(shake.about, size / btScalar(kHalf));
        });
        EXPECT_LT((grip.held() - before).norm(), 2e-3) << shake.name << (bySurface ? ", by its surface" : ", by nodes")
                                                       << (perStep ? ", per step" : ", per frame");
      }
    }
  }
}

TEST(ShakenGrip, SlidesByCoulombsLawAboveTheLimit) {
  for (const bool perStep : {true, false}) {
    Grip grip(true, perStep, 4);
    const btVector3 from = grip.at;
    const double acceleration = 1.5 * grip.limit();
    double time = 0.0, held = 0.0;  // the current force of the plates: a sheared body presses less
    const auto pull = [&](double seconds) {
      const double before = time;
      grip.simulate(seconds, [&](double t) {
        time = before + t;
        grip.at = from + btVector3(0, 0, static_cast<btScalar>(acceleration * time * time / 2));
      });
      const btVector3 force = grip.forceOn(0);
      EXPECT_NEAR(force.z() / force.x(), kFriction, 0.001);
      held = 2.0 * static_cast<double>(kFriction * std::abs(force.x()));
      return grip.held().z();
    };
    // At the first time, friction has sheared the body as far as it can, and the body already has a speed.
    const double each = 0.15, first = pull(0.1), second = pull(each), third = pull(each);
    const double law = (acceleration - held) * each * each;
    EXPECT_NEAR((2.0 * second - first - third) / law, 1.0, 0.02) << (perStep ? "per step" : "per frame");
  }
}

}  // namespace
}  // namespace tetskin::test
