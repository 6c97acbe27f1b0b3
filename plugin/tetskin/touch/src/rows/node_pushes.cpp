// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/bullet/src/base/body_trees.h>
#include <tetskin/bullet/src/base/build_stream.h>
#include <tetskin/bullet/src/base/required_solver.h>
#include <tetskin/touch/src/rows/node_pushes.h>
#include <tetskin/touch/src/rows/surface_joint_rows.h>

#include <algorithm>
#include <cassert>

namespace tetskin::touch_detail {
namespace {

void visitPushes(BuildStream& stream, NodePushes& pushes) {
  stream.each(pushes, [&](NodePush& push) {
    stream(push.node);
    stream.plain(push.push.data(), 3);
  });
}

/// Constant forces on nodes that act for a number of steps.
class Load : public ActiveJoint {
 public:
  Load(btSoftBody& body, NodePushes forces, int steps) : body_(&body), forces_(std::move(forces)), left_(steps) {
    assert(steps > 0);
    if (const BodyWithTrees* made = bodyWithTrees(body)) {
      life_ = made->lifetime();
      watched_ = true;
    }
  }

  /// If the world was destroyed before the body, it did not report that the body goes, so that its lifetime is tested
  /// too.
  btSoftBody* body() const override { return watched_ && life_.expired() ? nullptr : body_; }
  void drop() override { body_ = nullptr; }
  bool spent() const override { return !body() || left_ == 0; }
  void addJoints(btScalar seconds, std::vector<PointJoint>& joints) override {
    assert(body_ && left_ > 0 && seconds > 0);
    --left_;
    for (const NodePush& push : forces_) {
      PointJoint& load = joints.emplace_back();
      load.body = body_;
      load.constant = true;
      load.at.add(push.node, 1);
      load.impulse = toBullet(static_cast<double>(seconds) * push.push);
    }
  }
  void visitState(WorldStream& stream) override {
    stream(left_);
    for (NodePush& push : forces_) stream.plain(push.push.data(), 3);
  }
  void checkState(WorldStream& stream) override {
    stream.sameObject(body(), "other loads");
    stream.same(forces_.size(), "other loads");
    for (const NodePush& push : forces_) stream.same(push.node, "other loads");
  }
  Kind kind() const override { return Kind::Load; }
  void describe(BuildStream& stream) override {
    stream.object(body_);
    stream(left_);
    visitPushes(stream, forces_);
  }

 private:
  btSoftBody* body_;
  bool watched_ = false;
  std::weak_ptr<const void> life_;
  NodePushes forces_;
  int left_;
};

/// The force of the solver's world; the body, or the point that asks for it, keeps it.
std::shared_ptr<SurfaceJointRows> forceFor(DeformableSolver& solver, std::shared_ptr<void>& keeper) {
  auto kept = std::static_pointer_cast<SurfaceJointRows>(keeper);
  if (!kept || &kept->solver() != &solver) kept = SurfaceJointRows::instanceOf(solver);
  keeper = kept;
  return kept;
}

}  // namespace

void addPush(const PointJacobian& jacobian, const Eigen::Vector3d& push, NodePushes& pushes) {
  for (const PointJacobianNode& node : jacobian) pushes.push_back({node.node, node.linear.transpose() * push});
}

void applyImpulses(const NodePushes& impulses, btSoftBody& body) {
  for (const NodePush& push : impulses) {
    assert(push.node >= 0 && push.node < body.m_nodes.size());
    btSoftBody::Node& node = body.m_nodes[push.node];
    const btVector3 change = toBullet(static_cast<double>(node.m_im) * push.push);
    node.m_v += change;
    node.m_vn += change;  // implicit worlds begin the step with this one
  }
  body.activate();
}

StatusCode applyForces(NodePushes forces, int steps, btSoftBody& body, std::shared_ptr<void>* owner) {
  if (!body.getBroadphaseHandle()) return StatusCode::NotInWorld;
  DeformableSolver* solver = deformableSolverOf(body);
  BodyWithTrees* made = bodyWithTrees(body);
  if (!solver || steps < 1 || !(made || owner)) return StatusCode::InvalidOption;
  std::shared_ptr<void>& keeper = made ? made->companion() : *owner;
  forceFor(*solver, keeper)->add(std::make_shared<Load>(body, std::move(forces), steps));
  body.activate();
  return StatusCode::Ok;
}

std::shared_ptr<ActiveJoint> buildLoad(BuildStream& stream) {
  btSoftBody* body = nullptr;
  int left = 0;
  NodePushes pushes;
  stream.object(body);
  stream(left);
  visitPushes(stream, pushes);
  const auto fits = [&](const NodePush& push) {
    return push.node >= 0 && push.node < body->m_nodes.size() && push.push.allFinite();
  };
  stream.require(body && left > 0 && std::all_of(pushes.begin(), pushes.end(), fits), "a load is damaged");
  if (stream.failed()) return nullptr;
  return std::make_shared<Load>(*body, std::move(pushes), left);
}

}  // namespace tetskin::touch_detail
