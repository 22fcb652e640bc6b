// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Declarations shared by the parts of the Python module. Each file binds one theme.
#pragma once

#include <pybind11/pybind11.h>

#include <optional>
#include <vector>

#include "lanthorn/error_estimate.h"
#include "lanthorn/image.h"
#include "lanthorn/image_file.h"
#include "lanthorn/rays.h"
#include "lanthorn/render_options.h"
#include "lanthorn/scene.h"
#include "lanthorn/state.h"

namespace lanthorn::python {

namespace py = pybind11;

/// Calls `work` without the GIL and returns its result.
template <class Work>
auto without_gil(const Work& work) {
  const py::gil_scoped_release release;
  return work();
}

/// A scene with its view; a single value in Python.
struct SeenScene {
  SharedScene scene;
  ViewDescription view;
};

/// A picture with the data that displaying it needs.
struct Picture {
  Image image{};
  std::optional<ErrorEstimate> error{};
  bool measures_exposure = false, display_emission = false;
};
/// The picture with its layers of light denoised, and without the layers that denoising needs.
Picture denoised(Picture picture);
Picture picture_of_state(const RenderState& state, bool with_noise_layers);

/// The options of a render from keyword arguments: members of RenderOptions by their names; all other keywords are
/// parameters of the method. Throws Error for values of the wrong type.
RenderOptions options_of(const py::dict& keywords);
py::list texts_of(const std::vector<description::Warning>& warnings);

SceneDescription description_of_dict(const py::dict& data);

/// The rows of an array of shape (n, 3), or (3,) for one. Throws Error with its `name`.
std::vector<Vec3> vectors_of(py::handle data, const char* name);
/// One of `values` stands for all, as numpy broadcasts.
inline const Vec3& of_all(const std::vector<Vec3>& values, std::size_t i) { return values[values.size() == 1 ? 0 : i]; }
/// Rays from arrays of which one row stands for all.
std::vector<SceneRay> rays_of(const py::object& origins, const py::object& directions);

void bind_error(py::module_& module);
void bind_picture(py::module_& module);
void bind_scene(py::module_& module);
void bind_session(py::module_& module);
void bind_state(py::module_& module);
void bind_photons(py::module_& module);
void bind_rays(py::module_& module);
void bind_integrator(py::module_& module);
void bind_tools(py::module_& module);

}  // namespace lanthorn::python
