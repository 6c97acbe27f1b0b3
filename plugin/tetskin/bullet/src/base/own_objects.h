// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// Internal to tetskin: which of the objects that an application passes in are of the library's own classes.
//
// An application may be compiled without type information (-fno-rtti, /GR-). A dynamic_cast or typeid of an object of
// its own classes then crashes. Therefore the library registers the addresses of objects of its own classes. Anything
// derived from one of these classes has type information, and may be cast from there on.
#pragma once

#include <tetskin/core/src/base/compiler.h>
#include <tetskin/export.h>

#include <cstring>
#include <typeinfo>

namespace tetskin::bullet_detail {

/// As a member of an object, registers the object as long as it exists. From any thread; a look-up costs that of a
/// hash.
class TETSKIN_BULLET_API OwnObject {
 public:
  enum class Kind { InactiveForce, BodyGravity, DeformableSolver, BodyWithTrees };
  /// object  as a pointer to its Bullet class
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

/// True if the object has type information, so that it may be cast by it. Only the C++ ABI of GCC and clang reveals
/// this: with any other, the result is false.
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

/// True if an object's type information says that it is neither of the class `Derived` nor of one derived from it.
template <class Derived, class Base>
bool isKnownNotToBe(const Base& object) {
  return hasTypeInformation(object) && !dynamic_cast<const Derived*>(&object);
}

/// True if an object is of exactly the same class as another one: both have one virtual function table. Two libraries
/// may each have such a table; then type information decides, if there is any. Only the C++ ABI of GCC and clang
/// reveals whether there is: with any other, the result may be false for the same class.
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
