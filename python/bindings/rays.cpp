// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Ray queries, radiance along rays, and BSDFs, over arrays.
#include "lanthorn/rays.h"

#include <pybind11/stl.h>

#include "bindings.h"
#include "plain_data.h"

namespace lanthorn::python {

namespace {

std::size_t common_size(const std::vector<Vec3>& a, const std::vector<Vec3>& b, const char* names) {
  if (a.size() == b.size() || b.size() == 1) return a.size();
  if (a.size() == 1) return b.size();
  throw Error(std::string(names) + ": expected equal numbers of rows, or one, got " + std::to_string(a.size()) +
              " and " + std::to_string(b.size()));
}

py::object radiance(const SeenScene& scene, const py::object& origins, const py::object& directions,
                    std::uint32_t samples, std::uint64_t seed, int max_depth) {
  const std::vector<SceneRay> rays = rays_of(origins, directions);
  return array_of<float>(without_gil(
      [&] { return radiance_along(*scene.scene, rays, {.samples = samples, .seed = seed, .max_depth = max_depth}); }));
}

template <class Scalar, class T>
py::object column(const std::vector<RayHit>& hits, T RayHit::*member) {
  std::vector<T> values;
  values.reserve(hits.size());
  for (const RayHit& hit : hits) values.push_back(hit.*member);
  return array_of<Scalar>(std::move(values));
}

py::dict hits_of(const SeenScene& scene, const py::object& origins, const py::object& directions) {
  const std::vector<SceneRay> rays = rays_of(origins, directions);
  const std::vector<RayHit> hits = without_gil([&] { return intersect(*scene.scene, rays); });
  py::dict data;
  data["distance"] = column<float>(hits, &RayHit::distance);
  data["position"] = column<float>(hits, &RayHit::position);
  data["normal"] = column<float>(hits, &RayHit::normal);
  data["shading_normal"] = column<float>(hits, &RayHit::shading_normal);
  data["uv"] = column<float>(hits, &RayHit::uv);
  std::vector<std::uint8_t> emits;
  emits.reserve(hits.size());
  for (const RayHit& hit : hits) emits.push_back(hit.emits ? 1 : 0);
  data["emits"] = array_of<bool>(std::move(emits));
  return data;
}

// A scene with only this material, on a disk seen from above.
SurfaceBsdf bsdf_of_material(const py::dict& material) {
  py::dict disk, data;
  disk["type"] = "disk";
  disk["material"] = 1;
  data["materials"] = py::make_tuple(py::dict(), material);
  data["shapes"] = py::make_tuple(disk);
  return *bsdf_at(build_scene(description_of_dict(data)), {{0, 0, 1}, {0, 0, -1}});
}

template <class Scalar, class Result, class Function>
py::object over_pairs(const py::object& wi, const py::object& wo, Function&& function) {
  const std::vector<Vec3> from = vectors_of(wi, "wi"), to = vectors_of(wo, "wo");
  std::vector<Result> results(common_size(from, to, "wi, wo"));
  for (std::size_t i = 0; i < results.size(); ++i) results[i] = function(of_all(from, i), of_all(to, i));
  return array_of<Scalar>(std::move(results));
}

py::dict samples_of(const SurfaceBsdf& bsdf, const py::object& wi, const py::object& u) {
  const std::vector<Vec3> from = vectors_of(wi, "wi"), numbers = vectors_of(u, "u");
  const std::size_t count = common_size(from, numbers, "wi, u");
  std::vector<Vec3> wo(count);
  std::vector<Rgb> weight(count);
  std::vector<float> pdf(count);
  std::vector<std::uint8_t> is_delta(count);
  for (std::size_t i = 0; i < count; ++i) {
    const SurfaceBsdf::Sample sample = bsdf.sample(of_all(from, i), of_all(numbers, i));
    wo[i] = sample.wo;
    weight[i] = sample.weight;
    pdf[i] = sample.pdf;
    is_delta[i] = sample.is_delta ? 1 : 0;
  }
  py::dict data;
  data["wo"] = array_of<float>(std::move(wo));
  data["weight"] = array_of<float>(std::move(weight));
  data["pdf"] = array_of<float>(std::move(pdf));
  data["is_delta"] = array_of<bool>(std::move(is_delta));
  return data;
}

void bind_bsdf(py::module_& module) {
  py::class_<SurfaceBsdf>(
      module, "Bsdf",
      "The BSDF of a material, in RGB: Bsdf({'type': 'conductor', 'roughness': {'u': .3, 'v': .3}}).\n\n"
      "Directions are unit vectors of shape (n, 3) in the shading frame, whose z is the normal; all\n"
      "point away from the surface, wi towards the eye. A single row applies to all.")
      .def(py::init(&bsdf_of_material), py::arg("material"),
           "The BSDF of a material, a dict as in `load_dict`, without textures, on its outside.")
      .def(
          "eval",
          [](const SurfaceBsdf& self, const py::object& wi, const py::object& wo) {
            return over_pairs<float, Rgb>(wi, wo, [&](const Vec3& i, const Vec3& o) { return self.eval(i, o); });
          },
          py::arg("wi"), py::arg("wo"),
          "(n, 3) float32: f(wi, wo) in 1/sr, without the cosine and without delta lobes.")
      .def(
          "pdf",
          [](const SurfaceBsdf& self, const py::object& wi, const py::object& wo) {
            return over_pairs<float, float>(wi, wo, [&](const Vec3& i, const Vec3& o) { return self.pdf(i, o); });
          },
          py::arg("wi"), py::arg("wo"),
          "(n,) float32: density per solid angle with which `sample` chooses wo; without delta lobes.")
      .def("sample", &samples_of, py::arg("wi"), py::arg("u"),
           "dict of arrays: 'wo' (n, 3), 0 where light is absorbed; 'weight' (n, 3), f |cos| / pdf; 'pdf' (n,);\n"
           "'is_delta' (n,). u: numbers in [0, 1) of shape (n, 3).");
  module.def(
      "bsdf_at",
      [](const SeenScene& scene, const py::object& origin, const py::object& direction) {
        Reader reader;
        SceneRay ray;
        reader.at("origin", [&] { read(reader, origin, ray.origin); });
        reader.at("direction", [&] { read(reader, direction, ray.direction); });
        return bsdf_at(scene.scene, ray);
      },
      py::arg("scene"), py::arg("origin"), py::arg("direction"),
      "The Bsdf of the nearest surface along a ray; None if the ray hits nothing.");
}

bool is_one_row(py::handle data) {
  if (!py::isinstance<py::sequence>(data) || py::len(data) != 3) return false;
  const py::object first = data[py::int_(0)];
  return PyNumber_Check(first.ptr()) != 0 && PySequence_Check(first.ptr()) == 0;
}

}  // namespace

std::vector<Vec3> vectors_of(py::handle data, const char* name) {
  Reader reader;
  std::vector<Vec3> values;
  reader.at(name, [&] {
    if (is_one_row(data))
      read(reader, data, values.emplace_back());
    else
      read(reader, data, values);
  });
  return values;
}

std::vector<SceneRay> rays_of(const py::object& origins, const py::object& directions) {
  const std::vector<Vec3> o = vectors_of(origins, "origins"), d = vectors_of(directions, "directions");
  std::vector<SceneRay> rays(common_size(o, d, "origins, directions"));
  for (std::size_t i = 0; i < rays.size(); ++i) rays[i] = {of_all(o, i), of_all(d, i)};
  return rays;
}

void bind_rays(py::module_& module) {
  module.def(
      "radiance_along", &radiance, py::arg("scene"), py::arg("origins"), py::arg("directions"), py::kw_only(),
      py::arg("samples") = 64, py::arg("seed") = 0, py::arg("max_depth") = 64,
      "(n, 3) float32: radiance that arrives at each origin from its direction, linear Rec.709, by path tracing.\n\n"
      "origins, directions: (n, 3), metres; a single row applies to all. samples: paths per ray. The result does not\n"
      "depend on the number of threads.");
  module.def("intersect", &hits_of, py::arg("scene"), py::arg("origins"), py::arg("directions"),
             "dict of arrays, one row per ray: 'distance' (n,), metres, inf where the ray hits nothing; 'position',\n"
             "'normal' and 'shading_normal' (n, 3); 'uv' (n, 2); 'emits' (n,) bool.");
  bind_bsdf(module);
}

}  // namespace lanthorn::python
