// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "integrators/auto/choice.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "lanthorn/number_text.h"

namespace lanthorn {

std::string EffortReport::describe() const {
  const auto percent = [](double share) { return fmt::format("{:.{}f} %", 100 * share, share < 0.1 ? 1 : 0); };
  const bool has_caustics = caustic_light >= 0.001;
  const std::string found = has_caustics ? fmt::format("caustics make {} of the light, in {} of the picture",
                                                       percent(caustic_light), percent(caustic_part))
                                         : "hardly any light is in caustics";
  if (light_paths_per_pixel == 0) return found + ": path tracing";
  const std::string shorter =
      short_part > 0 ? fmt::format("; in {}, eye paths end at their first merge", percent(short_part)) : "";
  return fmt::format("{}: {} light paths a pixel, merged in {} and connected in {} of the picture{}", found,
                     short_number(light_paths_per_pixel), percent(merged_part), percent(connected_part), shorter);
}

std::string EffortReport::as_json() const {
  // Variances of extreme scenes may exceed all numbers, which JSON does not know.
  const auto finite = [](double x) { return std::isfinite(x) ? x : std::numeric_limits<double>::max(); };
  const EyeWork& eye = work_of_eye_path;
  nlohmann::json everywhere = nlohmann::json::array();
  for (const UniformEffort& u : uniform)
    everywhere.push_back({{"light_paths_per_pixel", u.light_paths_per_pixel},
                          {"connections", u.place.connections},
                          {"merges", u.place.merges},
                          {"merges_in_media", u.place.merges_in_media},
                          {"connects_to_lens", u.place.sees},
                          {"goes_on", u.place.goes_on},
                          {"variance", finite(u.variance)},
                          {"work", u.work}});
  return nlohmann::json{{"summary", describe()},
                        {"caustic_light", caustic_light},
                        {"caustic_part", caustic_part},
                        {"light_by_light_paths", light_by_light_paths},
                        {"light_paths_per_pixel", light_paths_per_pixel},
                        {"merged_part", merged_part},
                        {"connected_part", connected_part},
                        {"short_part", short_part},
                        {"variance", finite(variance)},
                        {"work", work},
                        {"eye_path",
                         {{"rays", eye.rays},
                          {"next_events", eye.next_events},
                          {"connections", eye.connections},
                          {"lookups", eye.lookups},
                          {"merges", eye.merges}}},
                        {"light_path", {{"rays", light_rays}, {"vertices", light_vertices}}},
                        {"everywhere", std::move(everywhere)}}
      .dump();
}

}  // namespace lanthorn
