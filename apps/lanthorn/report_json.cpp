// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "report_json.h"

namespace lanthorn::program {

nlohmann::json estimate_json(const ErrorEstimate& error) {
  return {{"noise", error.noise},
          {"bias", error.bias},
          {"error", error.error},
          {"bound", error.bound},
          {"doubt", error.doubt}};
}

nlohmann::json scene_json(const SceneSummary& s) {
  const auto vector = [](const Vec3& v) { return nlohmann::json{v.x, v.y, v.z}; };
  return {{"triangles", s.triangles},
          {"patches", s.patches},
          {"quadrics", s.quadrics},
          {"curve_segments", s.curves},
          {"instances", s.instances},
          {"textures", s.textures},
          {"lights", s.lights},
          {"materials", s.materials},
          {"bounds", {{"min", vector(s.bounds.min)}, {"max", vector(s.bounds.max)}}},
          {"memory_bytes",
           {{"geometry", s.geometry_bytes},
            {"bvh", s.bvh_bytes},
            {"textures", s.texture_bytes},
            {"texture_tiles_on_disk", s.texture_disk_bytes}}},
          {"texture_tiles_read", s.texture_tiles_read},
          {"build_seconds", s.build_seconds},
          {"dispersion", s.has_dispersion},
          {"measured_spectra", s.has_measured_spectra},
          {"motion", s.has_motion}};
}

}  // namespace lanthorn::program
