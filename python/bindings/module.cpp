// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The extension module lanthorn._lanthorn, whose names the package lanthorn re-exports.
#include "bindings.h"
#include "lanthorn/error.h"
#include "lanthorn/realtime.h"
#include "lanthorn/version.h"

namespace lanthorn::python {

void bind_integrator(py::module_& module);

void bind_error(py::module_& module) {
  // NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables): lives as long as the interpreter
  static py::handle type;
  py::exception<Error> error(module, "Error");
  error.attr("__doc__") =
      "An invalid scene, file, option or value.\n\n"
      "str(error) says where and what. Attributes: `file` (str, empty if no file is involved), `line` and `column`\n"
      "(int, from 1; 0 if not known) and `message` (str, without the location).";
  type = error.release();
  // NOLINTNEXTLINE(performance-unnecessary-value-param): pybind11 takes a function of this type
  py::register_exception_translator([](std::exception_ptr pointer) {
    try {
      if (pointer) std::rethrow_exception(pointer);
    } catch (const Error& e) {
      const py::object instance = type(py::str(e.what()));
      instance.attr("file") = e.where.file;
      instance.attr("line") = e.where.line;
      instance.attr("column") = e.where.column;
      instance.attr("message") = e.message;
      PyErr_SetObject(type.ptr(), instance.ptr());
    }
  });
}

}  // namespace lanthorn::python

PYBIND11_MODULE(_lanthorn, module) {
  using namespace lanthorn::python;
  module.attr("__version__") = lanthorn::version;
  lanthorn::add_realtime_methods();
  bind_error(module);
  bind_picture(module);
  bind_scene(module);
  bind_state(module);
  bind_session(module);
  bind_photons(module);
  bind_rays(module);
  bind_tools(module);
  bind_integrator(module);
}
