// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "replay_scenes.h"

#include "replay_models.h"
#include "support/rigids.h"

#include <tetskin/bullet/soft_body_skin.h>
#include <tetskin/contact/soft_contacts.h>
#include <tetskin/contact/surface_contact.h>
#include <tetskin/solver/deformable_body.h>
#include <tetskin/touch/surface_joint.h>
#include <tetskin/touch/surface_point.h>

#include <algorithm>
#include <cstdlib>

namespace tetskin::test {
namespace {

btVector3 at(double x, double y, double z) {
  return {btScalar(x), btScalar(y), btScalar(z)};
}

void require(bool condition) {
  if (!condition) std::abort();
}

std::unique_ptr<btCollisionShape> plane(const btVector3& normal, double distance) {
  return std::make_unique<btStaticPlaneShape>(normal, btScalar(distance));
}
std::unique_ptr<btCollisionShape> ball(double radius) {
  return std::make_unique<btSphereShape>(btScalar(radius));
}
std::unique_ptr<btCollisionShape> box(const btVector3& half) {
  return std::make_unique<btBoxShape>(half);
}

/// A soft body of a model, which touches rigid bodies at its surface.
struct Soft {
  Soft(tetskin::DeformableWorld& world, const ReplayModel& model, const Eigen::Vector3d& offset,
       const SoftBodyOptions& options)
      : owner(DeformableBody::add(world, movedBy(model.cage, offset), options).value()),
        contact(SurfaceContact::add(world, owner->body(), *model.binding, model.mesh).value()) {}
  btSoftBody& body() { return owner->body(); }

  std::unique_ptr<DeformableBody> owner;
  std::unique_ptr<SurfaceContact> contact;
};

SoftBodyOptions firmness(double relativeStiffness) {
  SoftBodyOptions options;
  options.relativeStiffness = relativeStiffness;
  options.faceTree = false;
  return options;
}

/// A scene that stands on a floor at y = 0.
class OnFloor : public ReplayScene {
 protected:
  explicit OnFloor(const DeformableWorldOptions& options) : ReplayScene(options) {}

 private:
  Rigid floor_{world(), plane(at(0, 1, 0), 0), 0, at(0, 0, 0)};
};

/// Four walls around a square, at this distance from its centre.
class Walls {
 public:
  Walls(tetskin::DeformableWorld& world, double distance) {
    for (const btVector3& inward : {at(1, 0, 0), at(-1, 0, 0), at(0, 0, 1), at(0, 0, -1)}) {
      walls_.push_back(std::make_unique<Rigid>(world, plane(inward, -distance), btScalar(0), at(0, 0, 0)));
    }
  }

 private:
  std::vector<std::unique_ptr<Rigid>> walls_;
};

class Drop : public OnFloor {
 public:
  explicit Drop(const DeformableWorldOptions& options) : OnFloor(options) {}

 private:
  ReplayModel model_ = ballModel(6, 12);
  Rigid stone_{world(), ball(0.25), 0, at(0.375, 0.125, 0.125)};
  Rigid ball_{world(), ball(0.25), 5, at(-0.375, 0.25, -0.0625)};
  Soft body_{world(), model_, {0, 1.25, 0}, firmness(60)};
};

class Heap : public OnFloor {
 public:
  explicit Heap(const DeformableWorldOptions& options) : OnFloor(options) {
    for (int n = 0; n < kToys; ++n) {
      const int i = n % 3, j = n / 9, k = n / 3 % 3;
      const Eigen::Vector3d shift(((5 * n) % 7 - 3) / 32.0, 0, ((3 * n) % 11 - 5) / 64.0);
      toys_.push_back(std::make_unique<Soft>(
          world(), model_, Eigen::Vector3d(0.875 * (i - 1), 0.75 + 1.25 * j, 0.875 * (k - 1)) + shift, firmness(60)));
      require(contacts_->add(toys_.back()->body(), model_.shape()).ok());
    }
  }

