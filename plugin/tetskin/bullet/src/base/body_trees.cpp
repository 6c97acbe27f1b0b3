// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <BulletSoftBody/btSoftBodyInternals.h>
#include <tetskin/bullet/src/base/body_trees.h>
#include <tetskin/bullet/src/base/world_stream.h>
#include <tetskin/core/src/base/bvh/bvh.h>

#include <cassert>
#include <vector>

namespace tetskin::bullet_detail {
namespace {

/// The leaves of a tree to be built, with their items.
struct Leaves {
  std::vector<btDbvtNode*> nodes;
  Bvh::Centroids<btScalar> centroids;

  explicit Leaves(int count) {
    nodes.reserve(static_cast<std::size_t>(count));
    centroids.reserve(static_cast<std::size_t>(count));
  }
  btDbvtNode* add(void* data, const btVector3& centroid);
};

/// Allocates nodes as Bullet does, because Bullet deletes them.
btDbvtNode* newNode() {
  return new (btAlignedAlloc(sizeof(btDbvtNode), 16)) btDbvtNode();
}

btDbvtNode* Leaves::add(void* data, const btVector3& centroid) {
  btDbvtNode* node = newNode();
  node->parent = nullptr;
  node->data = data;
  node->childs[1] = nullptr;  // this is how Bullet recognises leaves
  nodes.push_back(node);
  centroids.emplace_back(centroid.x(), centroid.y(), centroid.z());
  return node;
}

/// Creates the tree of a hierarchy with one item per leaf, linked as in Bullet. The caller computes the boxes.
btDbvtNode* linkNodes(const Bvh& bvh, const std::vector<btDbvtNode*>& leaves, int index = 0) {
  assert(leaves.size() == bvh.items().size());
  const Bvh::Node& from = bvh.nodes()[static_cast<std::size_t>(index)];
  if (from.isLeaf()) return leaves[static_cast<std::size_t>(bvh.item(from.first))];
  btDbvtNode* node = newNode();
  node->parent = nullptr;
  node->childs[0] = linkNodes(bvh, leaves, index + 1);
  node->childs[1] = linkNodes(bvh, leaves, from.right);
  node->childs[0]->parent = node->childs[1]->parent = node;
  return node;
}

void setTree(btDbvt& tree, const Leaves& leaves) {
  tree.clear();
  const Bvh bvh(leaves.centroids, 1);
  assert(leaves.nodes.size() == leaves.centroids.size());
  tree.m_root = bvh.empty() ? nullptr : linkNodes(bvh, leaves.nodes);
  tree.m_leaves = static_cast<int>(leaves.nodes.size());
}

/// Allocated with `new`, because btSoftBody deletes it.
btDbvntNode* copyWithNormals(const btDbvtNode* node) {
  if (!node) return nullptr;
  auto* copy = new btDbvntNode(node);
  if (node->isinternal()) {
    for (int k = 0; k < 2; ++k) copy->childs[k] = copyWithNormals(node->childs[k]);
  }
  return copy;
}

void setFaceTree(btSoftBody& body, const Leaves& leaves) {
  setTree(body.m_fdbvt, leaves);
  delete body.m_fdbvnt;
  body.m_fdbvnt = copyWithNormals(body.m_fdbvt.m_root);
}

void buildNodeTree(btSoftBody& body) {
  Leaves leaves(body.m_nodes.size());
  for (int i = 0; i < body.m_nodes.size(); ++i) {
    btSoftBody::Node& node = body.m_nodes[i];
    node.m_leaf = leaves.add(&node, node.m_x);
  }
  setTree(body.m_ndbvt, leaves);
  body.updateNodeTree(false, false);
}

void buildFaceTree(btSoftBody& body) {
  Leaves leaves(body.m_faces.size());
  for (int i = 0; i < body.m_faces.size(); ++i) {
    btSoftBody::Face& face = body.m_faces[i];
    face.m_leaf = leaves.add(&face, (face.m_n[0]->m_x + face.m_n[1]->m_x + face.m_n[2]->m_x) / 3);
  }
  setFaceTree(body, leaves);
  body.updateFaceTree(false, false);
}

/// A face without extent, far from everything. It belongs to the single leaf that replaces an omitted tree.
btSoftBody::Face* nowhere() {
  static btSoftBody::Node node = [] {
    btSoftBody::Node n = {};
    n.m_x.setValue(BT_LARGE_FLOAT, BT_LARGE_FLOAT, BT_LARGE_FLOAT);
    n.m_q = n.m_x;
    for (btVector3* rate : {&n.m_v, &n.m_vn, &n.m_splitv}) rate->setZero();
    return n;
  }();
  static btSoftBody::Face face = [] {
    btSoftBody::Face f = {};
    for (btSoftBody::Node*& corner : f.m_n) corner = &node;
    return f;
  }();
  return &face;
}

/// True if every item has a leaf that points back at it; after Bullet has moved the array, this no longer holds.
template <class Item>
bool isTreeOf(const btDbvt& tree, const btAlignedObjectArray<Item>& items) {
  if (items.size() == 0 || !tree.m_root) return items.size() == 0;
  for (int i = 0; i < items.size(); ++i) {
    if (!items[i].m_leaf || items[i].m_leaf->data != &items[i]) return false;
  }
  return true;
}

}  // namespace

void buildTrees(btSoftBody& body) {
  buildNodeTree(body);
  buildFaceTree(body);
}

void updateConstants(btSoftBody& body) {
  if (!body.m_bUpdateRtCst) return;
  body.updateConstants();
  if (!isTreeOf(body.m_ndbvt, body.m_nodes)) buildNodeTree(body);
  BodyWithTrees* own = bodyWithTrees(body);
  const bool leftOut = own && own->hasNoFaceTree();
  if (leftOut) {
    own->renewFaceTree();
  } else if (!isTreeOf(body.m_fdbvt, body.m_faces)) {
    buildFaceTree(body);
  }
  body.m_bUpdateRtCst = false;
}

/// Bullet asks for the margin in each step, right after deleting the tree.
class BodyWithTrees::Shape : public btSoftBodyCollisionShape {
 public:
  explicit Shape(BodyWithTrees& body) : btSoftBodyCollisionShape(&body), body_(body) {}
  btScalar getMargin() const override {
    body_.keepFaceTree();
    const BodyCompanion* companion = body_.companion();
    return btSoftBodyCollisionShape::getMargin() + (companion ? companion->speculation() : btScalar(0));
  }
  void getAabb(const btTransform& transform, btVector3& low, btVector3& high) const override {
    btSoftBodyCollisionShape::getAabb(transform, low, high);
    const BodyCompanion* companion = body_.companion();
    if (!companion || !(companion->reach() >= 0)) return;
    const btScalar reach = companion->reach() + companion->speculation();
    const btVector3 around(reach, reach, reach);
    for (int n = 0; n < body_.m_nodes.size(); ++n) {
      const btSoftBody::Node& node = body_.m_nodes[n];
      const btVector3 predicted = transform * (node.m_x + body_.m_sst.sdt * node.m_v);
      low.setMin(predicted - around);
      high.setMax(predicted + around);
    }
  }

