// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/bullet/src/base/build_stream.h>
#include <tetskin/bullet/src/base/required_solver.h>
#include <tetskin/touch/src/joints/joint_owner.h>
#include <tetskin/touch/src/rows/node_pushes.h>
#include <tetskin/touch/surface_joint.h>

#include <memory>
#include <vector>

namespace tetskin {

using namespace bullet_detail;

namespace {

using touch_detail::ActiveJoint;
using touch_detail::Joint;
using touch_detail::JointOwner;
using touch_detail::SurfaceJointRows;

struct BuiltJoints {
  std::shared_ptr<SurfaceJointRows> rows;
  std::vector<std::unique_ptr<JointOwner>> owners;
};

/// Adds the next entry. The list of forces has one object for all joints and loads of a world, which the first adds.
void buildEntry(BuildStream& stream, BuiltJoints& built) {
  DeformableSolver& solver = *deformableSolverOf(stream.world());
  ActiveJoint::Kind kind{};
  stream(kind);
  if (kind == ActiveJoint::Kind::Load) {
    std::shared_ptr<ActiveJoint> load = touch_detail::buildLoad(stream);
    if (!load) return;
    built.rows = SurfaceJointRows::instanceOf(solver);
    built.rows->add(std::move(load));
  } else if (std::shared_ptr<Joint> joint = Joint::build(stream)) {
    built.owners.push_back(std::make_unique<JointOwner>(std::move(joint)));
    built.rows = SurfaceJointRows::instanceOf(solver);
  }
}

BuiltSource buildJoints(BuildStream& stream) {
  const auto built = std::make_shared<BuiltJoints>();
  const std::size_t count = stream.length(0);
  for (std::size_t k = 0; k < count && !stream.failed(); ++k) buildEntry(stream, *built);
  stream.require(built->rows != nullptr, "springs and welds are damaged");
  if (stream.failed()) return {};
  return {built, built->rows.get()};
}

}  // namespace

const SourceBuilder* builderOfJoints() {
  static constexpr SourceBuilder builder{SurfaceJointRows::kBuilderName, buildJoints};
  return &builder;
}

}  // namespace tetskin
