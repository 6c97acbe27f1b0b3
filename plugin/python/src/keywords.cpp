// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// If arguments fit no signature, nanobind lists all signatures and does not say what is wrong. Here, all functions of
// the module get a wrapper: if names are unknown, missing or given twice, tetskin.keywords says which. A correct call
// costs one more jump.
#include "models.h"

#include <nb_internals.h>
#include <algorithm>
#include <exception>
#include <utility>

namespace tetskin::python {
namespace {

using Call = PyObject* (*)(PyObject*, PyObject* const*, std::size_t, PyObject*);

/// nanobind's own functions, one per kind of signature.
constexpr std::size_t kMostCalls = 12;
Call callsOfNanobind[kMostCalls];

/// Replaces the TypeError that has been raised, if names are wrong.
void explain(nb::handle function, std::size_t positional, nb::handle names) {
  nb::python_error raised;
  try {
    const nb::object fault =
        nb::module_::import_("tetskin.keywords")
            .attr("fault")(function.attr("__qualname__"), function.attr("__nb_signature__"), positional,
                           names.is_valid() ? nb::borrow<nb::tuple>(names) : nb::tuple());
    if (!fault.is_none()) return PyErr_SetObject(PyExc_TypeError, fault.ptr());
  } catch (const std::exception&) {
    // The package is incomplete: the module has been imported by itself.
  }
  raised.restore();
}

template <std::size_t K>
PyObject* explained(PyObject* function, PyObject* const* arguments, std::size_t count, PyObject* names) {
  PyObject* result = callsOfNanobind[K](function, arguments, count, names);
  // `count` also contains flags.
  if (!result && PyErr_ExceptionMatches(PyExc_TypeError)) explain(function, count & 0xFFFF, names);
  return result;
}

template <std::size_t... K>
void putInFront(PyObject* function, std::index_sequence<K...>) {
  static constexpr Call kExplained[] = {explained<K>...};
  Call& now = reinterpret_cast<nb::detail::nb_func*>(function)->vectorcall;
  Call* const end = callsOfNanobind + kMostCalls;
  Call* const found = std::find_if(callsOfNanobind, end, [&](Call call) { return !call || call == now; });
  if (found == end) return;  // nanobind's own messages remain
  *found = now;
  now = kExplained[found - callsOfNanobind];
}

void nameFaultsIn(nb::handle scope) {
  for (nb::handle item : nb::list(scope.attr("__dict__").attr("values")())) {
    if (nb::type_check(item)) {
      nameFaultsIn(item);
    } else if (nb::hasattr(item, "__nb_signature__")) {
      putInFront(item.ptr(), std::make_index_sequence<kMostCalls>());
    }
  }
}

}  // namespace

void nameFaults(nb::module_& module) {
  nameFaultsIn(module);
}

}  // namespace tetskin::python
