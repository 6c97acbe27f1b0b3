// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Members of Bullet's classes that it does not show. Access is not checked where a template is instantiated explicitly
// ([temp.spec.general]), so that this is C++ as it is written, and breaks at compile time when a member is renamed.
// Only snapshots, and what must not change a world by looking at it, may reach into Bullet in this way.
#pragma once

namespace tetskin::bullet_detail {

/// One member: after `struct Name { friend Type Object::*memberOf(Name); }`,
///     template struct Opened<Name, &Object::m_hidden>;
/// makes `object.*memberOf(Name())` that member.
template <class Name, auto member>
struct Opened {
  friend decltype(member) memberOf(Name) { return member; }
};

}  // namespace tetskin::bullet_detail
