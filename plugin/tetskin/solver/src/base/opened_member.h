// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Access to private members of Bullet's classes. Access is not checked in an explicit instantiation of a template
// ([temp.spec.general]): this is valid C++, and fails to compile when a member is renamed. Only snapshots, and code
// that must not change a world by looking at it, may reach into Bullet in this way.
#pragma once

#include <tetskin/core/src/base/compiler.h>

namespace tetskin::bullet_detail {

TETSKIN_FRIENDS_OF_TEMPLATES

/// Tag of one private member of a class, by the types of both: after
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
