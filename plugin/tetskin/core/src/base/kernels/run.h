// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Points of one tet, side by side. Plain types only, as kernels read it.
#pragma once

#include <cstdint>

namespace tetskin::kernels {

/// The slots [firstSlot, the next run's firstSlot) belong to the tet of these nodes.
struct Run {
  int nodes[4] = {};
  std::uint32_t firstSlot = 0;
  std::uint32_t tet = 0;
};

}  // namespace tetskin::kernels
