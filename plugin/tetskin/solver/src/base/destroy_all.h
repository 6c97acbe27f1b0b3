// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <LinearMath/btAlignedObjectArray.h>

namespace tetskin::bullet_detail {

/// Clears one of Bullet's lists and destroys its elements: those about multibodies own memory. resize(0) would do the
/// same with a default element, but GCC warns about it.
template <class Element>
void destroyAll(btAlignedObjectArray<Element>& elements) {
  while (elements.size() > 0) elements.pop_back();
}

}  // namespace tetskin::bullet_detail
