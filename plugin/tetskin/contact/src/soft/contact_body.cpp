// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/contact/src/soft/contact_body.h>

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

bool ContactBody::fits() const {
  const auto tets = static_cast<std::size_t>(body->m_tetras.size());
  // While a step is solved, the elastic force hides the tets from Bullet.
  const bool hasTets = tets == data().tets.size() || tets == 0;
  return static_cast<std::size_t>(body->m_nodes.size()) == data().nodes.size() && hasTets;
}

void ContactBody::read() {
  assert(fits());
  fitted_ = false;
  awake = body->isActive();
  isDeformed_.assign(data().tets.size(), 0);
  isBoxed_.assign(data().tets.size(), 0);
  isCarried_.assign(data().runs.size(), 0);
  box = {};
  positions.resize(data().nodes.size());
  btVector3 sum(0, 0, 0);
  for (std::size_t n = 0; n < positions.size(); ++n) {
    positions[n] = body->m_nodes[static_cast<int>(n)].m_x;
    box.extend(positions[n]);
    sum += positions[n];
  }
  const btScalar size = box.diagonal();
  // Comparisons skip NaN values; the sum does not.
  readable = std::isfinite(size + sum.x() + sum.y() + sum.z()) && size < static_cast<btScalar>(Limits::kMaxCoordinate);
  measureTravel(sum / static_cast<btScalar>(positions.size()));
  measureSpeed();
}

void ContactBody::measureSpeed() {
  const btSoftBody::tNodeArray& nodes = body->m_nodes;
  drift.setZero();
  for (int n = 0; n < nodes.size(); ++n) drift += nodes[n].m_v / static_cast<btScalar>(nodes.size());
  btScalar squared = 0;
  for (int n = 0; n < nodes.size(); ++n) squared = std::max(squared, (nodes[n].m_v - drift).length2());
  fastest = btSqrt(squared);
}

void ContactBody::measureTravel(const btVector3& newCentroid) {
  btScalar squared = 0;
  read_.resize(positions.size(), newCentroid);
  for (std::size_t n = 0; n < positions.size(); ++n) {
    squared = std::max(squared, (positions[n] - read_[n] - (newCentroid - centroid)).length2());
  }
  travelled += std::sqrt(static_cast<double>(squared));
  centroid = newCentroid;
  read_ = positions;
}

const ContactBox& ContactBody::carry(int run) {
  assert(run >= 0 && static_cast<std::size_t>(run) < isCarried_.size());
  const ShapeData& shapeData = data();
  const auto r = static_cast<std::size_t>(run);
  runBoxes_.resize(shapeData.runs.size());
  for (auto& coordinates : samples) coordinates.resize(shapeData.samples.size());
  if (!isCarried_[r]) carryRun(shapeData.runs[r], runBoxes_[r]);
  isCarried_[r] = 1;
  return runBoxes_[r];
}

/// Computes the positions of a run's samples, and a box around them that is tighter than the tet's.
void ContactBody::carryRun(const SampleRun& run, ContactBox& around) {
  assert(run.first < run.last && static_cast<std::size_t>(run.last) <= samples[0].size());
  const ShapeData& shapeData = data();
  const Tet& n = shapeData.tets[static_cast<std::size_t>(run.tet)];
  around = {};
  for (int axis = 0; axis < 3; ++axis) {
    btScalar at[4];
    for (std::size_t k = 0; k < 4; ++k) at[k] = positions[static_cast<std::size_t>(n[k])][axis];
    btScalar* out = samples[axis].data();
    btScalar low = BT_LARGE_FLOAT, high = -BT_LARGE_FLOAT;
    for (auto s = static_cast<std::size_t>(run.first); s < static_cast<std::size_t>(run.last); ++s) {
      out[s] = shapeData.weights[0][s] * at[0] + shapeData.weights[1][s] * at[1] + shapeData.weights[2][s] * at[2] +
               shapeData.weights[3][s] * at[3];
      low = std::min(low, out[s]);
      high = std::max(high, out[s]);
    }
    around.low[axis] = low;
    around.high[axis] = high;
  }
}