 private:
  BodyWithTrees& body_;
};

BodyWithTrees::BodyWithTrees(btSoftBodyWorldInfo& worldInfo, const std::vector<btVector3>& nodes)
    : btSoftBody(&worldInfo, static_cast<int>(nodes.size()), nodes.data(), nullptr), createdAt_(nodes) {
  m_sst.sdt = 0;            // Bullet leaves it unset until the first step
  delete m_collisionShape;  // as btSoftBody's destructor does
  m_collisionShape = new Shape(*this);
}

btScalar BodyWithTrees::margin() const {
  return static_cast<const Shape*>(m_collisionShape)->btSoftBodyCollisionShape::getMargin();
}

BodyWithTrees* bodyWithTrees(btSoftBody& body) {
  return asOwn<BodyWithTrees>(OwnObject::Kind::BodyWithTrees, &body);
}

const BodyWithTrees* bodyWithTrees(const btSoftBody& body) {
  return asOwn<const BodyWithTrees>(OwnObject::Kind::BodyWithTrees, &body);
}

void BodyWithTrees::makeTrees(bool faces) {
  assert(kind_ == Kind::None);
  buildNodeTree(*this);
  kind_ = faces ? Kind::Faces : Kind::Skipped;
  renewFaceTree();
}

void BodyWithTrees::renewFaceTree() {
  assert(kind_ != Kind::None);
  if (kind_ == Kind::Faces) return buildFaceTree(*this);
  Leaves leaves(1);
  btDbvtNode* const leaf = leaves.add(nowhere(), btVector3(0, 0, 0));
  // In the classic worlds, Bullet moves the leaf of each face that has left its box: this box contains all faces.
  const btVector3 everywhere(BT_LARGE_FLOAT, BT_LARGE_FLOAT, BT_LARGE_FLOAT);
  leaf->volume = btDbvtVolume::FromMM(-everywhere, everywhere);
  for (int i = 0; i < m_faces.size(); ++i) m_faces[i].m_leaf = leaf;
  setFaceTree(*this, leaves);
}

/// Bullet may have deleted the tree. And when nodes are appended, Bullet makes each leaf point at its face, including
/// the leaf that must not.
void BodyWithTrees::keepFaceTree() {
  if (kind_ == Kind::None) return;
  if (!m_fdbvt.m_root) renewFaceTree();
  if (kind_ == Kind::Skipped) m_fdbvt.m_root->data = nowhere();
}

void BodyWithTrees::transform(const btTransform& transform) {
  btSoftBody::transform(transform);
  countMove();
  if (!hasNoFaceTree()) updateFaceTree(false, false);
}

void BodyWithTrees::scale(const btVector3& factors) {
  btSoftBody::scale(factors);
  countMove();
  if (!hasNoFaceTree()) updateFaceTree(false, false);
}

void BodyWithTrees::returnToStart() {
  assert(createdAt_.size() == static_cast<std::size_t>(m_nodes.size()));
  for (int n = 0; n < m_nodes.size(); ++n) {
    Node& node = m_nodes[n];
    node.m_x = node.m_q = createdAt_[static_cast<std::size_t>(n)] + shifted_;
    for (btVector3* rate : {&node.m_v, &node.m_vn, &node.m_splitv, &node.m_f}) rate->setZero();
  }
  m_maxSpeedSquared = 0;
  if (companion_) companion_->returnToStart();
  countMove();
  if (kind_ != Kind::None) {
    buildNodeTree(*this);
    renewFaceTree();
  }
  updateNormals();
  updateBounds();
}

void BodyWithTrees::serializeShift(WorldStream& stream) {
  stream(shifted_);
  if (!stream.restoring()) return;
  countMove();
  if (companion_) companion_->dropStep();
  if (!hasNoFaceTree()) updateFaceTree(false, false);
}

}  // namespace tetskin::bullet_detail
