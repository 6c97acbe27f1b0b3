// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to snapshots: which objects and joints a world has, and which of them are those of a snapshot.
#pragma once

#include <tetskin/bullet/src/base/world_stream.h>
#include <tetskin/core/types.h>

#include <array>
#include <cstdint>
#include <vector>

namespace tetskin::bullet_detail {

/// What a snapshot does not put back, but compares: ids, shapes, sizes, who is joined to whom.
class WorldDirectory {
 public:
  WorldDirectory() = default;
  explicit WorldDirectory(btDeformableMultiBodyDynamicsWorld& world);

  void visit(WorldStream& stream);

  /// Finds its objects among those of a world: by their ids if all are there, else by their order.
  /// now     of the world
  /// Errors  SnapshotMismatch, with the name of the first object that is missing, another one, or not in here
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
  // Of `find`: for each of these, the index in the world.
  std::vector<int> objectAt_, multibodyAt_, jointAt_, bodyJointAt_;
};

}  // namespace tetskin::bullet_detail
