// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The extension module lanthorn._lanthorn, whose names the package lanthorn re-exports.
#include "bindings.h"
#include "lanthorn/error.h"
#include "lanthorn/methods.h"
#include "lanthorn/version.h"

namespace lanthorn::python {

void bind_error(py::module_& module) {
  // NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables): lives as long as the interpreter
  static py::handle type;
  py::exception<Error> error(module, "Error");
  error.attr("__doc__") =
      "An invalid scene, file, option or value.\n\n"
      "str(error) says where and what. Attributes: `file` (str, empty if no file is involved), `line` and `column`\n"
      "(int, from 1; 0 if not known) and `message` (str, without the location).";
  for (const char* const text : {"file", "message"}) error.attr(text) = "";
  for (const char* const number : {"line", "column"}) error.attr(number) = 0;
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

namespace {

// For pybind11's casters, which otherwise give functions uninitialised memory as the object.
void* refuse_object_without_value(std::size_t /*bytes*/) {
  throw py::type_error("this object was made by __new__ without __init__, so it has no value");
}

PyObject* refuse_to_create(PyTypeObject* type, PyObject* /*arguments*/, PyObject* /*keywords*/) {
  PyErr_Format(PyExc_TypeError, "%s has no constructor: use the functions of lanthorn that return one", type->tp_name);
  return nullptr;
}

// The value of an object belongs to its class, whatever Python assigns to `__class__`.
void keep_class(PyTypeObject* type) {
  const py::object builtins = py::module_::import("builtins");
  const py::cpp_function refuse([](const py::object& self, const py::object& /*other*/) {
    throw py::type_error("the class of an object of lanthorn cannot be changed: " + py::repr(self).cast<std::string>());
  });
  const py::object property = builtins.attr("property")(builtins.attr("type"), refuse);
  // An assignment would change the class of the class.
  if (PyDict_SetItemString(type->tp_dict, "__class__", property.ptr()) != 0) throw py::error_already_set();
  PyType_Modified(type);
}

// copy and pickle make objects without __init__. For old protocols, pickle calls pybind11's base class, which ends the
// program.
void refuse_to_pickle(const py::object& type) {
  for (const char* const name : {"__reduce__", "__reduce_ex__"})
    type.attr(name) = py::cpp_function(
        [](const py::object& self, const py::args& /*protocol*/) -> py::object {
          throw py::type_error("cannot copy or pickle an object of lanthorn: " + py::repr(self).cast<std::string>());
        },
        py::name(name), py::is_method(type));
}

// Keeps objects whose value was never constructed, or is of another class, out of all functions.
void guard_classes(const py::module_& module) {
  for (const auto& [name, member] : py::dict(module.attr("__dict__"))) {
    if (!PyType_Check(member.ptr())) continue;
    auto* const type = reinterpret_cast<PyTypeObject*>(member.ptr());
    py::detail::type_info* const info = py::detail::get_type_info(type);
    if (info == nullptr) continue;  // the exception
    info->operator_new = &refuse_object_without_value;
    // A class without py::init has the __init__ of its base, which raises.
    if (Py_TYPE(py::dict(member.attr("__dict__"))["__init__"].ptr()) == &PyWrapperDescr_Type)
      type->tp_new = &refuse_to_create;
    refuse_to_pickle(py::reinterpret_borrow<py::object>(member));
    keep_class(type);
  }
}

}  // namespace

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
  guard_classes(module);
}
