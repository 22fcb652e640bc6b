// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "scene_file.h"

#include <array>
#include <map>
#include <string>
#include <variant>

namespace lanthorn {

namespace {

template <class Counts>
void count_by_kind(const auto& variants, const auto& names, Counts& counts) {
  for (const auto& v : variants) ++counts[names[v.index()]];
}

nlohmann::json vector_json(const Vec3& v) { return {v.x, v.y, v.z}; }

}  // namespace

nlohmann::json describe_scene(const Scene& scene) {
  constexpr std::array light_names{"area",
                                   "point",
                                   "spot",
                                   "goniometric",
                                   "projection",
                                   "distant",
                                   "infinite (constant)",
                                   "infinite (image)",
                                   "infinite (portal)"};
  constexpr std::array material_names{"diffuse",
                                      "diffusetransmission",
                                      "conductor",
                                      "dielectric",
                                      "thindielectric",
                                      "coateddiffuse",
                                      "coatedconductor",
                                      "hair",
                                      "plastic",
                                      "measured",
                                      "mix",
                                      "interface"};
  static_assert(material_names.size() == std::variant_size_v<decltype(description::Material::node)>);
  std::map<std::string, int> lights, materials;
  count_by_kind(scene.lights(), light_names, lights);
  for (const description::Material& m : scene.description().materials) ++materials[material_names[m.node.index()]];
  const SceneStatistics& s = scene.statistics();
  return {{"triangles", s.triangles},
          {"patches", s.patches},
          {"quadrics", s.quadrics},
          {"curve_segments", s.curves},
          {"instances", s.instances},
          {"textures", s.textures},
          {"lights", lights},
          {"materials", materials},
          {"bounds", {{"min", vector_json(scene.bounds().min)}, {"max", vector_json(scene.bounds().max)}}},
          {"memory_bytes", {{"geometry", s.geometry_bytes}, {"bvh", s.bvh_bytes}, {"textures", s.texture_bytes}}},
          {"build_seconds", s.build_seconds},
          {"dispersion", scene.has_dispersion()},
          {"measured_spectra", scene.has_measured_spectra()},
          {"motion", scene.has_motion()}};
}

}  // namespace lanthorn
