// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/bullet/src/shared/bodies/body_trees.h>
#include <tetskin/bullet/src/shared/solver/required_solver.h>
#include <tetskin/touch/src/forces/node_pushes.h>
#include <tetskin/touch/src/forces/touch_force.h>

namespace tetskin::touch_detail {
namespace {

/// Constant forces on nodes, for some steps.
class Load : public Acting {
 public:
  Load(btSoftBody& body, NodePushes forces, int steps) : body_(&body), forces_(std::move(forces)), left_(steps) {
    if (const BodyWithTrees* made = bodyWithTrees(body)) {
      life_ = made->lifetime();
      watched_ = true;
    }
  }

  /// One whose world has gone before it does not tell that it goes, too.
  btSoftBody* body() const override { return watched_ && life_.expired() ? nullptr : body_; }
  void drop() override { body_ = nullptr; }
  bool spent() const override { return !body() || left_ == 0; }
  void addJoints(btScalar seconds, std::vector<PointJoint>& joints) override {
    --left_;
    for (const NodePush& of : forces_) {
      PointJoint& load = joints.emplace_back();
      load.body = body_;
      load.constant = true;
      load.nodeCount = 1;
      load.nodes[0] = of.node;
      load.weights[0] = 1;
      load.impulse = toBullet(static_cast<double>(seconds) * of.push);
    }
  }

 private:
  btSoftBody* body_;
  bool watched_ = false;
  std::weak_ptr<const void> life_;
  NodePushes forces_;
  int left_;
};

/// Kept by the body, or by the point that asks.
std::shared_ptr<TouchForce> forceFor(DeformableSolver& solver, std::shared_ptr<void>& keeper) {
  auto kept = std::static_pointer_cast<TouchForce>(keeper);
  if (!kept || &kept->solver() != &solver) kept = TouchForce::of(solver);
  keeper = kept;
  return kept;
}

}  // namespace

void addPush(const Lever& lever, const Eigen::Vector3d& push, NodePushes& pushes) {
  for (const LeverNode& of : lever) pushes.push_back({of.node, of.linear.transpose() * push});
}

void applyImpulses(const NodePushes& impulses, btSoftBody& body) {
  for (const NodePush& of : impulses) {
    btSoftBody::Node& node = body.m_nodes[of.node];
    const btVector3 change = toBullet(static_cast<double>(node.m_im) * of.push);
    node.m_v += change;
    node.m_vn += change;  // implicit worlds begin the step with this one
  }
  body.activate();
}

TouchStatus applyForces(NodePushes forces, int steps, btSoftBody& body, std::shared_ptr<void>* owner) {
  if (!body.getBroadphaseHandle()) return TouchStatus::OutOfWorld;
  DeformableSolver* solver = deformableSolverOf(body);
  BodyWithTrees* made = bodyWithTrees(body);
  if (!solver || steps < 1 || !(made || owner)) return TouchStatus::InvalidOption;
  std::shared_ptr<void>& keeper = made ? made->companion() : *owner;
  forceFor(*solver, keeper)->add(std::make_shared<Load>(body, std::move(forces), steps));
  body.activate();
  return TouchStatus::Ok;
}

}  // namespace tetskin::touch_detail
