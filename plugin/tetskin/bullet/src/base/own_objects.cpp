// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include <tetskin/bullet/src/base/own_objects.h>

#include <cassert>
#include <mutex>
#include <shared_mutex>
#include <unordered_set>

namespace tetskin::bullet_detail {
namespace {

struct OwnAddresses {
  std::shared_mutex mutex;
  std::unordered_set<const void*> of[4];  ///< by kind
};

/// Never destroyed: static objects may be registered, too.
OwnAddresses& ownAddresses() {
  static auto* addresses = new OwnAddresses;
  return *addresses;
}

std::unordered_set<const void*>& addressesOf(OwnObject::Kind kind) {
  return ownAddresses().of[static_cast<int>(kind)];
}

}  // namespace

OwnObject::OwnObject(Kind kind, const void* object) : kind_(kind), object_(object) {
  assert(object);
  const std::unique_lock<std::shared_mutex> lock(ownAddresses().mutex);
  addressesOf(kind).insert(object);
}

OwnObject::~OwnObject() {
  const std::unique_lock<std::shared_mutex> lock(ownAddresses().mutex);
  addressesOf(kind_).erase(object_);
}

bool OwnObject::is(Kind kind, const void* object) {
  const std::shared_lock<std::shared_mutex> lock(ownAddresses().mutex);
  return addressesOf(kind).count(object) > 0;
}

}  // namespace tetskin::bullet_detail