ContactBox ContactBody::filledBox(int tet) const {
  assert(data().filled.size() == data().tets.size() && positions.size() == data().nodes.size());
  const Tet& n = data().tets[static_cast<std::size_t>(tet)];
  const FilledComponent& component = data().filled[static_cast<std::size_t>(tet)];
  btVector3 base(0, 0, 0);
  for (std::size_t k = 0; k < 4; ++k) base += component.minimum[k] * positions[static_cast<std::size_t>(n[k])];
  ContactBox around;
  for (const int node : n) around.extend(base + component.left * positions[static_cast<std::size_t>(node)]);
  return around;
}

void ContactBody::fit() {
  if (fitted_) return;
  fitted_ = true;
  const ShapeData& shapeData = data();
  for (std::size_t t = 0; t < shapeData.tets.size(); ++t) around(static_cast<int>(t));
  for (std::size_t r = 0; r < shapeData.runs.size(); ++r) carry(static_cast<int>(r));
  shapeData.runTree.fit(runTreeBoxes, [&](int index) { return runBox(shapeData.runTree.item(index)); });
  shapeData.tetTree.fit(tetTreeBoxes, [&](int index) { return tetBox(shapeData.tetTree.item(index)); });
}

const ContactBox& ContactBody::around(int tet) {
  assert(tet >= 0 && static_cast<std::size_t>(tet) < isBoxed_.size());
  const auto t = static_cast<std::size_t>(tet);
  boxes_.resize(data().tets.size());
  if (!isBoxed_[t]) boxes_[t] = filledBox(tet);
  isBoxed_[t] = 1;
  return boxes_[t];
}

const DeformedTet& ContactBody::deformed(int tet) {
  assert(tet >= 0 && static_cast<std::size_t>(tet) < isDeformed_.size());
  deformed_.resize(data().tets.size());
  DeformedTet& deformed = deformed_[static_cast<std::size_t>(tet)];
  if (isDeformed_[static_cast<std::size_t>(tet)]) return deformed;
  isDeformed_[static_cast<std::size_t>(tet)] = 1;
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
  measure(deformed, n);
  return deformed;
}

void ContactBody::measure(DeformedTet& tet, const Tet& n) const {
  const btVector3 fourth = -(tet.rows[0] + tet.rows[1] + tet.rows[2]);
  tet.steepest =
      btSqrt(std::max({tet.rows[0].length2(), tet.rows[1].length2(), tet.rows[2].length2(), fourth.length2()}));
  // The map from world to rest space: its Frobenius norm bounds all singular values.
  btVector3 map[3] = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
  const auto rest = [&](std::size_t k) -> const btVector3& { return data().nodes[static_cast<std::size_t>(n[k])]; };
  for (std::size_t k = 0; k < 3; ++k) {
    const btVector3 edge = rest(k) - rest(3);
    for (int axis = 0; axis < 3; ++axis) map[axis] += edge[axis] * tet.rows[k];
  }
  tet.restPerWorld = btSqrt(map[0].length2() + map[1].length2() + map[2].length2());
}

btVector3 ContactBody::velocityAt(int tet, const btScalar weights[4]) const {
  assert(tet >= 0 && static_cast<std::size_t>(tet) < data().tets.size());
  const Tet& n = data().tets[static_cast<std::size_t>(tet)];
  btVector3 v(0, 0, 0);
  for (std::size_t k = 0; k < 4; ++k) v += weights[k] * body->m_nodes[n[k]].m_v;
  return v;
}

btScalar gapTo(const ContactBox& box, const DeformedTet& tet) {
  assert(!tet.flat && tet.steepest > 0);
  const btVector3 low(box.low[0], box.low[1], box.low[2]), high(box.high[0], box.high[1], box.high[2]);
  const btVector3 centroid = (low + high) / 2 - tet.origin, half = (high - low) / 2;
  const btVector3 fourth = -(tet.rows[0] + tet.rows[1] + tet.rows[2]);
  const auto maximum = [&](const btVector3& row) { return row.dot(centroid) + row.absolute().dot(half); };
  const btScalar minimum =
      std::min({maximum(tet.rows[0]), maximum(tet.rows[1]), maximum(tet.rows[2]), 1 + maximum(fourth)});
  return (kMinWeight - minimum) / tet.steepest;
}

}  // namespace tetskin::contact_detail
