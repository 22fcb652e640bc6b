// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "ibl/split_sum.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "ibl/bake_plan.h"

namespace lanthorn {

namespace {

constexpr int table_size = split_sum_table_size;
constexpr RoughnessMapping mapping = RoughnessMapping::square;

}  // namespace

IblSettings split_sum_settings(const Image& environment) {
  IblSettings settings;
  // The map is as fine as the environment, within these bounds of memory and time.
  constexpr unsigned least_size = 256, most_size = 1024;
  const auto texels_per_face = static_cast<unsigned>(environment.width) / 4;
  settings.specular_size = static_cast<int>(std::clamp(std::bit_ceil(texels_per_face), least_size, most_size));
  settings.sh = false;
  settings.checks = 0;
  settings.samples = 1024;
  settings.mapping = mapping;
  settings.weight = LobeWeight::masking;
  // Closely spaced roughness levels, since values between them are interpolated.
  settings.smallest_size = 4;
  return settings;
}

SplitSum::SplitSum(const Image& environment) : table_(brdf_table(table_size, false)) {
  const Ibl ibl = bake_ibl(environment, split_sum_settings(environment));
  irradiance_ = cube_of(*ibl.irradiance);
  for (const SpecularLevel& level : ibl.specular) levels_.push_back(cube_of(level.faces));
}

Spectrum SplitSum::reflection(const Direction& r, float alpha) const {
  const auto last = static_cast<float>(levels_.size() - 1);
  const float level = std::clamp(level_of_roughness(std::sqrt(alpha), mapping) * last, 0.0f, last);
  const auto lower = static_cast<std::size_t>(level), upper = std::min(lower + 1, levels_.size() - 1);
  const float t = level - static_cast<float>(lower);
  return (1 - t) * levels_[lower].lookup(r) + t * levels_[upper].lookup(r);
}

SplitSum::Brdf SplitSum::brdf(float cos, float alpha) const {
  const auto place = [](float x) { return std::clamp(x * table_size - 0.5f, 0.0f, table_size - 1.0f); };
  const float x = place(cos), y = place(std::sqrt(alpha));
  const int x0 = std::min(static_cast<int>(x), table_size - 2), y0 = std::min(static_cast<int>(y), table_size - 2);
  const float fx = x - static_cast<float>(x0), fy = y - static_cast<float>(y0);
  const auto channel = [&](std::size_t c) {
    return (1 - fy) * ((1 - fx) * table_.at(x0, y0, c) + fx * table_.at(x0 + 1, y0, c)) +
           fy * ((1 - fx) * table_.at(x0, y0 + 1, c) + fx * table_.at(x0 + 1, y0 + 1, c));
  };
  return {channel(0), channel(1)};
}

}  // namespace lanthorn