 private:
  static constexpr int kToys = 26;
  ReplayModel model_ = ballModel(3, 6);
  Walls walls_{world(), 1.5};
  std::vector<std::unique_ptr<Soft>> toys_;
  std::unique_ptr<SoftContacts> contacts_ = SoftContacts::add(world()).value();
};

class Drag : public OnFloor {
 public:
  explicit Drag(const DeformableWorldOptions& options) : OnFloor(options) {}

  /// Along a zigzag, up and down, and left to fall for the last quarter.
  void act(int frame) override {
    if (frame == 180) require(spring_->setMaxForce(1.0 / 1024) == StatusCode::Ok);
    const int leg = frame / 40, within = frame % 40;
    const int across = leg % 2 == 0 ? within - 20 : 20 - within;
    const int up = within < 20 ? within : 40 - within;
    require(spring_->setTarget(at(across / 32.0, 1 + up / 32.0, frame / 128.0)) == StatusCode::Ok);
  }

 private:
  ReplayModel model_ = ballModel(5, 10);
  Rigid hat_{world(), box(at(0.25, 0.0625, 0.25)), 1, at(0, 1.125, 0)};
  Rigid step_{world(), box(at(2, 0.25, 0.25)), 0, at(0, 0.25, 1.25)};
  Soft body_{world(), model_, {0, 0.5, 0}, firmness(50)};
  SurfaceTree tree_ = SurfaceTree::create(model_.binding, model_.mesh).value();
  std::unique_ptr<SurfaceWeld> weld_ =
      SurfaceWeld::add(world(), tree_.pointAtRest(body_.body(), {0, 0.5, 0}).value(), *hat_).value();
  std::unique_ptr<SurfaceSpring> spring_ =
      SurfaceSpring::add(world(), tree_.pointAtRest(body_.body(), {0, 0, 0.5}).value()).value();
};

class Twist : public OnFloor {
 public:
  explicit Twist(const DeformableWorldOptions& options) : OnFloor(options) {}

  /// The end at x > 0 turns by (1, 1/32) / |(1, 1/32)| in each frame; the square root is exactly rounded everywhere.
  void act(int frame) override {
    if (frame > kReleased) return;
    double c = 1, s = 0;
    const double length = std::sqrt(1 + 1.0 / 1024);
    for (int k = 0; k < frame; ++k) {
      const double turned = (c - s / 32) / length;
      s = (s + c / 32) / length;
      c = turned;
    }
    for (int n = 0; n < static_cast<int>(model_.cage.nodes.size()); ++n) {
      const Eigen::Vector3d& p = model_.cage.nodes[n];
      if (p.x() != 1.5) continue;
      const btVector3 there = at(p.x(), offset().y() + (c * p.y() - s * p.z()), s * p.y() + c * p.z());
      const Status done =
          frame == kReleased ? body_.owner->setPinned(n, false) : body_.owner->setPinnedPosition(n, there);
      require(done.ok());
    }
  }

 private:
  static constexpr int kCubes = 12, kReleased = 160;
  static Eigen::Vector3d offset() { return {0, 0.625, 0}; }
  static SoftBodyOptions options() {
    SoftBodyOptions made = firmness(200);
    made.pinned = [](const Eigen::Vector3d& p) { return p.x() == -1.5 || p.x() == 1.5; };
    return made;
  }
  ReplayModel model_ = barModel(kCubes, 3, 0.25);
  Soft body_{world(), model_, offset(), options()};
};

class Pit : public OnFloor {
 public:
  explicit Pit(const DeformableWorldOptions& options) : OnFloor(options) {
    for (int n = 0; n < kBalls; ++n) {
      const double shift = ((7 * n) % 13 - 6) / 512.0;
      const btVector3 where =
          at(0.34375 * (n % 4 - 1.5) + shift, 0.25 + 0.375 * (n / 16), 0.34375 * (n / 4 % 4 - 1.5) - shift);
      balls_.push_back(std::make_unique<Rigid>(world(), ball(0.15625), btScalar(0.25), where));
    }
  }

