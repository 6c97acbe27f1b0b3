// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/core/src/base/instantiate.h>
#include <tetskin/core/src/skinning/linear_skinning.h>
#include <tetskin/core/src/skinning/skin_tasks.h>

namespace tetskin {

template <class Scalar, class Out>
void skinLinear(const Embedding& embedding, const PackedNodes<Scalar>& nodes, const SkinOutput<Scalar, Out>& output,
                Box3* bounds, ParallelFor* threads) {
  auto work = skin_tasks::workFor(dataOf(embedding), nodes);
  work.surface = kernels::Surface::Linear;
  skin_tasks::skin(dataOf(embedding), work, nodes, output, bounds, threads);
}

#define TETSKIN_INSTANTIATE(Scalar, Out)                                                                        \
  template void skinLinear(const Embedding&, const PackedNodes<Scalar>&, const SkinOutput<Scalar, Out>&, Box3*, \
                           ParallelFor*);
TETSKIN_FOR_SCALAR_PAIRS(TETSKIN_INSTANTIATE)
#undef TETSKIN_INSTANTIATE

}  // namespace tetskin
