// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Methods written in Python.
#include <map>

#include "bindings.h"
#include "lanthorn/own_method.h"
#include "plain_data.h"

namespace lanthorn::python {

namespace {

// Python functions by method name. Never destroyed: at process exit the interpreter may already be gone.
std::map<std::string, py::object>& functions() {
  static auto* const all = new std::map<std::string, py::object>;
  return *all;
}

void call(const std::string& name, const SharedScene& scene, const EyeRays& eye, std::span<Rgb> radiance) {
  const py::gil_scoped_acquire acquire;
  std::vector<Vec3> origins, directions;
  for (const SceneRay& ray : eye.rays) {
    origins.push_back(ray.origin);
    directions.push_back(ray.direction);
  }
  const py::object answer = functions().at(name)(SeenScene{scene, description_of(*scene).view}, write(origins),
                                                 write(directions), eye.random_key);
  Reader reader;
  const std::string expected = "numbers of shape (" + std::to_string(radiance.size()) + ", 3)";
  reader.at(name + ".radiance", [&] {
    const auto values = plain::number_array<float>(reader, value_of(answer), expected);
    if (values.shape != plain::Shape{radiance.size(), 3}) reader.fail(expected, value_of(answer));
    std::memcpy(static_cast<void*>(radiance.data()), values.values.data(), radiance.size_bytes());
  });
}

void add(const std::string& name, const std::string& summary, const py::object& function) {
  // Redefining a method replaces its function, because notebook cells are run repeatedly.
  if (!functions().contains(name))
    add_method(name, summary, [name](const SharedScene& scene, const EyeRays& eye, std::span<Rgb> radiance) {
      call(name, scene, eye, radiance);
    });
  functions()[name] = function;
}

}  // namespace

void bind_integrator(py::module_& module) {
  module.def("_add_integrator", &add, py::arg("name"), py::arg("summary"), py::arg("function"));
}

}  // namespace lanthorn::python
