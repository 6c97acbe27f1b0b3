// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/bullet/src/base/body_trees.h>
#include <tetskin/contact/src/soft/contact_body.h>
#include <tetskin/solver/src/base/carried_point.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tetskin::contact_detail {

void DeformedTet::weightsAt(const btVector3& p, btScalar weights[4]) const {
  assert(!flat);
  const btVector3 r = p - origin;
  for (int k = 0; k < 3; ++k) weights[k] = rows[k].dot(r);
  weights[3] = 1 - weights[0] - weights[1] - weights[2];
}

void DeformedTet::setPlanes(const btScalar minimum[4]) {
  const btVector3 gradients[4] = {rows[0], rows[1], rows[2], -(rows[0] + rows[1] + rows[2])};
  steepness = 0;
  for (int k = 0; k < 4; ++k) {
    const btScalar length = gradients[k].length();
    normals[k] = gradients[k] / length;
    offsets[k] = ((k == 3 ? 1 : 0) - minimum[k]) / length;
    steepness += length;
  }
}

ContactBody::ContactBody(btSoftBody& solved, std::shared_ptr<const ContactShape> ofShape, bool meetsItself, int number)
    : body(&solved), shape(std::move(ofShape)), self(meetsItself), id(number), solver_(solved.getSoftBodySolver()) {
  const auto* own = bullet_detail::bodyWithTrees(solved);
  if (!own) return;
  watched_ = true;
  life_ = own->lifetime();
}

bool ContactBody::fits() const {
  return static_cast<std::size_t>(body->m_nodes.size()) == data().nodes.size() &&
         static_cast<std::size_t>(body->m_tetras.size()) == data().tets.size();
}

void ContactBody::read() {
  assert(fits());
  placed_.reset();
  fitted_.reset();
  awake = body->isActive();
  box = {};
  ++reads;
  before.swap(positions);
  positions.resize(data().nodes.size());
  velocities.resize(positions.size());
  const bool first = before.size() != positions.size();
  btScalar motion = 0, speed = 0;  // squares
  btVector3 sum(0, 0, 0);
  for (std::size_t n = 0; n < positions.size(); ++n) {
    const btSoftBody::Node& node = body->m_nodes[static_cast<int>(n)];
    positions[n] = node.m_x;
    velocities[n] = node.m_v;
    box.extend(positions[n]);
    sum += positions[n];
    speed = std::max(speed, velocities[n].length2());
    if (!first) motion = std::max(motion, (positions[n] - before[n]).length2());
  }
  moved = btSqrt(motion);
  fastest = btSqrt(speed);
  farthest = 0;
  for (int axis = 0; axis < 3; ++axis) farthest = std::max({farthest, -box.low[axis], box.high[axis]});
  const btScalar size = box.diagonal();
  // Comparisons skip NaN values; the sum does not.
  readable = std::isfinite(size + sum.x() + sum.y() + sum.z()) && size < static_cast<btScalar>(Limits::kMaxCoordinate);
  centroid = sum / static_cast<btScalar>(positions.size());
}

/// Everything else is read from the body in each step; its motion since the last step is measured from these positions.
void ContactBody::serialize(bullet_detail::WorldStream& stream, bool moves) {
  stream(self, id, reads);
  std::vector<btVector3> none;
  stream.each(moves || stream.restoring() ? positions : none, [&](btVector3& p) { stream(p); });
  if (!positions.empty() && positions.size() != data().nodes.size()) stream.fail();
}

ContactBox ContactBody::regionBox(const Tet& n, const TetSubregion& part) const {
  const auto at = [&](std::size_t k) { return fourOf(positions[static_cast<std::size_t>(n[k])]); };
  const Four corners[4] = {at(0), at(1), at(2), at(3)};
  Four base = corners[0] * four(part.minimum[0]);
  for (std::size_t k = 1; k < 4; ++k) base += corners[k] * four(part.minimum[k]);
  const Four left = four(part.left);
  Four low = base + left * corners[0], high = low;
  for (std::size_t k = 1; k < 4; ++k) {
    const Four corner = base + left * corners[k];
    low = smaller(corner, low);
    high = larger(corner, high);
  }
  ContactBox around;
  for (int axis = 0; axis < 3; ++axis) {
    around.low[axis] = low[axis];
    around.high[axis] = high[axis];
  }
  return around;
}

void ContactBody::place() {
  assert(data().filled.size() == data().tets.size() && positions.size() == data().nodes.size());
  placed_.make([&] {
    const std::vector<TetGroup>& groups = data().groups;
    groupBoxes.resize(groups.size());
    for (std::size_t g = 0; g < groups.size(); ++g) placeGroup(groups[g], groupBoxes[g]);
  });
}

