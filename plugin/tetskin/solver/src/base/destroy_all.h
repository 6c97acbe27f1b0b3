// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <LinearMath/btAlignedObjectArray.h>

namespace tetskin::bullet_detail {

/// Clears a list of Bullet's and destroys its elements, as those about multibodies own memory. resize(0) would do the
/// same with a default element, for which GCC warns.
template <class Element>
void destroyAll(btAlignedObjectArray<Element>& elements) {
  while (elements.size() > 0) elements.pop_back();
}

}  // namespace tetskin::bullet_detail
