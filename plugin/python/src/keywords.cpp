// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// A call whose arguments fit no signature is answered by nanobind with all signatures, and no word about what is wrong.
// Here, all functions of the module get one in front: where names are unknown, missing or given twice, tetskin.keywords
// says which. A call that is right pays for one jump.
#include "models.h"

#include <nb_internals.h>
#include <algorithm>
#include <exception>
#include <utility>

namespace tetskin::python {
namespace {

using Call = PyObject* (*)(PyObject*, PyObject* const*, std::size_t, PyObject*);

/// Those of nanobind's, which has one by kind of signature.
constexpr std::size_t kMostCalls = 12;
Call callsOfNanobind[kMostCalls];

/// In place of the TypeError that has been raised, if names are what is wrong.
void explain(nb::handle function, std::size_t positional, nb::handle names) {
  nb::python_error raised;
  try {
    const nb::object fault =
        nb::module_::import_("tetskin.keywords")
            .attr("fault")(function.attr("__qualname__"), function.attr("__nb_signature__"), positional,
                           names.is_valid() ? nb::borrow<nb::tuple>(names) : nb::tuple());
    if (!fault.is_none()) return PyErr_SetObject(PyExc_TypeError, fault.ptr());
  } catch (const std::exception&) {
    // The package is not complete: the module has been imported by itself.
  }
  raised.restore();
}

template <std::size_t K>
PyObject* explained(PyObject* function, PyObject* const* arguments, std::size_t count, PyObject* names) {
  PyObject* result = callsOfNanobind[K](function, arguments, count, names);
  // Beside the number, `count` has flags.
  if (!result && PyErr_ExceptionMatches(PyExc_TypeError)) explain(function, count & 0xFFFF, names);
  return result;
}

template <std::size_t... K>
void putInFront(PyObject* function, std::index_sequence<K...>) {
  static constexpr Call kExplained[] = {explained<K>...};
  Call& now = reinterpret_cast<nb::detail::nb_func*>(function)->vectorcall;
  Call* const end = callsOfNanobind + kMostCalls;
  Call* const found = std::find_if(callsOfNanobind, end, [&](Call call) { return !call || call == now; });
  if (found == end) return;  // its own answers remain
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
