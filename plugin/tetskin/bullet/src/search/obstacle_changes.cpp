// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/bullet/src/search/obstacle_changes.h>

namespace tetskin::bullet_detail {
namespace {

/// Most shapes whose boxes are kept; beyond it, all are forgotten, since shapes may have been destroyed.
constexpr std::size_t kMaxShapes = 10'000;

}  // namespace

void ObstacleChanges::syncRigidObject(btSoftBody& body, const btCollisionObjectWrapper& rigid) {
  auto& object = const_cast<btCollisionObject&>(*rigid.getCollisionObject());
  if (object.isStaticObject() || !object.isActive()) object.setInterpolationWorldTransform(object.getWorldTransform());
  const btCollisionShape* shape = rigid.getCollisionShape();
  Box box;
  shape->getAabb(btTransform::getIdentity(), box.first, box.second);
  if (boxes_.size() > kMaxShapes) boxes_.clear();
  const auto [known, isNew] = boxes_.emplace(shape, box);
  if (isNew || known->second == box) return;
  known->second = box;
  body.getWorldInfo()->m_sparsesdf.RemoveReferences(const_cast<btCollisionShape*>(shape));
}

}  // namespace tetskin::bullet_detail