 private:
  static constexpr int kBalls = 48;
  ReplayModel model_ = ballModel(4, 8);
  Walls walls_{world(), 0.75};
  std::vector<std::unique_ptr<Rigid>> balls_;
  Soft body_{world(), model_, {0.0625, 2, 0.125}, firmness(50)};
};

/// Balls whose material changes as they fall on each other: each of the four ways has its own, the last has all.
class Changing : public OnFloor {
 public:
  explicit Changing(const DeformableWorldOptions& options) : OnFloor(options) {
    for (int n = 0; n < kBalls; ++n) {
      const double aside = n % 2 - 0.5, height = 0.625 + 0.9375 * (n / 2);
      const Eigen::Vector3d where =
          n / 2 % 2 == 0 ? Eigen::Vector3d(aside, height, 0) : Eigen::Vector3d(0, height, aside);
      balls_.push_back(std::make_unique<Soft>(world(), model_, where, firmness(60)));
      require(contacts_->add(balls_.back()->body(), model_.shape()).ok());
    }
    for (const int n : {kClay, kAll}) require(ball(n).setPlasticity(clay()).ok());
    for (const int n : {kMuscle, kAll}) require(ball(n).addMuscle(muscle()).ok());
    require(ball(kGas).setGas(stress(0.0625), stress(0.25)).ok());
    require(ball(kAll).setPressure(stress(0.03125)).ok());
  }

  /// Muscles flex and relax; what grows does so for a second, by an eighth. By frame 119, clay has flowed, and they
  /// touch.
  void act(int frame) override {
    const int within = frame % 64;
    const double activation = (within < 32 ? within : 64 - within) / 32.0;
    for (const int n : {kMuscle, kAll}) require(ball(n).setActivation(0, activation).ok());
    for (const int n : {kGrowth, kAll}) require(ball(n).setGrowth(1 + std::min(frame, 64) / 512.0).ok());
    if (frame == 119) require(flowed(kClay) && flowed(kAll) && !contacts_->contacts().empty());
  }

 private:
  enum { kClay, kMuscle, kGrowth, kGas, kAll, kBalls };

  DeformableBody& ball(int n) { return *balls_[static_cast<std::size_t>(n)]->owner; }
  double stress(double strain) { return strain * ball(0).youngsModulus(); }
  bool flowed(int n) {
    const std::vector<double> strains = ball(n).plasticStrains();
    return *std::max_element(strains.begin(), strains.end()) > 0.01;
  }
  Plasticity clay() {
    Plasticity made;
    made.yieldStress = stress(0.015625);
    made.hardening = stress(0.0625);
    made.flowRate = 64;
    made.largestStrain = 0.5;
    return made;
  }
  Muscle muscle() {
    Muscle made;
    for (int t = 0; t < static_cast<int>(model_.cage.tets.size()); t += 2) made.tets.push_back(t);
    made.fibres = {{0.5, 1, 0.25}};
    made.stress = stress(0.25);
    return made;
  }
  ReplayModel model_ = ballModel(3, 6);
  Walls walls_{world(), 1};
  std::vector<std::unique_ptr<Soft>> balls_;
  std::unique_ptr<SoftContacts> contacts_ = SoftContacts::add(world()).value();
};

template <class Scene>
std::unique_ptr<ReplayScene> make(const DeformableWorldOptions& options) {
  return std::make_unique<Scene>(options);
}

}  // namespace

std::unique_ptr<ReplayScene> ReplayScene::create(const std::string& name, const DeformableWorldOptions& options) {
  if (name == "drop") return make<Drop>(options);
  if (name == "heap") return make<Heap>(options);
  if (name == "drag") return make<Drag>(options);
  if (name == "twist") return make<Twist>(options);
  if (name == "pit") return make<Pit>(options);
  if (name == "changing") return make<Changing>(options);
  return nullptr;
}

const std::vector<std::string>& replaySceneNames() {
  static const std::vector<std::string> names = {"drop", "heap", "drag", "twist", "pit", "changing"};
  return names;
}

void ReplayScene::step(int frame) {
  act(frame);
  world_.stepSimulation(btScalar(1) / 60, 4, btScalar(1) / 240);
}

}  // namespace tetskin::test
