// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to snapshots: the objects and joints of a world, and how they correspond to those of a snapshot.
#pragma once

#include <tetskin/bullet/src/base/world_stream.h>
#include <tetskin/core/types.h>

#include <array>
#include <cstdint>
#include <vector>

namespace tetskin::bullet_detail {

/// What a snapshot does not restore, but compares: ids, shapes, sizes, connections by joints.
class WorldDirectory {
 public:
  WorldDirectory() = default;
  explicit WorldDirectory(btDeformableMultiBodyDynamicsWorld& world);

  void serialize(WorldStream& stream);

  /// Finds its objects among those of a world: by their ids if all are there, otherwise by their order.
  /// now     the world's directory
  /// Errors  SnapshotMismatch, naming the first object that is missing, differs, or is not in this directory
  Status find(WorldDirectory now);
  /// After `find`: gives the world's lists the order that they had when it was saved.
  void order(btDeformableMultiBodyDynamicsWorld& world) const;

 private:
  struct Object {
    int id, type, userIndex;  ///< type: btCollisionObject::CollisionObjectTypes
    std::uint64_t fingerprint;
  };
  /// A multibody, or a joint: its kind, and the indices of its objects or multibodies; -1: none.
  using Key = std::array<std::int64_t, 5>;

  bool findById(const WorldDirectory& now);
  bool isSame(const WorldDirectory& now, std::size_t object) const;
  Status differenceOfObjects(const WorldDirectory& now, bool byId) const;
  bool listsFit() const;

  std::vector<Object> objects_;
  std::vector<int> moving_, softs_;  ///< indices of objects, in the order of the world's lists of such bodies
  std::vector<Key> multibodies_, joints_, bodyJoints_;
  // Result of `find`: for each of these, the index in the world.
  std::vector<int> objectAt_, multibodyAt_, jointAt_, bodyJointAt_;
};

}  // namespace tetskin::bullet_detail
