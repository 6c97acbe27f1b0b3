// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/contact/src/soft/contact_row.h>

namespace tetskin::contact_detail {

void ContactNodes::take(ContactBody& body, const Tet& tet, const btScalar* nodeWeights, btScalar sign) {
  of = &body;
  for (int k = 0; k < 4; ++k) {
    nodes[k] = tet[static_cast<std::size_t>(k)];
    weights[k] = sign * nodeWeights[k];
    numbers[k] = body.movable(nodes[k]) ? body.body->m_nodes[nodes[k]].index : -1;
  }
}

btScalar ContactNodes::inverseMass() const {
  btScalar sum = 0;
  for (int k = 0; k < 4; ++k) sum += weights[k] * weights[k] * of->inverseMass(nodes[k]);
  return sum;
}

btVector3 ContactRow::relativeOf(const VectorArray& velocities) const {
  return relative([&](const ContactNodes& side, int k) {
    return side.numbers[k] < 0 ? btVector3(0, 0, 0) : velocities[side.numbers[k]];
  });
}

btVector3 ContactRow::relativeNow() const {
  return relative([](const ContactNodes& side, int k) {
    return side.of->awake ? side.of->body->m_nodes[side.nodes[k]].m_v : btVector3(0, 0, 0);
  });
}

void ContactRow::addTo(VectorArray& forces, const btVector3& impulseOnFirst) const {
  for (const ContactNodes& side : sides) {
    for (int k = 0; k < 4; ++k) {
      if (side.numbers[k] >= 0) forces[side.numbers[k]] += side.weights[k] * impulseOnFirst;
    }
  }
}

}  // namespace tetskin::contact_detail
