// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to tetskin: which of the objects that an application hands over are the library's own.
//
// An application may be compiled without type information (-fno-rtti, /GR-). A dynamic_cast or typeid of an object of
// its own classes then crashes. Therefore objects of the library's own classes are known by their addresses. Whatever
// derives from one of these classes has type information, and may be cast from there on.
#pragma once

#include <tetskin/core/src/base/compiler.h>
#include <tetskin/export.h>

#include <cstring>
#include <typeinfo>

namespace tetskin::bullet_detail {

/// A member of an object, which is known as long as it has this. From any thread; cost of a look-up: that of a hash.
class TETSKIN_BULLET_API OwnObject {
 public:
  enum class Kind { InactiveForce, BodyGravity, DeformableSolver, BodyWithTrees };
  /// object  as its class in Bullet
  OwnObject(Kind kind, const void* object);
  ~OwnObject();
  OwnObject(const OwnObject&) = delete;
  OwnObject& operator=(const OwnObject&) = delete;

  static bool is(Kind kind, const void* object);

 private:
  Kind kind_;
  const void* object_;
};

/// The object as one of the library's own classes; null if it is of another class.
template <class Own, class Bullets>
Own* asOwn(OwnObject::Kind kind, Bullets* object) {
  return OwnObject::is(kind, object) ? static_cast<Own*>(object) : nullptr;
}

/// True if the object has type information, so that it may be cast by it. Only the C++ ABI of GCC and clang tells
/// whether it has: with another one, the result is false.
template <class Base>
bool hasTypeInformation([[maybe_unused]] const Base& object) {
#ifdef TETSKIN_GNU
  const void* const* table = nullptr;
  std::memcpy(&table, static_cast<const void*>(&object), sizeof table);
  return table[-1] != nullptr;
#else
  return false;
#endif
}

/// True if an object is known by its type information to be of another class than `Derived`, and of none derived from
/// it.
template <class Derived, class Base>
bool isKnownNotToBe(const Base& object) {
  return hasTypeInformation(object) && !dynamic_cast<const Derived*>(&object);
}

/// True if an object is of the same class as another one, rather than of one derived from it: both have one table of
/// virtual functions. Two libraries may each have such a table; then type information decides, if there is any. Only
/// the C++ ABI of GCC and clang tells whether there is: with another one, the result may be false for the same class.
template <class Base>
bool isOfSameClass(const Base& object, const Base& other) {
  const auto tableOf = [](const Base& of) {
    const void* table = nullptr;
    std::memcpy(&table, static_cast<const void*>(&of), sizeof table);
    return table;
  };
  return tableOf(object) == tableOf(other) || (hasTypeInformation(object) && typeid(object) == typeid(other));
}

}  // namespace tetskin::bullet_detail
