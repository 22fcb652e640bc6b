// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "integrators/vcm/effort.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "lanthorn/number_text.h"

namespace lanthorn {

Effort::Effort(std::uint64_t light_paths, const PixelWindow& window, int columns, std::vector<PlaceEffort> blocks,
               EffortReport report)
    : light_paths_(light_paths),
      window_(window),
      columns_(columns),
      rows_(static_cast<int>(blocks.size()) / columns),
      blocks_(std::move(blocks)),
      report_(std::move(report)) {}

std::size_t Effort::block_of(const Vec2& raster) const {
  const auto index = [](float x, int pixels, int blocks) {
    return std::clamp(static_cast<int>(x * static_cast<float>(blocks) / static_cast<float>(pixels)), 0, blocks - 1);
  };
  const Vec2 at = raster - window_.corner();
  const int row = index(at.y, window_.height(), rows_), column = index(at.x, window_.width(), columns_);
  const int block = row * columns_ + column;
  return static_cast<std::size_t>(block);
}

std::string Effort::describe() const {
  const auto percent = [](double share) { return fmt::format("{:.{}f} %", 100 * share, share < 0.1 ? 1 : 0); };
  const bool has_caustics = report_.caustic_light >= 0.001;
  const std::string found = has_caustics ? fmt::format("caustics make {} of the light, in {} of the picture",
                                                       percent(report_.caustic_light), percent(report_.caustic_part))
                                         : "hardly any light is in caustics";
  if (light_paths_ == 0) return found + ": path tracing";
  const std::string shorter =
      report_.short_part > 0 ? fmt::format("; in {}, eye paths end at their first merge", percent(report_.short_part))
                             : "";
  return fmt::format("{}: {} light paths a pixel, merged in {} and connected in {} of the picture{}", found,
                     short_number(report_.light_paths_per_pixel), percent(report_.merged_part),
                     percent(report_.connected_part), shorter);
}

std::string Effort::findings() const {
  // Variances of extreme scenes may exceed all numbers, which JSON does not know.
  const auto finite = [](double x) { return std::isfinite(x) ? x : std::numeric_limits<double>::max(); };
  const EyeWork& eye = report_.work_of_eye_path;
  nlohmann::json uniform = nlohmann::json::array();
  for (const UniformEffort& u : report_.uniform)
    uniform.push_back({{"light_paths_per_pixel", u.light_paths_per_pixel},
                       {"connections", u.place.connections},
                       {"merges", u.place.merges},
                       {"merges_in_media", u.place.merges_in_media},
                       {"connects_to_lens", u.place.sees},
                       {"goes_on", u.place.goes_on},
                       {"variance", finite(u.variance)},
                       {"work", u.work}});
  return nlohmann::json{{"summary", describe()},
                        {"caustic_light", report_.caustic_light},
                        {"caustic_part", report_.caustic_part},
                        {"light_by_light_paths", report_.light_by_light_paths},
                        {"light_paths_per_pixel", report_.light_paths_per_pixel},
                        {"merged_part", report_.merged_part},
                        {"connected_part", report_.connected_part},
                        {"short_part", report_.short_part},
                        {"variance", finite(report_.variance)},
                        {"work", report_.work},
                        {"eye_path",
                         {{"rays", eye.rays},
                          {"next_events", eye.next_events},
                          {"connections", eye.connections},
                          {"lookups", eye.lookups},
                          {"merges", eye.merges}}},
                        {"light_path", {{"rays", report_.light_rays}, {"vertices", report_.light_vertices}}},
                        {"everywhere", std::move(uniform)}}
      .dump();
}

}  // namespace lanthorn
