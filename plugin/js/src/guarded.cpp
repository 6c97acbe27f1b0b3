// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#include "guarded.h"

#include <emscripten.h>

#include <new>
#include <stdexcept>

namespace tetskin::js {
namespace {

// NOLINTNEXTLINE: the macro's own
EM_JS(void, throwInJavaScript, (const char* code, const char* message),
      { throw Module["makeError"](UTF8ToString(code), UTF8ToString(message)); });

constexpr char kReport[] = ": this is a fault of tetskin's; please report it";

/// The fault of the exception being handled. Throws if there is no memory for its message.
Fault wordedFault() {
  try {
    throw;
  } catch (const Failure& failure) {
    return {nameOf(failure.code), failure.what()};
  } catch (const std::bad_alloc&) {
    return {"OutOfMemory", {}};
  } catch (const std::length_error&) {
    return {"OutOfMemory", {}};
  } catch (const std::invalid_argument& error) {
    return {"InvalidArgument", error.what()};
  } catch (const std::exception& error) {
    return {"Internal", std::string(error.what()) + kReport};
  } catch (...) {
    return {"Internal", std::string("an exception of a kind that nothing here throws") + kReport};
  }
}

}  // namespace

Fault currentFault() {
  try {
    return wordedFault();
  } catch (...) {
    return {"OutOfMemory", {}};
  }
}

void throwFault(const Fault& fault) {
  throwInJavaScript(fault.code, fault.message.c_str());
}

}  // namespace tetskin::js
