// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Comparing and denoising pictures, convergence, image-based lighting, methods, threads.
#include <pybind11/functional.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <atomic>
#include <limits>
#include <memory>

#include "bindings.h"
#include "lanthorn/convergence.h"
#include "lanthorn/denoise.h"
#include "lanthorn/flip.h"
#include "lanthorn/ibl.h"
#include "lanthorn/methods.h"
#include "lanthorn/metrics.h"
#include "lanthorn/threads.h"
#include "plain_data.h"

namespace lanthorn::python {

namespace {

Image colours_of(const Picture& picture, const char* name) {
  std::optional<Image> colours = select_layer(picture.image, "color");
  if (!colours) throw Error(std::string(name) + ": the picture has no colours");
  return std::move(*colours);
}

py::dict compare(const Picture& picture, const Picture& reference) {
  ImageErrors errors;
  double flip = 0;
  {
    const py::gil_scoped_release release;
    const Image a = colours_of(picture, "picture"), r = colours_of(reference, "reference");
    errors = image_errors(a, r);
    flip = hdr_flip(a, r).mean;
  }
  py::dict data;
  data["mse"] = errors.mse;
  data["rel_mse"] = errors.rel_mse;
  data["flip"] = flip;
  data["mean"] = errors.mean_image;
  data["mean_reference"] = errors.mean_reference;
  data["mean_ratio"] = errors.mean_ratio;
  data["max_difference"] = errors.max_difference;
  data["non_finite"] = errors.non_finite;
  return data;
}

constexpr double no_reference = std::numeric_limits<double>::quiet_NaN();

// One column of the points; NaN where there is no reference.
template <class Value>
py::object column(const Convergence& convergence, Value&& value) {
  std::vector<double> values;
  values.reserve(convergence.points.size());
  for (const auto& point : convergence.points) values.push_back(value(point));
  return array_of<double>(std::move(values));
}

py::dict converge(const SeenScene& scene, std::uint64_t runs, const std::optional<Picture>& reference,
                  const py::kwargs& keywords) {
  const RenderOptions options = options_of(keywords);
  std::atomic<bool> is_stopped{false};
  std::optional<py::error_already_set> raised;
  ConvergenceSettings settings{.runs = runs, .stop = &is_stopped};
  settings.progress = [&](std::uint64_t, std::uint64_t) {
    const py::gil_scoped_acquire acquire;
    if (raised || PyErr_CheckSignals() == 0) return;
    raised.emplace();
    is_stopped = true;
  };
  Convergence convergence;
  {
    const py::gil_scoped_release release;
    std::optional<Image> truth;
    if (reference) truth = colours_of(*reference, "reference");
    convergence = measure_convergence(*scene.scene, scene.view, options, settings, truth);
  }
  if (raised) throw py::error_already_set(std::move(*raised));
  py::dict data;
  data["runs"] = convergence.runs;
  data["passes"] = column(convergence, [](const auto& p) { return static_cast<double>(p.passes); });
  data["deviation"] = column(convergence, [](const auto& p) { return p.deviation; });
  data["bias"] = column(convergence, [](const auto& p) { return p.bias.value_or(no_reference); });
  data["error"] = column(convergence, [](const auto& p) { return p.error.value_or(no_reference); });
  data["variance_slope"] = convergence.variance_slope;
  data["bias_slope"] = convergence.bias_slope;
  return data;
}

py::dict ibl_as_dict(const Ibl& ibl) {
  const auto picture = [](const Image& image) { return py::cast(Picture{.image = image}); };
  py::dict data;
  data["irradiance"] = picture(*ibl.irradiance);
  py::list specular;
  for (const SpecularLevel& level : ibl.specular)
    specular.append(py::make_tuple(level.roughness, picture(level.faces)));
  data["specular"] = specular;
  data["sh"] = write(std::vector<Rgb>(ibl.sh->irradiance.begin(), ibl.sh->irradiance.begin() + 9));
  data["mean"] = write(ibl.mean);
  return data;
}

py::dict bake(const Picture& environment, int irradiance_size, int specular_size, int samples) {
  IblSettings settings{.irradiance_size = irradiance_size, .specular_size = specular_size, .samples = samples};
  settings.smallest_size = std::min(settings.smallest_size, specular_size);
  settings.checks = 0;
  return ibl_as_dict(without_gil([&] { return bake_ibl(environment.image, settings); }));
}

py::list methods_as_list() {
  py::list all;
  for (const MethodInfo& method : methods()) {
    py::dict parameters;
    for (const ParameterInfo& p : method.parameters)
      parameters[p.name.c_str()] = py::make_tuple(p.default_value, p.help);
    py::dict data;
    data["name"] = method.name;
    data["summary"] = method.summary;
    data["paper"] = method.paper;
    data["parameters"] = parameters;
    all.append(data);
  }
  return all;
}

void bind_threads(py::module_& module) {
  module.def(
      "set_threads",
      [](unsigned threads) {
        // Never destroyed: at process exit TBB may already be gone.
        static auto& limit = *new std::unique_ptr<ThreadLimit>;
        limit.reset();
        if (threads > 0) limit = std::make_unique<ThreadLimit>(threads);
      },
      py::arg("threads"), "Limits the threads of all renders; 0: all available. Does not change any result.");
}

}  // namespace

void bind_tools(py::module_& module) {
  module.def("compare", &compare, py::arg("picture"), py::arg("reference"),
             "dict: errors of the layer 'color' against a reference of the same size: 'mse'; 'rel_mse', the mean of\n"
             "(a - r)**2 / (r**2 + 0.01); 'flip' (HDR-FLIP, 0 to 1); 'mean', 'mean_reference', 'mean_ratio',\n"
             "'max_difference'; 'non_finite', the number of excluded values.");
  module.def("denoise", &denoised, py::arg("picture"), py::call_guard<py::gil_scoped_release>(),
             "The Picture denoised layer by layer. It needs the layers of session.picture(noise=True).");
  module.def("converge", &converge, py::arg("scene"), py::kw_only(), py::arg("runs") = 50,
             py::arg("reference") = py::none(),
             "dict of arrays over 1, 2, 4 ... passes, from `runs` renders that differ in their seeds: 'passes';\n"
             "'deviation' of a pixel; 'bias' and 'error' against the reference, NaN without; and the exponents\n"
             "'variance_slope' and 'bias_slope'. Further keywords are options as of Session (passes, integrator ...).");
  module.def(
      "read_environment", [](const std::filesystem::path& path) { return Picture{.image = read_environment({path})}; },
      py::arg("path"), py::call_guard<py::gil_scoped_release>(),
      "The Picture of an environment, for `ibl`: equirectangular, octahedral or cube by its shape.");
  module.def(
      "ibl", &bake, py::arg("environment"), py::kw_only(), py::arg("irradiance_size") = 32,
      py::arg("specular_size") = 256, py::arg("samples") = 4096,
      "dict: tables that engines look up instead of integrating over an environment (docs/methods/ibl.md): "
      "'irradiance',\n"
      "a Picture of six faces side by side, divided by pi; 'specular', a list of (roughness, Picture) by level;\n"
      "'sh' (9, 3), spherical harmonics of the irradiance divided by pi; 'mean' radiance.");
  module.def("_methods", &methods_as_list, "Data from which lanthorn.methods makes a list of Method.");
  bind_threads(module);
}

}  // namespace lanthorn::python
