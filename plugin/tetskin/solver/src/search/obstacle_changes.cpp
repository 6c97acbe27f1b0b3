// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/solver/src/search/obstacle_changes.h>

namespace tetskin::bullet_detail {
namespace {

/// Most shapes to remember; beyond it all are forgotten, since shapes may have been destroyed.
constexpr std::size_t kMaxShapes = 10'000;

}  // namespace

void ObstacleChanges::syncRigidObject(btSoftBody& body, const btCollisionObjectWrapper& rigid) {
  auto& object = const_cast<btCollisionObject&>(*rigid.getCollisionObject());
  if (object.isStaticObject() || !object.isActive()) object.setInterpolationWorldTransform(object.getWorldTransform());
  const btCollisionShape* shape = rigid.getCollisionShape();
  const ShapeKey key = ShapeKey::of(*shape);
  if (known_.size() > kMaxShapes) known_.clear();
  const auto [known, isNew] = known_.emplace(shape, key);
  if (isNew || known->second == key) return;
  known->second = key;
  body.getWorldInfo()->m_sparsesdf.RemoveReferences(const_cast<btCollisionShape*>(shape));
}

}  // namespace tetskin::bullet_detail
