// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to snapshots: private members of Bullet's classes. A world continues to the last bit only if they are
// restored exactly, and Bullet's setters compute or round.
#pragma once

#include <tetskin/bullet/src/base/world_stream.h>
#include <tetskin/solver/src/base/opened_member.h>

#include <type_traits>

namespace tetskin::bullet_detail {

/// A number, a vector, an array of these; or a struct that has its own serialize.
template <class T>
void serializeMember(WorldStream& stream, T& member) {
  if constexpr (std::is_array_v<T>) {
    for (auto& element : member) serializeMember(stream, element);
  } else if constexpr (std::is_invocable_v<WorldStream&, T&>) {
    stream(member);
  } else {
    serialize(stream, member);
  }
}

template <class... Members>
void serializeAll(WorldStream& stream, Members&... members) {
  (serializeMember(stream, members), ...);
}

template <class Object>
struct MembersOf {
  friend void serializeOpened(MembersOf, WorldStream& stream, Object& object);
};

/// In a source,
///     template struct Serialized<Object, &Object::m_hidden, ...>;
/// defines what `serializeMembers` writes or reads of that class.
template <class Object, auto... members>
struct Serialized {
  friend void serializeOpened(MembersOf<Object>, WorldStream& stream, Object& object) {
    serializeAll(stream, object.*members...);
  }
};
template <class Object>
void serializeMembers(WorldStream& stream, Object& object) {
  serializeOpened(MembersOf<Object>(), stream, object);
}

}  // namespace tetskin::bullet_detail
