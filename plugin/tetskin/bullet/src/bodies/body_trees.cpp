// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <BulletSoftBody/btSoftBodyInternals.h>
#include <tetskin/bullet/src/bodies/body_trees.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace tetskin {
namespace {

/// A leaf to be, and where it belongs.
struct Leaf {
  btDbvtNode* node;
  btVector3 centre;
};

/// As Bullet makes them, which deletes them.
btDbvtNode* newNode() {
  return new (btAlignedAlloc(sizeof(btDbvtNode), 16)) btDbvtNode();
}

Leaf makeLeaf(void* data, const btVector3& centre) {
  btDbvtNode* node = newNode();
  node->parent = nullptr;
  node->data = data;
  node->childs[1] = nullptr;  // which is how Bullet tells leaves
  // Nodes of an exploded body cannot be sorted; anywhere will do for them.
  const bool finite = std::isfinite(centre.x()) && std::isfinite(centre.y()) && std::isfinite(centre.z());
  return {node, finite ? centre : btVector3(0, 0, 0)};
}

/// The tree of the leaves [first, last), of which there is at least one. Boxes are for the caller to compute.
btDbvtNode* join(Leaf* first, Leaf* last) {
  if (last - first == 1) return first->node;
  btVector3 lowest = first->centre, highest = first->centre;
  for (const Leaf* leaf = first; leaf != last; ++leaf) {
    lowest.setMin(leaf->centre);
    highest.setMax(leaf->centre);
  }
  const int axis = (highest - lowest).maxAxis();
  Leaf* middle = first + (last - first) / 2;
  std::nth_element(first, middle, last, [&](const Leaf& a, const Leaf& b) { return a.centre[axis] < b.centre[axis]; });
  btDbvtNode* node = newNode();
  node->parent = nullptr;
  node->childs[0] = join(first, middle);
  node->childs[1] = join(middle, last);
  node->childs[0]->parent = node->childs[1]->parent = node;
  return node;
}

void setTree(btDbvt& tree, std::vector<Leaf>& leaves) {
  tree.clear();
  tree.m_root = leaves.empty() ? nullptr : join(leaves.data(), leaves.data() + leaves.size());
  tree.m_leaves = static_cast<int>(leaves.size());
}

/// By `new`: btSoftBody deletes it so.
btDbvntNode* copyWithNormals(const btDbvtNode* node) {
  if (!node) return nullptr;
  auto* copy = new btDbvntNode(node);
  if (node->isinternal()) {
    for (int k = 0; k < 2; ++k) copy->childs[k] = copyWithNormals(node->childs[k]);
  }
  return copy;
}

void setFaceTree(btSoftBody& body, std::vector<Leaf>& leaves) {
  setTree(body.m_fdbvt, leaves);
  delete body.m_fdbvnt;
  body.m_fdbvnt = copyWithNormals(body.m_fdbvt.m_root);
}

void buildNodeTree(btSoftBody& body) {
  std::vector<Leaf> leaves;
  leaves.reserve(static_cast<std::size_t>(body.m_nodes.size()));
  for (int i = 0; i < body.m_nodes.size(); ++i) {
    btSoftBody::Node& node = body.m_nodes[i];
    leaves.push_back(makeLeaf(&node, node.m_x));
    node.m_leaf = leaves.back().node;
  }
  setTree(body.m_ndbvt, leaves);
  body.updateNodeTree(false, false);
}

void buildFaceTree(btSoftBody& body) {
  std::vector<Leaf> leaves;
  leaves.reserve(static_cast<std::size_t>(body.m_faces.size()));
  for (int i = 0; i < body.m_faces.size(); ++i) {
    btSoftBody::Face& face = body.m_faces[i];
    leaves.push_back(makeLeaf(&face, (face.m_n[0]->m_x + face.m_n[1]->m_x + face.m_n[2]->m_x) / 3));
    face.m_leaf = leaves.back().node;
  }
  setFaceTree(body, leaves);
  body.updateFaceTree(false, false);
}

/// A face without extent, far from everything: what the leaf holds that stands for a tree left out.
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

/// Every item has a leaf that points back at it, as is no longer so once Bullet has moved the array.
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
  auto* own = dynamic_cast<BodyWithTrees*>(&body);
  const bool leftOut = own && own->faceTreeIsLeftOut();
  if (leftOut) {
    own->renewFaceTree();
  } else if (!isTreeOf(body.m_fdbvt, body.m_faces)) {
    buildFaceTree(body);
  }
  body.m_bUpdateRtCst = false;
}

/// Bullet asks for the margin in each step, right after it has cleared the tree.
class BodyWithTrees::Shape : public btSoftBodyCollisionShape {
 public:
  explicit Shape(BodyWithTrees& body) : btSoftBodyCollisionShape(&body), body_(body) {}
  btScalar getMargin() const override {
    body_.keepFaceTree();
    return btSoftBodyCollisionShape::getMargin();
  }
  void getAabb(const btTransform& transform, btVector3& low, btVector3& high) const override {
    btSoftBodyCollisionShape::getAabb(transform, low, high);
    if (!(body_.reach() >= 0)) return;
    const btVector3 around(body_.reach(), body_.reach(), body_.reach());
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
    : btSoftBody(&worldInfo, static_cast<int>(nodes.size()), nodes.data(), nullptr) {
  m_sst.sdt = 0;            // Bullet leaves it unset until the first step
  delete m_collisionShape;  // as its destructor does
  m_collisionShape = new Shape(*this);
}

BodyWithTrees* bodyWithTrees(btSoftBody& body) {
  return dynamic_cast<BodyWithTrees*>(&body);
}

void BodyWithTrees::makeTrees(bool faces) {
  buildNodeTree(*this);
  kind_ = faces ? Kind::Faces : Kind::LeftOut;
  renewFaceTree();
}

void BodyWithTrees::renewFaceTree() {
  if (kind_ == Kind::Faces) return buildFaceTree(*this);
  std::vector<Leaf> leaves = {makeLeaf(nowhere(), btVector3(0, 0, 0))};
  // In the classic worlds Bullet moves the leaf of each face in which the face no longer fits: all fit into this one.
  const btVector3 everywhere(BT_LARGE_FLOAT, BT_LARGE_FLOAT, BT_LARGE_FLOAT);
  leaves[0].node->volume = btDbvtVolume::FromMM(-everywhere, everywhere);
  for (int i = 0; i < m_faces.size(); ++i) m_faces[i].m_leaf = leaves[0].node;
  setFaceTree(*this, leaves);
}

/// The tree may be gone; and where nodes are appended Bullet lets each leaf point at its face, also one that must not.
void BodyWithTrees::keepFaceTree() {
  if (kind_ == Kind::None) return;
  if (!m_fdbvt.m_root) renewFaceTree();
  if (kind_ == Kind::LeftOut) m_fdbvt.m_root->data = nowhere();
}

void BodyWithTrees::transform(const btTransform& transform) {
  btSoftBody::transform(transform);
  if (!faceTreeIsLeftOut()) updateFaceTree(false, false);
}

void BodyWithTrees::scale(const btVector3& factors) {
  btSoftBody::scale(factors);
  if (!faceTreeIsLeftOut()) updateFaceTree(false, false);
}

}  // namespace tetskin