void ContactBody::placeGroup(const TetGroup& group, GroupBoxes& boxes) const {
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    const auto tet = static_cast<std::size_t>(group[lane]);
    const ContactBox around = group[lane] < 0 ? ContactBox{} : regionBox(data().tets[tet], data().filled[tet]);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      boxes.low[axis][static_cast<int>(lane)] = around.low[axis];
      boxes.high[axis][static_cast<int>(lane)] = around.high[axis];
    }
  }
}

void ContactBody::fit() {
  place();
  fitted_.make([&] { fitTrees(); });
}

void ContactBody::fitTrees() {
  const SearchTree &runs = data().runTree, &tets = data().tetTree;
  runs.tree.fit(runTreeBoxes, [&](int index) { return runBox(runs.tree.item(index)); });
  const auto aroundGroup = [&](const Bvh::Node& leaf) {
    const auto node = static_cast<std::size_t>(&leaf - tets.tree.nodes().data());
    const GroupBoxes& boxes = groupBoxes[static_cast<std::size_t>(tets.leafOf[node])];
    ContactBox around;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      around.low[axis] = least(boxes.low[axis]);
      around.high[axis] = largest(boxes.high[axis]);
    }
    return around;
  };
  tets.tree.fill(tetTreeBoxes, aroundGroup, [](ContactBox around, const ContactBox& other) {
    around.extend(other);
    return around;
  });
}

DeformedTet ContactBody::deformed(int tet) const {
  assert(tet >= 0 && static_cast<std::size_t>(tet) < data().tets.size());
  DeformedTet deformed;
  const Tet& n = data().tets[static_cast<std::size_t>(tet)];
  deformed.origin = positions[static_cast<std::size_t>(n[3])];
  btVector3 edge[3];
  for (int k = 0; k < 3; ++k)
    edge[k] = positions[static_cast<std::size_t>(n[static_cast<std::size_t>(k)])] - deformed.origin;
  const btVector3 normal = edge[1].cross(edge[2]);
  const btScalar volume = edge[0].dot(normal);
  const btScalar size = std::max({edge[0].length(), edge[1].length(), edge[2].length()});
  deformed.flat = !(std::abs(volume) > btScalar(1e-6) * size * size * size);
  if (deformed.flat) return deformed;
  deformed.rows[0] = normal / volume;
  deformed.rows[1] = edge[2].cross(edge[0]) / volume;
  deformed.rows[2] = edge[0].cross(edge[1]) / volume;
  measure(deformed, tet);
  return deformed;
}

void ContactBody::measure(DeformedTet& tet, int t) const {
  const Tet& n = data().tets[static_cast<std::size_t>(t)];
  tet.setPlanes(data().filled[static_cast<std::size_t>(t)].minimum);
  // The map from world to rest space. The largest row sum of its square bounds the square of its largest singular
  // value.
  const auto rest = [&](std::size_t k) -> const btVector3& { return data().nodes[static_cast<std::size_t>(n[k])]; };
  btVector3* map = tet.toRest;
  for (int axis = 0; axis < 3; ++axis) map[axis].setZero();
  for (std::size_t k = 0; k < 3; ++k) {
    const btVector3 edge = rest(k) - rest(3);
    for (int axis = 0; axis < 3; ++axis) map[axis] += edge[axis] * tet.rows[k];
  }
  tet.restOrigin = rest(3);
  const btScalar xy = std::abs(map[0].dot(map[1])), yz = std::abs(map[1].dot(map[2])),
                 zx = std::abs(map[2].dot(map[0]));
  tet.restPerWorld =
      btSqrt(std::max({map[0].length2() + xy + zx, map[1].length2() + yz + xy, map[2].length2() + zx + yz}));
}

btVector3 ContactBody::velocityAt(int tet, const btScalar weights[4]) const {
  assert(tet >= 0 && static_cast<std::size_t>(tet) < data().tets.size());
  return bullet_detail::CarriedPoint(4, data().tets[static_cast<std::size_t>(tet)], weights).velocity(*body);
}

btScalar gapTo(const ContactBox& box, const DeformedTet& tet) {
  assert(!tet.flat);
  const btVector3 low(box.low[0], box.low[1], box.low[2]), high(box.high[0], box.high[1], box.high[2]);
  const btVector3 centroid = (low + high) / 2 - tet.origin, half = (high - low) / 2;
  btScalar least = BT_LARGE_FLOAT;
  for (int k = 0; k < 4; ++k) {
    least = std::min(least, tet.normals[k].dot(centroid) + tet.normals[k].absolute().dot(half) + tet.offsets[k]);
  }
  return -least;
}

}  // namespace tetskin::contact_detail
