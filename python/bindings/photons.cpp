// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Photons as arrays.
#include "lanthorn/photons.h"

#include <optional>
#include <string>
#include <vector>

#include "bindings.h"
#include "plain_data.h"

namespace lanthorn::python {

namespace {

// The starts of the light paths that the user gives; empty if lights emit them instead.
std::optional<std::vector<PhotonStart>> starts_of(const py::object& origins, const py::object& directions,
                                                  const py::object& powers) {
  if (origins.is_none() && directions.is_none() && powers.is_none()) return {};
  if (origins.is_none() || directions.is_none()) throw Error("origins, directions: expected both, or none of them");
  const std::vector<SceneRay> rays = rays_of(origins, directions);
  const std::vector<Vec3> watts = powers.is_none() ? std::vector<Vec3>{Vec3(1)} : vectors_of(powers, "powers");
  if (watts.size() != rays.size() && watts.size() != 1)
    throw Error("powers: expected as many rows as there are rays, or one, got " + std::to_string(watts.size()) +
                " for " + std::to_string(rays.size()));
  std::vector<PhotonStart> starts(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Vec3& power = of_all(watts, i);
    starts[i] = {rays[i], {power.x, power.y, power.z}};
  }
  return starts;
}

Photons trace(const SeenScene& scene, const py::object& origins, const py::object& directions, const py::object& powers,
              std::uint32_t pass, bool direct, const py::kwargs& keywords) {
  const RenderOptions options = options_of(keywords);
  const std::optional<std::vector<PhotonStart>> starts = starts_of(origins, directions, powers);
  const py::gil_scoped_release release;
  if (starts) return trace_photons(*scene.scene, scene.view, options, *starts, pass, direct);
  return trace_photons(*scene.scene, scene.view, options, pass, direct);
}

template <class Scalar, auto member>
py::object column(const py::object& self) {
  const auto& values = self.cast<const Photons&>().*member;
  return array_in(values.data(), layout_of<Scalar>(values), self, /*writable=*/false);
}

}  // namespace

void bind_photons(py::module_& module) {
  py::class_<Photons>(
      module, "Photons",
      "Photons of one pass as read-only arrays, which share their memory. n = len(photons).\n\n"
      "Classes are DIRECT (0, straight from the light), CAUSTIC (1, after only mirrors and clear glass)\n"
      "and INDIRECT (2, all others).")
      .def("__len__", &Photons::size, "Number of photons.")
      .def_readonly("light_paths", &Photons::light_paths, "int: light paths that were emitted.")
      .def_property_readonly("positions", &column<float, &Photons::positions>,
                             "(n, 3) float32: metres, in the coordinates of the scene's file.")
      .def_property_readonly("normals", &column<float, &Photons::normals>,
                             "(n, 3) float32: of the surface; 0 in media.")
      .def_property_readonly("directions", &column<float, &Photons::directions>,
                             "(n, 3) float32: unit vectors towards where the photon came from.")
      .def_property_readonly("powers", &column<float, &Photons::powers>,
                             "(n, 3) float32: watts in linear Rec.709; negative for wavelengths outside the gamut.")
      .def_property_readonly(
          "depths", &column<std::int32_t, &Photons::depths>,
          "(n,) int32: scattering events up to and including the photon's own; 1: straight from the light.")
      .def_property_readonly("classes", &column<std::uint8_t, &Photons::classes>,
                             "(n,) uint8: DIRECT, CAUSTIC or INDIRECT.")
      .def_property_readonly("starts", &column<std::uint32_t, &Photons::starts>,
                             "(n,) uint32: row of `origins` whose path the photon is of; (0,) if lights sent it.")
      .def("__repr__",
           [](const Photons& p) {
             return "<lanthorn.Photons " + std::to_string(p.size()) + " of " + std::to_string(p.light_paths) +
                    " light paths>";
           })
      .attr("DIRECT") = 0;
  const py::object type = module.attr("Photons");
  type.attr("CAUSTIC") = 1;
  type.attr("INDIRECT") = 2;
  module.def("trace_photons", &trace, py::arg("scene"), py::kw_only(), py::arg("origins") = py::none(),
             py::arg("directions") = py::none(), py::arg("powers") = py::none(), py::arg("pass_number") = 0,
             py::arg("direct") = true,
             "Traces the Photons of a pass; the same for any number of threads. direct: with those that come straight\n"
             "from a light. Further keywords are options as of Session (integrator, photons, seed, max_depth ...).\n\n"
             "origins, directions: (n, 3), metres; n light paths start there, in place of those of the lights.\n"
             "powers: (n, 3), what each carries, watts in linear Rec.709; default: 1. One row stands for all.");
}

}  // namespace lanthorn::python
