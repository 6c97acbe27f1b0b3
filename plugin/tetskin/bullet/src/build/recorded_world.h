// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/bullet/deformable_body.h>
#include <tetskin/bullet/deformable_world.h>
#include <tetskin/bullet/src/base/build_stream.h>
#include <tetskin/bullet/src/build/rigid_objects.h>
#include <tetskin/bullet/src/exported/point_search.h>

#include <memory>
#include <vector>

namespace tetskin::bullet_detail {

/// Describes a world, so that a RecordedWorld can be built of it, without its state.
/// world   created with a `DeformableSolver`, not within a step
/// store   gets what is new in it
/// Error   NotSaved: the world has something that cannot be described, which the message names
Result<std::vector<unsigned char>> describeWorld(btDeformableMultiBodyDynamicsWorld& world, CopyStore& store);

/// A world with all its bodies, objects, joints and contacts, in the state in which they are created.
class RecordedWorld {
 public:
  /// bytes     from `describeWorld`
  /// store     its large values, in their order
  /// builders  of libraries beyond tetskin::bullet
  /// Errors    Malformed; InvalidOption: a builder is missing
  static Result<std::unique_ptr<RecordedWorld>> build(const std::vector<unsigned char>& bytes, CopyStore& store,
                                                      const std::vector<const SourceBuilder*>& builders);
  ~RecordedWorld();
  RecordedWorld(const RecordedWorld&) = delete;
  RecordedWorld& operator=(const RecordedWorld&) = delete;

  DeformableWorld& world() { return world_; }

 private:
  RecordedWorld() = default;
  void visit(BuildStream& stream, const std::vector<const SourceBuilder*>& builders);

  DeformableWorld world_;
  std::vector<BuiltObject> objects_;
  std::vector<std::unique_ptr<DeformableBody>> bodies_;
  std::vector<std::unique_ptr<btTypedConstraint>> joints_;
  std::vector<std::unique_ptr<PointSearch>> searches_;
  std::vector<BuiltSource> sources_;
};

}  // namespace tetskin::bullet_detail
