// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Members of Bullet's classes that it does not show. Access is not checked where a template is instantiated explicitly
// ([temp.spec.general]), so that this is C++ as it is written, and breaks at compile time when a member is renamed.
// Only snapshots, and what must not change a world by looking at it, may reach into Bullet in this way.
#pragma once

#include <tetskin/core/src/base/compiler.h>

namespace tetskin::bullet_detail {

TETSKIN_FRIENDS_OF_TEMPLATES

/// The only member of a type, of a class, that is opened: after
///     using ThatMember = Hidden<Object, Type>;
///     template struct Opened<ThatMember, &Object::m_hidden>;
/// `object.*memberOf(ThatMember())` is that member.
template <class Object, class Type>
struct Hidden {
  friend Type Object::*memberOf(Hidden);
};

template <class Name, auto member>
struct Opened {
  friend decltype(member) memberOf(Name) { return member; }
};

}  // namespace tetskin::bullet_detail
