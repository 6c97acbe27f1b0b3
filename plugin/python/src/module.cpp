// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
//
// The extension module tetskin._core. Each other source binds one subject.
#include "handles.h"

#include <tetskin/tetskin.h>

#include <cctype>

namespace tetskin::python {
namespace {

/// The name in Python's style for constants.
std::string constantOf(StatusCode code) {
  std::string constant;
  for (const char* letter = nameOf(code); *letter; ++letter) {
    const bool isCapital = std::isupper(static_cast<unsigned char>(*letter));
    if (isCapital && !constant.empty()) constant += '_';
    constant += static_cast<char>(std::toupper(static_cast<unsigned char>(*letter)));
  }
  return constant;
}

PyObject* errorType = nullptr;  // owned by the module, which is never unloaded

void translate(const std::exception_ptr& thrown, void*) {
  try {
    std::rethrow_exception(thrown);
  } catch (const Failure& failure) {
    nb::object error = nb::handle(errorType)(textOf(failure.what()));
    error.attr("code") = nb::cast(failure.code);
    PyErr_SetObject(errorType, error.ptr());
  }
}

void bindErrors(nb::module_& module) {
  nb::enum_<StatusCode> codes(module, "StatusCode", "The code of an Error, which says what has failed.");
  for (int i = 0; i <= static_cast<int>(StatusCode::Cancelled); ++i) {
    const auto code = static_cast<StatusCode>(i);
    codes.value(constantOf(code).c_str(), code, toString(code));
  }
  errorType = PyErr_NewExceptionWithDoc("tetskin.Error",
                                        "Raised when the library refuses a call; says why. code: a StatusCode.",
                                        PyExc_RuntimeError, nullptr);
  nb::setattr(nb::handle(errorType), "code", nb::none());
  module.attr("Error") = nb::handle(errorType);
  nb::register_exception_translator(translate);
}

}  // namespace
}  // namespace tetskin::python

NB_MODULE(_core, module) {
  using namespace tetskin::python;
  module.doc() = "Soft bodies in cages of tets, with their fine surface.";
  module.attr("__version__") = TETSKIN_VERSION;
  bindErrors(module);
  bindMeshes(module);
  bindCages(module);
  bindSkins(module);
  Class<ElasticModel> elastic = bindElasticBodies(module);
  Class<World> world = bindWorlds(module);
  bindRigidBodies(module, world);
  bindJoints(module, world);
  Class<BodyHandle> body = bindBodies(module, world);
  bindMaterialChanges(module, body, elastic);
  bindContacts(module, world);
  bindTouch(module, world);
  bindRuns(module, world);
  bindAnimations(module);
  bindPages(module, world, body);
  nameFaults(module);
}
