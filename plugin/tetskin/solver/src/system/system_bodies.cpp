// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/solver/src/system/system_bodies.h>

#include <cassert>
#include <utility>

namespace tetskin::bullet_detail {

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
