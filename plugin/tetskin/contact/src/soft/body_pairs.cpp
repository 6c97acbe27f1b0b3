// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// This work is based on:
//   David Baraff, "Dynamic Simulation of Non-Penetrating Rigid Bodies", PhD thesis, Cornell University, 1992 (sweep and
//   prune)
#include <tetskin/contact/src/soft/body_pairs.h>

#include <algorithm>
#include <numeric>

namespace tetskin::contact_detail {
namespace {

/// The axis along which the boxes are spread most.
int widestAxis(const std::vector<ContactBox>& boxes) {
  ContactBox corners;
  for (const ContactBox& box : boxes) corners.extend(box.low, box.low);
  int axis = 0;
  for (int k = 1; k < 3; ++k) {
    if (corners.high[k] - corners.low[k] > corners.high[axis] - corners.low[axis]) axis = k;
  }
  return axis;
}

}  // namespace

std::vector<std::pair<std::size_t, std::size_t>> overlappingBoxPairs(const std::vector<ContactBox>& boxes) {
  const int axis = widestAxis(boxes);
  std::vector<std::size_t> order(boxes.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return boxes[a].low[axis] < boxes[b].low[axis]; });
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t k = 0; k < order.size(); ++k) {
    const ContactBox& box = boxes[order[k]];
    pairs.emplace_back(order[k], order[k]);
    for (std::size_t next = k + 1; next < order.size() && boxes[order[next]].low[axis] <= box.high[axis]; ++next) {
      if (!box.collides(boxes[order[next]])) continue;
      pairs.push_back(std::minmax(order[k], order[next]));
    }
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace tetskin::contact_detail
