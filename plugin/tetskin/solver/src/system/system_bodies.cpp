// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/solver/src/forces/node_vectors.h>
#include <tetskin/solver/src/system/system_bodies.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>
#include <utility>

namespace tetskin::bullet_detail {
namespace {

/// Adds the upper triangle of the matrix.
void addSymmetric(const btMatrix3x3& m, btScalar factor, btScalar to[6]) {
  const btScalar entries[6] = {m[0][0], m[0][1], m[0][2], m[1][1], m[1][2], m[2][2]};
  for (int k = 0; k < 6; ++k) to[k] += factor * entries[k];
}

}  // namespace

void BodyEnds::add(std::size_t row, std::size_t index, const CarriedPoint& point) {
  assert(point.count > 0 && index < 2 && (ends_.empty() || ends_.back().index <= index));
  const auto number = static_cast<std::uint32_t>(ends_.size());
  if (!isOfLastGroup(index, point)) addGroup(point.count * (point.count - 1) / 2);
  groups_.back().last = number + 1;
  BodyEnd& added = ends_.emplace_back();
  added.row = static_cast<std::uint32_t>(row);
  added.index = static_cast<std::uint32_t>(index);
  added.first = static_cast<std::uint32_t>(nodes_.size());
  for (std::uint32_t k = 0; k < point.count; ++k) {
    const auto node = static_cast<std::size_t>(point.nodes[k]);
    nodes_.push_back({metNode(node), static_cast<std::uint32_t>(matrix_->slotOf(node)),
                      static_cast<std::uint32_t>(matrix_->wideOf(node)), point.weights[k]});
  }
  added.last = static_cast<std::uint32_t>(nodes_.size());
}

std::uint32_t BodyEnds::metNode(std::size_t node) {
  metAt_.resize(matrix_->slotCount(), 0);
  std::uint32_t& number = metAt_[matrix_->slotOf(node)];
  if (number == 0) {
    met_.emplace_back().node = node;
    number = static_cast<std::uint32_t>(met_.size());
  }
  return number - 1;
}

bool BodyEnds::isOfLastGroup(std::size_t index, const CarriedPoint& point) const {
  if (ends_.empty() || ends_.back().index != index) return false;
  const BodyEnd& before = ends_.back();
  return std::equal(nodes_.begin() + before.first, nodes_.begin() + before.last, point.nodes.begin(),
                    point.nodes.begin() + point.count,
                    [this](const Node& a, int b) { return a.slot == matrix_->slotOf(static_cast<std::size_t>(b)); });
}

void BodyEnds::addGroup(std::uint32_t pairs) {
  Group& group = groups_.emplace_back();
  group.first = static_cast<std::uint32_t>(ends_.size());
  group.couplings = static_cast<std::uint32_t>(couplings_.size());
  couplings_.resize(couplings_.size() + pairs);
}

void BodyEnds::findCouplings(Group& group) {
  assert(!group.coupled && group.first < group.last);
  const BodyEnd& end = ends_[group.first];
  Coupling* coupling = couplings_.data() + group.couplings;
  for (std::uint32_t i = end.first; i < end.last; ++i) {
    for (std::uint32_t j = end.first; j < i; ++j, ++coupling) {
      *coupling = matrix_->couplingOf(met_[nodes_[i].met].node, met_[nodes_[j].met].node);
    }
  }
  group.coupled = true;
}

btVector3 BodyEnds::velocity(const BodyEnd& end) const {
  assert(end.first <= end.last && end.last <= nodes_.size());
  btVector3 sum(0, 0, 0);
  for (std::uint32_t k = end.first; k < end.last; ++k) {
    sum += nodes_[k].weight * fromWide(matrix_->solution() + nodes_[k].wide);
  }
  return sum;
}

btVector3 BodyEnds::stepVelocity(const BodyEnd& end) const {
  assert(end.first <= end.last && end.last <= nodes_.size());
  btVector3 sum(0, 0, 0);
  for (std::uint32_t k = end.first; k < end.last; ++k) {
    sum += nodes_[k].weight * fromPoint(matrix_->stepPoints() + std::size_t{4} * nodes_[k].slot);
  }
  return sum;
}

void BodyEnds::addImpulse(const BodyEnd& end, const btVector3& impulse, btScalar* wide) const {
  assert(end.first <= end.last && end.last <= nodes_.size());
  for (std::uint32_t k = end.first; k < end.last; ++k) {
    btScalar* at = wide + nodes_[k].wide;
    toWide(fromWide(at) + nodes_[k].weight * impulse, at);
  }
}

void BodyEnds::addTangents(const Rows& rows) {
  for (Group& group : groups_) {
    const bool apart = std::all_of(ends_.begin() + group.first, ends_.begin() + group.last, [&](const BodyEnd& end) {
      return rows[end.row]->state == ContactRow::State::Apart;
    });
    if (!apart) addBlocks(group, rows);
  }
  matrix_->applyCouplings();
  for (MetNode& met : met_) {
    if (!met.used) continue;
    matrix_->resist(met.node, met.block);
    std::fill(std::begin(met.block), std::end(met.block), btScalar(0));
    met.used = false;
  }
}

/// Nodes that no tet connects have no block in the matrix: each gets by itself the stiffness that they have together.
void BodyEnds::addBlocks(Group& group, const Rows& rows) {
  assert(group.first < group.last && group.last <= ends_.size());
  if (!group.coupled) findCouplings(group);
  const Node* nodes = &nodes_[ends_[group.first].first];
  const std::uint32_t count = ends_[group.first].last - ends_[group.first].first;
  Blocks blocks = {};
  for (std::uint32_t e = group.first; e < group.last; ++e) {
    const ContactRow& row = *rows[ends_[e].row];
    if (row.state == ContactRow::State::Apart) continue;
    const btMatrix3x3& h = row.tangent;
    const btScalar tangent[6] = {h[0][0], h[0][1], h[0][2], h[1][1], h[1][2], h[2][2]};
    const Node* weighted = &nodes_[ends_[e].first];
    for (std::uint32_t i = 0; i < count; ++i) {
      for (std::uint32_t j = 0; j <= i; ++j) {
        const btScalar weight = weighted[i].weight * weighted[j].weight;
        for (int k = 0; k < 6; ++k) blocks[i][j][k] += weight * tangent[k];
      }
    }
  }
  const Coupling* coupling = couplings_.data() + group.couplings;
  for (std::uint32_t i = 0; i < count; ++i) {
    for (std::uint32_t j = 0; j < i; ++j, ++coupling) {
      if (*coupling) {
        matrix_->couple(**coupling, blocks[i][j]);
      } else {
        addApart(group, rows, i, j, blocks);
      }
    }
  }
  for (std::uint32_t i = 0; i < count; ++i) {
    MetNode& met = met_[nodes[i].met];
    for (int k = 0; k < 6; ++k) met.block[k] += blocks[i][i][k];
    met.used = true;
  }
}

void BodyEnds::addApart(const Group& group, const Rows& rows, std::uint32_t i, std::uint32_t j, Blocks& blocks) const {
  for (std::uint32_t e = group.first; e < group.last; ++e) {
    const ContactRow& row = *rows[ends_[e].row];
    if (row.state == ContactRow::State::Apart) continue;
    const Node* nodes = &nodes_[ends_[e].first];
    const btScalar weight = std::abs(nodes[i].weight * nodes[j].weight);
    addSymmetric(row.tangent, weight, blocks[i][i]);
    addSymmetric(row.tangent, weight, blocks[j][j]);
  }
}

// ---- the bodies of a system

SystemBodies::SystemBodies(const SystemInput& input, const SolvedSystem& system, ParallelFor* threads)
    : in_(input), system_(system), threads_(threads) {
  assert(!system.bodies.empty());
  joinsSoft_ = std::any_of(system.rows.begin(), system.rows.end(),
                           [](const ContactRow* row) { return row->ends[0].isSoft() && row->ends[1].isSoft(); });
  bodies_.reserve(system.bodies.size());
  for (std::size_t k = 0; k < system.bodies.size(); ++k) {
    SystemBody& body = bodies_.emplace_back(system.bodies[k], in_.bodies.bodies()[system.bodies[k]]);
    body.solved.solve.place = k;
    sizes_.push_back(body.matrix().slotCount());
  }
  collectEnds();
}

void SystemBodies::collectEnds() {
  std::vector<std::vector<std::pair<std::size_t, std::size_t>>> ends(bodies_.size());  // of each body: row and index
  for (const std::size_t index : {std::size_t{0}, std::size_t{1}}) {
    for (std::size_t r = 0; r < rowCount(); ++r) {
      const RowEnd& end = row(r).ends[index];
      if (!end.isSoft()) continue;
      const SolvedBody& on = in_.bodies.bodies()[end.body];
      assert(on.solve.place < bodies_.size() && &bodies_[on.solve.place].solved == &on);
      ends[on.solve.place].emplace_back(r, index);
    }
  }
  forEachBody([&](SystemBody& body, ParallelFor*) {
    for (const auto& [r, index] : ends[body.solved.solve.place]) body.ends.add(r, index, pointOf(r, index));
  });
}

}  // namespace tetskin::bullet_detail
