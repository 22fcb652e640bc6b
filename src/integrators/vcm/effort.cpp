// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "integrators/vcm/effort.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
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

EffortReport Effort::findings() const {
  // Variances of extreme scenes may exceed all numbers, which JSON does not know.
  const auto finite = [](double x) { return std::isfinite(x) ? x : std::numeric_limits<double>::max(); };
  EffortReport report = report_;
  report.summary = describe();
  report.variance = finite(report.variance);
  for (UniformEffort& choice : report.uniform) choice.variance = finite(choice.variance);
  return report;
}

}  // namespace lanthorn
