// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to the kernels: the nodes' bones, computed from their gradients: see bone_palette.h.
#pragma once

#include <tetskin/core/src/kernels/points.h>
#include <tetskin/core/src/kernels/skinning_kernels.h>

namespace tetskin::kernels::TETSKIN_KERNELS {

/// A matrix [ A | t ]: its three columns, and its translation; the fourth numbers are meaningless.
template <class S>
struct BoneColumns {
  Lanes<S, 4> item[4];

  BoneColumns(const BoneWork<S>& work, std::size_t node) {
    const S* gradient = work.gradients + kGradientStride * static_cast<std::size_t>(work.gradientOf[node]);
    const S* rest = work.restNodes + 4 * node;
    for (int k = 0; k < 3; ++k) item[k] = loadPadded(gradient + 4 * k);
    item[3] = loadPadded(work.nodes + 4 * node);
    if (work.content == BoneContent::Gradient) {
      item[3] -= loadPadded(rest);
    } else {
      for (int k = 0; k < 3; ++k) item[k] = item[k] * S(0.5);
      item[3] -= item[0] * rest[0] + item[1] * rest[1] + item[2] * rest[2];
    }
    item[3] += loadPadded(work.shift);  // last: it may be large
  }

  Lanes<float, 4> column(int k) const { return toFloats<S, 1>(item[k]); }
  void storeColumns(float* out) const {
    for (int k = 0; k < 4; ++k) {
      Lanes<float, 4> c = column(k);
      c[3] = k == 3 ? 1.0f : 0.0f;
      storeWhole<float, 1>(c, out + 4 * k);
    }
  }
  void storeRows(float* out) const {
    const Lanes<float, 4> x = column(0), y = column(1), z = column(2), t = column(3);
    const Lanes<float, 4> above = mixed<0, 1, 0, 1, float, 1>(x, y), aboveLast = mixed<0, 1, 0, 1, float, 1>(z, t);
    const Lanes<float, 4> below = mixed<2, 2, 2, 2, float, 1>(x, y), belowLast = mixed<2, 2, 2, 2, float, 1>(z, t);
    storeWhole<float, 1>(mixed<0, 2, 0, 2, float, 1>(above, aboveLast), out);
    storeWhole<float, 1>(mixed<1, 3, 1, 3, float, 1>(above, aboveLast), out + 4);
    storeWhole<float, 1>(mixed<0, 2, 0, 2, float, 1>(below, belowLast), out + 8);
  }
};

template <class S>
void bones(const BoneWork<S>& given) {
  const BoneWork<S> work = given;
  auto* out = reinterpret_cast<unsigned char*>(work.bones) + work.firstNode * work.strideBytes;
  for (std::size_t n = work.firstNode; n < work.lastNode; ++n, out += work.strideBytes) {
    const BoneColumns<S> bone(work, n);
    if (work.columns) {
      bone.storeColumns(reinterpret_cast<float*>(out));
    } else {
      bone.storeRows(reinterpret_cast<float*>(out));
    }
  }
}

}  // namespace tetskin::kernels::TETSKIN_KERNELS
