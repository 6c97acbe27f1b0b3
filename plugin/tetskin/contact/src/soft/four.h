// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to SoftContacts: four numbers side by side. Compilers do not vectorise loops over four by themselves.
#pragma once

#define TETSKIN_KERNELS contact
#include <tetskin/core/src/base/kernels/lanes.h>
#undef TETSKIN_KERNELS

#include <LinearMath/btVector3.h>

#include <algorithm>
#include <cstring>

namespace tetskin::contact_detail {

using Four = kernels::contact::Lanes<btScalar, 4>;

using kernels::contact::larger;
using kernels::contact::smaller;

TETSKIN_INLINE Four four(btScalar x) {
  return Four{x, x, x, x};
}

/// Loads four numbers from any address.
TETSKIN_INLINE Four fourAt(const btScalar* from) {
  Four v;
  std::memcpy(&v, from, sizeof v);
  return v;
}

TETSKIN_INLINE void put(const Four& v, btScalar* to) {
  std::memcpy(to, &v, sizeof v);
}

/// The coordinates, and a meaningless fourth number.
TETSKIN_INLINE Four fourOf(const btVector3& p) {
  return fourAt(p.m_floats);
}

TETSKIN_INLINE btScalar least(const Four& v) {
  return std::min(std::min(v[0], v[1]), std::min(v[2], v[3]));
}

TETSKIN_INLINE btScalar largest(const Four& v) {
  return std::max(std::max(v[0], v[1]), std::max(v[2], v[3]));
}

}  // namespace tetskin::contact_detail
