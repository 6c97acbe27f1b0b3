// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Between the libraries: a StateStream that knows Bullet's types, and refers to objects by their index in the world.
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <BulletSoftBody/btSoftBody.h>
#include <LinearMath/btTransform.h>
#include <tetskin/core/src/base/state/state_stream.h>

#include <string>
#include <type_traits>
#include <vector>

namespace tetskin::bullet_detail {

class WorldStream : public StateStream {
 public:
  template <class... Arguments>
  explicit WorldStream(btDeformableMultiBodyDynamicsWorld& world, Arguments... arguments)
      : StateStream(arguments...), world_(world) {}

  btDeformableMultiBodyDynamicsWorld& world() const { return world_; }
  /// Whether to include force records, which describe steps and change none.
  bool withRecords() const { return withRecords_; }
  void leaveOutRecords() { withRecords_ = false; }

  using StateStream::operator();
  /// The first three numbers: the fourth is not always set.
  void operator()(btVector3& v) {
    plain(&v[0], 3);
    if (restoring()) v[3] = 0;
  }
  void operator()(btMatrix3x3& m) { (*this)(m[0], m[1], m[2]); }
  void operator()(btTransform& t) { (*this)(t.getBasis(), t.getOrigin()); }
  void operator()(btQuaternion& q) { plain(&q[0], 4); }
  template <class First, class Second, class... More>
  void operator()(First& first, Second& second, More&... more) {
    (*this)(first);
    (*this)(second);
    ((*this)(more), ...);
  }

  /// An object of the world, stored as its index there; or null. While a snapshot is restored, the world's list of
  /// objects has the snapshot's order. An object that is no longer in the world may have been destroyed: it is read as
  /// null.
  template <class Object>
  void object(Object*& object) {
    int index = saving() && object ? indexOf(*object) : -1;
    (*this)(index);
    if (!restoring()) return;
    const btCollisionObjectArray& objects = world_.getCollisionObjectArray();
    object = nullptr;
    if (index == -1) return;
    if (index < 0 || index >= objects.size()) return fail();
    if constexpr (std::is_same_v<std::remove_const_t<Object>, btSoftBody>) {
      object = btSoftBody::upcast(objects[index]);
      if (!object) fail();
    } else {
      object = objects[index];
    }
  }

  /// True if an object, which may have been destroyed, is in the world.
  bool has(const btCollisionObject* object) { return object && indexOf(*object) >= 0; }

  /// A map whose keys are objects of the world: visit(key, value) in the order of the objects, which does not depend on
  /// addresses. Entries for objects that are not in the world are left out, and lost on restoring.
  template <class Map, class Visit>
  void byObject(Map& map, Visit&& visit) {
    using Key = typename Map::key_type;
    std::vector<int> indices;
    if (saving()) {
      const btCollisionObjectArray& objects = world_.getCollisionObjectArray();
      for (int k = 0; k < objects.size(); ++k) {
        if (const Key key = keyOf<Key>(*objects[k]); key && map.find(key) != map.end()) indices.push_back(k);
      }
    } else {
      map.clear();
    }
    array(indices);
    for (const int index : indices) {
      Key key = nullptr;
      if (index >= 0 && index < world_.getCollisionObjectArray().size()) {
        key = keyOf<Key>(*world_.getCollisionObjectArray()[index]);
      }
      if (!key) return fail();
      visit(*key, map[key]);
    }
  }

  /// Names what cannot be saved, or does not fit. Only the first refusal counts.
  void refuse(const std::string& message) {
    if (refusal_.empty()) refusal_ = message;
    fail();
  }
  const std::string& refusal() const { return refusal_; }
  /// A number that must be the same in the saved world and in the restored one.
  template <class T>
  void same(T now, const char* otherwise) {
    T saved = now;
    (*this)(saved);
    if (saved != now) refuse(otherwise);
  }
  /// The object must have the same index in both worlds. Null, or an object that is not in the world, counts as none.
  void sameObject(const btCollisionObject* object, const char* otherwise) {
    same(object ? indexOf(*object) : -1, otherwise);
  }

 private:
  /// -1: not in the world. The same object is often asked for many times in succession.
  int indexOf(const btCollisionObject& object) {
    const btCollisionObjectArray& objects = world_.getCollisionObjectArray();
    if (last_ < objects.size() && objects[last_] == &object) return last_;
    const int found =
        objects.findLinearSearch(const_cast<btCollisionObject*>(&object));  // NOLINT: pointers are compared
    if (found == objects.size()) return -1;
    return last_ = found;
  }

  template <class Key>
  static Key keyOf(btCollisionObject& object) {
    using Object = std::remove_const_t<std::remove_pointer_t<Key>>;
    if constexpr (std::is_same_v<Object, btSoftBody> || std::is_same_v<Object, btRigidBody>) {
      return Object::upcast(&object);
    } else {
      return &object;
    }
  }

  btDeformableMultiBodyDynamicsWorld& world_;
  bool withRecords_ = true;
  std::string refusal_;
  int last_ = 0;  ///< index found last
};

}  // namespace tetskin::bullet_detail
